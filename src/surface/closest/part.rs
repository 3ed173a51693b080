//! Parts of a piece, which a search halves.

use super::Bicubic;
use crate::surface::index::Domain;
use glam::DVec3;

/// A piece and what is wanted of it.
pub(super) struct Piece {
    /// The point relative to `origin`, as the control points are.
    pub(super) point: DVec3,
    pub(super) origin: DVec3,
    pub(super) domain: Domain,
    pub(super) feet_only: bool,
    pub(super) facing: DVec3,
}

/// A square of a piece, from (s, t).
#[derive(Clone, Copy)]
pub(super) struct Square {
    pub(super) s: f64,
    pub(super) t: f64,
    pub(super) size: f64,
    pub(super) halvings: u32,
}

impl Square {
    pub(super) const WHOLE: Self = Self { s: 0.0, t: 0.0, size: 1.0, halvings: 0 };

    /// Its quarters in the order of [`Bicubic::quarters`].
    pub(super) fn quarter(&self, i: usize) -> Self {
        let size = 0.5 * self.size;
        Self {
            s: self.s + if i % 2 == 1 { size } else { 0.0 },
            t: self.t + if i >= 2 { size } else { 0.0 },
            size,
            halvings: self.halvings + 1,
        }
    }
}

/// A part of a piece that is still to be looked at.
pub(super) struct Part {
    pub(super) bicubic: Bicubic,
    pub(super) square: Square,
}
