//! The innermost loop of evaluation: a bicubic patch at one parameter.
//!
//! Points are taken as vectors of four numbers (x, y, z and one that does not matter), for which the compiler makes the
//! widest instructions that the machine has. Products and sums are never fused and their order is fixed: results are the
//! same to the last bit on every machine.

use super::{Bicubic, Jet};
use glam::DVec3;

/// Which derivatives are wanted.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub enum Derivatives {
    /// The position only.
    None,
    /// The position and the derivatives by u and by v.
    First,
    /// Those, and the derivatives by u twice, by u and v, by v twice.
    Second,
}

impl Derivatives {
    /// Numbers per point: three for each vector.
    pub const fn values(self) -> usize {
        match self {
            Self::None => 3,
            Self::First => 9,
            Self::Second => 18,
        }
    }
}

/// Bernstein polynomials of degree 3 at `t`, and their first and second derivatives.
#[inline(always)]
fn bernstein(t: f64) -> [[f64; 4]; 3] {
    let s = 1.0 - t;
    [
        [s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t],
        [-3.0 * s * s, 3.0 * s * (s - 2.0 * t), 3.0 * t * (2.0 * s - t), 3.0 * t * t],
        [6.0 * s, 6.0 * t - 12.0 * s, 6.0 * s - 12.0 * t, 6.0 * t],
    ]
}

/// x, y, z and one number that does not matter.
pub(super) type Lanes = [f64; 4];

#[inline(always)]
fn lanes(point: &DVec3, next: f64) -> Lanes {
    [point.x, point.y, point.z, next]
}

#[inline(always)]
pub(super) fn point(lanes: Lanes) -> DVec3 {
    DVec3::new(lanes[0], lanes[1], lanes[2])
}

#[inline(always)]
fn scaled(a: Lanes, w: f64) -> Lanes {
    [a[0] * w, a[1] * w, a[2] * w, a[3] * w]
}

#[inline(always)]
fn sum(a: Lanes, b: Lanes) -> Lanes {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2], a[3] + b[3]]
}

#[inline(always)]
fn blend(p: &[Lanes; 4], w: &[f64; 4]) -> Lanes {
    let low = sum(scaled(p[0], w[0]), scaled(p[1], w[1]));
    let high = sum(scaled(p[2], w[2]), scaled(p[3], w[3]));
    sum(low, high)
}

/// The four points along v of column `i`; loads reach into the next point, which saves taking them apart.
#[inline(always)]
fn column(bicubic: &Bicubic, i: usize) -> [Lanes; 4] {
    let [a, b, c, d] = &bicubic.points;
    if i == 3 {
        return [lanes(&a[3], b[0].x), lanes(&b[3], c[0].x), lanes(&c[3], d[0].x), lanes(&d[3], 0.0)];
    }
    [lanes(&a[i], a[i + 1].x), lanes(&b[i], b[i + 1].x), lanes(&c[i], c[i + 1].x), lanes(&d[i], d[i + 1].x)]
}

#[inline(always)]
fn across(columns: &[[Lanes; 4]; 4], w: &[f64; 4]) -> [Lanes; 4] {
    [blend(&columns[0], w), blend(&columns[1], w), blend(&columns[2], w), blend(&columns[3], w)]
}

/// The patch at (u, v), with the derivatives up to `ORDER`; the others are 0.
#[inline(always)]
pub(super) fn jet<const ORDER: usize>(bicubic: &Bicubic, u: f64, v: f64) -> Jet {
    let [b, db, ddb] = bernstein(u);
    let [c, dc, ddc] = bernstein(v);
    let columns = [column(bicubic, 0), column(bicubic, 1), column(bicubic, 2), column(bicubic, 3)];
    let along = across(&columns, &c);
    let mut jet = Jet { position: point(blend(&along, &b)), ..Jet::default() };
    if ORDER >= 1 {
        let slopes = across(&columns, &dc);
        jet.du = point(blend(&along, &db));
        jet.dv = point(blend(&slopes, &b));
        if ORDER >= 2 {
            jet.duu = point(blend(&along, &ddb));
            jet.duv = point(blend(&slopes, &db));
            jet.dvv = point(blend(&across(&columns, &ddc), &b));
        }
    }
    jet
}

/// Adds `point`, times eight weights, to eight points.
#[inline(always)]
pub(super) fn accumulate(sums: &mut [Lanes; 8], weights: &[f64; 8], point: &DVec3) {
    let lanes = lanes(point, 0.0);
    for (at, &weight) in sums.iter_mut().zip(weights) {
        *at = sum(*at, scaled(lanes, weight));
    }
}
