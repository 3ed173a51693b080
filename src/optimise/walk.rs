//! Feet that are followed over the frozen surface, from patch to patch.
//!
//! A sample moves little from one step of a fit to the next, and its foot with it: Newton's method finds the new foot from
//! the old one, and where it leaves a quad it goes on in the quad beside it. A search of the whole surface is for samples
//! that have no foot yet and for those that lose it.

use crate::mesh::{FaceId, Mesh};
use crate::subdivision::SurfacePoint;
use crate::surface::{Hit, LimitSurface};
use glam::{DMat2, DVec2, DVec3};

/// Steps at most: Newton's method squares the error of a near start, so that one that takes longer was not near.
const STEPS: usize = 10;
/// After a step below this, in parameters, the error is some 1e-8, and that of the distance its square.
const CONVERGED: f64 = 1e-4;
/// Longest step in parameters; beyond it nothing is known of the surface.
const LONGEST: f64 = 2.0;
/// Quads that one step crosses at most.
const CROSSINGS: usize = 4;

/// Which quads lie beside each other.
#[derive(Clone, Default, Debug)]
pub(super) struct Beside {
    /// Quads, ascending.
    faces: Vec<FaceId>,
    /// Per quad and side the face behind it and the number of the same edge there; side 0 lies at v = 0, the others follow
    /// counter-clockwise.
    sides: Vec<[(FaceId, u8); 4]>,
}

/// A place of a surface.
#[derive(Clone, Copy)]
pub(super) struct Start {
    pub(super) face: FaceId,
    pub(super) corner: usize,
    pub(super) u: f64,
    pub(super) v: f64,
}

impl Start {
    /// The middle of a quad.
    pub(super) fn middle(face: FaceId) -> Self {
        Self { face, corner: 0, u: 0.5, v: 0.5 }
    }
}

impl From<Hit> for Start {
    fn from(hit: Hit) -> Self {
        Self { face: hit.face, corner: hit.corner, u: hit.u, v: hit.v }
    }
}

impl Beside {
    /// Of the quads among `faces`.
    pub(super) fn new(mesh: &Mesh, faces: &[FaceId]) -> Self {
        let mut quads: Vec<FaceId> = faces
            .iter()
            .copied()
            .filter(|&f| mesh.has_face(f) && !f.is_boundary() && mesh.arity(f) == 4)
            .collect();
        quads.sort_unstable();
        quads.dedup();
        let of_quad = |&quad: &FaceId| {
            let mut sides = [(quad, 0); 4];
            for (side, h) in sides.iter_mut().zip(mesh.face_half_edges(quad)) {
                let behind = mesh.face(h.mate());
                let number = if behind.is_boundary() {
                    None
                } else {
                    mesh.face_half_edges(behind).take(4).position(|other| other == h.mate())
                };
                *side = (behind, number.unwrap_or_default() as u8);
            }
            sides
        };
        let sides = quads.iter().map(of_quad).collect();
        Self { faces: quads, sides }
    }

    /// `place`, whose parameters may lie outside of its quad, in the quad where it lies, or on the border of the mesh where it
    /// lies beyond; `None` where nothing is known.
    fn inside(&self, mut place: Start) -> Option<Start> {
        for _ in 0..=CROSSINGS {
            let Start { u, v, .. } = place;
            // How far beyond each side.
            let beyond = [-v, u - 1.0, v - 1.0, -u];
            let side = (0..4).max_by(|&a, &b| beyond[a].total_cmp(&beyond[b]))?;
            let beyond = beyond[side];
            if beyond <= 0.0 {
                return Some(place);
            }
            let (face, other) = self.sides[self.faces.binary_search(&place.face).ok()?][side];
            if face.is_boundary() {
                let (u, v) = [(u, 0.0), (1.0, v), (u, 1.0), (0.0, v)][side];
                place = Start { u, v, ..place };
                continue;
            }
            self.faces.binary_search(&face).ok()?;
            // Along the side, from its end, which is where the other quad begins.
            let along = 1.0 - [u, v, 1.0 - u, 1.0 - v][side];
            let (u, v) = match other {
                0 => (along, beyond),
                1 => (1.0 - beyond, along),
                2 => (1.0 - along, 1.0 - beyond),
                _ => (beyond, 1.0 - along),
            };
            place = Start { face, u, v, ..place };
        }
        None
    }

    /// Whether the surface ends at the sides where u and v of a place of a quad, in this order, are 0 or 1.
    fn ends(&self, place: &Start) -> [bool; 2] {
        let ends = |at: f64, low: usize, high: usize| {
            let side = if at <= 0.0 {
                low
            } else if at >= 1.0 {
                high
            } else {
                return false;
            };
            let quad = self.faces.binary_search(&place.face);
            quad.is_ok_and(|quad| self.sides[quad][side].0.is_boundary())
        };
        [ends(place.u, 3, 1), ends(place.v, 0, 2)]
    }

    /// The foot of `point` to which Newton's method comes from `start`, and the surface there. `None` where it comes to none.
    pub(super) fn follow(
        &self,
        surface: &LimitSurface,
        start: Start,
        point: DVec3,
    ) -> Option<(Hit, SurfacePoint)> {
        let mut place = start;
        let mut here = surface.evaluate(place.face, place.corner, place.u, place.v)?;
        for _ in 0..STEPS {
            let second = here.second?;
            let gap = here.position - point;
            let gradient = DVec2::new(gap.dot(here.du), gap.dot(here.dv));
            let mixed = here.du.dot(here.dv) + gap.dot(second.uv);
            let hessian = DMat2::from_cols(
                DVec2::new(here.du.length_squared() + gap.dot(second.uu), mixed),
                DVec2::new(mixed, here.dv.length_squared() + gap.dot(second.vv)),
            );
            // On the border of the mesh the foot stays where the distance falls outwards.
            let outwards = |at: f64, slope: f64| if at <= 0.0 { slope > 0.0 } else { slope < 0.0 };
            let [ends_u, ends_v] = self.ends(&place);
            let stays = [ends_u && outwards(place.u, gradient.x), ends_v && outwards(place.v, gradient.y)];
            let (along_u, along_v) = (hessian.x_axis.x, hessian.y_axis.y);
            // Only a minimum of the distance is a foot.
            let step = match stays {
                [true, true] => DVec2::ZERO,
                [true, false] if along_v > 0.0 => DVec2::new(0.0, gradient.y / along_v),
                [false, true] if along_u > 0.0 => DVec2::new(gradient.x / along_u, 0.0),
                [false, false] if along_u > 0.0 && hessian.determinant() > 0.0 => {
                    hessian.inverse() * gradient
                }
                _ => return None,
            };
            let length = step.abs().max_element();
            if length.is_nan() || length >= LONGEST {
                return None;
            }
            place = self.inside(Start { u: place.u - step.x, v: place.v - step.y, ..place })?;
            here = surface.evaluate(place.face, place.corner, place.u, place.v)?;
            if length < CONVERGED {
                let s = (here.position - point).dot(here.normal);
                let Start { face, corner, u, v } = place;
                let hit = Hit { face, corner, u, v, s, position: here.position, normal: here.normal };
                return Some((hit, here));
            }
        }
        None
    }
}
