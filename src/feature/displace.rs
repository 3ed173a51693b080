//! Heights: how far the control vertices of a feature move so that its limit surface has the asked depth.
//!
//! One sparse system over the green vertices: the limit point of each is to lie at its target height along its
//! normal. In straight bands this gives the closed form 3/2 of the depth, in crossings the centre at half height
//! (docs/linear-features.md, sections 1 and 2).

use super::request::Feature;
use super::section::Section;
use crate::fault;
use crate::mesh::{Domain, Mesh, Node, Value, VertexId};
use crate::optimise::{LeastSquares, Row};
use crate::subdivision::{limit_mask, limit_normal, limit_position};
use glam::DVec3;
use rustc_hash::FxHashMap;

/// A vertex that belongs to a line of a profile.
#[derive(Clone, Copy, Debug)]
pub(super) struct LineVertex {
    pub(super) vertex: VertexId,
    /// Which feature.
    pub(super) feature: usize,
    /// Which line, from 0.
    pub(super) line: usize,
    /// Feature and line of the other one, where two cross.
    pub(super) cross: Option<(usize, usize)>,
    /// The mark on whose edge it was inserted; `None` inside a junction.
    pub(super) mark: Option<usize>,
    /// Control height as a fraction of that in a straight band, where a rule fixes it.
    pub(super) hold: Option<f64>,
}

impl LineVertex {
    fn lines(&self) -> impl Iterator<Item = (usize, usize)> {
        [Some((self.feature, self.line)), self.cross].into_iter().flatten()
    }

    /// True when both lie on one line of a feature.
    pub(super) fn shares_line(&self, other: &Self) -> bool {
        self.lines().any(|line| other.lines().any(|other| line == other))
    }
}

/// The vertices that the rules assigned to lines of profiles, by id. `feature_of` knows the kinds.
pub(super) fn line_vertices(mesh: &Mesh, feature_of: impl Fn(&str) -> Option<usize>) -> Vec<LineVertex> {
    let Some(line) = mesh.symbol("line") else { return Vec::new() };
    let value = |v: VertexId, name: &str| mesh.attribute_named(Node::Vertex(v), name);
    let number = |v: VertexId, name: &str| value(v, name).and_then(Value::as_number);
    let feature =
        |v: VertexId, name: &str| value(v, name).and_then(Value::as_text).map_or(Some(0), &feature_of);
    mesh.nodes_with_attribute(Domain::Vertex, line)
        .into_iter()
        .map(VertexId)
        .filter_map(|vertex| {
            // Lines count from 1 in rules; a cast of anything else saturates and finds no line.
            let index = |name: &str| number(vertex, name).map(|line| (line - 1.0) as usize);
            Some(LineVertex {
                vertex,
                feature: feature(vertex, "kind")?,
                line: index("line")?,
                cross: index("cross").and_then(|line| Some((feature(vertex, "crosskind")?, line))),
                mark: number(vertex, "mark").map(|mark| mark as usize),
                hold: number(vertex, "hold"),
            })
        })
        .collect()
}

/// A displaced vertex.
#[derive(Clone, Copy, Debug)]
pub(super) struct Green {
    pub(super) vertex: VertexId,
    /// Limit point before displacement.
    pub(super) base: DVec3,
    /// Unit normal of the limit surface before displacement.
    pub(super) normal: DVec3,
    /// Asked height of the limit surface along the normal, model units.
    pub(super) target: f64,
    /// Size of the height asked for by the user, without corrections.
    pub(super) asked: f64,
    /// Height of the control vertex over the base, where a rule fixes it.
    hold: Option<f64>,
}

/// What the marks ask for: parameters of their features, in model units.
pub(super) struct Asked<'a> {
    pub(super) features: &'a [Feature],
    /// The feature of each mark.
    pub(super) feature_of: &'a [usize],
    /// Per mark, values to aim at.
    pub(super) aims: &'a [Vec<f64>],
    /// Per mark, values that the user asked for.
    pub(super) asked: &'a [Vec<f64>],
    /// Vertices inside of closed loops, and their features.
    pub(super) inside: &'a [(VertexId, usize)],
}

/// Values to aim at and asked for.
type Values = [Vec<f64>; 2];

fn mean(values: &[Values], count: usize) -> Values {
    let n = values.len().max(1) as f64;
    [0, 1].map(|k| (0..count).map(|p| values.iter().map(|v| v[k][p]).sum::<f64>() / n).collect())
}

