//! Loop subdivision (Loop 1987) of triangle meshes, with sharpness, boundary rules and holes as for Catmull-Clark.
//!
//! A level is a control mesh of the same surface: it has the sharpness that is left.

use super::loop_limit::edge_weight;
use super::refinement::{DEEPEST, RefineError};
use super::ring::Ring;
use super::sharpness::{Around, VertexBlend, has_limit};
use crate::mesh::{BoundaryRule, Defects, FaceId, HalfEdgeId, Mesh, Polygons, VertexId};
use glam::DVec3;

/// Loop subdivision was asked for on a mesh that has other faces than triangles.
#[derive(Clone, PartialEq, Eq, Debug, thiserror::Error)]
#[error("face {face} has {arity} vertices; Loop subdivision needs triangles: triangulate the mesh")]
pub struct NotTriangles {
    /// The first such face.
    pub face: u32,
    /// Its number of vertices.
    pub arity: usize,
}

/// A triangle mesh as the control mesh of a Loop surface.
#[derive(Clone, Copy, Debug)]
pub struct LoopSurface<'a> {
    pub(super) mesh: &'a Mesh,
}

impl<'a> LoopSurface<'a> {
    /// Takes `mesh` for a control mesh of Loop subdivision, with its sharpness, options and holes.
    ///
    /// # Errors
    /// [`NotTriangles`].
    pub fn new(mesh: &'a Mesh) -> Result<Self, NotTriangles> {
        match mesh.faces().map(|f| (f, mesh.arity(f))).find(|&(_, arity)| arity != 3) {
            Some((f, arity)) => Err(NotTriangles { face: f.0, arity }),
            None => Ok(Self { mesh }),
        }
    }

    /// Refines once. Of the `V` vertices, `E` edges and `F` faces of the mesh, in the order of their ids, the first
    /// `V` vertices are the vertex points and the next `E` the edge points; faces `4 f` to `4 f + 2` lie at the corners
    /// of face `f`, and `4 f + 3` is the one in its middle. Time is linear.
    ///
    /// # Errors
    /// [`RefineError::TooLarge`] where the level would have more elements than 31-bit ids can number.
    pub fn refine(&self) -> Result<Polygons, RefineError> {
        let mesh = self.mesh;
        check_size(mesh.half_edge_bound() as u64 / 2, mesh.face_bound() as u64, 1)?;
        let vertices: Vec<VertexId> = mesh.vertices().collect();
        let edges: Vec<HalfEdgeId> = mesh.edges().collect();
        let mut ranks = vec![0u32; mesh.vertex_bound()];
        for (&v, rank) in vertices.iter().zip(0..) {
            ranks[v.index()] = rank;
        }
        let mut edge_points = vec![0u32; mesh.half_edge_bound() / 2];
        for (&h, point) in edges.iter().zip(vertices.len() as u32..) {
            edge_points[h.edge() as usize] = point;
        }
        let edge_point = |h: HalfEdgeId| edge_points[h.edge() as usize];

        let mut level = Polygons { subdivision: mesh.subdivision(), ..Polygons::default() };
        level.positions.resize(vertices.len() + edges.len(), DVec3::ZERO);
        for &h in &edges {
            level.positions[edge_point(h) as usize] = self.smooth_edge_point(h);
        }
        for &v in &vertices {
            self.refine_vertex(v, &mut level, &|v: VertexId| ranks[v.index()], &edge_point);
        }
        if level.subdivision.boundary == BoundaryRule::None {
            // The faces that it leaves out are holes of the level.
            level.subdivision.boundary = BoundaryRule::EdgeOnly;
        }
        for (face, number) in mesh.faces().zip(0u32..) {
            self.split(face, &mut level, &|v: VertexId| ranks[v.index()], &edge_point);
            if !has_limit(mesh, face) {
                level.holes.extend(4 * number..4 * number + 4);
            }
        }
        Ok(level)
    }

    /// Refines `levels` times.
    ///
    /// # Errors
    /// [`RefineError`], before any level is made.
    pub fn refine_levels(&self, levels: usize) -> Result<Polygons, RefineError> {
        check_size(self.mesh.half_edge_bound() as u64 / 2, self.mesh.face_bound() as u64, levels)?;
        let mut polygons = self.mesh.to_polygons();
        for level in 1..=levels {
            // A refined surface is one; only its size can be refused.
            let too_large =
                |_: Defects| RefineError::TooLarge { level, elements: polygons.face_vertices.len() as u64 };
            let mesh = Mesh::from_polygons(&polygons).map_err(too_large)?;
            polygons = LoopSurface { mesh: &mesh }.refine()?;
        }
        Ok(polygons)
    }

