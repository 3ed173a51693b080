//! The limit surface of one quad, or of one quadrant of another face, in a form that can be evaluated anywhere.
//!
//! Parameters: a quad has one patch, with (u, v) in [0, 1]^2 from its first corner, u along the first edge and v
//! against the last one. A face of k edges has k patches, one per corner: (0, 0) is the corner, (1, 0) the middle of
//! the edge to the next corner, (0, 1) the middle of the edge from the previous corner, (1, 1) the face point.

use super::patch_bicubic::{Bicubic, Jet};
use super::patch_corner::{Corner, Points};
use super::patch_ring::{RefinedFace, Ring};
use crate::mesh::{FaceId, Mesh};

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
    /// Four quarters, each with its own origin at corner 0, 1, 2 or 3 of the patch.
    Irregular(Box<[Quarter; 4]>),
}

/// A quarter of an irregular patch, with u and v running from the patch's corner: see [`from_quarter`].
#[derive(Clone, Debug)]
#[expect(
    clippy::large_enum_variant,
    reason = "most are regular; boxing them would cost each face an allocation"
)]
pub(crate) enum Quarter {
    /// One bicubic piece.
    Regular(Bicubic),
    /// A quad with an extraordinary vertex at its origin.
    Corner(Corner),
}

/// Patch parameters of the point (x, y) in [0, 1]^2 of quarter `quarter`.
pub(crate) fn from_quarter(quarter: usize, x: f64, y: f64) -> (f64, f64) {
    match quarter {
        0 => (0.5 * x, 0.5 * y),
        1 => (1.0 - 0.5 * y, 0.5 * x),
        2 => (1.0 - 0.5 * x, 1.0 - 0.5 * y),
        _ => (0.5 * y, 1.0 - 0.5 * x),
    }
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
        let jet = self.scaled(2.0);
        let (du, dv) = match quarter {
            0 => (jet.du, jet.dv),
            1 => (-jet.dv, jet.du),
            2 => (-jet.du, -jet.dv),
            _ => (jet.dv, -jet.du),
        };
        let turned = quarter % 2 == 1;
        Self {
            position: jet.position,
            du,
            dv,
            duu: if turned { jet.dvv } else { jet.duu },
            duv: if turned { -jet.duv } else { jet.duv },
            dvv: if turned { jet.duu } else { jet.dvv },
        }
    }
}

/// What [`Patch::evaluate`] found.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Evaluated {
    pub(crate) jet: Jet,
    /// Unit normal, or zero where there is none.
    pub(crate) normal: glam::DVec3,
    /// False at an extraordinary vertex, where the second derivatives are not defined.
    pub(crate) smooth: bool,
}

impl Patch {
    /// The patches of a real face: one for a quad, one per corner for another face. Empty for a face that does not
    /// exist or has fewer than three edges.
    pub(crate) fn of_face(mesh: &Mesh, face: FaceId) -> Vec<Self> {
        let Some(ring) = Ring::new(mesh, face) else {
            return Vec::new();
        };
        if ring.arity() == 4 {
            return Self::of_quad(&ring).into_iter().collect();
        }
        let refined = ring.refine();
        let patches = (0..ring.arity()).map(|corner| Self::of_quad(&ring.child(&refined, corner)));
        patches.collect::<Option<_>>().unwrap_or_default()
    }

    /// The patch of one corner of a real face, without the face's other patches.
    pub(crate) fn of_corner(mesh: &Mesh, face: FaceId, corner: usize) -> Option<Self> {
        let ring = Ring::new(mesh, face)?;
        match ring.arity() {
            4 if corner == 0 => Self::of_quad(&ring),
            4 => None,
            arity if corner < arity => Self::of_quad(&ring.child(&ring.refine(), corner)),
            _ => None,
        }
    }

    /// Classification: the one place that decides what is bicubic and what needs local refinement.
    fn of_quad(ring: &Ring) -> Option<Self> {
        if let Some(grid) = ring.regular_grid() {
            return Some(Self::Regular(Bicubic::from_bspline(&grid)));
        }
        let refined = ring.refine();
        let quarter = |i| Quarter::new(ring, &refined, i);
        Some(Self::Irregular(Box::new([quarter(0)?, quarter(1)?, quarter(2)?, quarter(3)?])))
    }

    /// Evaluates at (u, v) in [0, 1]^2.
    pub(crate) fn evaluate(&self, u: f64, v: f64) -> Evaluated {
        match self {
            Self::Regular(bicubic) => {
                let jet = bicubic.jet(u, v);
                Evaluated { jet, normal: jet.du.cross(jet.dv).normalize_or_zero(), smooth: true }
            }
            Self::Irregular(quarters) => {
                let (quarter, x, y) = to_quarter(u, v);
                let found = match &quarters[quarter] {
                    Quarter::Regular(bicubic) => {
                        let jet = bicubic.jet(x, y);
                        Evaluated { jet, normal: jet.du.cross(jet.dv).normalize_or_zero(), smooth: true }
                    }
                    Quarter::Corner(corner) => evaluate_corner(corner, x, y),
                };
                Evaluated { jet: found.jet.in_patch(quarter), ..found }
            }
        }
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

impl Quarter {
    fn new(ring: &Ring, refined: &RefinedFace, corner: usize) -> Option<Self> {
        let corner = ring.child(refined, corner).corner()?;
        Some(if corner.is_regular() {
            let grid = corner.grid().map(|row| row.map(|p| p + corner.origin));
            Self::Regular(Bicubic::from_bspline(&grid))
        } else {
            Self::Corner(corner)
        })
    }
}