/// The vertices that are displaced, with their targets.
pub(super) fn greens(mesh: &Mesh, lines: &[LineVertex], asked: &Asked) -> Vec<Green> {
    let of_mark = |mark: usize| -> Option<(usize, Values)> {
        Some((*asked.feature_of.get(mark)?, [asked.aims.get(mark)?.clone(), asked.asked.get(mark)?.clone()]))
    };
    let marks: FxHashMap<VertexId, usize> = lines.iter().filter_map(|v| Some((v.vertex, v.mark?))).collect();
    let count = |feature: usize| asked.features[feature].profile.parameters.len();
    let overall: Vec<Values> = (0..asked.features.len())
        .map(|feature| {
            let all = (0..asked.aims.len()).filter_map(of_mark).filter(|(f, _)| *f == feature);
            mean(&all.map(|(_, values)| values).collect::<Vec<_>>(), count(feature))
        })
        .collect();
    // At a vertex: what its mark asks for; inside a junction, what the lines around it ask for.
    let values = |v: VertexId, feature: usize| -> Values {
        let of_vertex = |v: &VertexId| {
            let (f, values) = of_mark(*marks.get(v)?)?;
            (f == feature).then_some(values)
        };
        of_vertex(&v).unwrap_or_else(|| {
            let around: Vec<Values> = mesh.outgoing(v).filter_map(|h| of_vertex(&mesh.target(h))).collect();
            if around.is_empty() { overall[feature].clone() } else { mean(&around, count(feature)) }
        })
    };
    let green = |vertex: VertexId, height: [f64; 2], hold: Option<f64>| {
        let normal = limit_normal(mesh, vertex)?;
        let base = limit_position(mesh, vertex);
        Some(Green { vertex, base, normal, target: height[0], asked: height[1].abs(), hold })
    };
    let mut greens: Vec<Green> = lines
        .iter()
        .filter_map(|v| {
            // Where two features cross, the greater height wins.
            let (feature, line, height, values) = v
                .lines()
                .filter_map(|(feature, line)| {
                    let height = asked.features[feature].profile.lines.get(line)?.height?;
                    let values = values(v.vertex, feature);
                    Some((feature, line, [height.of(&values[0]), height.of(&values[1])], values))
                })
                .max_by(|a, b| a.2[0].abs().total_cmp(&b.2[0].abs()))?;
            let hold = v.hold.map(|fraction| {
                let section = Section::new(&asked.features[feature].profile, &values[0]);
                fraction * section.control.get(line).copied().unwrap_or(0.0)
            });
            green(v.vertex, height, hold)
        })
        .collect();
    greens.extend(asked.inside.iter().filter(|(v, _)| mesh.has_vertex(*v)).filter_map(|&(v, feature)| {
        let height = asked.features[feature].profile.inside?;
        green(v, [0, 1].map(|k| height.of(&overall[feature][k])), None)
    }));
    greens.sort_by_key(|green| green.vertex);
    greens
}

/// Displaces single vertices: moves each along the limit normal so that its limit point rises by `height` (model
/// units, negative inwards), all together by one sparse system. Returns the vertices that have no normal and were left
/// out. This is the stage that [`apply`](super::apply) runs on the lines of a profile.
pub fn raise(mesh: &mut Mesh, heights: &[(VertexId, f64)]) -> Vec<VertexId> {
    let mut left_out = Vec::new();
    let mut greens = Vec::new();
    for &(vertex, target) in heights {
        match limit_normal(mesh, vertex) {
            Some(normal) => {
                let base = limit_position(mesh, vertex);
                greens.push(Green { vertex, base, normal, target, asked: target.abs(), hold: None });
            }
            None => left_out.push(vertex),
        }
    }
    displace(mesh, &greens);
    left_out
}

/// Moves the green vertices along their normals so that their limit points reach the targets.
pub(super) fn displace(mesh: &mut Mesh, greens: &[Green]) {
    fault::point("displace");
    let unknowns: FxHashMap<VertexId, u32> = greens
        .iter()
        .filter(|green| green.hold.is_none())
        .enumerate()
        .map(|(i, green)| (green.vertex, i as u32))
        .collect();
    let held: FxHashMap<VertexId, DVec3> =
        greens.iter().filter_map(|green| Some((green.vertex, green.normal * green.hold?))).collect();
    let free: Vec<&Green> = greens.iter().filter(|green| green.hold.is_none()).collect();
    let mut rows = Vec::with_capacity(free.len());
    let mut targets = Vec::with_capacity(free.len());
    for green in &free {
        let mut row = Row::new();
        let mut target = green.target;
        for (v, weight) in limit_mask(mesh, green.vertex) {
            if let Some(&j) = unknowns.get(&v) {
                row.push((j, weight * free[j as usize].normal.dot(green.normal)));
            } else if let Some(shift) = held.get(&v) {
                target -= weight * shift.dot(green.normal);
            }
        }
        rows.push(row);
        targets.push(target);
    }
    if let Some(system) = LeastSquares::new(rows, free.len()) {
        let heights = system.solve(targets.into_iter());
        for (green, height) in free.iter().zip(heights) {
            mesh.set_position(green.vertex, mesh.position(green.vertex) + green.normal * height);
            fault::point("displace");
        }
    }
    for (v, shift) in held_in_order(greens, &held) {
        mesh.set_position(v, mesh.position(v) + shift);
    }
}

fn held_in_order(
    greens: &[Green],
    held: &FxHashMap<VertexId, DVec3>,
) -> impl Iterator<Item = (VertexId, DVec3)> {
    greens.iter().filter_map(|green| Some((green.vertex, *held.get(&green.vertex)?)))
}
