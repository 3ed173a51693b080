//! Sharp edges and vertices of each level of a refinement, and the points that the smooth pass gets wrong there.

use super::mask_sharp::{CatmullClark, SharpMasks};
use super::mask_step::with_opposite_vertices;
use super::refinement::ControlIds;
use super::ring::RingShape;
use super::sharpness::{
    Around, INFINITE, Values, VertexBlend, all_smooth, crease_share, decremented, edge_sharpness, halves,
    is_semi_sharp, vertex_sharpness,
};
use super::topology::Level;
use crate::mesh::{Creasing, Mesh};
use glam::DVec3;
use smallvec::SmallVec;

/// A sharp edge inside the surface.
#[derive(Clone, Copy, Debug)]
pub(super) struct SharpEdge {
    edge: u32,
    /// The vertices at which half-edges `2 edge` and `2 edge + 1` start.
    ends: [u32; 2],
    sharpness: f32,
}

/// All that is sharp on a level but its boundary.
#[derive(Clone, Default, Debug)]
pub(super) struct LevelSharpness {
    edges: Vec<SharpEdge>,
    /// Sharp vertices, ascending.
    vertices: Vec<(u32, f32)>,
}

/// An edge point: `share` of the middle of the edge, the rest of the smooth point.
#[derive(Clone, Copy, Debug)]
struct EdgeException {
    edge: u32,
    ends: [u32; 2],
    share: f64,
}

/// A vertex point: shares of the vertex, of the crease to the two ends, the rest of the smooth point.
#[derive(Clone, Copy, Debug)]
struct VertexException {
    vertex: u32,
    corner: f64,
    crease: f64,
    ends: [u32; 2],
}

/// The points of the next level that differ from smooth ones.
#[derive(Clone, Default, Debug)]
pub(super) struct Exceptions {
    edges: Vec<EdgeException>,
    vertices: Vec<VertexException>,
}

/// A sharp edge that leaves a vertex.
#[derive(Clone, Copy)]
struct Spoke {
    far: u32,
    sharpness: f32,
    /// Index into the sharp edges, and end of it; `None` on the boundary.
    edge: Option<(u32, usize)>,
}

impl LevelSharpness {
    /// What is sharp on level 0.
    pub(super) fn of(mesh: &Mesh, ids: &ControlIds) -> Self {
        if all_smooth(mesh) {
            return Self::default();
        }
        let rank = |v| ids.vertices.binary_search(&v).map_or(u32::MAX, |rank| rank as u32);
        let interior = |h| !mesh.face(h).is_boundary() && !mesh.face(h.mate()).is_boundary();
        let edges =
            ids.edges.iter().enumerate().filter(|&(_, &h)| interior(h) && mesh.edge_sharpness(h) > 0.0);
        let edges = edges.map(|(edge, &h)| SharpEdge {
            edge: edge as u32,
            ends: [rank(mesh.source(h)), rank(mesh.target(h))],
            sharpness: edge_sharpness(mesh, h),
        });
        let vertices =
            ids.vertices.iter().enumerate().map(|(rank, &v)| (rank as u32, vertex_sharpness(mesh, v)));
        Self { edges: edges.collect(), vertices: vertices.filter(|entry| entry.1 > 0.0).collect() }
    }

    /// Sharp edges, by their vertices.
    pub(super) fn creases(&self) -> impl Iterator<Item = (u32, u32, f32)> {
        self.edges.iter().map(|edge| (edge.ends[0], edge.ends[1], edge.sharpness))
    }

    /// Sharp vertices.
    pub(super) fn corners(&self) -> impl Iterator<Item = (u32, f32)> {
        self.vertices.iter().copied()
    }

