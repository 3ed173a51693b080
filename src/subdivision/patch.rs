//! The limit surface of one quad, or of one quadrant of another face, in a form that can be evaluated anywhere.
//!
//! Parameters: a quad has one patch, with (u, v) in [0, 1]^2 from its first corner, u along the first edge and v
//! against the last one. A face of k edges has k patches, one per corner: (0, 0) is the corner, (1, 0) the middle of
//! the edge to the next corner, (0, 1) the middle of the edge from the previous corner, (1, 1) the face point.

use super::patch_bicubic::{Bicubic, Jet};
use super::patch_corner::{Corner, Points};
use super::patch_ring::Ring;
use crate::mesh::{FaceId, Mesh};
use smallvec::SmallVec;

/// The parameter at which the normal is taken where a vertex itself has none.
const BESIDE: f64 = 1.0 / 4096.0;

/// One patch; see the [module](self).
#[derive(Clone, Debug)]
#[expect(
    clippy::large_enum_variant,
    reason = "most are regular; boxing them would cost each face an allocation"
)]
pub(crate) enum Patch {
    /// One bicubic piece.
    Regular(Bicubic),
    /// A quad with an extraordinary vertex at its origin.
    Corner(Corner),
    /// Four quarters, each with its own origin at corner 0, 1, 2 or 3 of the patch: see [`to_quarter`].
    Split(Box<[Self; 4]>),
}

/// What a quad is.
#[expect(clippy::large_enum_variant, reason = "it lives for one call")]
enum Class {
    Regular(Bicubic),
    Corner(Corner),
    /// Its quarters are to be looked at.
    Split,
}

/// The quarter in which (u, v) lies, and the parameters in it.
pub(crate) fn to_quarter(u: f64, v: f64) -> (usize, f64, f64) {
    match (u > 0.5, v > 0.5) {
        (false, false) => (0, 2.0 * u, 2.0 * v),
        (true, false) => (1, 2.0 * v, 2.0 * (1.0 - u)),
        (true, true) => (2, 2.0 * (1.0 - u), 2.0 * (1.0 - v)),
        (false, true) => (3, 2.0 * (1.0 - v), 2.0 * u),
    }
}

impl Jet {
    /// A jet in the parameters of quarter `quarter` as one in the patch's.
    pub(crate) fn in_patch(self, quarter: usize) -> Self {
        self.scaled(2.0).turned_back(quarter)
    }

    /// A jet in the axes of a square that is turned by `turns` quarter turns as one in those of the patch.
    pub(crate) fn turned_back(self, turns: usize) -> Self {
        let (du, dv) = match turns % 4 {
            0 => return self,
            1 => (-self.dv, self.du),
            2 => (-self.du, -self.dv),
            _ => (self.dv, -self.du),
        };
        let odd = turns % 2 == 1;
        Self {
            position: self.position,
            du,
            dv,
            duu: if odd { self.dvv } else { self.duu },
            duv: if odd { -self.duv } else { self.duv },
            dvv: if odd { self.duu } else { self.dvv },
        }
    }
}

/// The parameters (u, v) of a square in the axes of the same square turned by `turns` quarter turns, so that its corner
/// `turns` becomes the origin.
pub(crate) fn turn(turns: usize, u: f64, v: f64) -> (f64, f64) {
    match turns % 4 {
        0 => (u, v),
        1 => (v, 1.0 - u),
        2 => (1.0 - u, 1.0 - v),
        _ => (1.0 - v, u),
    }
}

/// What [`Patch::evaluate_at`] found.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Evaluated {
    pub(crate) jet: Jet,
    /// Unit normal, or zero where there is none.
    pub(crate) normal: glam::DVec3,
    /// False at an extraordinary vertex, where the second derivatives are not defined.
    pub(crate) smooth: bool,
}

impl Evaluated {
    pub(crate) fn regular(jet: Jet) -> Self {
        Self { jet, normal: jet.du.cross(jet.dv).normalize_or_zero(), smooth: true }
    }
}

/// Classification: the one place that decides what is bicubic and what needs local refinement. `child` says that the
/// quad is a quarter of another one, so that its corners but the first are regular unless something is semi-sharp.
fn classify(ring: &Ring, child: bool) -> Class {
    if ring.is_semi_sharp() {
        return Class::Split;
    }
    let sectors = ring.sectors();
    if let Some(grid) = sectors.regular_grid() {
        return Class::Regular(Bicubic::from_bspline(&grid));
    }
    match sectors.corner().filter(|_| child) {
        Some(corner) => Class::Corner(corner),
        None => Class::Split,
    }
}

