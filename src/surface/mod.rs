//! A frozen limit surface: evaluation, line hits, closest points, deviation.
//!
//! [`LimitSurface`] takes what it needs from the mesh and does not change when the mesh does. Regular faces are held as
//! bicubics (384 bytes each). A quad with an extraordinary corner is held as its control points, of which those round the
//! corner are held once for all quads there: memory at a vertex of valence n grows with n. They are evaluated by tables per
//! valence, up to 16, of the first six refinements, and refined level by level below and for other corners: exact
//! everywhere. What queries search (four levels of bicubics beside extraordinary vertices, and a tree) is made at the
//! first query. Parameters (face, corner, u, v) are those of [`evaluate`](crate::subdivision::evaluate).
//!
//! Degenerate queries have defined results. A point or line with a coordinate that is not finite, and a direction that is zero,
//! find nothing. Of equally close points one is found. A line through a vertex or along an edge hits it once per crossing; a
//! tangent line hits where it comes within the rounding of the surface; a line inside the surface gives some of the
//! points they share.

mod batch;
mod closest;
mod deviation;
mod disc;
mod fans;
mod freeze;
mod index;
mod kernel;
mod line;
mod near;
mod patches;
mod places;
mod quality;
mod signed;
mod tree;
mod valence;

pub use batch::Parameter;
pub use closest::{ClosestOptions, Facing, Foot};
pub use deviation::{Comparison, Deviation, DeviationSample, SAMPLES, Sampling, compare, deviation_samples};
pub use kernel::Derivatives;
pub use line::Hit;
pub use patches::{PatchOptions, PatchReport, Patches, SplinePatch, SplinePoint};
pub use quality::{ExtraordinaryVertex, FaceQuality, Quality};

use crate::job::{Cancelled, Job};
use crate::memory::{self, OutOfMemory};
use crate::mesh::{FaceId, Mesh};
use crate::subdivision::SurfacePoint;
use crate::subdivision::patch::{Evaluated, Patch};
use crate::subdivision::patch_bicubic::{Bicubic, Jet};
use crate::subdivision::patch_corner::Corner;
use fans::Corners;
use index::Index;
use kernel::Plain;
use places::{Entry, FaceTable, Located, PatchPlace};
use std::sync::OnceLock;

/// The limit surface of a mesh or of some of its faces, frozen. See the [module](self).
#[derive(Clone, Debug)]
pub struct LimitSurface {
    faces: FaceTable,
    places: Vec<PatchPlace>,
    patches: Vec<Entry>,
    /// Quarters of patches and of each other, four by four.
    parts: Vec<Entry>,
    bicubics: Vec<Bicubic>,
    corners: Corners,
    index: OnceLock<Index>,
    /// Every edge of the frozen faces lies between two of them.
    closed: bool,
    /// Diagonal of the bounding box of the control points of the patches.
    size: f64,
    /// Distances below this are rounding.
    tolerance: f64,
}

/// Why a surface was not frozen, or not measured.
#[derive(Clone, Copy, PartialEq, Eq, Debug, thiserror::Error)]
pub enum FreezeError {
    /// The caller cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// There is no memory for the surface, or for what was measured.
    #[error(transparent)]
    Memory(#[from] OutOfMemory),
}

/// Progress of work that nobody watches.
fn unwatched(_: f64) -> Result<(), OutOfMemory> {
    Ok(())
}

/// The real ones of `faces`, ascending, each once.
fn existing(mesh: &Mesh, faces: &[FaceId]) -> Result<Vec<FaceId>, OutOfMemory> {
    let real = faces.iter().copied().filter(|&f| !f.is_boundary() && mesh.has_face(f));
    let mut faces = memory::collected(faces.len(), real)?;
    faces.sort_unstable();
    faces.dedup();
    Ok(faces)
}

impl LimitSurface {
    /// Freezes the whole surface (Catmull-Clark) with the sharpness and the options of the mesh. Faces that have no
    /// limit surface are left out.
    pub fn new(mesh: &Mesh) -> Self {
        let faces: Vec<FaceId> = mesh.faces().collect();
        freeze::freeze(mesh, &faces, unwatched).unwrap_or_else(|error| memory::give_up(error))
    }

    /// Freezes the surface of `faces` only; boundary loops and faces that do not exist or have no limit surface are
    /// passed over. Time and
    /// memory follow the number of these faces and their neighbours, not the mesh.
    pub fn around(mesh: &Mesh, faces: &[FaceId]) -> Self {
        existing(mesh, faces)
            .and_then(|faces| freeze::freeze(mesh, &faces, unwatched))
            .unwrap_or_else(|error| memory::give_up(error))
    }

