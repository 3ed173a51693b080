//! The piece of mesh that a pattern describes: what its labels say, and what follows from them.

use crate::grammar::pattern::Label;
use crate::grammar::ruleset::Rule;
use crate::mesh::Domain;

/// Where one gets from a half-edge.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(in crate::grammar) enum Side {
    Next,
    Prev,
    Mate,
    Source,
    Target,
    Face,
}

const SIDES: [Side; 6] = [Side::Next, Side::Prev, Side::Mate, Side::Source, Side::Target, Side::Face];

/// Elements that a pattern needs, and how they hang together. The first are the nodes of the pattern; the others are
/// not named in it. Nodes that are the same element share a root.
#[derive(Clone, Debug)]
pub(in crate::grammar) struct Shape {
    parent: Vec<usize>,
    domains: Vec<Domain>,
    sides: Vec<[Option<usize>; 6]>,
    boundary: Vec<bool>,
    named: usize,
    /// Pairs that are the same element.
    pending: Vec<(usize, usize)>,
}

/// The edge of the pattern at which it becomes impossible, and why.
type Impossible = (Option<usize>, String);

impl Shape {
    /// The shape of a rule's pattern, or why no mesh has it.
    pub(in crate::grammar) fn of(rule: &Rule) -> Result<Self, Impossible> {
        let nodes = &rule.pattern.nodes;
        let domains: Vec<Domain> = rule.nodes.iter().map(|(_, domain)| *domain).collect();
        let mut shape = Self {
            parent: (0..nodes.len()).collect(),
            sides: vec![[None; 6]; nodes.len()],
            boundary: nodes.iter().map(|node| node.boundary).collect(),
            domains,
            named: nodes.len(),
            pending: Vec::new(),
        };
        for (number, edge) in rule.pattern.edges.iter().enumerate() {
            let (a, b) = (edge.from, edge.to);
            match edge.label {
                Label::FaceCcw => shape.put(a, Side::Next, b),
                Label::FaceCw => shape.put(a, Side::Prev, b),
                Label::Mate => shape.put(a, Side::Mate, b),
                Label::VertexCw => {
                    let mate = shape.get(a, Side::Mate);
                    shape.put(mate, Side::Next, b);
                }
                Label::VertexCcw => {
                    let prev = shape.get(a, Side::Prev);
                    shape.put(prev, Side::Mate, b);
                }
                Label::Source => shape.put(a, Side::Source, b),
                Label::Target => shape.put(a, Side::Target, b),
                Label::Face => shape.put(a, Side::Face, b),
                Label::Link(_) => {}
            }
            shape.close();
            shape.contradiction(rule).map_or(Ok(()), |message| Err((Some(number), message)))?;
        }
        Ok(shape)
    }

    /// The element that stands for `element`.
    pub(in crate::grammar) fn root(&self, element: usize) -> usize {
        let mut at = element;
        while self.parent[at] != at {
            at = self.parent[at];
        }
        at
    }

    /// Number of elements, merged ones included.
    pub(in crate::grammar) fn len(&self) -> usize {
        self.parent.len()
    }

    pub(in crate::grammar) fn domain(&self, element: usize) -> Domain {
        self.domains[element]
    }

    pub(in crate::grammar) fn is_boundary(&self, element: usize) -> bool {
        self.boundary[self.root(element)]
    }

    /// Where `side` leads, if the pattern says so.
    pub(in crate::grammar) fn side(&self, element: usize, side: Side) -> Option<usize> {
        self.sides[self.root(element)][side as usize].map(|to| self.root(to))
    }

    /// Where `side` leads; a new element when that is not known.
    pub(in crate::grammar) fn get(&mut self, element: usize, side: Side) -> usize {
        if let Some(to) = self.side(element, side) {
            return to;
        }
        let to = self.add(match side {
            Side::Next | Side::Prev | Side::Mate => Domain::HalfEdge,
            Side::Source | Side::Target => Domain::Vertex,
            Side::Face => Domain::Face,
        });
        self.put(element, side, to);
        self.close();
        self.root(to)
    }

    /// A half-edge that nothing is known of.
    pub(in crate::grammar) fn add_half_edge(&mut self) -> usize {
        self.add(Domain::HalfEdge)
    }

    fn add(&mut self, domain: Domain) -> usize {
        self.parent.push(self.parent.len());
        self.domains.push(domain);
        self.sides.push([None; 6]);
        self.boundary.push(false);
        self.parent.len() - 1
    }

