//! Bicubic patches: the pieces of which the limit surface consists away from extraordinary vertices.

use glam::DVec3;

/// Value and derivatives of a surface at one parameter.
#[derive(Clone, Copy, PartialEq, Default, Debug)]
pub(crate) struct Jet {
    pub(crate) position: DVec3,
    pub(crate) du: DVec3,
    pub(crate) dv: DVec3,
    pub(crate) duu: DVec3,
    pub(crate) duv: DVec3,
    pub(crate) dvv: DVec3,
}

/// Sixteen control points of a uniform bicubic B-spline piece, `grid[j][i]` with `i` along u and `j` along v.
/// The piece lies over the middle cell, from `grid[1][1]` to `grid[2][2]`.
pub(crate) type Grid = [[DVec3; 4]; 4];

/// A bicubic Bezier patch over [0, 1]^2, `points[j][i]` with `i` along u and `j` along v. Fills six cache lines.
#[derive(Clone, Copy, PartialEq, Debug)]
#[repr(align(64))]
pub(crate) struct Bicubic {
    pub(crate) points: Grid,
}

fn bspline_to_bezier(p: [DVec3; 4]) -> [DVec3; 4] {
    let (third, sixth) = (1.0 / 3.0, 1.0 / 6.0);
    [
        (p[0] + 4.0 * p[1] + p[2]) * sixth,
        (2.0 * p[1] + p[2]) * third,
        (p[1] + 2.0 * p[2]) * third,
        (p[1] + 4.0 * p[2] + p[3]) * sixth,
    ]
}

/// The two halves of a cubic Bezier curve.
fn halves(p: [DVec3; 4]) -> [[DVec3; 4]; 2] {
    let (a, b, c) = ((p[0] + p[1]) * 0.5, (p[1] + p[2]) * 0.5, (p[2] + p[3]) * 0.5);
    let (d, e) = ((a + b) * 0.5, (b + c) * 0.5);
    let middle = (d + e) * 0.5;
    [[p[0], a, d, middle], [middle, e, c, p[3]]]
}

fn transpose(p: &Grid) -> Grid {
    std::array::from_fn(|i| std::array::from_fn(|j| p[j][i]))
}

/// Bernstein polynomials of degree 3 at `t`, and their first and second derivatives.
fn bernstein(t: f64) -> [[f64; 4]; 3] {
    let s = 1.0 - t;
    [
        [s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t],
        [-3.0 * s * s, 3.0 * s * (s - 2.0 * t), 3.0 * t * (2.0 * s - t), 3.0 * t * t],
        [6.0 * s, 6.0 * t - 12.0 * s, 6.0 * s - 12.0 * t, 6.0 * t],
    ]
}

fn combine(weights: &[f64; 4], points: &[DVec3; 4]) -> DVec3 {
    weights[0] * points[0] + weights[1] * points[1] + weights[2] * points[2] + weights[3] * points[3]
}

impl Bicubic {
    /// The Bezier form of a uniform B-spline piece.
    pub(crate) fn from_bspline(grid: &Grid) -> Self {
        let rows = grid.map(bspline_to_bezier);
        Self { points: transpose(&transpose(&rows).map(bspline_to_bezier)) }
    }

    /// Value and first derivatives; the second derivatives stay zero.
    pub(crate) fn tangents(&self, u: f64, v: f64) -> Jet {
        let [b, db, _] = bernstein(u);
        let [c, dc, _] = bernstein(v);
        let along: [DVec3; 4] = self.points.map(|row| combine(&b, &row));
        let slopes: [DVec3; 4] = self.points.map(|row| combine(&db, &row));
        Jet {
            position: combine(&c, &along),
            du: combine(&c, &slopes),
            dv: combine(&dc, &along),
            ..Jet::default()
        }
    }

    /// Value, first and second derivatives.
    pub(crate) fn jet(&self, u: f64, v: f64) -> Jet {
        let [b, db, ddb] = bernstein(u);
        let [c, dc, ddc] = bernstein(v);
        let along: [DVec3; 4] = self.points.map(|row| combine(&b, &row));
        let slopes: [DVec3; 4] = self.points.map(|row| combine(&db, &row));
        let bends: [DVec3; 4] = self.points.map(|row| combine(&ddb, &row));
        Jet {
            position: combine(&c, &along),
            du: combine(&c, &slopes),
            dv: combine(&dc, &along),
            duu: combine(&c, &bends),
            duv: combine(&dc, &slopes),
            dvv: combine(&ddc, &along),
        }
    }

    /// The four quarters: `[low u low v, high u low v, low u high v, high u high v]`.
    pub(crate) fn quarters(&self) -> [Self; 4] {
        let split = self.points.map(halves);
        let quarter = |i: usize| transpose(&split.map(|row| row[i])).map(halves);
        let (left, right) = (quarter(0), quarter(1));
        let pick = |side: &[[[DVec3; 4]; 2]; 4], j: usize| Self {
            points: transpose(&std::array::from_fn(|i| side[i][j])),
        };
        [pick(&left, 0), pick(&right, 0), pick(&left, 1), pick(&right, 1)]
    }

    /// The control points in one array, u running fastest.
    pub(crate) fn net(&self) -> [DVec3; 16] {
        std::array::from_fn(|k| self.points[k / 4][k % 4])
    }

    /// The smallest axis-parallel box round the control points, which holds the patch.
    pub(crate) fn bounds(&self) -> (DVec3, DVec3) {
        let flat = self.points.as_flattened();
        flat.iter().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), &p| (low.min(p), high.max(p)))
    }
}
