//! Sharpness: how it falls from level to level, and which rules it selects.
//!
//! Sharpness is an f32 from 0 (smooth) to 10 (infinite), as in OpenSubdiv, whose arithmetic this is. Boundary edges
//! are infinitely sharp, and so are, under the rule "edge and corner", boundary vertices of a single face. Where a
//! rule changes from one level to the next, the masks of both are blended by the sharpness that is left. Sums of
//! sharpness alone are made in f64, where they do not depend on the order: the faces round a vertex agree.

use crate::mesh::{BoundaryRule, Creasing, FaceId, HalfEdgeId, Mesh, VertexId};
use smallvec::SmallVec;

/// From here on sharpness does not fall.
pub(super) const INFINITE: f32 = 10.0;

/// Sharpness of edges round a vertex.
pub(super) type Values = SmallVec<[f32; 8]>;

pub(crate) fn is_infinite(sharpness: f32) -> bool {
    sharpness >= INFINITE
}

pub(super) fn is_semi_sharp(sharpness: f32) -> bool {
    sharpness > 0.0 && sharpness < INFINITE
}

/// Sharpness one level on, without regard to neighbours: that of vertices, and of edges under uniform creasing.
pub(super) fn decremented(sharpness: f32) -> f32 {
    if is_infinite(sharpness) { INFINITE } else { (sharpness - 1.0).max(0.0) }
}

/// Sharpness of the half of an edge next to a vertex where it meets `others`.
pub(super) fn half(creasing: Creasing, sharpness: f32, others: impl Iterator<Item = f32>) -> f32 {
    if creasing == Creasing::Uniform || !is_semi_sharp(sharpness) {
        return decremented(sharpness);
    }
    let others = others.filter(|&other| is_semi_sharp(other));
    let (sum, count) = others.fold((0.0, 0), |(sum, count), other| (sum + f64::from(other), count + 1));
    chaikin(sharpness, sum, count)
}

/// Chaikin's rule for an edge that meets `count` other semi-sharp edges with the sum `sum`.
fn chaikin(sharpness: f32, sum: f64, count: usize) -> f32 {
    if count == 0 {
        return decremented(sharpness);
    }
    (0.75 * sharpness + 0.25 * (sum as f32 / count as f32) - 1.0).max(0.0)
}

/// Sharpness of the halves next to a vertex of all edges there.
pub(super) fn halves(creasing: Creasing, around: &[f32]) -> Values {
    let semi_sharp = around.iter().copied().filter(|&s| is_semi_sharp(s));
    let (sum, count) = semi_sharp.fold((0.0, 0), |(sum, count), s| (sum + f64::from(s), count + 1));
    let half = |&sharpness: &f32| {
        if creasing == Creasing::Uniform || !is_semi_sharp(sharpness) {
            return decremented(sharpness);
        }
        chaikin(sharpness, sum - f64::from(sharpness), count - 1)
    };
    around.iter().map(half).collect()
}

/// The mask of a vertex point.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum VertexRule {
    /// No sharp edge or one.
    Smooth,
    /// Two sharp edges: their places round the vertex.
    Crease([usize; 2]),
    /// The vertex stays.
    Corner,
}

impl VertexRule {
    fn of(vertex: f32, around: &[f32]) -> Self {
        if vertex > 0.0 {
            return Self::Corner;
        }
        let mut sharp = around.iter().enumerate().filter(|&(_, &s)| s > 0.0).map(|(i, _)| i);
        match [sharp.next(), sharp.next(), sharp.next()] {
            [Some(a), Some(b), None] => Self::Crease([a, b]),
            [_, None, _] => Self::Smooth,
            _ => Self::Corner,
        }
    }
}

/// Shares of the rules in a vertex point; they add up to 1.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct VertexBlend {
    pub(super) corner: f64,
    pub(super) crease: f64,
    /// Places of the crease's edges round the vertex; of no meaning where its share is 0.
    pub(super) crease_edges: [usize; 2],
}

impl VertexBlend {
    pub(super) const SMOOTH: Self = Self { corner: 0.0, crease: 0.0, crease_edges: [0; 2] };