    /// Sharp spokes of the vertices that have something sharp besides the boundary, by vertex.
    fn spokes(&self, level: &Level) -> Vec<(u32, SmallVec<[Spoke; 4]>)> {
        let ends = self.edges.iter().zip(0..).flat_map(|(edge, index)| {
            [0, 1].map(|end: usize| {
                let spoke =
                    Spoke { far: edge.ends[1 - end], sharpness: edge.sharpness, edge: Some((index, end)) };
                (edge.ends[end], spoke)
            })
        });
        let mut ends: Vec<(u32, Spoke)> = ends.collect();
        ends.sort_by_key(|entry| entry.0);
        let mut vertices: Vec<u32> =
            ends.iter().map(|entry| entry.0).chain(self.vertices.iter().map(|v| v.0)).collect();
        vertices.sort_unstable();
        vertices.dedup();
        let mut rest = ends.as_slice();
        let mut all: Vec<(u32, SmallVec<[Spoke; 4]>)> = Vec::with_capacity(vertices.len());
        for &vertex in &vertices {
            let (own, others) = rest.split_at(rest.partition_point(|entry| entry.0 <= vertex));
            rest = others;
            all.push((vertex, own.iter().map(|entry| entry.1).collect()));
        }
        for edge in &level.boundary {
            if let Ok(index) = vertices.binary_search(&edge.source) {
                let spoke = |far| Spoke { far, sharpness: INFINITE, edge: None };
                all[index].1.extend([spoke(edge.target), spoke(edge.previous_source)]);
            }
        }
        all
    }

    /// The points of the next level that differ, and what is sharp there.
    pub(super) fn refined(&self, level: &Level, creasing: Creasing) -> (Exceptions, Self) {
        let mut exceptions = Exceptions::default();
        let mut ends = vec![[0.0f32; 2]; self.edges.len()];
        let mut sharp = self.vertices.iter().peekable();
        for (vertex, spokes) in self.spokes(level) {
            let own = sharp.next_if(|entry| entry.0 == vertex).map_or(0.0, |entry| entry.1);
            let values: SmallVec<[f32; 8]> = spokes.iter().map(|spoke| spoke.sharpness).collect();
            for (spoke, half) in spokes.iter().zip(halves(creasing, &values)) {
                if let Some((edge, end)) = spoke.edge {
                    ends[edge as usize][end] = half;
                }
            }
            let VertexBlend { corner, crease, crease_edges } = VertexBlend::new(creasing, own, &values);
            if corner + crease > 0.0 {
                let ends = crease_edges.map(|i| spokes.get(i).map_or(vertex, |spoke| spoke.far));
                exceptions.vertices.push(VertexException { vertex, corner, crease, ends });
            }
        }
        let mut child = Self::default();
        for (edge, halves) in self.edges.iter().zip(ends) {
            let share = crease_share(creasing, edge.sharpness, halves);
            exceptions.edges.push(EdgeException { edge: edge.edge, ends: edge.ends, share });
            for (end, sharpness) in halves.into_iter().enumerate().filter(|half| half.1 > 0.0) {
                let ends = [edge.ends[end], level.vertex_count + edge.edge];
                child.edges.push(SharpEdge { edge: 2 * edge.edge + end as u32, ends, sharpness });
            }
        }
        let vertices = self.vertices.iter().map(|&(vertex, sharpness)| (vertex, decremented(sharpness)));
        child.vertices = vertices.filter(|entry| entry.1 > 0.0).collect();
        (exceptions, child)
    }
}

