//! Where a bicubic patch crosses the z axis: halving until Newton's method is certain.
//!
//! The two coordinates across the axis are multiplied by the inverse of their mean derivative. Where the result's
//! derivative stays within 1/2 of the identity all over the part, the map is one to one there and Newton's method,
//! kept inside the part, finds its root if there is one.

use super::Bicubic;
use glam::{DMat2, DVec2, DVec3};

/// How often a patch is halved at most: beyond, the line touches the surface.
const MAX_HALVINGS: u32 = 12;
/// Parts of pieces looked at with proof; beyond (a line that lies in the surface) they are no longer halved.
const MAX_PARTS: u32 = 4000;

/// A point on the axis, at (a, b) of the patch.
pub(super) struct Crossing {
    pub(super) a: f64,
    pub(super) b: f64,
    pub(super) position: DVec3,
    /// Not normalised.
    pub(super) normal: DVec3,
}

struct Part {
    bicubic: Bicubic,
    a: f64,
    b: f64,
    size: f64,
    halvings: u32,
}

/// What bounds say about the roots in a part.
enum Verdict {
    None,
    AtMostOne,
    Unknown,
}

/// Appends the crossings of `bicubic` with the z axis, within `tolerance` of it. `parts` counts the work.
pub(super) fn crossings(bicubic: &Bicubic, tolerance: f64, parts: &mut u32, out: &mut Vec<Crossing>) {
    let mut stack = vec![Part { bicubic: *bicubic, a: 0.0, b: 0.0, size: 1.0, halvings: 0 }];
    while let Some(part) = stack.pop() {
        let (low, high) = part.bicubic.bounds();
        let apart = low.truncate().max_element() > tolerance || high.truncate().min_element() < -tolerance;
        if apart {
            continue;
        }
        *parts = parts.saturating_add(1);
        let certain = match verdict(&part.bicubic, tolerance) {
            Verdict::None => continue,
            Verdict::AtMostOne => true,
            Verdict::Unknown => false,
        };
        let last = part.halvings >= MAX_HALVINGS || *parts > MAX_PARTS;
        if certain || last || lies_in_its_plane(&part.bicubic, tolerance) {
            let (s, t, jet) = approach(&part.bicubic);
            if jet.position.truncate().length() <= tolerance {
                out.push(Crossing {
                    a: part.a + part.size * s,
                    b: part.b + part.size * t,
                    position: jet.position,
                    normal: jet.du.cross(jet.dv),
                });
            }
            continue;
        }
        let size = 0.5 * part.size;
        for (i, quarter) in part.bicubic.quarters().into_iter().enumerate() {
            stack.push(Part {
                bicubic: quarter,
                a: part.a + if i % 2 == 1 { size } else { 0.0 },
                b: part.b + if i >= 2 { size } else { 0.0 },
                size,
                halvings: part.halvings + 1,
            });
        }
    }
}

/// True where the patch is flat and the axis lies in its plane: they share a line or nothing, of which one point is wanted.
fn lies_in_its_plane(bicubic: &Bicubic, tolerance: f64) -> bool {
    let points = || bicubic.points.as_flattened().iter().map(|p| p.truncate());
    let farthest =
        points().fold(DVec2::ZERO, |most, p| if p.length_squared() > most.length_squared() { p } else { most });
    let way = farthest.normalize_or_zero();
    points().all(|p| p.perp_dot(way).abs() <= tolerance)
}

fn verdict(bicubic: &Bicubic, tolerance: f64) -> Verdict {
    let p: [[DVec2; 4]; 4] = bicubic.points.map(|row| row.map(DVec3::truncate));
    let du: [DVec2; 12] = std::array::from_fn(|k| 3.0 * (p[k / 3][k % 3 + 1] - p[k / 3][k % 3]));
    let dv: [DVec2; 12] = std::array::from_fn(|k| 3.0 * (p[k / 4 + 1][k % 4] - p[k / 4][k % 4]));
    let mean = |d: &[DVec2; 12]| d.iter().sum::<DVec2>() / 12.0;
    let jacobian = DMat2::from_cols(mean(&du), mean(&dv));
    let scale = jacobian.x_axis.length() * jacobian.y_axis.length();
    let determinant = jacobian.determinant();
    if determinant.is_nan() || determinant.abs() <= 1e-6 * scale {
        return Verdict::Unknown;
    }
    let inverse = jacobian.inverse();
    let empty = (DVec2::INFINITY, DVec2::NEG_INFINITY);
    let (low, high) = p.as_flattened().iter().fold(empty, |(low, high), &q| {
        let q = inverse * q;
        (low.min(q), high.max(q))
    });
    let slack = (inverse.x_axis.abs() + inverse.y_axis.abs()) * tolerance;
    if (low - slack).max_element() > 0.0 || (high + slack).min_element() < 0.0 {
        return Verdict::None;
    }
    let largest = |d: &[DVec2; 12], identity: DVec2| {
        d.iter().fold(DVec2::ZERO, |most, &q| most.max((inverse * q - identity).abs()))
    };
    let change = largest(&du, DVec2::X) + largest(&dv, DVec2::Y);
    if change.max_element() <= 0.5 { Verdict::AtMostOne } else { Verdict::Unknown }
}

/// The point of the patch nearest to the axis that Newton's method finds inside [0, 1]^2.
fn approach(bicubic: &Bicubic) -> (f64, f64, crate::subdivision::patch_bicubic::Jet) {
    let mut at = DVec2::splat(0.5);
    let mut jet = bicubic.tangents(at.x, at.y);
    for _ in 0..40 {
        let jacobian = DMat2::from_cols(jet.du.truncate(), jet.dv.truncate());
        let residual = jet.position.truncate();
        let scale = jacobian.x_axis.length_squared() + jacobian.y_axis.length_squared();
        let step = if jacobian.determinant().abs() > 1e-9 * scale {
            jacobian.inverse() * residual
        } else {
            // The line touches the surface: the shortest step that lessens the residual.
            let damped = jacobian * jacobian.transpose() + DMat2::from_diagonal(DVec2::splat(1e-9 * scale));
            jacobian.transpose() * (damped.inverse() * residual)
        };
        let next = (at - step).clamp(DVec2::ZERO, DVec2::ONE);
        if next.is_nan() {
            break;
        }
        let moved = (next - at).abs().max_element();
        at = next;
        jet = bicubic.tangents(at.x, at.y);
        if moved < 1e-15 || residual == DVec2::ZERO {
            break;
        }
    }
    (at.x, at.y, jet)
}