    /// The shares at a vertex with sharpness `vertex` and edges of sharpness `around`.
    pub(super) fn new(creasing: Creasing, vertex: f32, around: &[f32]) -> Self {
        let parent = VertexRule::of(vertex, around);
        let mut blend = Self::SMOOTH;
        if parent == VertexRule::Smooth {
            return blend;
        }
        let (child_vertex, child_around) = (decremented(vertex), halves(creasing, around));
        let child = VertexRule::of(child_vertex, &child_around);
        let same = std::mem::discriminant(&parent) == std::mem::discriminant(&child);
        let share = if same { 1.0 } else { parent_share(vertex, around, child_vertex, &child_around) };
        blend.add(parent, share);
        if !same {
            blend.add(child, 1.0 - share);
        }
        blend
    }

    fn add(&mut self, rule: VertexRule, share: f64) {
        match rule {
            VertexRule::Smooth => {}
            VertexRule::Crease(edges) => (self.crease, self.crease_edges) = (share, edges),
            VertexRule::Corner => self.corner = share,
        }
    }

    pub(super) fn smooth(&self) -> f64 {
        1.0 - self.corner - self.crease
    }
}

/// The mean of the sharpness that falls to 0 in this step, at most 1.
fn parent_share(vertex: f32, around: &[f32], child_vertex: f32, child_around: &[f32]) -> f64 {
    let pairs = std::iter::once((vertex, child_vertex))
        .chain(around.iter().copied().zip(child_around.iter().copied()));
    let falling = pairs.filter(|&(parent, child)| parent > 0.0 && child <= 0.0);
    let (sum, count) = falling.fold((0.0, 0), |(sum, count), (s, _)| (sum + f64::from(s), count + 1));
    if count == 0 { 0.0 } else { f64::from((sum as f32 / count as f32).min(1.0)) }
}

/// The share of the crease's mask in an edge point; the rest is the smooth mask. `ends` is the sharpness of the two
/// halves of the edge.
pub(super) fn crease_share(creasing: Creasing, sharpness: f32, ends: [f32; 2]) -> f64 {
    let stays = creasing == Creasing::Chaikin && ends.iter().all(|&end| end > 0.0);
    if sharpness >= 1.0 || sharpness > 0.0 && stays { 1.0 } else { f64::from(sharpness.max(0.0)) }
}

/// Sharpness of the edge of `h` with regard to the boundary.
pub(super) fn edge_sharpness(mesh: &Mesh, h: HalfEdgeId) -> f32 {
    if is_boundary_edge(mesh, h) { INFINITE } else { mesh.edge_sharpness(h).min(INFINITE) }
}

fn is_boundary_edge(mesh: &Mesh, h: HalfEdgeId) -> bool {
    mesh.face(h).is_boundary() || mesh.face(h.mate()).is_boundary()
}

/// Sharpness of `v` with regard to the boundary.
pub(super) fn vertex_sharpness(mesh: &Mesh, v: VertexId) -> f32 {
    if mesh.subdivision().boundary == BoundaryRule::EdgeAndCorner
        && mesh.outgoing(v).any(|h| mesh.face(h).is_boundary())
        && mesh.valence(v) == 2
    {
        return INFINITE;
    }
    mesh.vertex_sharpness(v).min(INFINITE)
}

/// True when nothing but the boundary is sharp: then no vertex needs a closer look.
pub(super) fn all_smooth(mesh: &Mesh) -> bool {
    !mesh.has_sharpness() && mesh.subdivision().boundary != BoundaryRule::EdgeAndCorner
}

/// What is sharp round a vertex, in the order of its edges.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct Around {
    pub(super) vertex: f32,
    pub(super) spokes: Values,
    /// Per spoke the sharpness of the semi-sharp edges that it meets at its far end; only for Chaikin creasing of
    /// semi-sharp spokes, else empty.
    pub(super) far: SmallVec<[Values; 2]>,
}