impl LevelSharpness {
    /// Limit positions of the vertices that have something sharp besides the boundary. The level must have quads only.
    pub(super) fn limits(&self, level: &Level, creasing: Creasing, positions: &[DVec3]) -> Vec<(u32, DVec3)> {
        let spokes = self.spokes(level);
        let Some(quads) = level.quads().filter(|_| !spokes.is_empty()) else { return Vec::new() };
        let index = |v: u32| spokes.binary_search_by_key(&v, |entry| entry.0).ok();
        // Per sharp vertex its quads, as the vertices after, opposite and before.
        let mut fans: Vec<SmallVec<[[u32; 3]; 4]>> = vec![SmallVec::new(); spokes.len()];
        for quad in quads {
            for i in 0..4 {
                if let Some(found) = index(quad[i]) {
                    fans[found].push([1, 2, 3].map(|k| quad[(i + k) % 4]));
                }
            }
        }
        let mut sharp = self.vertices.iter().peekable();
        let mut limits = Vec::with_capacity(spokes.len());
        for ((vertex, own), mut fan) in spokes.iter().zip(fans) {
            let vertex_sharpness = sharp.next_if(|entry| entry.0 == *vertex).map_or(0.0, |entry| entry.1);
            let on_boundary = order(&mut fan);
            let mut ends: SmallVec<[u32; 8]> = fan.iter().map(|quad| quad[0]).collect();
            if on_boundary {
                ends.extend(fan.last().map(|quad| quad[2]));
            }
            if fan.is_empty() {
                limits.push((*vertex, positions[*vertex as usize]));
                continue;
            }
            let mut sorted = own.clone();
            sorted.sort_unstable_by_key(|spoke| spoke.far);
            let to = |far: u32| sorted.binary_search_by_key(&far, |spoke| spoke.far).map(|i| sorted[i]);
            let values: Values =
                ends.iter().map(|&far| to(far).map_or(0.0, |spoke| spoke.sharpness)).collect();
            let far = ends.iter().map(|&far| {
                let there = index(far).map(|i| spokes[i].1.as_slice()).unwrap_or_default();
                let others =
                    there.iter().filter(|spoke| spoke.far != *vertex && is_semi_sharp(spoke.sharpness));
                others.map(|spoke| spoke.sharpness).collect()
            });
            let far = if creasing == Creasing::Chaikin { far.collect() } else { SmallVec::new() };
            let shape = RingShape { faces: fan.len(), on_boundary };
            let around = Around { vertex: vertex_sharpness, spokes: values, far };
            let mask = with_opposite_vertices(
                shape,
                &SharpMasks::new::<CatmullClark>(shape, around, creasing).position,
            );
            let position = |v: u32| positions[v as usize];
            let edges = ends.iter().zip(&mask.edges).map(|(&v, &w)| w * position(v));
            let faces = fan.iter().zip(&mask.faces).map(|(quad, &w)| w * position(quad[1]));
            limits.push((
                *vertex,
                mask.vertex * position(*vertex) + edges.sum::<DVec3>() + faces.sum::<DVec3>(),
            ));
        }
        limits
    }
}

/// Puts the quads of a fan in counter-clockwise order; true when the fan is open.
fn order(fan: &mut SmallVec<[[u32; 3]; 4]>) -> bool {
    fan.sort_unstable();
    let mut ends: SmallVec<[u32; 4]> = fan.iter().map(|quad| quad[2]).collect();
    ends.sort_unstable();
    let start = fan.iter().position(|quad| ends.binary_search(&quad[0]).is_err());
    let mut ordered: SmallVec<[[u32; 3]; 4]> = SmallVec::with_capacity(fan.len());
    let mut next = start.or_else(|| (!fan.is_empty()).then_some(0));
    while let Some(found) = next.filter(|_| ordered.len() < fan.len()) {
        ordered.push(fan[found]);
        next = fan.binary_search_by_key(&fan[found][2], |quad| quad[0]).ok();
    }
    *fan = ordered;
    start.is_some()
}

impl Exceptions {
    /// Overwrites what the smooth pass and the boundary pass made of the points that differ.
    pub(super) fn apply(&self, positions: &[DVec3], vertex_points: &mut [DVec3], edge_points: &mut [DVec3]) {
        for &EdgeException { edge, ends, share } in &self.edges {
            let middle = (positions[ends[0] as usize] + positions[ends[1] as usize]) * 0.5;
            let point = &mut edge_points[edge as usize];
            *point = share * middle + (1.0 - share) * *point;
        }
        for &VertexException { vertex, corner, crease, ends } in &self.vertices {
            let position = positions[vertex as usize];
            let point = &mut vertex_points[vertex as usize];
            let along = position * 0.75 + (positions[ends[0] as usize] + positions[ends[1] as usize]) * 0.125;
            *point = corner * position + crease * along + (1.0 - corner - crease) * *point;
        }
    }
}
