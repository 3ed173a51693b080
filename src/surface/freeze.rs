//! Taking the patches of faces out of the mesh.

use super::tree::Tree;
use super::{Bicubic, Corner, LimitSurface, Patch};
use crate::mesh::{FaceId, Mesh};
use crate::subdivision::has_limit;
use crate::subdivision::patch::evaluate_corner;
use crate::subdivision::patch_corner::{Points, VertexLimit};
use crate::subdivision::sharpness::is_infinite;
use glam::DVec3;

/// Levels of pieces that are stored beside an extraordinary vertex; deeper ones are made on demand.
pub(super) const LEVELS: u32 = 4;

/// Where a piece lies: a square of a patch, turned by quarter turns.
#[derive(Clone, Copy, Debug)]
pub(super) struct Domain {
    pub(super) patch: u32,
    /// Patch parameters of the square's own origin.
    u: f64,
    v: f64,
    /// Quarter turns from the patch's axes to the square's, counter-clockwise.
    turns: u8,
    size: f64,
}

impl Domain {
    /// Patch parameters of the point (s, t) in [0, 1]^2 of the piece.
    pub(super) fn parameters(&self, s: f64, t: f64) -> (f64, f64) {
        let (s, t) = (s * self.size, t * self.size);
        match self.turns {
            0 => (self.u + s, self.v + t),
            1 => (self.u - t, self.v + s),
            2 => (self.u - s, self.v - t),
            _ => (self.u + t, self.v - s),
        }
    }

    /// The quarter at corner `corner` of the square, whose origin that corner is.
    fn quarter(&self, corner: u8) -> Self {
        let (s, t) = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)][usize::from(corner)];
        let (u, v) = self.parameters(s, t);
        Self { u, v, turns: (self.turns + corner) % 4, size: 0.5 * self.size, ..*self }
    }

    /// Domain of side `side` of the extraordinary quad over this square, after one refinement.
    pub(super) fn side(&self, side: usize) -> Self {
        let (s, t) = [(0.5, 0.0), (0.5, 0.5), (0.0, 0.5)][side];
        let (u, v) = self.parameters(s, t);
        Self { u, v, size: 0.5 * self.size, ..*self }
    }

    /// Domain of what remains of the extraordinary quad after one refinement.
    pub(super) fn inner(&self) -> Self {
        Self { size: 0.5 * self.size, ..*self }
    }
}

#[derive(Clone, Debug)]
pub(super) struct Piece {
    pub(super) bicubic: Bicubic,
    pub(super) domain: Domain,
}

/// An extraordinary quad at the deepest stored level.
#[derive(Clone, Debug)]
pub(super) struct CornerEntry {
    pub(super) corner: Corner,
    pub(super) domain: Domain,
    /// Tangents at the vertex in the parameters of the whole quarter.
    pub(super) limit: VertexLimit,
    /// Unit normal at the vertex, zero where there is none.
    pub(super) normal: DVec3,
}

/// A patch or a part of one.
#[derive(Clone, Copy, Debug)]
pub(super) enum Entry {
    /// Index of the piece.
    Regular(u32),
    /// The pieces of level l are `first_piece + 3 l + side`.
    Corner { first_piece: u32, corner: u32 },
    /// Index of the first of the four quarters among the parts.
    Split(u32),
}

#[derive(Clone, Copy, Debug)]
pub(super) struct PatchPlace {
    pub(super) face: FaceId,
    pub(super) corner: u32,
    /// Sides beyond which nothing is frozen, and infinitely sharp ones: bit 0 at v = 0, bit 1 at u = 1, bit 2 at v = 1, bit 3 at u = 0.
    pub(super) rims: u8,
}

/// Faces between two calls of `step`.
const SLICE: usize = 256;