impl Patch {
    /// The patches of a real face: one for a quad, one per corner for another face. Empty for a face that does not
    /// exist or has fewer than three edges.
    pub(crate) fn of_face(mesh: &Mesh, face: FaceId) -> Vec<Self> {
        Ring::new(mesh, face).map_or(Vec::new(), |ring| Self::of_ring(&ring))
    }

    /// The patches of the face of `ring`.
    pub(crate) fn of_ring(ring: &Ring) -> Vec<Self> {
        if ring.arity() == 4 {
            return vec![Self::of_quad(ring, false)];
        }
        let refined = ring.refine();
        (0..ring.arity()).map(|corner| Self::of_quad(&ring.child(&refined, corner), false)).collect()
    }

    /// Evaluates the patch at (u, v) in [0, 1]^2.
    pub(crate) fn evaluate(&self, u: f64, v: f64) -> Evaluated {
        match self {
            Self::Regular(bicubic) => Evaluated::regular(bicubic.jet(u, v)),
            Self::Corner(corner) => evaluate_corner(corner, u, v),
            Self::Split(quarters) => {
                let (quarter, x, y) = to_quarter(u, v);
                let found = quarters[quarter].evaluate(x, y);
                Evaluated { jet: found.jet.in_patch(quarter), ..found }
            }
        }
    }

    /// Recursion ends after 12 levels: sharpness is below 10 or infinite, and then quarters are no longer split.
    fn of_quad(ring: &Ring, child: bool) -> Self {
        match classify(ring, child) {
            Class::Regular(bicubic) => Self::Regular(bicubic),
            Class::Corner(corner) => Self::Corner(corner),
            Class::Split => {
                if let Some(quarters) = ring.smooth_quarters() {
                    let quarters = quarters.map(|quarter| match quarter.regular_grid() {
                        Some(grid) => Self::Regular(Bicubic::from_bspline(&grid)),
                        None => Self::Corner(quarter),
                    });
                    return Self::Split(Box::new(quarters));
                }
                let refined = ring.refine();
                Self::Split(Box::new([0, 1, 2, 3].map(|i| Self::of_quad(&ring.child(&refined, i), true))))
            }
        }
    }

    /// Evaluates the patch of one corner of a real face at (u, v) in [0, 1]^2, without making the rest of it. `None`
    /// where there is no such patch.
    pub(crate) fn evaluate_at(mesh: &Mesh, face: FaceId, corner: usize, u: f64, v: f64) -> Option<Evaluated> {
        let mut ring = Ring::new(mesh, face)?;
        let patches = if ring.arity() == 4 { 1 } else { ring.arity() };
        if corner >= patches {
            return None;
        }
        if patches > 1 {
            ring = ring.child(&ring.refine(), corner);
        }
        let (mut x, mut y) = (u, v);
        let mut quarters: SmallVec<[usize; 12]> = SmallVec::new();
        let mut found = loop {
            match classify(&ring, !quarters.is_empty()) {
                Class::Regular(bicubic) => break Evaluated::regular(bicubic.jet(x, y)),
                Class::Corner(corner) => break evaluate_corner(&corner, x, y),
                Class::Split => {
                    let quarter;
                    (quarter, x, y) = to_quarter(x, y);
                    ring = ring.child(&ring.refine(), quarter);
                    quarters.push(quarter);
                }
            }
        };
        for &quarter in quarters.iter().rev() {
            found.jet = found.jet.in_patch(quarter);
        }
        Some(found)
    }
}

/// Evaluates an extraordinary corner at (x, y) in [0, 1]^2.
pub(crate) fn evaluate_corner(corner: &Corner, x: f64, y: f64) -> Evaluated {
    let mut scratch = Points::new();
    let (jet, normal, smooth) = corner.clone().evaluate(x, y, &mut scratch);
    let mut normal = normal.normalize_or_zero();
    if !smooth && normal == glam::DVec3::ZERO {
        let (_, beside, _) = corner.clone().evaluate(BESIDE, BESIDE, &mut scratch);
        normal = beside.normalize_or_zero();
    }
    Evaluated { jet, normal, smooth }
}