    /// [`around`](Self::around) under the eyes of a job.
    ///
    /// # Errors
    /// [`FreezeError`].
    pub fn around_with(mesh: &Mesh, faces: &[FaceId], job: &Job) -> Result<Self, FreezeError> {
        freeze::freeze(mesh, &existing(mesh, faces)?, |done| Ok(job.step("freeze", done)?))
    }

    /// [`around`](Self::around) within a stage of a job of which the share `done` (0 to 1) is done.
    ///
    /// # Errors
    /// [`FreezeError`].
    pub(crate) fn around_during(
        mesh: &Mesh,
        faces: &[FaceId],
        job: &Job,
        stage: &'static str,
        done: f64,
    ) -> Result<Self, FreezeError> {
        freeze::freeze(mesh, &existing(mesh, faces)?, |_| Ok(job.step(stage, done)?))
    }

    /// Frozen faces, ascending.
    pub fn faces(&self) -> impl Iterator<Item = FaceId> {
        self.places.iter().filter(|place| place.corner == 0).map(|place| place.face)
    }

    /// Number of patches of `face`: 1 for a quad, one per corner for another face, 0 for a face that is not frozen.
    pub fn patch_count(&self, face: FaceId) -> usize {
        self.faces.patches(face).len()
    }

    /// True where a patch is one bicubic, so that curvature is smooth in it.
    pub(crate) fn is_bicubic(&self, face: FaceId, corner: usize) -> bool {
        self.patch_index(face, corner).is_some_and(|patch| matches!(self.patches[patch], Entry::Regular(_)))
    }

    /// Diagonal of a box round the surface: the size that tolerances refer to. 0 when nothing is frozen.
    pub fn size(&self) -> f64 {
        self.size
    }

    /// Distances below this are rounding.
    pub(crate) fn rounding(&self) -> f64 {
        self.tolerance
    }

    /// True when the surface has no border: every edge of the frozen faces lies between two of them.
    pub fn is_closed(&self) -> bool {
        self.closed
    }

    /// The surface at (u, v) of patch `corner` of `face`; parameters outside [0, 1] are moved to the nearest inside.
    /// `None` where no such patch is frozen and for NaN.
    pub fn evaluate(&self, face: FaceId, corner: usize, u: f64, v: f64) -> Option<SurfacePoint> {
        if u.is_nan() || v.is_nan() {
            return None;
        }
        let patch = self.patch_index(face, corner)?;
        Some(self.evaluate_patch(patch, u.clamp(0.0, 1.0), v.clamp(0.0, 1.0)))
    }

    fn patch_index(&self, face: FaceId, corner: usize) -> Option<usize> {
        self.faces.patches(face).nth(corner).map(|patch| patch as usize)
    }

    fn evaluate_patch(&self, patch: usize, u: f64, v: f64) -> SurfacePoint {
        self.evaluate_located(&Located::new(self.patches[patch], &self.parts, u, v))
    }

    fn evaluate_located(&self, located: &Located) -> SurfacePoint {
        let mut found = match located.entry {
            Entry::Corner { corner, .. } => self.evaluate_corner(corner, located.u, located.v),
            Entry::Regular(piece) | Entry::Split(piece) => Evaluated::regular(kernel::jet::<2, Plain>(
                Plain,
                &self.bicubics[piece as usize],
                located.u,
                located.v,
            )),
        };
        found.jet = located.in_patch(found.jet);
        found.into()
    }

    fn evaluate_corner(&self, corner: u32, u: f64, v: f64) -> Evaluated {
        match self.corners.jet::<2, Plain>(Plain, corner, u, v) {
            Some(jet) => Evaluated::regular(jet),
            None => self.corners.evaluate(corner, u, v),
        }
    }

    /// What queries search.
    fn index(&self) -> &Index {
        self.index.get_or_init(|| Index::new(self).unwrap_or_else(|error| memory::give_up(error)))
    }

    /// Makes what queries search, which the first of them does otherwise: there, no memory ends the program.
    ///
    /// # Errors
    /// [`OutOfMemory`]; the surface is as it was.
    pub fn prepare(&self) -> Result<(), OutOfMemory> {
        if self.index.get().is_none() {
            // Another thread may have been first; what it made is the same.
            let _ = self.index.set(Index::new(self)?);
        }
        Ok(())
    }

    /// [`around`](Self::around), ready for queries.
    pub(crate) fn prepared(mesh: &Mesh, faces: &[FaceId]) -> Result<Self, OutOfMemory> {
        let surface = freeze::freeze(mesh, &existing(mesh, faces)?, unwatched)?;
        surface.prepare()?;
        Ok(surface)
    }
}
