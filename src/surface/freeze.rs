//! Taking the patches of faces out of the mesh.

use super::fans::{Corners, Shared};
use super::places::{Entry, FaceTable, PatchPlace};
use super::{Bicubic, LimitSurface, Patch};
use crate::memory::{self, OutOfMemory};
use crate::mesh::{FaceId, Mesh};
use crate::subdivision::has_limit;
use crate::subdivision::patch_direct::{Direct, is_smooth};
use crate::subdivision::patch_ring::Ring;
use crate::subdivision::sharpness::is_infinite;
use glam::DVec3;
use std::sync::OnceLock;

/// A surface in the making.
struct Freezing {
    surface: LimitSurface,
    shared: Shared,
    low: DVec3,
    high: DVec3,
}

/// Faces between two calls of `step`.
const SLICE: usize = 256;

/// Freezes `faces`, which are ascending, real and exist. `step` is told how much is done, in [0, 1], and may end it.
pub(super) fn freeze<E: From<OutOfMemory>>(
    mesh: &Mesh,
    faces: &[FaceId],
    step: impl Fn(f64) -> Result<(), E>,
) -> Result<LimitSurface, E> {
    let surface = LimitSurface {
        faces: FaceTable::with_room_for(faces)?,
        places: memory::room(faces.len())?,
        patches: memory::room(faces.len())?,
        parts: Vec::new(),
        bicubics: memory::room(faces.len())?,
        corners: Corners::default(),
        index: OnceLock::new(),
        closed: true,
        size: 0.0,
        tolerance: 0.0,
    };
    let mut freezing =
        Freezing { surface, shared: Shared::default(), low: DVec3::INFINITY, high: DVec3::NEG_INFINITY };
    for (i, &face) in faces.iter().enumerate() {
        if i % SLICE == 0 {
            step(i as f64 / faces.len() as f64)?;
        }
        if has_limit(mesh, face) {
            freezing.reserve(mesh.arity(face))?;
            freezing.add_face(mesh, faces, face);
        }
    }
    step(1.0)?;
    Ok(freezing.finish())
}

/// Room per corner of a face; deeper splits, beside semi-sharp creases, take more.
const ROOM: usize = 64;

impl Freezing {
    /// Makes room for the patches of a face with `arity` corners.
    fn reserve(&mut self, arity: usize) -> Result<(), OutOfMemory> {
        let surface = &mut self.surface;
        memory::reserve(&mut surface.places, arity)?;
        memory::reserve(&mut surface.patches, arity)?;
        memory::reserve(&mut surface.parts, ROOM * arity)?;
        memory::reserve(&mut surface.bicubics, ROOM * arity)?;
        surface.corners.reserve(ROOM * arity)
    }

    fn add_face(&mut self, mesh: &Mesh, faces: &[FaceId], face: FaceId) {
        let first = self.surface.patches.len();
        match self.smooth_quad(mesh, face) {
            Some(entry) => self.surface.patches.push(entry),
            None => {
                for patch in Patch::of_face(mesh, face) {
                    let entry = self.add_part(patch);
                    self.surface.patches.push(entry);
                }
            }
        }
        let count = self.surface.patches.len() - first;
        if count > 0 {
            self.surface.faces.add(face, first as u32);
            self.surface.places.extend((0..count as u32).map(|corner| PatchPlace { face, corner, rims: 0 }));
            self.mark_rims(mesh, faces, face, first);
        }
    }

    /// The patch of a quad inside the surface round which nothing is sharp.
    fn smooth_quad(&mut self, mesh: &Mesh, face: FaceId) -> Option<Entry> {
        if !is_smooth(mesh, face) {
            return None;
        }
        match Direct::new(mesh, face) {
            Some(Direct::Regular(grid)) => return Some(self.add_bicubic(Bicubic::from_bspline(&grid))),
            Some(Direct::Corner { corner, half_edge, outer }) => {
                if let Some(index) =
                    self.surface.corners.add_at_vertex(mesh, half_edge, outer, &mut self.shared)
                {
                    return Some(self.corner_entry(index, corner));
                }
            }
            None => {}
        }
        let quarters = Ring::new(mesh, face)?.smooth_quarters()?;
        let entries = quarters.map(|quarter| match quarter.regular_grid() {
            Some(grid) => self.add_bicubic(Bicubic::from_bspline(&grid)),
            None => {
                let index = self.surface.corners.add(quarter, &mut self.shared);
                self.corner_entry(index, 0)
            }
        });
        self.surface.parts.extend(entries);
        Some(Entry::Split(self.surface.parts.len() as u32 - 4))
    }

    /// Recursion is as deep as patches are split, 12 levels at most.
    fn add_part(&mut self, patch: Patch) -> Entry {
        match patch {
            Patch::Regular(bicubic) => self.add_bicubic(bicubic),
            Patch::Corner(corner) => {
                let index = self.surface.corners.add(corner, &mut self.shared);
                self.corner_entry(index, 0)
            }
            Patch::Split(quarters) => {
                let entries = quarters.map(|quarter| self.add_part(quarter));
                self.surface.parts.extend(entries);
                Entry::Split(self.surface.parts.len() as u32 - 4)
            }
        }
    }

    fn add_bicubic(&mut self, bicubic: Bicubic) -> Entry {
        let (low, high) = bicubic.bounds();
        self.enclose(low, high);
        self.surface.bicubics.push(bicubic);
        Entry::Regular(self.surface.bicubics.len() as u32 - 1)
    }

    fn corner_entry(&mut self, corner: u32, turns: u8) -> Entry {
        let (low, high) = self.surface.corners.bounds(corner);
        self.enclose(low, high);
        Entry::Corner { corner, turns }
    }

    fn enclose(&mut self, low: DVec3, high: DVec3) {
        (self.low, self.high) = (self.low.min(low), self.high.max(high));
    }

    /// Marks the sides of the last face's patches, from `first` on, beyond which nothing is frozen, and those along infinite
    /// creases.
    fn mark_rims(&mut self, mesh: &Mesh, faces: &[FaceId], face: FaceId, first: usize) {
        let places = &mut self.surface.places[first..];
        let count = places.len();
        for (i, h) in mesh.face_half_edges(face).enumerate() {
            let beyond = mesh.face(h.mate());
            let goes_on = !beyond.is_boundary()
                && (faces.len() == mesh.face_bound() || faces.binary_search(&beyond).is_ok())
                && has_limit(mesh, beyond);
            self.surface.closed &= goes_on;
            if goes_on && !is_infinite(mesh.edge_sharpness(h)) {
                continue;
            }
            if count == 1 {
                places[0].rims |= 1 << i;
            } else {
                places[i].rims |= 1;
                places[(i + 1) % count].rims |= 1 << 3;
            }
        }
    }

    fn finish(self) -> LimitSurface {
        let Self { mut surface, low, high, .. } = self;
        if low.x <= high.x {
            surface.size = low.distance(high);
            let farthest = low.abs().max(high.abs()).max_element();
            surface.tolerance = 1e-13 * surface.size + 8.0 * f64::EPSILON * farthest;
        }
        surface.closed &= !surface.patches.is_empty();
        surface.faces.close(surface.patches.len() as u32);
        surface
    }
}
