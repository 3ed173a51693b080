//! The order in which a pattern is matched, decided once when the rules are read.

use super::pattern::{Label, Pattern, Test};
use crate::gml::Strings;
use crate::mesh::{Domain, Value};

/// A name of an attribute or a link: index into the rule set's list, which each run turns into the mesh's symbols.
pub(super) type NameIndex = usize;

/// A step to the one neighbour there is.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Via {
    Next,
    Prev,
    Mate,
    VertexCw,
    VertexCcw,
    Source,
    Target,
    Face,
}

/// A step to one of several neighbours.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Choice {
    Link(NameIndex),
    BackLink(NameIndex),
    /// Half-edges out of a vertex.
    Outgoing,
    /// Half-edges into a vertex.
    Incoming,
    /// Half-edges of a face.
    FaceEdges,
}

/// How to get from one node of a pattern to a neighbour.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Hop {
    One(Via),
    Many(Choice),
}

#[derive(Clone, Debug)]
pub(super) enum Step {
    /// Binds `to`.
    Hop {
        from: usize,
        hop: Hop,
        to: usize,
    },
    /// Both are bound.
    Check {
        from: usize,
        via: Via,
        to: usize,
    },
    CheckLink {
        from: usize,
        label: NameIndex,
        to: usize,
    },
    /// Binds `to` to each of the candidates of `anchor`.
    Seed {
        anchor: Anchor,
        to: usize,
    },
    /// Further tests of a node that is bound.
    Test {
        node: usize,
        tests: Vec<NodeTest>,
        boundary: bool,
    },
}

/// Where a search starts.
#[derive(Clone, PartialEq, Debug)]
pub(super) enum Anchor {
    Value(Domain, NameIndex, Value),
    Attribute(Domain, NameIndex),
    /// Nodes from which a link starts.
    Linked(Domain, NameIndex),
    /// Every element of the kind.
    All(Domain),
}

#[derive(Clone, PartialEq, Debug)]
pub(super) struct NodeTest {
    pub(super) name: NameIndex,
    pub(super) value: Option<(super::pattern::Comparison, Value)>,
}

#[derive(Clone, Debug)]
pub(super) struct NodePlan {
    pub(super) domain: Domain,
    pub(super) tests: Vec<NodeTest>,
    pub(super) boundary: bool,
    /// Nodes of the same kind that are bound before: this one must differ from them.
    pub(super) others: Vec<usize>,
}

/// How a match is found from its anchor.
#[derive(Clone, Debug)]
pub(super) struct Plan {
    pub(super) steps: Vec<Step>,
}

/// A way back from a node of the pattern to the anchor.
#[derive(Clone, Debug)]
pub(super) struct Reach {
    pub(super) domain: Domain,
    pub(super) path: Vec<Hop>,
    /// Kind of the node at the end of each hop.
    pub(super) domains: Vec<Domain>,
    /// No hop leaves a choice.
    pub(super) single: bool,
}

/// A pattern with its names and kinds resolved.
pub(super) struct Graph {
    pub(super) nodes: Vec<NodePlan>,
    pub(super) edges: Vec<(usize, Hop, usize)>,
}

/// Gives each name a number.
pub(super) fn number_name(names: &mut Strings, name: &str) -> NameIndex {
    names.intern(name).0 as usize
}

pub(super) fn number_tests(names: &mut Strings, tests: &[Test]) -> Vec<NodeTest> {
    tests
        .iter()
        .map(|test| NodeTest { name: number_name(names, &test.attribute), value: test.value.clone() })
        .collect()
}

/// The edges of a pattern whose node `i` is node `place[i]` of the rule.
pub(super) fn edges(pattern: &Pattern, place: &[usize], names: &mut Strings) -> Vec<(usize, Hop, usize)> {
    pattern
        .edges
        .iter()
        .map(|edge| {
            let hop = match &edge.label {
                Label::FaceCcw => Hop::One(Via::Next),
                Label::FaceCw => Hop::One(Via::Prev),
                Label::VertexCcw => Hop::One(Via::VertexCcw),
                Label::VertexCw => Hop::One(Via::VertexCw),
                Label::Mate => Hop::One(Via::Mate),
                Label::Source => Hop::One(Via::Source),
                Label::Target => Hop::One(Via::Target),
                Label::Face => Hop::One(Via::Face),
                Label::Link(name) => Hop::Many(Choice::Link(number_name(names, name))),
            };
            (place[edge.from], hop, place[edge.to])
        })
        .collect()
}

impl Hop {
    /// The way back.
    pub(super) fn inverse(self) -> Self {
        match self {
            Self::One(Via::Next) => Self::One(Via::Prev),
            Self::One(Via::Prev) => Self::One(Via::Next),
            Self::One(Via::Mate) => Self::One(Via::Mate),
            Self::One(Via::VertexCw) => Self::One(Via::VertexCcw),
            Self::One(Via::VertexCcw) => Self::One(Via::VertexCw),
            Self::One(Via::Source) => Self::Many(Choice::Outgoing),
            Self::One(Via::Target) => Self::Many(Choice::Incoming),
            Self::One(Via::Face) => Self::Many(Choice::FaceEdges),
            Self::Many(Choice::Link(name)) => Self::Many(Choice::BackLink(name)),
            Self::Many(Choice::BackLink(name)) => Self::Many(Choice::Link(name)),
            Self::Many(Choice::Outgoing) => Self::One(Via::Source),
            Self::Many(Choice::Incoming) => Self::One(Via::Target),
            Self::Many(Choice::FaceEdges) => Self::One(Via::Face),
        }
    }

    /// Cheaper hops first.
    fn cost(self) -> u32 {
        match self {
            Self::One(_) => 0,
            Self::Many(Choice::Link(_) | Choice::BackLink(_)) => 1,
            Self::Many(_) => 2,
        }
    }
}

