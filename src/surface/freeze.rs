//! Taking the patches of faces out of the mesh.

use super::tree::Tree;
use super::{Bicubic, Corner, LimitSurface, Patch};
use crate::mesh::{FaceId, Mesh};
use crate::subdivision::patch::{Quarter, evaluate_corner, from_quarter};
use crate::subdivision::patch_corner::{Points, VertexLimit};
use glam::DVec3;

/// Levels of pieces that are stored beside an extraordinary vertex; deeper ones are made on demand.
pub(super) const LEVELS: u32 = 4;

/// Where a piece lies: a square of a patch or of one of its quarters.
#[derive(Clone, Copy, Debug)]
pub(super) struct Domain {
    pub(super) patch: u32,
    /// 0 to 3; `WHOLE` when the square is one of the patch itself.
    pub(super) quarter: u8,
    pub(super) x: f64,
    pub(super) y: f64,
    pub(super) size: f64,
}

const WHOLE: u8 = 4;

impl Domain {
    /// Patch parameters of the point (s, t) in [0, 1]^2 of the piece.
    pub(super) fn parameters(&self, s: f64, t: f64) -> (f64, f64) {
        let (x, y) = (self.x + s * self.size, self.y + t * self.size);
        if self.quarter == WHOLE { (x, y) } else { from_quarter(usize::from(self.quarter), x, y) }
    }

    /// Domain of side `side` of the extraordinary quad over this square, after one refinement.
    pub(super) fn side(&self, side: usize) -> Self {
        let size = 0.5 * self.size;
        let x = if side < 2 { self.x + size } else { self.x };
        let y = if side > 0 { self.y + size } else { self.y };
        Self { x, y, size, ..*self }
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

#[derive(Clone, Debug)]
pub(super) enum PatchEntry {
    /// Index of the piece.
    Regular(u32),
    Irregular([QuarterEntry; 4]),
}

#[derive(Clone, Copy, Debug)]
pub(super) enum QuarterEntry {
    /// Index of the piece.
    Regular(u32),
    /// The pieces of level l are `first_piece + 3 l + side`.
    Corner { first_piece: u32, corner: u32 },
}

#[derive(Clone, Copy, Debug)]
pub(super) struct PatchPlace {
    pub(super) face: FaceId,
    pub(super) corner: u32,
    /// Sides beyond which nothing is frozen: bit 0 at v = 0, bit 1 at u = 1, bit 2 at v = 1, bit 3 at u = 0.
    pub(super) rims: u8,
}

/// Freezes `faces`, which are ascending, real and exist.
pub(super) fn freeze(mesh: &Mesh, faces: Vec<FaceId>) -> LimitSurface {
    let mut frozen = LimitSurface {
        faces: Vec::with_capacity(faces.len()),
        places: Vec::with_capacity(faces.len()),
        patches: Vec::with_capacity(faces.len()),
        pieces: Vec::with_capacity(faces.len()),
        corners: Vec::new(),
        tree: Tree::default(),
        size: 0.0,
        tolerance: 0.0,
    };
    let mut scratch = Points::new();
    for &face in &faces {
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
        mark_rims(&mut frozen, mesh, &faces, face, count);
    }
    frozen.finish();
    frozen
}

/// Marks the sides of the last face's patches beyond which nothing is frozen.
fn mark_rims(frozen: &mut LimitSurface, mesh: &Mesh, faces: &[FaceId], face: FaceId, count: usize) {
    let first = frozen.places.len() - count;
    for place in &mut frozen.places[first..] {
        place.rims = 0;
    }
    for (i, h) in mesh.face_half_edges(face).enumerate() {
        let beyond = mesh.face(h.mate());
        if !beyond.is_boundary() && faces.binary_search(&beyond).is_ok() {
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
        let index = self.patches.len() as u32;
        let whole = Domain { patch: index, quarter: WHOLE, x: 0.0, y: 0.0, size: 1.0 };
        let entry = match patch {
            Patch::Regular(bicubic) => PatchEntry::Regular(self.add_piece(bicubic, whole)),
            Patch::Irregular(quarters) => {
                let mut place = 0;
                PatchEntry::Irregular(quarters.map(|quarter| {
                    let domain = Domain { quarter: place, ..whole };
                    place += 1;
                    match quarter {
                        Quarter::Regular(bicubic) => QuarterEntry::Regular(self.add_piece(bicubic, domain)),
                        Quarter::Corner(corner) => self.add_corner(corner, domain, scratch),
                    }
                }))
            }
        };
        self.patches.push(entry);
    }

    fn add_piece(&mut self, bicubic: Bicubic, domain: Domain) -> u32 {
        self.pieces.push(Piece { bicubic, domain });
        self.pieces.len() as u32 - 1
    }

    fn add_corner(&mut self, mut corner: Corner, mut domain: Domain, scratch: &mut Points) -> QuarterEntry {
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
        QuarterEntry::Corner { first_piece, corner: self.corners.len() as u32 - 1 }
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
