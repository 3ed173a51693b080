//! Meshes made from the patterns of rules, for drawings.

use super::error::RunError;
use super::lint::{Shape, Side};
use super::pattern::{Comparison, Label, Test};
use super::ruleset::{Rule, RuleSet};
use super::run::apply_to;
use super::search::compare;
use crate::mesh::{Domain, Mesh, Node, Polygons, Value, VertexId};

/// Pieces between the two ends of a link along a side: three lines make four pieces, as in the paper's figures.
const INNER_PIECES: usize = 2;
/// Sides of a face whose number of sides the pattern leaves open.
const SIDES: usize = 4;

/// A mesh in which a rule's pattern is found, in the plane z = 0.
#[derive(Clone, Debug)]
pub struct Sample {
    /// The mesh, with the attributes and links that the pattern asks for.
    pub mesh: Mesh,
    /// The element of each node of the pattern.
    pub nodes: Vec<(String, Node)>,
    /// Vertices where a side of a face begins; the others lie inside of straight sides.
    pub corners: Vec<bool>,
    rule: usize,
}

/// The half-edges of a face, and for each whether a side begins with it.
struct Outline {
    edges: Vec<usize>,
    begins: Vec<bool>,
}

impl Sample {
    /// A mesh made from the pattern of `rule`. Faces are regular polygons, quads where the pattern does not say; the
    /// pieces of a side lie on a straight line.
    ///
    /// # Errors
    /// Why no mesh can be made: the pattern contradicts itself.
    pub fn new(set: &RuleSet, rule: &Rule) -> Result<Self, String> {
        let number =
            set.rules.iter().position(|known| known.name == rule.name).ok_or("the rule is of another set")?;
        let mut shape = Shape::of(rule).map_err(|(_, message)| message)?;
        let outlines = outlines(set, rule, &mut shape);
        if outlines.is_empty() {
            return Err("the pattern has no face".to_owned());
        }
        Self::build(set, rule, number, &mut shape, &outlines)
    }

    fn build(
        set: &RuleSet,
        rule: &Rule,
        number: usize,
        shape: &mut Shape,
        outlines: &[Outline],
    ) -> Result<Self, String> {
        let mut vertices: Vec<usize> = Vec::new();
        let mut faces: Vec<Vec<u32>> = Vec::new();
        let mut corners: Vec<bool> = Vec::new();
        for outline in outlines {
            let mut face = Vec::new();
            for (&h, &begins) in outline.edges.iter().zip(&outline.begins) {
                let v = shape.get(h, Side::Source);
                let at = vertices.iter().position(|&known| known == v).unwrap_or_else(|| {
                    vertices.push(v);
                    corners.push(false);
                    vertices.len() - 1
                });
                corners[at] |= begins;
                face.push(at as u32);
            }
            faces.push(face);
        }
        let lists: Vec<&[u32]> = faces.iter().map(Vec::as_slice).collect();
        let positions = super::layout::positions(&lists, &corners);
        let mut mesh =
            Mesh::from_polygons(&Polygons::new(positions, &lists)).map_err(|defects| defects.to_string())?;
        let vertex = |v: usize| vertices.iter().position(|&known| known == v).map(|at| VertexId(at as u32));
        let half_edge = |mesh: &Mesh, h: usize| {
            let ends = [Side::Source, Side::Target].map(|side| shape.side(h, side).and_then(vertex));
            mesh.find_half_edge(ends[0]?, ends[1]?)
        };
        let mut nodes = Vec::new();
        for (i, (name, domain)) in rule.nodes.iter().enumerate() {
            let node = match domain {
                Domain::Vertex => vertex(shape.root(i)).map(Node::Vertex),
                Domain::HalfEdge => half_edge(&mesh, i).map(Node::HalfEdge),
                Domain::Face => (0..shape.len())
                    .filter(|&h| {
                        shape.domain(h) == Domain::HalfEdge
                            && shape.side(h, Side::Face) == Some(shape.root(i))
                    })
                    .find_map(|h| half_edge(&mesh, h))
                    .map(|h| Node::Face(mesh.face(h))),
            };
            nodes.push((
                name.clone(),
                node.ok_or_else(|| format!("`{name}` finds no place in a plane drawing"))?,
            ));
        }
        for (node, (_, element)) in rule.pattern.nodes.iter().zip(&nodes) {
            for test in &node.tests {
                let symbol = mesh.intern(&test.attribute);
                mesh.set_attribute(*element, symbol, Some(passing(set, &node.tests, test)));
            }
        }
        for edge in &rule.pattern.edges {
            if let Label::Link(label) = &edge.label {
                let symbol = mesh.intern(label);
                mesh.set_link(nodes[edge.from].1, symbol, nodes[edge.to].1, true);
            }
        }
        Ok(Self { mesh, nodes, corners, rule: number })
    }

    /// Applies the rule, whatever its conditions say. Attributes that the script misses have the values of the
    /// `example`s.
    ///
    /// # Errors
    /// Why the action failed.
    pub fn apply(&self, set: &RuleSet) -> Result<Mesh, RunError> {
        let mut mesh = self.mesh.clone();
        let ids: Vec<u32> = self.nodes.iter().map(|(_, node)| node.id()).collect();
        apply_to(set, self.rule, &mut mesh, &ids)?;
        Ok(mesh)
    }
}