impl Graph {
    /// The most selective place to start among the nodes that are not `bound`: an attribute with a value, an
    /// attribute, a link, else any element.
    fn anchor(&self, bound: &[bool]) -> Option<(usize, Anchor)> {
        let mut best: Option<(u32, usize, Anchor)> = None;
        for (node, plan) in self.nodes.iter().enumerate().filter(|(node, _)| !bound[*node]) {
            let link = self.edges.iter().find_map(|&(from, hop, _)| match hop {
                Hop::Many(Choice::Link(name)) if from == node => Some(name),
                _ => None,
            });
            let equal = plan.tests.iter().find_map(|test| match &test.value {
                Some((super::pattern::Comparison::Equal, value)) => Some((test.name, value.clone())),
                _ => None,
            });
            let (rank, anchor) = if let Some((name, value)) = equal {
                (0, Anchor::Value(plan.domain, name, value))
            } else if let Some(test) = plan.tests.first() {
                (1, Anchor::Attribute(plan.domain, test.name))
            } else if let Some(name) = link {
                (2, Anchor::Linked(plan.domain, name))
            } else {
                // Half-edges before vertices and faces: they lead on without a choice.
                (3 + u32::from(plan.domain != Domain::HalfEdge), Anchor::All(plan.domain))
            };
            if best.as_ref().is_none_or(|(least, ..)| rank < *least) {
                best = Some((rank, node, anchor));
            }
        }
        best.map(|(_, node, anchor)| (node, anchor))
    }

    /// The steps that bind every node that is not `bound`, and how many searches over the whole mesh they hold.
    /// `order` lists the nodes that are bound before.
    fn steps(&mut self, bound: &mut [bool], order: &mut Vec<usize>) -> (Vec<Step>, usize) {
        let mut steps = Vec::new();
        let mut seeds = 0;
        let mut left = self.edges.clone();
        loop {
            left.retain(|&(from, hop, to)| {
                let both = bound[from] && bound[to];
                if both {
                    steps.push(match hop {
                        Hop::One(via) => Step::Check { from, via, to },
                        Hop::Many(Choice::Link(label)) => Step::CheckLink { from, label, to },
                        // A pattern as it is written has no other edges.
                        Hop::Many(_) => return false,
                    });
                }
                !both
            });
            let next = left
                .iter()
                .filter(|(from, _, to)| bound[*from] || bound[*to])
                .map(|&(from, hop, to)| if bound[from] { (from, hop, to) } else { (to, hop.inverse(), from) })
                .min_by_key(|(_, hop, _)| hop.cost());
            let to = if let Some((from, hop, to)) = next {
                steps.push(Step::Hop { from, hop, to });
                // The edge itself is found again above when it was walked backwards or has several targets; a
                // check of what was just walked costs little, but is left out.
                left.retain(|&(f, h, t)| {
                    (f, h, t) != (from, hop, to) && (t, h.inverse(), f) != (from, hop, to)
                });
                to
            } else if let Some((to, anchor)) = self.anchor(bound) {
                steps.push(Step::Seed { anchor, to });
                seeds += 1;
                to
            } else {
                return (steps, seeds);
            };
            let domain = self.nodes[to].domain;
            self.nodes[to].others =
                order.iter().copied().filter(|&other| self.nodes[other].domain == domain).collect();
            bound[to] = true;
            order.push(to);
        }
    }

    /// The plan of a whole pattern. Its first step is the seed of the anchor.
    pub(super) fn plan(&mut self) -> (Plan, usize) {
        let mut bound = vec![false; self.nodes.len()];
        let (steps, seeds) = self.steps(&mut bound, &mut Vec::new());
        (Plan { steps }, seeds)
    }

    /// The plan of the rest of a pattern whose nodes below `known` are bound.
    pub(super) fn plan_rest(&mut self, known: usize) -> (Plan, usize) {
        let mut bound: Vec<bool> = (0..self.nodes.len()).map(|node| node < known).collect();
        // New nodes must differ from one another; they may be nodes of the main pattern.
        let (steps, seeds) = self.steps(&mut bound, &mut Vec::new());
        (Plan { steps }, seeds)
    }

    /// The ways from every node back to `anchor`.
    pub(super) fn reach(&self, anchor: usize) -> Vec<Reach> {
        // Per node, the hops and the kinds of the nodes they lead to.
        let mut paths: Vec<Option<Vec<(Hop, Domain)>>> = vec![None; self.nodes.len()];
        paths[anchor] = Some(Vec::new());
        let mut queue = std::collections::VecDeque::from([anchor]);
        while let Some(node) = queue.pop_front() {
            let mut next: Vec<(u32, usize, Hop)> = Vec::new();
            for &(from, hop, to) in &self.edges {
                // From the neighbour to this node.
                if to == node && paths[from].is_none() {
                    next.push((hop.cost(), from, hop));
                } else if from == node && paths[to].is_none() {
                    next.push((hop.inverse().cost(), to, hop.inverse()));
                }
            }
            next.sort_by_key(|(cost, ..)| *cost);
            for (_, neighbour, hop) in next {
                if paths[neighbour].is_none() {
                    let mut path = vec![(hop, self.nodes[node].domain)];
                    path.extend(paths[node].iter().flatten());
                    paths[neighbour] = Some(path);
                    queue.push_back(neighbour);
                }
            }
        }
        self.nodes
            .iter()
            .zip(paths)
            .filter_map(|(plan, path)| {
                let (path, domains): (Vec<Hop>, _) = path?.into_iter().unzip();
                let single = path.iter().all(|hop| matches!(hop, Hop::One(_)));
                Some(Reach { domain: plan.domain, path, domains, single })
            })
            .collect()
    }
}
