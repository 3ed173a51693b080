//! Where the patches of a face are, and where a parameter lies in them.

use super::Jet;
use crate::memory::{self, OutOfMemory};
use crate::mesh::FaceId;
use crate::subdivision::patch::{to_quarter, turn};

/// A patch or a part of one.
#[derive(Clone, Copy, Debug)]
pub(super) enum Entry {
    /// Number of the bicubic.
    Regular(u32),
    /// Number of the corner, whose axes are turned by quarter turns.
    Corner { corner: u32, turns: u8 },
    /// Number of the first of the four quarters among the parts.
    Split(u32),
}

#[derive(Clone, Copy, Debug)]
pub(super) struct PatchPlace {
    pub(super) face: FaceId,
    pub(super) corner: u32,
    /// Sides beyond which nothing is frozen, and infinitely sharp ones: bit 0 at v = 0, bit 1 at u = 1, bit 2 at v = 1, bit 3
    /// at u = 0.
    pub(super) rims: u8,
}

/// The first patch of each face. The patches of a face stand together, those of faces in ascending order.
#[derive(Clone, Debug)]
pub(super) enum FaceTable {
    /// Per face id the first patch, and at the end the number of patches.
    Dense(Vec<u32>),
    /// Frozen faces only; the last entry stands behind all.
    Sparse(Vec<(FaceId, u32)>),
}

impl FaceTable {
    /// For these faces, which are ascending.
    pub(super) fn with_room_for(faces: &[FaceId]) -> Result<Self, OutOfMemory> {
        let bound = faces.last().map_or(0, |last| last.index() + 1);
        Ok(if bound <= 4 * faces.len() {
            Self::Dense(memory::room(bound + 1)?)
        } else {
            Self::Sparse(memory::room(faces.len() + 1)?)
        })
    }

    /// Faces are added in ascending order.
    pub(super) fn add(&mut self, face: FaceId, first: u32) {
        match self {
            Self::Dense(starts) => starts.resize(face.index() + 1, first),
            Self::Sparse(starts) => starts.push((face, first)),
        }
    }

    /// `count` is the number of all patches.
    pub(super) fn close(&mut self, count: u32) {
        match self {
            Self::Dense(starts) => starts.push(count),
            Self::Sparse(starts) => starts.push((FaceId(u32::MAX), count)),
        }
    }

    /// The patches of a face.
    #[inline]
    pub(super) fn patches(&self, face: FaceId) -> std::ops::Range<u32> {
        match self {
            Self::Dense(starts) => match starts.get(face.index()..).unwrap_or_default() {
                [first, end, ..] if !face.is_boundary() => *first..*end,
                _ => 0..0,
            },
            Self::Sparse(starts) => match starts.binary_search_by_key(&face, |entry| entry.0) {
                Ok(index) => starts.get(index + 1).map_or(0..0, |end| starts[index].1..end.1),
                Err(_) => 0..0,
            },
        }
    }
}

/// A parameter of a patch as one of a bicubic or a corner.
#[derive(Clone, Copy, Debug)]
pub(super) struct Located {
    /// Regular or a corner.
    pub(super) entry: Entry,
    pub(super) u: f64,
    pub(super) v: f64,
    /// Quarter turns from the patch's axes to the entry's.
    turns: usize,
    /// How much faster the entry's parameters run.
    scale: f64,
}

impl Located {
    /// `entry` is that of a patch, `parts` those it may be split into.
    #[inline(always)]
    pub(super) fn new(mut entry: Entry, parts: &[Entry], mut u: f64, mut v: f64) -> Self {
        let (mut turns, mut scale) = (0, 1.0);
        loop {
            match entry {
                Entry::Split(first) => {
                    let quarter;
                    (quarter, u, v) = to_quarter(u, v);
                    turns += quarter;
                    scale *= 2.0;
                    entry = parts[first as usize + quarter];
                }
                Entry::Corner { turns: own, .. } => {
                    (u, v) = turn(usize::from(own), u, v);
                    turns += usize::from(own);
                    break;
                }
                Entry::Regular(_) => break,
            }
        }
        Self { entry, u, v, turns, scale }
    }

    /// A jet in the entry's parameters as one in the patch's.
    #[inline(always)]
    pub(super) fn in_patch(&self, jet: Jet) -> Jet {
        if self.turns == 0 && self.scale == 1.0 {
            return jet;
        }
        jet.scaled(self.scale).turned_back(self.turns)
    }
}