/// A value of `test`'s attribute that passes all tests of it.
fn passing(set: &RuleSet, tests: &[Test], test: &Test) -> Value {
    let same = || {
        tests
            .iter()
            .filter(|other| other.attribute == test.attribute)
            .filter_map(|other| other.value.as_ref())
    };
    let near = same().flat_map(|(_, value)| match value {
        Value::Number(x) => vec![Value::Number(*x), Value::Number(x + 1.0), Value::Number(x - 1.0)],
        other => vec![other.clone()],
    });
    let mut candidates =
        set.examples.get(&test.attribute).cloned().into_iter().chain([Value::Number(1.0)]).chain(near);
    let passes = |value: &Value| {
        same().all(|(comparison, wanted): &(Comparison, Value)| compare(value, *comparison, wanted))
    };
    candidates.find(passes).unwrap_or(Value::Number(1.0))
}

/// The faces of a shape, made complete where the pattern leaves something open.
fn outlines(set: &RuleSet, rule: &Rule, shape: &mut Shape) -> Vec<Outline> {
    for node in 0..rule.nodes.len() {
        // A vertex or a face alone gets a half-edge.
        let lacks = |shape: &Shape, side: Side| {
            shape.root(node) == node
                && !(0..shape.len())
                    .any(|h| shape.domain(h) == Domain::HalfEdge && shape.side(h, side) == Some(node))
        };
        let (side, is_lone) = match shape.domain(node) {
            Domain::Vertex => (Side::Source, lacks(shape, Side::Source) && lacks(shape, Side::Target)),
            Domain::Face => (Side::Face, lacks(shape, Side::Face)),
            Domain::HalfEdge => continue,
        };
        if is_lone {
            let h = shape.add_half_edge();
            shape.put(h, side, node);
            shape.close();
        }
    }
    let mut done = vec![false; shape.len()];
    let mut found = Vec::new();
    let mut h = 0;
    while h < shape.len() {
        if shape.domain(h) == Domain::HalfEdge && shape.root(h) == h && !done.get(h).copied().unwrap_or(false)
        {
            if shape.is_boundary(h) {
                // Outside: the face is on the other side.
                shape.get(h, Side::Mate);
            } else {
                let outline = outline(set, rule, shape, h);
                done.resize(shape.len(), false);
                outline.edges.iter().for_each(|&h| done[h] = true);
                found.push(outline);
            }
        }
        h += 1;
    }
    found
}

/// Walks round the face of `h` and closes it.
fn outline(set: &RuleSet, rule: &Rule, shape: &mut Shape, h: usize) -> Outline {
    let first = |shape: &Shape, h: usize| {
        let mut at = h;
        while let Some(prev) = shape.side(at, Side::Prev) {
            if prev == h {
                return h;
            }
            at = prev;
        }
        at
    };
    let begin = first(shape, h);
    // A side begins with a half-edge unless it starts at a vertex inside of a side.
    let corner = |shape: &mut Shape, h: usize| {
        let v = shape.get(h, Side::Source);
        let inside = |test: &Test| set.straight.contains(&test.attribute);
        let at = |node: usize| shape.root(node) == v && rule.pattern.nodes[node].tests.iter().any(inside);
        !(0..rule.pattern.nodes.len()).any(at)
    };
    let mut edges = vec![begin];
    let mut begins = vec![corner(shape, begin)];
    loop {
        let last = edges[edges.len() - 1];
        if let Some(next) = shape.side(last, Side::Next) {
            if next == begin {
                break;
            }
            edges.push(next);
            begins.push(corner(shape, next));
            continue;
        }
        // A link to the begin of a chain runs along a side: pieces lie between.
        let linked = rule.pattern.edges.iter().find_map(|edge| {
            let to = shape.root(edge.to);
            let fits = edge.label.link().is_some()
                && shape.root(edge.from) == last
                && shape.domain(to) == Domain::HalfEdge;
            (fits && shape.side(to, Side::Prev).is_none() && to != last).then_some(to)
        });
        let mut at = last;
        let (pieces, straight) = match linked {
            Some(_) => (INNER_PIECES, true),
            None => {
                let sides = begins.iter().filter(|begins| **begins).count();
                (SIDES.saturating_sub(sides), false)
            }
        };
        for _ in 0..pieces {
            let piece = shape.get(at, Side::Next);
            edges.push(piece);
            begins.push(!straight && corner(shape, piece));
            at = piece;
        }
        let to = linked.unwrap_or(begin);
        shape.put(at, Side::Next, to);
        shape.close();
        if to == begin {
            // The chain began in the middle of a side.
            begins[0] &= !straight;
            break;
        }
        edges.push(to);
        begins.push(!straight);
    }
    // A link between two ends of a side that the pattern writes out: its pieces are straight, too.
    for edge in rule.pattern.edges.iter().filter(|edge| edge.label.link().is_some()) {
        let place = |node: usize| edges.iter().position(|&h| h == shape.root(node));
        if let (Some(from), Some(to)) = (place(edge.from), place(edge.to)) {
            let mut at = from;
            while at != to {
                at = (at + 1) % edges.len();
                begins[at] = false;
            }
        }
    }
    // The side of the node that is named first lies below.
    let named = (0..edges.len()).min_by_key(|&i| edges[i]).unwrap_or(0);
    let start = (0..=named).rev().chain((0..edges.len()).rev()).find(|&i| begins[i]).unwrap_or(0);
    edges.rotate_left(start);
    begins.rotate_left(start);
    Outline { edges: edges.iter().map(|&h| shape.root(h)).collect(), begins }
}