    /// The edge point of the smooth rule; the middle on the boundary.
    fn smooth_edge_point(&self, h: HalfEdgeId) -> DVec3 {
        let mesh = self.mesh;
        let ends = mesh.position(mesh.source(h)) + mesh.position(mesh.target(h));
        if mesh.face(h).is_boundary() || mesh.face(h.mate()).is_boundary() {
            return 0.5 * ends;
        }
        let opposite = |h: HalfEdgeId| mesh.position(mesh.target(mesh.next(h)));
        0.375 * ends + 0.125 * (opposite(h) + opposite(h.mate()))
    }

    /// Sets the vertex point, and what sharpness makes of the edges that leave the vertex by their even half-edges.
    fn refine_vertex(
        &self,
        v: VertexId,
        level: &mut Polygons,
        rank: &dyn Fn(VertexId) -> u32,
        edge_point: &dyn Fn(HalfEdgeId) -> u32,
    ) {
        let mesh = self.mesh;
        let position = mesh.position(v);
        let target = |h: HalfEdgeId| mesh.position(mesh.target(h));
        let point = &mut level.positions[rank(v) as usize];
        let Some(ring) = Ring::new(mesh, v) else {
            *point = position;
            return;
        };
        let count = ring.edges.len();
        let crease =
            |a: usize, b: usize| 0.75 * position + 0.125 * (target(ring.edges[a]) + target(ring.edges[b]));
        let smooth = || {
            let weight = edge_weight(count);
            (1.0 - weight * count as f64) * position
                + weight * ring.edges.iter().map(|&h| target(h)).sum::<DVec3>()
        };
        let Some(around) = Around::of(mesh, v, &ring.edges) else {
            *point = if ring.on_boundary { crease(0, count - 1) } else { smooth() };
            return;
        };
        let creasing = mesh.subdivision().creasing;
        let VertexBlend { corner, crease: share, crease_edges: [a, b] } = around.blend(creasing);
        *point = corner * position;
        if share > 0.0 {
            *point += share * crease(a, b);
        }
        if corner + share < 1.0 {
            *point += (1.0 - corner - share) * smooth();
        }
        let next = around.refined(creasing);
        for (j, &h) in ring.edges.iter().enumerate() {
            let on_boundary = mesh.face(h).is_boundary() || mesh.face(h.mate()).is_boundary();
            if on_boundary || around.spokes[j] <= 0.0 {
                continue;
            }
            if h.0 & 1 == 0 {
                let share = around.crease_share(creasing, j);
                let point = &mut level.positions[edge_point(h) as usize];
                *point = share * 0.5 * (position + target(h)) + (1.0 - share) * *point;
            }
            if next.spokes[j] > 0.0 {
                level.creases.push((rank(v), edge_point(h), next.spokes[j]));
            }
        }
        if next.vertex > 0.0 {
            level.corners.push((rank(v), next.vertex));
        }
    }

    fn split(
        &self,
        face: FaceId,
        level: &mut Polygons,
        rank: &dyn Fn(VertexId) -> u32,
        edge_point: &dyn Fn(HalfEdgeId) -> u32,
    ) {
        let mesh = self.mesh;
        let mut before = edge_point(mesh.prev(mesh.face_half_edge(face)));
        let mut middle = [0; 3];
        for (i, h) in mesh.face_half_edges(face).take(3).enumerate() {
            middle[i] = edge_point(h);
            level.face_vertices.extend([rank(mesh.source(h)), middle[i], before]);
            before = middle[i];
        }
        level.face_vertices.extend(middle);
        level.face_sizes.extend([3; 4]);
    }
}

/// A level has twice the edges of the last and three for each of its faces.
fn check_size(mut edges: u64, mut faces: u64, levels: usize) -> Result<(), RefineError> {
    if levels > DEEPEST {
        return Err(RefineError::TooDeep { depth: levels });
    }
    for level in 1..=levels {
        edges = 2 * edges + 3 * faces;
        faces *= 4;
        if 2 * edges > u64::from(u32::MAX >> 1) {
            return Err(RefineError::TooLarge { level, elements: 2 * edges });
        }
    }
    Ok(())
}
