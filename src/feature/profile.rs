//! Profiles: the cross-section of a linear feature as data.

use super::length::Length;
use serde::Serialize;

/// A parameter that a feature declares, for hosts that build dialogs.
#[derive(Clone, Copy, PartialEq, Debug, Serialize)]
pub struct Parameter {
    /// Name, as in `--set width=0.1`.
    pub name: &'static str,
    /// Value unless set.
    pub default: Length,
    /// One line of help.
    pub help: &'static str,
}

/// One line of control vertices along a feature.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Line {
    /// Place across the feature, in half widths of the control band: -1 and 1 are the rims.
    pub across: f64,
    /// Height of the limit surface over the base at this line, in units of the feature's depth or height; `None`
    /// leaves the control vertices of the line in the base surface.
    pub height: Option<f64>,
}

/// The cross-section of a linear feature.
#[derive(Clone, Copy, PartialEq, Debug, Serialize)]
pub struct Profile {
    /// Name of the feature.
    pub name: &'static str,
    /// One line of help.
    pub help: &'static str,
    /// What can be set.
    pub parameters: &'static [Parameter],
    /// Name of the parameter that `Line::height` is a multiple of.
    #[serde(skip)]
    pub extent: &'static str,
    /// The lines, from one rim to the other, the same from either side: marks may run in either direction along a
    /// feature.
    #[serde(skip)]
    pub lines: &'static [Line],
}

const RIM_LEFT: Line = Line { across: -1.0, height: None };
const RIM_RIGHT: Line = Line { across: 1.0, height: None };

const WIDTH: Parameter = Parameter {
    name: "width",
    default: Length::OfEdge(0.3),
    help: "full width of the limit surface at half depth, across the feature",
};

/// A groove of three lines: rim, valley, rim (paper, Figure 4).
pub const GROOVE: Profile = Profile {
    name: "groove",
    help: "a seam pressed into the surface",
    parameters: &[
        WIDTH,
        Parameter {
            name: "depth",
            default: Length::OfEdge(0.1),
            help: "depth of the limit surface below the base, against the normal",
        },
    ],
    extent: "depth",
    lines: &[RIM_LEFT, Line { across: 0.0, height: Some(-1.0) }, RIM_RIGHT],
};

/// A ridge: a groove turned outwards.
pub const RIDGE: Profile = Profile {
    name: "ridge",
    help: "a seam raised from the surface",
    parameters: &[
        WIDTH,
        Parameter {
            name: "height",
            default: Length::OfEdge(0.1),
            help: "height of the limit surface above the base, along the normal",
        },
    ],
    extent: "height",
    lines: &[RIM_LEFT, Line { across: 0.0, height: Some(1.0) }, RIM_RIGHT],
};

/// The features that ship.
pub const ALL: [&Profile; 2] = [&GROOVE, &RIDGE];

/// Limit depth over control depth of the middle of three lines: a cubic B-spline's centre weight.
/// (docs/linear-features.md, section 1: D = 2h/3.)
const CENTRE_WEIGHT: f64 = 2.0 / 3.0;
/// Full width at half depth of a middle line between two rims at distance w with gaps g beyond the rims is
/// `RIM w + GAP g`, for a uniform cubic B-spline cross-section (docs/linear-features.md, section 1).
pub(super) const RIM: f64 = 1.3191;
/// See [`RIM`].
pub(super) const GAP: f64 = 0.1257;

impl Profile {
    /// The profile called `name`.
    pub fn named(name: &str) -> Option<&'static Self> {
        ALL.into_iter().find(|profile| profile.name == name)
    }

    /// Control height of a line in a straight band whose limit has height 1.
    pub(super) fn straight_control_height() -> f64 {
        1.0 / CENTRE_WEIGHT
    }
}

/// Half width of the control band along an edge of length `edge` that makes the limit `width` wide at half depth;
/// both lengths along the edge. The gaps beyond the rims add up to `edge - 2 w`.
pub(super) fn half_width(width: f64, edge: f64) -> f64 {
    (width - GAP / 2.0 * edge) / (RIM - GAP)
}

/// The inverse of [`half_width`].
pub(super) fn full_width(half_width: f64, edge: f64) -> f64 {
    (RIM - GAP) * half_width + GAP / 2.0 * edge
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The two constants from the cross-section itself: cubic B-spline in place and height.
    #[test]
    fn the_width_formula_is_that_of_a_cubic_b_spline() {
        // Height of the basis function at distance u <= 1 from its centre: 2/3 - u^2 + u^3/2; half of 2/3 at u.
        let height = |u: f64| 2.0 / 3.0 - u * u + u * u * u / 2.0;
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..60 {
            let middle = (low + high) / 2.0;
            if height(middle) > 1.0 / 3.0 { low = middle } else { high = middle }
        }
        let u: f64 = low;
        // Place at u between the middle (0), the rim (w), the next vertex (w + g) and the other rim (-w).
        let b = |x: f64| {
            let x = x.abs();
            if x <= 1.0 { 2.0 / 3.0 - x * x + x * x * x / 2.0 } else { (2.0 - x).max(0.0).powi(3) / 6.0 }
        };
        let per_w = b(u - 1.0) + b(u - 2.0) - b(u + 1.0);
        let per_g = b(u - 2.0);
        assert!((2.0 * per_w - RIM).abs() < 1e-4, "{}", 2.0 * per_w);
        assert!((2.0 * per_g - GAP).abs() < 1e-4, "{}", 2.0 * per_g);
    }

    #[test]
    fn half_width_and_full_width_are_inverse() {
        assert!((full_width(half_width(0.3, 1.0), 1.0) - 0.3).abs() < 1e-15);
    }
}
