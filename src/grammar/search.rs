//! Finding matches: a plan is followed step by step, with a stack of choices instead of recursion.

use super::pattern::Comparison;
use super::plan::{Anchor, Choice, Hop, NodePlan, NodeTest, Plan, Step, Via};
use crate::gml::{Budget, Stop};
use crate::mesh::{Domain, FaceId, HalfEdgeId, Mesh, Node, Symbol, Value, VertexId};

/// A mesh and the symbols of the names that the rules mention.
#[derive(Clone, Copy)]
pub(super) struct View<'a> {
    pub(super) mesh: &'a Mesh,
    pub(super) symbols: &'a [Symbol],
}

/// The candidates of a step that are still to be tried.
#[derive(Clone, Copy, Debug)]
enum Candidates {
    Links {
        next: u32,
    },
    /// Half-edges round a vertex or a face; ends at `start`.
    Ring {
        next: u32,
        start: u32,
    },
    /// A part of the list of ids.
    Ids {
        next: usize,
        base: usize,
    },
    Range {
        next: u32,
        end: u32,
    },
    /// Nothing is left.
    None,
}

#[derive(Clone, Copy, Debug)]
struct Open {
    step: usize,
    candidates: Candidates,
}

/// The memory of a search.
#[derive(Default, Debug)]
pub(super) struct Search {
    open: Vec<Open>,
    ids: Vec<u32>,
}

impl View<'_> {
    /// The neighbour of `id` by `via`.
    #[inline]
    pub(super) fn follow(&self, via: Via, id: u32) -> u32 {
        let h = HalfEdgeId(id);
        match via {
            Via::Next => self.mesh.next(h).0,
            Via::Prev => self.mesh.prev(h).0,
            Via::Mate => h.mate().0,
            Via::VertexCw => self.mesh.vertex_cw(h).0,
            Via::VertexCcw => self.mesh.vertex_ccw(h).0,
            Via::Source => self.mesh.source(h).0,
            Via::Target => self.mesh.target(h).0,
            Via::Face => self.mesh.face(h).0,
        }
    }

    /// All neighbours of `from` by `hop` that are of kind `domain` are added to `found`.
    pub(super) fn neighbours(&self, from: Node, hop: Hop, domain: Domain, found: &mut Vec<u32>) {
        let of_kind = |nodes: &[Node], found: &mut Vec<u32>| {
            found.extend(nodes.iter().filter(|node| node.domain() == domain).map(|node| node.id()));
        };
        match (hop, from) {
            (Hop::One(via), Node::HalfEdge(h)) => found.push(self.follow(via, h.0)),
            (Hop::Many(Choice::Link(name)), from) => {
                of_kind(self.mesh.links(from, self.symbols[name]), found)
            }
            (Hop::Many(Choice::BackLink(name)), from) => {
                of_kind(self.mesh.back_links(from, self.symbols[name]), found);
            }
            (Hop::Many(Choice::Outgoing), Node::Vertex(v)) => {
                found.extend(self.mesh.outgoing(v).map(|h| h.0));
            }
            (Hop::Many(Choice::Incoming), Node::Vertex(v)) => {
                found.extend(self.mesh.outgoing(v).map(|h| h.mate().0));
            }
            (Hop::Many(Choice::FaceEdges), Node::Face(f)) => {
                found.extend(self.mesh.face_half_edges(f).map(|h| h.0));
            }
            // The kinds of the nodes were checked when the rules were read.
            _ => {}
        }
    }

    /// True when `hop` leads from one node to the other.
    pub(super) fn leads(&self, from: Node, hop: Hop, to: Node) -> bool {
        let mut found = Vec::new();
        self.neighbours(from, hop, to.domain(), &mut found);
        found.contains(&to.id())
    }

    fn lies_on_boundary(&self, node: Node) -> bool {
        match node {
            Node::HalfEdge(h) => self.mesh.face(h).is_boundary(),
            Node::Face(f) => f.is_boundary(),
            Node::Vertex(v) => self.mesh.is_boundary_vertex(v),
        }
    }

    fn pass(&self, node: Node, tests: &[NodeTest]) -> bool {
        tests.iter().all(|test| {
            let value = self.mesh.attribute(node, self.symbols[test.name]);
            match (&test.value, value) {
                (_, None) => false,
                (None, Some(_)) => true,
                (Some((comparison, wanted)), Some(found)) => compare(found, *comparison, wanted),
            }
        })
    }

    /// True when `node` exists and can be the anchor's node: a quick look before it is examined.
    #[inline]
    pub(super) fn may_anchor(&self, node: Node, plan: &NodePlan, anchor: &Anchor) -> bool {
        self.mesh.has_node(node)
            && self.pass(node, &plan.tests)
            && match anchor {
                Anchor::Linked(_, name) => !self.mesh.links(node, self.symbols[*name]).is_empty(),
                _ => true,
            }
    }

    /// Ids of the candidates of `anchor`, ascending; `None` for all elements of its kind.
    pub(super) fn candidates(&self, anchor: &Anchor) -> Option<Vec<u32>> {
        match anchor {
            Anchor::Value(domain, name, value) => {
                Some(self.mesh.nodes_with_value(*domain, self.symbols[*name], value).collect())
            }
            Anchor::Attribute(domain, name) => {
                Some(self.mesh.nodes_with_attribute(*domain, self.symbols[*name]))
            }
            Anchor::Linked(domain, name) => {
                Some(self.mesh.nodes_with_link(*domain, self.symbols[*name]).collect())
            }
            Anchor::All(_) => None,
        }
    }

    /// One past the greatest id of a kind.
    pub(super) fn bound(&self, domain: Domain) -> u32 {
        let bound = match domain {
            Domain::Vertex => self.mesh.vertex_bound(),
            Domain::HalfEdge => self.mesh.half_edge_bound(),
            Domain::Face => self.mesh.face_bound(),
        };
        bound as u32
    }
}

