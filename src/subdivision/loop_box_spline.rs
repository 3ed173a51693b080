//! The quartic box spline: the pieces of which Loop surfaces consist away from extraordinary vertices (Loop 1987).

use super::patch_bicubic::Jet;
use glam::DVec3;

/// The control points of a piece, in lattice coordinates: the triangle's corners lie at (0, 0), (1, 0) and (0, 1). A point
/// (x, y) stands at `[y + 1][x + 1]`; four of the sixteen places are not used.
pub(super) type Net = [[DVec3; 4]; 4];

/// A term: 12 times the coefficient, and the powers of three barycentric coordinates.
type Term = (f64, [usize; 3]);

/// Of the corner of the first coordinate.
const CORNER: &[Term] = &[
    (6.0, [4, 0, 0]),
    (24.0, [3, 1, 0]),
    (24.0, [3, 0, 1]),
    (24.0, [2, 2, 0]),
    (60.0, [2, 1, 1]),
    (24.0, [2, 0, 2]),
    (8.0, [1, 3, 0]),
    (36.0, [1, 2, 1]),
    (36.0, [1, 1, 2]),
    (8.0, [1, 0, 3]),
    (1.0, [0, 4, 0]),
    (6.0, [0, 3, 1]),
    (12.0, [0, 2, 2]),
    (6.0, [0, 1, 3]),
    (1.0, [0, 0, 4]),
];

/// Of the point beyond the edge between the corners of the first two coordinates.
const BEYOND: &[Term] = &[
    (1.0, [4, 0, 0]),
    (6.0, [3, 1, 0]),
    (12.0, [2, 2, 0]),
    (6.0, [1, 3, 0]),
    (1.0, [0, 4, 0]),
    (2.0, [3, 0, 1]),
    (6.0, [2, 1, 1]),
    (6.0, [1, 2, 1]),
    (2.0, [0, 3, 1]),
];

/// Of a point behind the corner of the first coordinate, on the side of the second.
const BEHIND: &[Term] = &[(1.0, [4, 0, 0]), (2.0, [3, 1, 0])];

/// Lattice place, basis function, and which coordinates (1 - u - v, u, v) it takes in which order.
const BASIS: [([isize; 2], &[Term], [usize; 3]); 12] = [
    ([0, 0], CORNER, [0, 1, 2]),
    ([1, 0], CORNER, [1, 2, 0]),
    ([0, 1], CORNER, [2, 0, 1]),
    ([1, -1], BEYOND, [0, 1, 2]),
    ([1, 1], BEYOND, [1, 2, 0]),
    ([-1, 1], BEYOND, [2, 0, 1]),
    ([0, -1], BEHIND, [0, 1, 2]),
    ([-1, 0], BEHIND, [0, 2, 1]),
    ([2, -1], BEHIND, [1, 0, 2]),
    ([2, 0], BEHIND, [1, 2, 0]),
    ([0, 2], BEHIND, [2, 1, 0]),
    ([-1, 2], BEHIND, [2, 0, 1]),
];

/// x^n and its first two derivatives.
fn power(x: f64, n: usize) -> [f64; 3] {
    let at = |n: usize| x.powi(n as i32);
    match n {
        0 => [1.0, 0.0, 0.0],
        1 => [x, 1.0, 0.0],
        _ => [at(n), n as f64 * at(n - 1), (n * (n - 1)) as f64 * at(n - 2)],
    }
}

/// The piece at (u, v), the weights of the second and third corner.
pub(super) fn jet(net: &Net, u: f64, v: f64) -> Jet {
    let coordinates = [1.0 - u - v, u, v];
    let mut jet = Jet::default();
    for (place, terms, order) in BASIS {
        let [x, y] = place.map(|at| (at + 1) as usize);
        let point = net[y][x] / 12.0;
        for &(weight, powers) in terms {
            // Powers of the coordinates in their own order.
            let mut own = [0; 3];
            order.iter().zip(powers).for_each(|(&coordinate, n)| own[coordinate] = n);
            let [r, s, t]: [[f64; 3]; 3] = std::array::from_fn(|i| power(coordinates[i], own[i]));
            let [rst, dr, ds, dt] =
                [r[0] * s[0] * t[0], r[1] * s[0] * t[0], r[0] * s[1] * t[0], r[0] * s[0] * t[1]];
            let [rr, ss, tt] = [r[2] * s[0] * t[0], r[0] * s[2] * t[0], r[0] * s[0] * t[2]];
            let [rs, rt, st] = [r[1] * s[1] * t[0], r[1] * s[0] * t[1], r[0] * s[1] * t[1]];
            jet.position += weight * rst * point;
            jet.du += weight * (ds - dr) * point;
            jet.dv += weight * (dt - dr) * point;
            jet.duu += weight * (ss - 2.0 * rs + rr) * point;
            jet.duv += weight * (st - rs - rt + rr) * point;
            jet.dvv += weight * (tt - 2.0 * rt + rr) * point;
        }
    }
    jet
}
