//! The innermost loop of evaluation: a bicubic patch at one parameter.
//!
//! Points are taken as vectors of four numbers (x, y, z and one that does not matter), in one instruction each where the
//! machine has them. Products and sums are never fused and their order is fixed: results are the
//! same to the last bit on every machine.

use super::{Bicubic, Jet};
use glam::DVec3;
#[cfg(target_arch = "x86_64")]
use pulp::Simd;

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

/// Arithmetic on four numbers at once, rounded as that on each of them.
pub(super) trait Four: Copy {
    type Value: Copy;
    fn of(self, numbers: Lanes) -> Self::Value;
    fn numbers(self, value: Self::Value) -> Lanes;
    fn sum(self, a: Self::Value, b: Self::Value) -> Self::Value;
    fn product(self, a: Self::Value, b: Self::Value) -> Self::Value;
}

/// Instructions that every machine has.
#[derive(Clone, Copy)]
pub(super) struct Plain;

impl Four for Plain {
    type Value = Lanes;

    #[inline(always)]
    fn of(self, numbers: Lanes) -> Lanes {
        numbers
    }

    #[inline(always)]
    fn numbers(self, value: Lanes) -> Lanes {
        value
    }

    #[inline(always)]
    fn sum(self, a: Lanes, b: Lanes) -> Lanes {
        [a[0] + b[0], a[1] + b[1], a[2] + b[2], a[3] + b[3]]
    }

    #[inline(always)]
    fn product(self, a: Lanes, b: Lanes) -> Lanes {
        [a[0] * b[0], a[1] * b[1], a[2] * b[2], a[3] * b[3]]
    }
}

#[cfg(target_arch = "x86_64")]
impl Four for pulp::x86::V3 {
    type Value = pulp::f64x4;

    #[inline(always)]
    fn of(self, [a, b, c, d]: Lanes) -> pulp::f64x4 {
        pulp::f64x4(a, b, c, d)
    }

    #[inline(always)]
    fn numbers(self, pulp::f64x4(a, b, c, d): pulp::f64x4) -> Lanes {
        [a, b, c, d]
    }

    #[inline(always)]
    fn sum(self, a: pulp::f64x4, b: pulp::f64x4) -> pulp::f64x4 {
        self.add_f64s(a, b)
    }

    #[inline(always)]
    fn product(self, a: pulp::f64x4, b: pulp::f64x4) -> pulp::f64x4 {
        self.mul_f64s(a, b)
    }
}

#[inline(always)]
fn lanes(point: &DVec3, next: f64) -> Lanes {
    [point.x, point.y, point.z, next]
}

#[inline(always)]
pub(super) fn point([x, y, z, _]: Lanes) -> DVec3 {
    DVec3::new(x, y, z)
}

/// One weight for all four numbers.
#[inline(always)]
fn weight<F: Four>(four: F, w: f64) -> F::Value {
    four.of([w; 4])
}

#[inline(always)]
fn weights<F: Four>(four: F, w: [f64; 4]) -> [F::Value; 4] {
    [weight(four, w[0]), weight(four, w[1]), weight(four, w[2]), weight(four, w[3])]
}

#[inline(always)]
fn blend<F: Four>(four: F, p: &[F::Value; 4], w: &[F::Value; 4]) -> F::Value {
    let low = four.sum(four.product(p[0], w[0]), four.product(p[1], w[1]));
    let high = four.sum(four.product(p[2], w[2]), four.product(p[3], w[3]));
    four.sum(low, high)
}

/// The four points along v of column `i`; loads reach into the next point, which saves taking them apart.
#[inline(always)]
fn column<F: Four>(four: F, bicubic: &Bicubic, i: usize) -> [F::Value; 4] {
    let [a, b, c, d] = &bicubic.points;
    let columns = if i == 3 {
        [lanes(&a[3], b[0].x), lanes(&b[3], c[0].x), lanes(&c[3], d[0].x), lanes(&d[3], 0.0)]
    } else {
        [
            lanes(&a[i], a[i + 1].x),
            lanes(&b[i], b[i + 1].x),
            lanes(&c[i], c[i + 1].x),
            lanes(&d[i], d[i + 1].x),
        ]
    };
    [four.of(columns[0]), four.of(columns[1]), four.of(columns[2]), four.of(columns[3])]
}

#[inline(always)]
fn across<F: Four>(four: F, columns: &[[F::Value; 4]; 4], w: &[F::Value; 4]) -> [F::Value; 4] {
    [
        blend(four, &columns[0], w),
        blend(four, &columns[1], w),
        blend(four, &columns[2], w),
        blend(four, &columns[3], w),
    ]
}

/// The patch at (u, v), with the derivatives up to `ORDER`; the others are 0.
#[inline(always)]
pub(super) fn jet<const ORDER: usize, F: Four>(four: F, bicubic: &Bicubic, u: f64, v: f64) -> Jet {
    let [b, db, ddb] = bernstein(u);
    let [c, dc, ddc] = bernstein(v);
    let [b, db] = [weights(four, b), weights(four, db)];
    let columns = [
        column(four, bicubic, 0),
        column(four, bicubic, 1),
        column(four, bicubic, 2),
        column(four, bicubic, 3),
    ];
    let along = across(four, &columns, &weights(four, c));
    let at = |p: &[F::Value; 4], w: &[F::Value; 4]| point(four.numbers(blend(four, p, w)));
    let mut jet = Jet { position: at(&along, &b), ..Jet::default() };
    if ORDER >= 1 {
        let slopes = across(four, &columns, &weights(four, dc));
        jet.du = at(&along, &db);
        jet.dv = at(&slopes, &b);
        if ORDER >= 2 {
            jet.duu = at(&along, &weights(four, ddb));
            jet.duv = at(&slopes, &db);
            jet.dvv = at(&across(four, &columns, &weights(four, ddc)), &b);
        }
    }
    jet
}

/// Adds `point`, times eight weights, to eight points.
#[inline(always)]
pub(super) fn accumulate<F: Four>(four: F, sums: &mut [F::Value; 8], weights: &[f64; 8], point: &DVec3) {
    let point = four.of(lanes(point, 0.0));
    for (at, &w) in sums.iter_mut().zip(weights) {
        *at = four.sum(*at, four.product(point, weight(four, w)));
    }
}