/// A value of another type than the wanted one is neither less nor greater; it is not equal.
pub(super) fn compare(found: &Value, comparison: Comparison, wanted: &Value) -> bool {
    match comparison {
        Comparison::Equal => found == wanted,
        Comparison::NotEqual => found != wanted,
        _ => match (found, wanted) {
            (Value::Number(a), Value::Number(b)) => match comparison {
                Comparison::Less => a < b,
                Comparison::LessOrEqual => a <= b,
                Comparison::Greater => a > b,
                _ => a >= b,
            },
            _ => false,
        },
    }
}

impl Anchor {
    pub(super) fn domain(&self) -> Domain {
        match self {
            Self::Value(domain, ..)
            | Self::Attribute(domain, _)
            | Self::Linked(domain, _)
            | Self::All(domain) => *domain,
        }
    }
}

impl Search {
    /// Finds the first match after the steps before `first` have been done by the caller. The ids are in `bound`.
    pub(super) fn start(
        &mut self,
        view: View<'_>,
        plan: &Plan,
        nodes: &[NodePlan],
        first: usize,
        bound: &mut [u32],
        budget: &mut Budget<'_>,
    ) -> Result<bool, Stop> {
        self.open.clear();
        self.ids.clear();
        self.advance(view, plan, nodes, first, bound, budget)
    }

    /// Finds the next match.
    pub(super) fn resume(
        &mut self,
        view: View<'_>,
        plan: &Plan,
        nodes: &[NodePlan],
        bound: &mut [u32],
        budget: &mut Budget<'_>,
    ) -> Result<bool, Stop> {
        match self.retry(view, plan, nodes, bound, budget)? {
            Some(step) => self.advance(view, plan, nodes, step, bound, budget),
            None => Ok(false),
        }
    }

    fn advance(
        &mut self,
        view: View<'_>,
        plan: &Plan,
        nodes: &[NodePlan],
        first: usize,
        bound: &mut [u32],
        budget: &mut Budget<'_>,
    ) -> Result<bool, Stop> {
        let mut at = first;
        while let Some(step) = plan.steps.get(at) {
            budget.spend()?;
            let done = match step {
                Step::Hop { from, hop: Hop::One(via), to } => {
                    let id = view.follow(*via, bound[*from]);
                    bind(view, &nodes[*to], id, bound, *to)
                }
                Step::Hop { .. } | Step::Seed { .. } => {
                    let candidates = self.candidates(view, step, nodes, bound, budget)?;
                    self.open.push(Open { step: at, candidates });
                    false
                }
                Step::Check { from, via, to } => view.follow(*via, bound[*from]) == bound[*to],
                Step::CheckLink { from, label, to } => {
                    let [from, to] = [*from, *to].map(|node| Node::new(nodes[node].domain, bound[node]));
                    view.mesh.links(from, view.symbols[*label]).contains(&to)
                }
                Step::Test { node, tests, boundary } => {
                    let node = Node::new(nodes[*node].domain, bound[*node]);
                    view.pass(node, tests) && (!boundary || view.lies_on_boundary(node))
                }
            };
            if done {
                at += 1;
                continue;
            }
            match self.retry(view, plan, nodes, bound, budget)? {
                Some(step) => at = step,
                None => return Ok(false),
            }
        }
        Ok(true)
    }

