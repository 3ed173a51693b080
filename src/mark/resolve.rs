//! From selectors to marks on a mesh.

use super::selector::{Selector, Shape};
use super::{Curve, DEFAULT_KIND, Mark, file, path};
use crate::mesh::{FaceId, HalfEdgeId, Mesh, VertexId};
use rustc_hash::{FxHashMap, FxHashSet};
use serde::Serialize;

/// Why a ring did not go on.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum StopReason {
    /// The mesh ends there.
    Border,
    /// A face with three edges: there is no opposite edge.
    Triangle,
    /// A face with more than four edges: there is no opposite edge.
    NGon,
}

/// Where a ring stopped before it closed.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug, Serialize)]
pub struct StripEnd {
    /// The last marked edge.
    pub edge: (u32, u32),
    /// The face it could not cross; `None` at the border.
    pub face: Option<u32>,
    /// Why.
    pub reason: StopReason,
}

impl std::fmt::Display for StripEnd {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let (a, b) = self.edge;
        match (self.reason, self.face) {
            (StopReason::Triangle, Some(face)) => {
                write!(f, "the ring ends at edge {a},{b}: face {face} is a triangle")
            }
            (StopReason::NGon, Some(face)) => {
                write!(f, "the ring ends at edge {a},{b}: face {face} has more than four edges")
            }
            _ => write!(f, "the ring ends at edge {a},{b}: the mesh has a border there"),
        }
    }
}

/// The marks of some selectors.
#[derive(Clone, PartialEq, Default, Debug)]
pub struct Selection {
    /// One mark per crossed edge, in the order of the selectors, without repetition.
    pub marks: Vec<Mark>,
    /// Where rings stopped before they closed, without repetition.
    pub ends: Vec<StripEnd>,
    /// Curves that features are to follow; which edges they cross is found when a feature is applied.
    pub curves: Vec<Curve>,
}

/// A selector that does not fit the mesh.
#[derive(Clone, PartialEq, Debug, thiserror::Error)]
pub enum MarkError {
    /// A vertex number beyond the mesh.
    #[error("vertex {vertex} does not exist; the mesh has {}", numbers(*count))]
    NoSuchVertex {
        /// The number asked for.
        vertex: u32,
        /// How many there are.
        count: usize,
    },
    /// Two vertices without an edge between them.
    #[error("there is no edge {},{}; {}", edge.0, edge.1, joined(edge.0, neighbours))]
    NoSuchEdge {
        /// The vertices asked for.
        edge: (u32, u32),
        /// The vertices that share an edge with the first one.
        neighbours: Vec<u32>,
    },
    /// One edge marked in two ways.
    #[error(
        "edge {},{} is marked twice, {first} and {second}; a feature crosses an edge once", edge.0, edge.1
    )]
    MarkedTwice {
        /// The edge.
        edge: (u32, u32),
        /// The first mark, in words.
        first: String,
        /// The second.
        second: String,
    },
    /// A path between edges that no row of quads joins.
    #[error("no path of quads leads from edge {},{} to edge {},{}", from.0, from.1, to.0, to.1)]
    NoPath {
        /// First edge.
        from: (u32, u32),
        /// Last edge.
        to: (u32, u32),
    },
    /// A cut that no edge leaves.
    #[error("no edge leaves the vertices of the cut; name some vertices of a component, not all of them")]
    EmptyCut,
    /// A mark file that cannot be used.
    #[error("{path}: {problem}")]
    File {
        /// The file.
        path: String,
        /// What is wrong.
        problem: String,
    },
}

fn joined(vertex: u32, neighbours: &[u32]) -> String {
    if neighbours.is_empty() {
        return format!("vertex {vertex} has no edges");
    }
    let list: Vec<String> = neighbours.iter().map(u32::to_string).collect();
    format!("vertex {vertex} has edges to {}", list.join(", "))
}

impl Selection {
    /// The marks and curves of a mark file with the content `text`; see [`Shape::File`]. Entries without a kind get
    /// the default kind. `name` stands for the file in messages.
    ///
    /// # Errors
    /// What is wrong with the text, and what does not fit the mesh.
    pub fn from_json(mesh: &Mesh, name: &str, text: &[u8]) -> Result<Self, MarkError> {
        let (marks, curves) = file::parse(mesh, name, text, DEFAULT_KIND)?;
        Self::merge(mesh, std::iter::once(Ok(Self { marks, curves, ends: Vec::new() })))
    }

    /// The marks of `selectors` on `mesh`, in order.
    ///
    /// # Errors
    /// An element that does not exist, an edge marked in two ways, a path that does not exist, a bad mark file.
    pub fn resolve(mesh: &Mesh, selectors: &[Selector]) -> Result<Self, MarkError> {
        let found = selectors.iter().map(|selector| {
            let mut found = Self::default();
            selector.collect(mesh, &mut found).map(|()| found)
        });
        Self::merge(mesh, found)
    }

    fn merge(mesh: &Mesh, parts: impl Iterator<Item = Result<Self, MarkError>>) -> Result<Self, MarkError> {
        let mut selection = Self::default();
        let mut at: FxHashMap<u32, usize> = FxHashMap::default();
        let mut ends: FxHashSet<StripEnd> = FxHashSet::default();
        for found in parts {
            let mut found = found?;
            for mark in found.marks {
                match at.get(&mark.half_edge.edge()) {
                    None => {
                        at.insert(mark.half_edge.edge(), selection.marks.len());
                        selection.marks.push(mark);
                    }
                    Some(&index) => same_mark(mesh, &selection.marks[index], &mark)?,
                }
            }
            selection.curves.append(&mut found.curves);
            selection.ends.extend(found.ends.into_iter().filter(|&end| ends.insert(end)));
        }
        Ok(selection)
    }
}