impl Around {
    /// What is sharp round `v`, whose outgoing half-edges are `edges`; `None` where nothing is but the boundary.
    pub(super) fn of(mesh: &Mesh, v: VertexId, edges: &[HalfEdgeId]) -> Option<Self> {
        if all_smooth(mesh) {
            return None;
        }
        let vertex = vertex_sharpness(mesh, v);
        let sharp =
            vertex > 0.0 || edges.iter().any(|&h| mesh.edge_sharpness(h) > 0.0 && !is_boundary_edge(mesh, h));
        if !sharp {
            return None;
        }
        let spokes: Values = edges.iter().map(|&h| edge_sharpness(mesh, h)).collect();
        let chaikin = mesh.subdivision().creasing == Creasing::Chaikin;
        let mut far = SmallVec::new();
        if chaikin && spokes.iter().any(|&s| is_semi_sharp(s)) {
            far.extend(edges.iter().zip(&spokes).map(|(&h, &spoke)| {
                if !is_semi_sharp(spoke) {
                    return Values::new();
                }
                let others = mesh.outgoing(mesh.target(h)).filter(|&other| other != h.mate());
                others.map(|other| edge_sharpness(mesh, other)).filter(|&s| is_semi_sharp(s)).collect()
            }));
        }
        Some(Self { vertex, spokes, far })
    }

    /// True while anything will fall.
    pub(super) fn is_semi_sharp(&self) -> bool {
        is_semi_sharp(self.vertex) || self.spokes.iter().any(|&s| is_semi_sharp(s))
    }

    /// Sharpness of the half of spoke `j` at its far end.
    pub(super) fn far_half(&self, creasing: Creasing, j: usize) -> f32 {
        half(creasing, self.spokes[j], self.far.get(j).into_iter().flatten().copied())
    }

    /// Sharpness of the halves of all spokes at the vertex.
    pub(super) fn halves(&self, creasing: Creasing) -> Values {
        halves(creasing, &self.spokes)
    }

    /// The share of the crease's mask in the edge point of spoke `j`.
    pub(super) fn crease_share(&self, creasing: Creasing, j: usize) -> f64 {
        if creasing == Creasing::Uniform || self.spokes[j] <= 0.0 || self.spokes[j] >= 1.0 {
            return crease_share(creasing, self.spokes[j], [0.0; 2]);
        }
        let others = self.spokes.iter().enumerate().filter(|&(i, _)| i != j).map(|(_, &s)| s);
        let near = half(creasing, self.spokes[j], others);
        crease_share(creasing, self.spokes[j], [near, self.far_half(creasing, j)])
    }

    /// The shares of the rules in the vertex point.
    pub(super) fn blend(&self, creasing: Creasing) -> VertexBlend {
        VertexBlend::new(creasing, self.vertex, &self.spokes)
    }

    /// What is sharp round the vertex one level on.
    pub(super) fn refined(&self, creasing: Creasing) -> Self {
        let spokes = self.halves(creasing);
        let far = if self.far.is_empty() {
            SmallVec::new()
        } else {
            // The far end is the edge point now, where the other half continues.
            (0..self.spokes.len()).map(|j| Values::from_slice(&[self.far_half(creasing, j)])).collect()
        };
        Self { vertex: decremented(self.vertex), spokes, far }
    }

    /// Places of the infinitely sharp spokes, ascending.
    pub(super) fn infinite_spokes(&self) -> SmallVec<[usize; 4]> {
        (0..self.spokes.len()).filter(|&j| is_infinite(self.spokes[j])).collect()
    }

    /// True where infinite sharpness alone keeps the vertex in its place.
    pub(super) fn is_fixed(&self) -> bool {
        is_infinite(self.vertex) || self.infinite_spokes().len() > 2
    }
}

/// True when `face` is a part of the limit surface: no hole, and under the boundary rule "none" without a vertex on
/// a boundary edge that is not infinitely sharp by itself.
///
/// # Panics
/// When there is no such face.
pub fn has_limit(mesh: &Mesh, face: FaceId) -> bool {
    if face.is_boundary() || mesh.is_hole(face) {
        return false;
    }
    mesh.subdivision().boundary != BoundaryRule::None
        || mesh.face_vertices(face).all(|v| {
            mesh.outgoing(v).all(|h| !is_boundary_edge(mesh, h) || is_infinite(mesh.edge_sharpness(h)))
        })
}
