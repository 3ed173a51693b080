//! What is to be expected of the surface of a control mesh: extraordinary vertices, worst faces.

use super::LimitSurface;
use crate::mesh::{FaceId, Mesh, VertexId};
use crate::subdivision::limit_position;
use glam::DVec3;
use serde::Serialize;

/// An extraordinary vertex: inside, not of four quads; on the boundary, not of two.
#[derive(Clone, PartialEq, Debug, Serialize)]
pub struct ExtraordinaryVertex {
    /// The vertex.
    pub vertex: u32,
    /// Number of its edges.
    pub valence: usize,
    /// Whether it lies on the boundary.
    pub on_boundary: bool,
    /// Where it goes on the limit surface.
    pub position: [f64; 3],
    /// Least and greatest mean curvature on a ring about it on the surface, an eighth of an edge away in the parameters, per model unit; `None` where
    /// the surface has none there.
    pub mean_curvature: Option<[f64; 2]>,
    /// Their difference times the mean length of the edges there: without unit, so that vertices can be compared; 0 on spheres and planes.
    pub variation: f64,
}

/// A face and how far it is from a flat square.
#[derive(Clone, Copy, PartialEq, Debug, Serialize)]
pub struct FaceQuality {
    /// The face.
    pub face: u32,
    /// Number of its edges.
    pub edges: usize,
    /// Longest edge over shortest; `null` in JSON where one has no length.
    pub aspect: f64,
    /// Largest distance of a corner from the mean plane over the mean edge: 0 for a flat face.
    pub warp: f64,
}

/// The quality of a control mesh.
#[derive(Clone, PartialEq, Debug, Serialize)]
pub struct Quality {
    /// Extraordinary vertices, greatest variation first.
    pub extraordinary: Vec<ExtraordinaryVertex>,
    /// The faces with the greatest aspect, greatest first.
    pub aspect: Vec<FaceQuality>,
    /// The faces with the greatest warp, greatest first.
    pub warp: Vec<FaceQuality>,
    /// Half of the faces have at most this aspect.
    pub median_aspect: f64,
    /// Half of the faces have at most this warp.
    pub median_warp: f64,
}

/// Where curvature is looked at round an extraordinary vertex: the corner's distance in the parameters of a quad, and the directions per face.
const RADIUS: f64 = 0.125;
const DIRECTIONS: usize = 8;

impl Quality {
    /// Looks at all vertices and faces; lists the `worst` faces.
    pub fn of(mesh: &Mesh, worst: usize) -> Self {
        let is_extraordinary = |&v: &VertexId| {
            let faces = || mesh.outgoing(v).map(|h| mesh.face(h)).filter(|f| !f.is_boundary());
            let usual = if mesh.is_boundary_vertex(v) { 2 } else { 4 };
            faces().count() > 0 && (faces().count() != usual || faces().any(|f| mesh.arity(f) != 4))
        };
        let vertices: Vec<VertexId> = mesh.vertices().filter(is_extraordinary).collect();
        let around: Vec<FaceId> =
            vertices.iter().flat_map(|&v| mesh.outgoing(v)).map(|h| mesh.face(h)).collect();
        let surface = LimitSurface::around(mesh, &around);
        let mut extraordinary: Vec<ExtraordinaryVertex> =
            vertices.into_iter().map(|v| look_at(mesh, &surface, v)).collect();
        extraordinary.sort_by(|a, b| b.variation.total_cmp(&a.variation).then(a.vertex.cmp(&b.vertex)));
        let faces: Vec<FaceQuality> = mesh.faces().map(|f| of_face(mesh, f)).collect();
        let sorted = |key: fn(&FaceQuality) -> f64| {
            let mut faces = faces.clone();
            faces.sort_by(|a, b| key(b).total_cmp(&key(a)).then(a.face.cmp(&b.face)));
            faces
        };
        let median =
            |faces: &[FaceQuality], key: fn(&FaceQuality) -> f64| faces.get(faces.len() / 2).map_or(0.0, key);
        let (mut aspect, mut warp) = (sorted(|face| face.aspect), sorted(|face| face.warp));
        let (median_aspect, median_warp) =
            (median(&aspect, |face| face.aspect), median(&warp, |face| face.warp));
        aspect.truncate(worst);
        warp.truncate(worst);
        Self { extraordinary, aspect, warp, median_aspect, median_warp }
    }
}

fn look_at(mesh: &Mesh, surface: &LimitSurface, v: VertexId) -> ExtraordinaryVertex {
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    let (mut length, mut edges) = (0.0, 0.0);
    for h in mesh.outgoing(v) {
        length += mesh.edge_length(h);
        edges += 1.0;
        let face = mesh.face(h);
        if face.is_boundary() {
            continue;
        }
        let Some(corner) = mesh.face_half_edges(face).position(|other| other == h) else { continue };
        for i in 0..DIRECTIONS {
            let (y, x) = ((i as f64 + 0.5) / DIRECTIONS as f64 * std::f64::consts::FRAC_PI_2).sin_cos();
            // A quadrant of another face is half as wide as a quad.
            let (patch, radius) = if mesh.arity(face) == 4 { (0, RADIUS) } else { (corner, 2.0 * RADIUS) };
            let (x, y) = (radius * x, radius * y);
            let (u, v) = match (mesh.arity(face), corner) {
                (4, 1) => (1.0 - y, x),
                (4, 2) => (1.0 - x, 1.0 - y),
                (4, 3) => (y, 1.0 - x),
                _ => (x, y),
            };
            if let Some(found) = surface.evaluate(face, patch, u, v).and_then(|point| point.curvature()) {
                (low, high) = (low.min(found.mean), high.max(found.mean));
            }
        }
    }
    let mean_curvature = (low <= high).then_some([low, high]);
    ExtraordinaryVertex {
        vertex: v.0,
        valence: mesh.valence(v),
        on_boundary: mesh.is_boundary_vertex(v),
        position: limit_position(mesh, v).to_array(),
        mean_curvature,
        variation: mean_curvature.map_or(0.0, |[low, high]| (high - low) * length / edges),
    }
}

fn of_face(mesh: &Mesh, face: FaceId) -> FaceQuality {
    let corners: Vec<DVec3> = mesh.face_vertices(face).map(|v| mesh.position(v)).collect();
    let count = corners.len() as f64;
    let centre = corners.iter().sum::<DVec3>() / count;
    let pairs = || corners.iter().zip(corners.iter().cycle().skip(1));
    // Newell's normal: the plane that fits the polygon.
    let normal = pairs().map(|(a, b)| (*a - centre).cross(*b - centre)).sum::<DVec3>().normalize_or_zero();
    let lengths = || pairs().map(|(a, b)| a.distance(*b));
    let (low, high) = lengths().fold((f64::INFINITY, 0.0_f64), |(low, high), x| (low.min(x), high.max(x)));
    let off = corners.iter().map(|corner| (*corner - centre).dot(normal).abs()).fold(0.0, f64::max);
    let mean = lengths().sum::<f64>() / count;
    FaceQuality {
        face: face.0,
        edges: corners.len(),
        aspect: if high > 0.0 { high / low } else { f64::INFINITY },
        warp: if mean > 0.0 { off / mean } else { 0.0 },
    }
}
