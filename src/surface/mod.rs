//! A frozen limit surface: evaluation, line hits, closest points, deviation.
//!
//! [`LimitSurface`] takes what it needs from the mesh and does not change when the mesh does. Every face is held as
//! bicubic pieces; beside an extraordinary vertex some levels of pieces are stored and deeper ones are made when a
//! query gets there, so results are those of the true limit surface everywhere. Parameters (face, corner, u, v) are
//! those of [`evaluate`](crate::subdivision::evaluate).

mod closest;
mod convexity;
mod deviation;
mod freeze;
mod line;
mod line_piece;
mod minimise;
mod near;
mod quality;
mod tree;

pub use closest::{ClosestOptions, Facing, Foot};
pub use deviation::{Comparison, Deviation, DeviationSample, SAMPLES, Sampling, compare, deviation_samples};
pub use line::Hit;
pub use quality::{ExtraordinaryVertex, FaceQuality, Quality};

use crate::mesh::{FaceId, Mesh};
use crate::subdivision::SurfacePoint;
use crate::subdivision::patch::{Evaluated, Patch, evaluate_corner, to_quarter};
use crate::subdivision::patch_bicubic::{Bicubic, Jet};
use crate::subdivision::patch_corner::Corner;
use freeze::{CornerEntry, Entry, LEVELS, PatchPlace, Piece};
use glam::DVec3;
use smallvec::SmallVec;
use tree::Tree;

/// The limit surface of a mesh or of some of its faces, frozen. See the [module](self).
#[derive(Clone, Debug)]
pub struct LimitSurface {
    /// Frozen faces, ascending, each with its first patch.
    faces: Vec<(FaceId, u32)>,
    places: Vec<PatchPlace>,
    patches: Vec<Entry>,
    /// Quarters of patches and of each other, four by four.
    parts: Vec<Entry>,
    pieces: Vec<Piece>,
    corners: Vec<CornerEntry>,
    tree: Tree,
    /// Diagonal of the bounding box of the pieces' control points.
    size: f64,
    /// Distances below this are rounding.
    tolerance: f64,
}

impl LimitSurface {
    /// Freezes the whole surface (Catmull-Clark) with the sharpness and the options of the mesh. Faces that have no
    /// limit surface are left out.
    pub fn new(mesh: &Mesh) -> Self {
        let faces: Vec<FaceId> = mesh.faces().collect();
        freeze::freeze(mesh, faces)
    }

    /// Freezes the surface of `faces` only; boundary loops and faces that do not exist or have no limit surface are
    /// passed over. Time and
    /// memory follow the number of these faces and their neighbours, not the mesh.
    pub fn around(mesh: &Mesh, faces: &[FaceId]) -> Self {
        let mut faces: Vec<FaceId> =
            faces.iter().copied().filter(|&f| !f.is_boundary() && mesh.has_face(f)).collect();
        faces.sort_unstable();
        faces.dedup();
        freeze::freeze(mesh, faces)
    }

    /// Frozen faces, ascending.
    pub fn faces(&self) -> impl ExactSizeIterator<Item = FaceId> {
        self.faces.iter().map(|entry| entry.0)
    }

    /// Number of patches of `face`: 1 for a quad, one per corner for another face, 0 for a face that is not frozen.
    pub fn patch_count(&self, face: FaceId) -> usize {
        let Ok(index) = self.faces.binary_search_by_key(&face, |entry| entry.0) else {
            return 0;
        };
        let end = self.faces.get(index + 1).map_or(self.patches.len(), |entry| entry.1 as usize);
        end - self.faces[index].1 as usize
    }

    /// Diagonal of a box round the surface: the size that tolerances refer to. 0 when nothing is frozen.
    pub fn size(&self) -> f64 {
        self.size
    }