/// Marking an edge again in the same way is fine.
fn same_mark(mesh: &Mesh, first: &Mark, second: &Mark) -> Result<(), MarkError> {
    let t = if first.half_edge == second.half_edge { second.t } else { 1.0 - second.t };
    if first.kind == second.kind && (first.t - t).abs() < 1e-12 {
        return Ok(());
    }
    let words = |kind: &str, t: f64| format!("#{kind} at {t}");
    Err(MarkError::MarkedTwice {
        edge: ends(mesh, first.half_edge),
        first: words(&first.kind, first.t),
        second: words(&second.kind, t),
    })
}

impl Selector {
    fn collect(&self, mesh: &Mesh, found: &mut Selection) -> Result<(), MarkError> {
        let mut mark = |half_edge, t| {
            found.marks.push(Mark { half_edge, t, kind: self.kind.clone(), breadth: None });
        };
        match &self.shape {
            Shape::Edge { edge, t } => mark(half_edge(mesh, *edge)?, *t),
            Shape::Ring { edge } => {
                let (strip, stops) = ring(mesh, half_edge(mesh, *edge)?);
                strip.into_iter().for_each(|h| mark(h, 0.5));
                found.ends.extend(stops);
            }
            Shape::Path { from, to } => {
                let (a, b) = (half_edge(mesh, *from)?, half_edge(mesh, *to)?);
                let strip = path::shortest(mesh, a, b).ok_or(MarkError::NoPath { from: *from, to: *to })?;
                strip.into_iter().for_each(|h| mark(h, 0.5));
            }
            Shape::Cut { vertices } => {
                for &v in vertices {
                    check_vertex(mesh, v)?;
                }
                let inside: FxHashSet<VertexId> = vertices.iter().map(|&v| VertexId(v)).collect();
                let mut sorted: Vec<VertexId> = inside.iter().copied().collect();
                sorted.sort_unstable();
                let leaving: Vec<HalfEdgeId> = sorted
                    .iter()
                    .flat_map(|&v| mesh.outgoing(v))
                    .filter(|&h| !inside.contains(&mesh.target(h)))
                    .collect();
                if leaving.is_empty() {
                    return Err(MarkError::EmptyCut);
                }
                leaving.into_iter().for_each(|h| mark(h, 0.5));
            }
            Shape::File(path) => {
                let (marks, curves) = file::read(mesh, path, &self.kind)?;
                found.marks.extend(marks);
                found.curves.extend(curves);
            }
            Shape::Curve { points, course, closed } => {
                let (points, kind) = (points.clone(), self.kind.clone());
                found.curves.push(Curve { points, course: *course, closed: *closed, kind });
            }
        }
        Ok(())
    }
}

/// What numbers the vertices of a mesh have.
fn numbers(count: usize) -> String {
    count.checked_sub(1).map_or("none".into(), |last| format!("vertices 0 to {last}"))
}

fn check_vertex(mesh: &Mesh, vertex: u32) -> Result<(), MarkError> {
    if mesh.has_vertex(VertexId(vertex)) {
        return Ok(());
    }
    Err(MarkError::NoSuchVertex { vertex, count: mesh.vertex_bound() })
}

/// The half-edge between two vertices given by number.
pub(super) fn half_edge(mesh: &Mesh, edge: (u32, u32)) -> Result<HalfEdgeId, MarkError> {
    check_vertex(mesh, edge.0)?;
    check_vertex(mesh, edge.1)?;
    mesh.find_half_edge(VertexId(edge.0), VertexId(edge.1)).ok_or_else(|| {
        let mut neighbours: Vec<u32> = mesh.outgoing(VertexId(edge.0)).map(|h| mesh.target(h).0).collect();
        neighbours.sort_unstable();
        MarkError::NoSuchEdge { edge, neighbours }
    })
}

fn ends(mesh: &Mesh, h: HalfEdgeId) -> (u32, u32) {
    (mesh.source(h).0, mesh.target(h).0)
}

/// The half-edge across the quad of `h`, or why there is none.
fn opposite(mesh: &Mesh, h: HalfEdgeId) -> Result<HalfEdgeId, StripEnd> {
    let face: FaceId = mesh.face(h);
    let stop = |face, reason| Err(StripEnd { edge: ends(mesh, h), face, reason });
    if face.is_boundary() {
        return stop(None, StopReason::Border);
    }
    match mesh.face_half_edges(face).take(5).count() {
        4 => Ok(mesh.next(mesh.next(h))),
        0..4 => stop(Some(face.0), StopReason::Triangle),
        _ => stop(Some(face.0), StopReason::NGon),
    }
}

/// The edges a loop cut from `start` crosses, all pointing to the same side, and where it stopped.
fn ring(mesh: &Mesh, start: HalfEdgeId) -> (Vec<HalfEdgeId>, Vec<StripEnd>) {
    let mut seen: FxHashSet<u32> = std::iter::once(start.edge()).collect();
    let (mut strip, mut before) = (vec![start], Vec::new());
    let mut stops = Vec::new();
    // To the left of `start` first; when the ring does not close, to its right from the other side.
    'ways: for (from, reversed) in [(start, false), (start.mate(), true)] {
        let mut h = from;
        loop {
            match opposite(mesh, h) {
                Ok(across) => h = across.mate(),
                Err(stop) => {
                    stops.push(stop);
                    break;
                }
            }
            if !seen.insert(h.edge()) {
                break 'ways;
            }
            if reversed { before.push(h.mate()) } else { strip.push(h) }
        }
    }
    before.reverse();
    before.append(&mut strip);
    (before, stops)
}
