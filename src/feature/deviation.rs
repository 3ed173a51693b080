//! How far the result is from the surface as it was: measured over the surface, both ways.

use super::aftermath::affected_faces;
use super::displace::Green;
use super::report::{Difference, Warning};
use crate::job::Job;
use crate::memory::{self, OutOfMemory};
use crate::mesh::{FaceId, Mesh};
use crate::surface::{Deviation, DeviationSample, FreezeError, LimitSurface, Sampling, deviation_samples};
use glam::DVec3;

/// The surface as it was around a feature, for the report.
pub(super) struct Reference {
    surface: LimitSurface,
    /// Original faces of the footprint, ascending.
    footprint: Vec<FaceId>,
    /// Bounding box diagonal of the mesh before.
    size: f64,
    sampling: Sampling,
    active_rings: usize,
}

impl Reference {
    /// `active_rings` of faces round the changed ones may move.
    pub(super) fn freeze(
        mesh: &Mesh,
        crossed: &[FaceId],
        footprint: Vec<FaceId>,
        sampling: Sampling,
        active_rings: usize,
    ) -> Result<Self, OutOfMemory> {
        // Rules change the faces round the crossed ones; feet may lie beside the affected faces.
        let mut faces = affected_faces(mesh, &mesh.grow_faces(crossed), active_rings);
        faces = mesh.grow_faces(&faces);
        let surface = LimitSurface::prepared(mesh, &faces)?;
        Ok(Self { surface, footprint, size: mesh.size(), sampling, active_rings })
    }

    pub(super) fn size(&self) -> f64 {
        self.size
    }

    /// Distances between the present limit surface and the frozen one.
    pub(super) fn difference(
        &self,
        mesh: &Mesh,
        changed: &[FaceId],
        job: &Job,
    ) -> Result<Difference, FreezeError> {
        let affected = affected_faces(mesh, changed, self.active_rings);
        // Feet of the frozen surface's samples may lie one face further.
        let now = LimitSurface::prepared(mesh, &mesh.grow_faces(&affected))?;
        let in_footprint = |f: FaceId| self.footprint.binary_search(&mesh.original_face(f)).is_ok();
        let was_affected = {
            let mut faces: Vec<FaceId> = affected.iter().map(|&f| mesh.original_face(f)).collect();
            faces.sort_unstable();
            faces.dedup();
            move |f: FaceId| faces.binary_search(&f).is_ok()
        };
        let is_affected = |f: FaceId| affected.binary_search(&f).is_ok();
        job.step("deviation", 0.0)?;
        let mut samples = deviation_samples(&now, is_affected, &self.surface, self.sampling, job)?;
        let mut outside: Vec<DeviationSample> =
            memory::collected(0, samples.iter().filter(|s| !in_footprint(s.face)).copied())?;
        job.step("deviation", 0.5)?;
        let back = deviation_samples(&self.surface, was_affected, &now, self.sampling, job)?;
        for sample in back.iter().filter(|s| self.footprint.binary_search(&s.face).is_err()) {
            memory::reserve(&mut outside, 1)?;
            outside.push(*sample);
        }
        memory::reserve(&mut samples, back.len())?;
        samples.extend(back);
        Ok(Difference { total: Deviation::of(&samples)?, outside: Deviation::of(&outside)? })
    }
}

/// The surface near a feature in space, wherever it is on the mesh: opposite walls.
pub(super) struct Walls {
    surface: LimitSurface,
}

impl Walls {
    /// Faces of the crossed components whose control points come as near as `depth` to the box around the crossed
    /// faces. Other components that touch are no walls of this body.
    pub(super) fn around(mesh: &Mesh, crossed: &[FaceId], depth: f64) -> Result<Self, OutOfMemory> {
        let corners = || crossed.iter().flat_map(|&f| mesh.face_vertices(f)).map(|v| mesh.position(v));
        let (low, high) = corners()
            .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), p| (low.min(p), high.max(p)));
        let near: Vec<FaceId> = components(mesh, crossed)
            .into_iter()
            .filter(|&f| {
                let (face_low, face_high) = mesh
                    .face_vertices(f)
                    .map(|v| mesh.position(v))
                    .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(l, h), p| (l.min(p), h.max(p)));
                face_low.cmple(high + depth).all() && face_high.cmpge(low - depth).all()
            })
            .collect();
        Ok(Self { surface: LimitSurface::prepared(mesh, &near)? })
    }

    /// The worst place where the feature goes deeper than the wall behind it is thick.
    pub(super) fn warning(&self, greens: &[Green]) -> Option<Warning> {
        greens
            .iter()
            .filter(|green| green.target < 0.0)
            .filter_map(|green| {
                let inwards = -green.normal;
                let thickness = self
                    .surface
                    .line_hits(green.base, inwards)
                    .into_iter()
                    // The far side of a wall faces away; the near side is the surface itself.
                    .filter(|hit| hit.s > 0.0 && hit.normal.dot(green.normal) < 0.0)
                    .map(|hit| hit.s)
                    .fold(f64::INFINITY, f64::min);
                let depth = green.asked;
                (thickness < depth).then_some((thickness, depth, green.vertex.0))
            })
            .min_by(|a, b| (a.0 - a.1).total_cmp(&(b.0 - b.1)))
            .map(|(thickness, depth, vertex)| Warning::Wall { thickness, depth, vertex })
    }
}

/// All faces that are joined to one of `faces` by edges.
fn components(mesh: &Mesh, faces: &[FaceId]) -> Vec<FaceId> {
    let mut seen = vec![false; mesh.face_bound()];
    let mut found = Vec::new();
    let mut waiting = faces.to_vec();
    while let Some(f) = waiting.pop() {
        if f.is_boundary() || std::mem::replace(&mut seen[f.index()], true) {
            continue;
        }
        found.push(f);
        waiting.extend(mesh.face_half_edges(f).map(|h| mesh.face(h.mate())));
    }
    found
}