    /// Says that `side` of `a` is `b`.
    pub(in crate::grammar) fn put(&mut self, a: usize, side: Side, b: usize) {
        let (a, b) = (self.root(a), self.root(b));
        let set =
            |shape: &mut Self, from: usize, side: Side, to: usize| match shape.sides[from][side as usize] {
                Some(known) => shape.pending.push((known, to)),
                None => shape.sides[from][side as usize] = Some(to),
            };
        set(self, a, side, b);
        match side {
            Side::Next => set(self, b, Side::Prev, a),
            Side::Prev => set(self, b, Side::Next, a),
            Side::Mate => set(self, b, Side::Mate, a),
            _ => {}
        }
    }

    /// Draws all conclusions.
    pub(in crate::grammar) fn close(&mut self) {
        loop {
            while let Some((a, b)) = self.pending.pop() {
                self.merge(a, b);
            }
            let mut changed = false;
            for h in (0..self.parent.len())
                .filter(|&h| self.parent[h] == h && self.domains[h] == Domain::HalfEdge)
                .collect::<Vec<_>>()
            {
                let [next, mate] = [Side::Next, Side::Mate].map(|side| self.side(h, side));
                // The ends of neighbours and of the two directions of an edge are the same.
                let same = |shape: &mut Self, a: usize, x: Side, b: usize, y: Side| {
                    match (shape.side(a, x), shape.side(b, y)) {
                        (Some(v), Some(w)) if v == w => return false,
                        (Some(v), Some(w)) => shape.pending.push((v, w)),
                        (Some(v), None) => shape.put(b, y, v),
                        (None, Some(w)) => shape.put(a, x, w),
                        (None, None) => return false,
                    }
                    true
                };
                if let Some(next) = next {
                    changed |= same(self, h, Side::Target, next, Side::Source);
                    changed |= same(self, h, Side::Face, next, Side::Face);
                }
                if let Some(mate) = mate {
                    changed |= same(self, h, Side::Target, mate, Side::Source);
                    changed |= same(self, h, Side::Source, mate, Side::Target);
                }
            }
            if !changed && self.pending.is_empty() {
                return;
            }
        }
    }

    fn merge(&mut self, a: usize, b: usize) {
        let (a, b) = (self.root(a), self.root(b));
        if a == b {
            return;
        }
        // The named element stands for both.
        let (keep, drop) = (a.min(b), a.max(b));
        self.parent[drop] = keep;
        self.boundary[keep] |= self.boundary[drop];
        for side in SIDES {
            match (self.sides[keep][side as usize], self.sides[drop][side as usize]) {
                (Some(x), Some(y)) => self.pending.push((x, y)),
                (None, Some(y)) => self.sides[keep][side as usize] = Some(y),
                _ => {}
            }
        }
    }

    /// Why no mesh has this shape.
    fn contradiction(&self, rule: &Rule) -> Option<String> {
        let name = |node: usize| rule.nodes.get(node).map_or("", |(name, _)| name.as_str());
        for node in 0..self.named {
            let root = self.root(node);
            if root != node {
                let (a, b) = (name(root), name(node));
                return Some(format!(
                    "`{a}` and `{b}` are the same element here, but different nodes of a pattern are different elements"
                ));
            }
        }
        let asks = |node: usize| rule.pattern.nodes.get(node).map(|node| node.boundary);
        for h in (0..self.len()).filter(|&h| self.root(h) == h && self.domains[h] == Domain::HalfEdge) {
            if self.side(h, Side::Mate) == Some(h) || self.side(h, Side::Next) == Some(h) {
                return Some(format!("`{}` would be its own neighbour", name(h)));
            }
            if let (Some(a), Some(b)) = (self.side(h, Side::Source), self.side(h, Side::Target))
                && a == b
            {
                return Some("an edge would begin and end at the same vertex".to_owned());
            }
            // Half-edges of one face lie all outside, or all inside.
            for other in [Side::Next, Side::Face].into_iter().filter_map(|side| self.side(h, side)) {
                if let (Some(a), Some(b)) = (asks(h), asks(other))
                    && a != b
                {
                    return Some(format!(
                        "`{}` and `{}` belong to one face, but only one of them asks for `boundary`",
                        name(h),
                        name(other)
                    ));
                }
            }
            if let Some(mate) = self.side(h, Side::Mate)
                && asks(h) == Some(true)
                && asks(mate) == Some(true)
            {
                return Some(format!(
                    "`{}` and `{}` cannot both lie outside: an edge has a face",
                    name(h),
                    name(mate)
                ));
            }
        }
        None
    }
}