    /// The surface at (u, v) of patch `corner` of `face`; parameters outside [0, 1] are moved to the nearest inside.
    /// `None` where no such patch is frozen and for NaN.
    pub fn evaluate(&self, face: FaceId, corner: usize, u: f64, v: f64) -> Option<SurfacePoint> {
        if u.is_nan() || v.is_nan() || corner >= self.patch_count(face) {
            return None;
        }
        let index = self.faces.binary_search_by_key(&face, |entry| entry.0).ok()?;
        let patch = self.faces[index].1 as usize + corner;
        Some(self.evaluate_patch(patch, u.clamp(0.0, 1.0), v.clamp(0.0, 1.0)))
    }

    fn evaluate_patch(&self, patch: usize, u: f64, v: f64) -> SurfacePoint {
        let (mut entry, mut x, mut y) = (self.patches[patch], u, v);
        let mut quarters: SmallVec<[usize; 12]> = SmallVec::new();
        while let Entry::Split(first) = entry {
            let quarter;
            (quarter, x, y) = to_quarter(x, y);
            quarters.push(quarter);
            entry = self.parts[first as usize + quarter];
        }
        let mut found = match entry {
            Entry::Corner { first_piece, corner } => self.evaluate_corner(first_piece, corner, x, y),
            Entry::Regular(piece) | Entry::Split(piece) => {
                Evaluated::regular(self.pieces[piece as usize].bicubic.jet(x, y))
            }
        };
        for &quarter in quarters.iter().rev() {
            found.jet = found.jet.in_patch(quarter);
        }
        found.into()
    }

    fn evaluate_corner(&self, first_piece: u32, corner: u32, mut x: f64, mut y: f64) -> Evaluated {
        let mut scale = 1.0;
        for level in 0..LEVELS {
            (x, y, scale) = (2.0 * x, 2.0 * y, 2.0 * scale);
            let (side, a, b) = match (x >= 1.0, y >= 1.0) {
                (false, false) => continue,
                (true, false) => (0, x - 1.0, y),
                (true, true) => (1, x - 1.0, y - 1.0),
                (false, true) => (2, x, y - 1.0),
            };
            let piece = &self.pieces[(first_piece + 3 * level + side) as usize];
            return Evaluated::regular(piece.bicubic.jet(a, b).scaled(scale));
        }
        let entry = &self.corners[corner as usize];
        let mut found = evaluate_corner(&entry.corner, x, y);
        if found.smooth {
            found.jet = found.jet.scaled(scale);
        } else {
            found.jet = Jet { du: entry.limit.du, dv: entry.limit.dv, ..found.jet };
            found.normal = entry.normal;
        }
        found
    }

    /// The distance of `point` to the surface, positive on the side of its normals: that to its
    /// [`compatible_foot`](Self::compatible_foot). `None` when the surface is empty or a coordinate is not finite.
    pub fn signed_distance(&self, point: DVec3, normal: DVec3) -> Option<f64> {
        let foot = self.compatible_foot(point, normal)?;
        Some(foot.distance.copysign((point - foot.position).dot(foot.normal)))
    }

    /// The point of the surface that belongs to `point`, which lies on another surface with `normal`.
    ///
    /// The closest point, unless its normal is opposite to `normal`: then a foot whose normal has an angle below 90
    /// degrees counts, so that a thin wall does not snap to its other side, if there is one at most ten times as far
    /// away (else the point belongs to a small fold). `None` when the surface is empty or a coordinate is not finite.
    pub fn compatible_foot(&self, point: DVec3, normal: DVec3) -> Option<Foot> {
        const FARTHER: f64 = 10.0;
        let foot = self.closest(point, &ClosestOptions::default())?;
        if foot.normal.dot(normal) > 0.0 {
            return Some(foot);
        }
        let facing = Some(Facing { normal, min_cosine: 0.0 });
        let radius = FARTHER * foot.distance;
        Some(self.closest(point, &ClosestOptions { radius, facing }).unwrap_or(foot))
    }
}