/// Freezes `faces`, which are ascending, real and exist. `step` is told how much is done, in [0, 1], and may end it.
pub(super) fn freeze<E>(
    mesh: &Mesh,
    faces: &[FaceId],
    step: impl Fn(f64) -> Result<(), E>,
) -> Result<LimitSurface, E> {
    let mut frozen = LimitSurface {
        faces: Vec::with_capacity(faces.len()),
        places: Vec::with_capacity(faces.len()),
        patches: Vec::with_capacity(faces.len()),
        parts: Vec::new(),
        pieces: Vec::with_capacity(faces.len()),
        corners: Vec::new(),
        tree: Tree::default(),
        size: 0.0,
        tolerance: 0.0,
    };
    let mut scratch = Points::new();
    for (i, &face) in faces.iter().enumerate() {
        if i % SLICE == 0 {
            // The tree over everything is a part, too.
            step(i as f64 / (faces.len() + faces.len() / 4 + 1) as f64)?;
        }
        if !has_limit(mesh, face) {
            continue;
        }
        let patches = Patch::of_face(mesh, face);
        if patches.is_empty() {
            continue;
        }
        frozen.faces.push((face, frozen.patches.len() as u32));
        let count = patches.len();
        for (corner, patch) in patches.into_iter().enumerate() {
            let rims = if count == 1 { 0 } else { 0b0110 };
            frozen.places.push(PatchPlace { face, corner: corner as u32, rims });
            frozen.add_patch(patch, &mut scratch);
        }
        mark_rims(&mut frozen, mesh, faces, face, count);
    }
    step(0.8)?;
    frozen.finish();
    step(1.0)?;
    Ok(frozen)
}

/// Marks the sides of the last face's patches beyond which nothing is frozen, and those along infinite creases.
fn mark_rims(frozen: &mut LimitSurface, mesh: &Mesh, faces: &[FaceId], face: FaceId, count: usize) {
    let first = frozen.places.len() - count;
    for place in &mut frozen.places[first..] {
        place.rims = 0;
    }
    for (i, h) in mesh.face_half_edges(face).enumerate() {
        let beyond = mesh.face(h.mate());
        let goes_on =
            !beyond.is_boundary() && faces.binary_search(&beyond).is_ok() && has_limit(mesh, beyond);
        if goes_on && !is_infinite(mesh.edge_sharpness(h)) {
            continue;
        }
        if count == 1 {
            frozen.places[first].rims |= 1 << i;
        } else {
            frozen.places[first + i].rims |= 1;
            frozen.places[first + (i + 1) % count].rims |= 1 << 3;
        }
    }
}

impl LimitSurface {
    fn add_patch(&mut self, patch: Patch, scratch: &mut Points) {
        let patch_index = self.patches.len() as u32;
        let whole = Domain { patch: patch_index, u: 0.0, v: 0.0, turns: 0, size: 1.0 };
        let entry = self.add_part(patch, whole, scratch);
        self.patches.push(entry);
    }

    /// Recursion is as deep as patches are split, 12 levels at most.
    fn add_part(&mut self, patch: Patch, domain: Domain, scratch: &mut Points) -> Entry {
        match patch {
            Patch::Regular(bicubic) => Entry::Regular(self.add_piece(bicubic, domain)),
            Patch::Corner(corner) => self.add_corner(corner, domain, scratch),
            Patch::Split(quarters) => {
                let mut place = 0;
                let entries = quarters.map(|quarter| {
                    place += 1;
                    self.add_part(quarter, domain.quarter(place - 1), scratch)
                });
                self.parts.extend(entries);
                Entry::Split(self.parts.len() as u32 - 4)
            }
        }
    }

    fn add_piece(&mut self, bicubic: Bicubic, domain: Domain) -> u32 {
        self.pieces.push(Piece { bicubic, domain });
        self.pieces.len() as u32 - 1
    }

    fn add_corner(&mut self, mut corner: Corner, mut domain: Domain, scratch: &mut Points) -> Entry {
        let first_piece = self.pieces.len() as u32;
        let limit = corner.vertex_limit();
        let normal = evaluate_corner(&corner, 0.0, 0.0).normal;
        for _ in 0..LEVELS {
            let sides = corner.refine(scratch);
            for (side, grid) in sides.iter().enumerate() {
                let grid = grid.map(|row| row.map(|p| p + corner.origin));
                self.add_piece(Bicubic::from_bspline(&grid), domain.side(side));
            }
            domain = domain.inner();
        }
        self.corners.push(CornerEntry { corner, domain, limit, normal });
        Entry::Corner { first_piece, corner: self.corners.len() as u32 - 1 }
    }

    /// Builds the tree over everything that was added.
    fn finish(&mut self) {
        let pieces = self.pieces.iter().map(|piece| piece.bicubic.bounds());
        let corners = self.corners.iter().map(|entry| entry.corner.bounds());
        let boxes: Vec<(DVec3, DVec3)> = pieces.chain(corners).collect();
        self.tree = Tree::new(&boxes);
        if let Some((low, high)) = self.tree.bounds() {
            self.size = low.distance(high);
            let farthest = low.abs().max(high.abs()).max_element();
            self.tolerance = 1e-13 * self.size + 8.0 * f64::EPSILON * farthest;
        }
    }
}
