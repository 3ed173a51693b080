//! How the surface is made of the control mesh: options of the subdivision scheme, and faces that are holes.
//!
//! They are data of the mesh, like sharpness, so that every stage sees the same surface.

use super::Mesh;
use super::ids::FaceId;
use super::log::Change;

/// What becomes of the boundary (OpenSubdiv's vertex boundary interpolation).
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug)]
pub enum BoundaryRule {
    /// Faces at a boundary vertex are no part of the surface, unless all boundary edges there are infinitely sharp.
    None,
    /// The boundary is a cubic B-spline curve; a corner of a single face is rounded like any other boundary vertex.
    #[default]
    EdgeOnly,
    /// As `EdgeOnly`, but vertices of a single face stay where they are.
    EdgeAndCorner,
}

/// How the sharpness of semi-sharp creases falls from level to level.
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug)]
pub enum Creasing {
    /// By one per level.
    #[default]
    Uniform,
    /// By one per level, after averaging along the crease (3/4 of itself, 1/4 of the others at the vertex).
    Chaikin,
}

/// Options of the subdivision scheme.
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug)]
pub struct SubdivisionOptions {
    /// The boundary rule.
    pub boundary: BoundaryRule,
    /// The creasing method.
    pub creasing: Creasing,
}

impl Mesh {
    /// The options under which the mesh is subdivided.
    pub fn subdivision(&self) -> SubdivisionOptions {
        self.subdivision
    }

    /// Sets the options under which the mesh is subdivided.
    pub fn set_subdivision(&mut self, options: SubdivisionOptions) {
        let old = std::mem::replace(&mut self.subdivision, options);
        self.log.push(Change::Subdivision { old });
    }

    /// True when `f` is a hole: it is subdivided like other faces, but no part of the surface.
    pub fn is_hole(&self, f: FaceId) -> bool {
        self.hole_faces.contains(&f.0)
    }

    /// True when some face is a hole.
    pub fn has_holes(&self) -> bool {
        !self.hole_faces.is_empty()
    }

    /// Makes the real face `f` a hole, or a part of the surface again.
    pub fn set_hole(&mut self, f: FaceId, hole: bool) {
        if f.is_boundary() || self.is_hole(f) == hole {
            return;
        }
        self.log.push(Change::HoleFace { face: f.0, was: !hole });
        self.write_hole(f.0, hole);
    }

    pub(super) fn write_hole(&mut self, face: u32, hole: bool) {
        if hole {
            self.hole_faces.insert(face);
        } else {
            self.hole_faces.remove(&face);
        }
    }
}
