//! Features along curves: level-set marks and the centre solve (docs/linear-features.md, section 6).
//!
//! [`trace`] projects a curve to the limit surface, moves control vertices out of the way of the band (the paper's Rules
//! 7 and 8) and marks the edges whose ends then lie on different sides. After the rules have run, [`centre`] shifts each
//! section of the band within the surface until the limit of its middle line lies on the curve.

mod centre;
mod trace;
mod track;

pub(super) use centre::{centre, off_curve};
pub(super) use trace::trace;
pub(super) use track::Track;