    fn candidates(
        &mut self,
        view: View<'_>,
        step: &Step,
        nodes: &[NodePlan],
        bound: &[u32],
        budget: &mut Budget<'_>,
    ) -> Result<Candidates, Stop> {
        Ok(match step {
            Step::Hop { hop: Hop::Many(Choice::Link(_) | Choice::BackLink(_)), .. } => {
                Candidates::Links { next: 0 }
            }
            Step::Hop { from, hop: Hop::Many(Choice::FaceEdges), .. } => {
                let start = view.mesh.face_half_edge(FaceId(bound[*from])).0;
                Candidates::Ring { next: start, start }
            }
            Step::Hop { from, .. } => match view.mesh.vertex_half_edge(VertexId(bound[*from])) {
                Some(start) => Candidates::Ring { next: start.0, start: start.0 },
                None => Candidates::None,
            },
            Step::Seed { anchor, to } => match view.candidates(anchor) {
                Some(ids) => {
                    budget.spend_many(ids.len() as u64)?;
                    let base = self.ids.len();
                    self.ids.extend(ids);
                    Candidates::Ids { next: base, base }
                }
                None => Candidates::Range { next: 0, end: view.bound(nodes[*to].domain) },
            },
            _ => Candidates::None,
        })
    }

    /// Binds the next candidate of the last open choice that has one; gives the step to go on with.
    fn retry(
        &mut self,
        view: View<'_>,
        plan: &Plan,
        nodes: &[NodePlan],
        bound: &mut [u32],
        budget: &mut Budget<'_>,
    ) -> Result<Option<usize>, Stop> {
        while let Some(open) = self.open.last_mut() {
            budget.spend()?;
            let at = open.step;
            let (from, hop, to) = match &plan.steps[at] {
                Step::Hop { from, hop, to } => (*from, *hop, *to),
                Step::Seed { to, .. } => (*to, Hop::One(Via::Mate), *to),
                _ => (0, Hop::One(Via::Mate), 0),
            };
            let next = match &mut open.candidates {
                Candidates::Links { next } => {
                    let from = Node::new(nodes[from].domain, bound[from]);
                    let ends = match hop {
                        Hop::Many(Choice::Link(name)) => view.mesh.links(from, view.symbols[name]),
                        Hop::Many(Choice::BackLink(name)) => view.mesh.back_links(from, view.symbols[name]),
                        _ => &[],
                    };
                    let end = ends.get(*next as usize).copied();
                    *next += 1;
                    // A link to another kind of node is no candidate; its place is taken by an impossible id.
                    end.map(|end| if end.domain() == nodes[to].domain { end.id() } else { u32::MAX })
                }
                Candidates::Ring { next, start } => {
                    let h = HalfEdgeId(*next);
                    let around = if hop == Hop::Many(Choice::FaceEdges) {
                        view.mesh.next(h)
                    } else {
                        view.mesh.vertex_cw(h)
                    };
                    let found = if hop == Hop::Many(Choice::Incoming) { h.mate() } else { h };
                    *next = around.0;
                    if around.0 == *start {
                        open.candidates = Candidates::None;
                    }
                    Some(found.0)
                }
                Candidates::Ids { next, base } => {
                    let id = self.ids.get(*next).copied();
                    *next += 1;
                    if id.is_none() {
                        self.ids.truncate(*base);
                    }
                    id
                }
                Candidates::Range { next, end } => {
                    let id = (*next < *end).then_some(*next);
                    *next += 1;
                    id
                }
                Candidates::None => None,
            };
            match next {
                None => {
                    self.open.pop();
                }
                Some(id) => {
                    if view.mesh.has_node(Node::new(nodes[to].domain, id))
                        && bind(view, &nodes[to], id, bound, to)
                    {
                        return Ok(Some(at + 1));
                    }
                }
            }
        }
        Ok(None)
    }
}

/// Binds node `to` to the element `id` if it can be that.
#[inline]
pub(super) fn bind(view: View<'_>, plan: &NodePlan, id: u32, bound: &mut [u32], to: usize) -> bool {
    if plan.others.iter().any(|&other| bound[other] == id) {
        return false;
    }
    let node = Node::new(plan.domain, id);
    let boundary_fits = match node {
        Node::Vertex(_) => !plan.boundary || view.lies_on_boundary(node),
        _ => plan.boundary == view.lies_on_boundary(node),
    };
    if !boundary_fits || !view.pass(node, &plan.tests) {
        return false;
    }
    bound[to] = id;
    true
}
