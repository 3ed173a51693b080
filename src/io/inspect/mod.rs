//! What a mesh, or what should have become one, consists of: the figures behind `welt check`.

mod measure;
mod text;

use super::error::LocatedDefect;
use serde::Serialize;
use std::collections::BTreeMap;

pub use measure::inspect;

/// Counts, histograms, parts and defects. Numbers of vertices and faces are 0-based, those of the file where there is
/// one; lengths are in the unit of the model.
#[derive(Clone, PartialEq, Default, Debug, Serialize)]
pub struct Inspection {
    /// Number of vertices.
    pub vertices: usize,
    /// Number of edges.
    pub edges: usize,
    /// Number of faces.
    pub faces: usize,
    /// Vertices without a face.
    pub isolated_vertices: Vec<u32>,
    /// Number of vertices of a face -> how many faces.
    pub arities: BTreeMap<usize, usize>,
    /// Number of edges at a vertex -> how many vertices inside the surface.
    pub interior_valences: BTreeMap<usize, usize>,
    /// Number of edges at a vertex -> how many vertices on a boundary.
    pub boundary_valences: BTreeMap<usize, usize>,
    /// Boundaries, by their lowest vertex.
    pub boundaries: Vec<Boundary>,
    /// Parts that share no vertex, by their lowest vertex.
    pub components: Vec<Component>,
    /// Sum of the genera of the components; none where one of them has none.
    pub genus: Option<usize>,
    /// Boundary vertices that coincide with another boundary vertex of lower number, and that one: places where the
    /// mesh looks closed and is not. "Coincide" means closer than 1e-9 of the size of the mesh.
    pub seams: Vec<(u32, u32)>,
    /// All vertices that coincide with one of lower number, and that one.
    pub coincident_vertices: Vec<(u32, u32)>,
    /// Closed components whose faces look inwards (negative volume), as indices into `components`.
    pub inside_out: Vec<usize>,
    /// Faces whose area is below 1e-12 of the square of their longest side; those that are defects are not counted.
    pub zero_area_faces: Vec<u32>,
    /// Number of crease edges.
    pub creases: usize,
    /// Number of sharp vertices (corners).
    pub corners: usize,
    /// Groups and how many faces each has, in the order of their first face.
    pub groups: Vec<(String, usize)>,
    /// Materials and how many faces each has, in the order of their first face.
    pub materials: Vec<(String, usize)>,
    /// Lowest and highest coordinates.
    pub bounding_box: Option<[[f64; 3]; 2]>,
    /// What keeps the polygons from being a mesh; empty for a mesh. Fans that meet in a vertex are looked for once
    /// edges are in order.
    pub defects: Vec<LocatedDefect>,
}

/// One boundary: the open edges that hang together.
#[derive(Clone, PartialEq, Debug, Serialize)]
pub struct Boundary {
    /// Its lowest vertex.
    pub vertex: u32,
    /// Number of edges.
    pub edges: usize,
    /// Sum of their lengths.
    pub length: f64,
}

/// One part of the mesh.
#[derive(Clone, PartialEq, Debug, Serialize)]
pub struct Component {
    /// Its lowest vertex.
    pub vertex: u32,
    /// Number of vertices.
    pub vertices: usize,
    /// Number of edges.
    pub edges: usize,
    /// Number of faces.
    pub faces: usize,
    /// Number of boundaries.
    pub boundaries: usize,
    /// Genus g, from V - E + F = 2 - 2g - boundaries; none where the part is no orientable manifold.
    pub genus: Option<usize>,
    /// Enclosed volume, positive when the faces look outwards; none where the part is not closed or not consistently
    /// oriented.
    pub volume: Option<f64>,
}

impl Inspection {
    /// True when nothing keeps the polygons from being a mesh.
    pub fn is_clean(&self) -> bool {
        self.defects.is_empty()
    }
}
