//! Polygons as a file or a caller holds them: flat arrays, before the half-edge mesh is built and after it is done.

use super::SubdivisionOptions;
use glam::{DVec2, DVec3};

/// A group and a material that faces can belong to. Faces refer to it by index.
#[derive(Clone, PartialEq, Eq, Hash, Default, Debug)]
pub struct FaceSet {
    /// Group names (`g`), in the order of the file.
    pub groups: Vec<String>,
    /// Object name (`o`).
    pub object: Option<String>,
    /// Material (`usemtl`).
    pub material: Option<String>,
    /// Smoothing group (`s`), as written.
    pub smoothing: Option<String>,
}

/// A polygon mesh in flat arrays.
///
/// Face `f` has the `face_sizes[f]` vertices that follow those of face `f - 1` in `face_vertices`.
/// A cube therefore has 8 positions, `face_sizes = [4; 6]` and 24 entries in `face_vertices`.
#[derive(Clone, PartialEq, Default, Debug)]
pub struct Polygons {
    /// Vertex positions, in the caller's unit.
    pub positions: Vec<DVec3>,
    /// Number of vertices of each face.
    pub face_sizes: Vec<u32>,
    /// Vertex indices (0-based) of all faces, counter-clockwise seen from outside.
    pub face_vertices: Vec<u32>,
    /// Texture coordinates; empty when there are none.
    pub texcoords: Vec<DVec2>,
    /// One index into `texcoords` per entry of `face_vertices`, `u32::MAX` where a corner has none; or empty.
    pub face_texcoords: Vec<u32>,
    /// Groups and materials.
    pub sets: Vec<FaceSet>,
    /// One index into `sets` per face; or empty.
    pub face_sets: Vec<u32>,
    /// Material libraries (`mtllib`) the materials come from.
    pub material_libraries: Vec<String>,
    /// Crease edges: two vertices and a sharpness (0 smooth, 10 and more infinitely sharp, as in OpenSubdiv).
    pub creases: Vec<(u32, u32, f32)>,
    /// Corner vertices and their sharpness.
    pub corners: Vec<(u32, f32)>,
    /// Faces that are no part of the surface, though they are subdivided.
    pub holes: Vec<u32>,
    /// How the polygons are subdivided.
    pub subdivision: SubdivisionOptions,
}

impl Polygons {
    /// A mesh of `positions` and faces of any size, without further data.
    pub fn new(positions: Vec<DVec3>, faces: &[&[u32]]) -> Self {
        Self {
            positions,
            face_sizes: faces.iter().map(|face| face.len() as u32).collect(),
            face_vertices: faces.concat(),
            ..Self::default()
        }
    }

    /// The vertices of each face, in order. Stops early where `face_sizes` promises more than is there.
    pub fn faces(&self) -> impl Iterator<Item = &[u32]> {
        let mut rest = self.face_vertices.as_slice();
        self.face_sizes.iter().map_while(move |&size| {
            let (face, tail) = rest.split_at_checked(size as usize)?;
            rest = tail;
            Some(face)
        })
    }
}
