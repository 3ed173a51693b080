//! Bicubic B-spline surfaces.

use crate::mesh::FaceId;
use glam::DVec3;

/// A bicubic B-spline surface over a rectangle of faces. See [`Patches`](super::Patches).
///
/// Knots are flat: the first and the last one stand four times, those between once; there are four more than poles.
/// Sides: 0 at the first v, from there counter-clockwise.
#[derive(Clone, PartialEq, Debug)]
pub struct SplinePatch {
    /// Along u.
    pub knots_u: Vec<f64>,
    /// Along v.
    pub knots_v: Vec<f64>,
    /// Row by row, u running fastest.
    pub poles: Vec<DVec3>,
    /// The faces whose surface it is, row by row, u running fastest, each once.
    pub faces: Vec<FaceId>,
    /// Per side the patch beyond it and the side of that patch; `None` at the border of the surface. The sides have the
    /// same poles, in opposite order.
    pub neighbours: [Option<(usize, usize)>; 4],
    /// Per corner, from that at the first u and v counter-clockwise: whether it lies at an extraordinary vertex. In
    /// the last three spans beside such a corner the patch is an approximation, everywhere else exact.
    pub irregular: [bool; 4],
    /// Greatest distance to the limit surface that was found, in units of the model; 0 where the patch is exact.
    pub deviation: f64,
    /// The same in parts of the mean length of the edges of the control face.
    pub relative_deviation: f64,
}

/// Value and first derivatives.
#[derive(Clone, Copy, Default, Debug)]
pub struct SplinePoint {
    /// The point.
    pub position: DVec3,
    /// Derivative by u.
    pub du: DVec3,
    /// Derivative by v.
    pub dv: DVec3,
}

impl SplinePoint {
    /// The derivatives along a side, in its sense, and from it inwards.
    pub(super) fn beside(self, side: usize) -> (DVec3, DVec3) {
        match side % 4 {
            0 => (self.du, self.dv),
            1 => (self.dv, -self.du),
            2 => (-self.du, -self.dv),
            _ => (-self.dv, self.du),
        }
    }
}

/// Number of the span in which `t` lies, from the first one that has a length, and the values and derivatives of the four
/// basis functions there (de Boor 1972).
pub(super) fn basis(knots: &[f64], t: f64) -> Option<(usize, [f64; 4], [f64; 4])> {
    // The starts of spans.
    let starts = knots.get(3..knots.len().checked_sub(4)?)?;
    let span = starts.partition_point(|&knot| knot <= t).max(1) - 1;
    let knot: &[f64; 8] = knots.get(span..span + 8)?.try_into().ok()?;
    let mut values = [1.0, 0.0, 0.0, 0.0];
    let mut quadratic = values;
    for degree in 1..=3 {
        quadratic = values;
        values = [0.0; 4];
        for k in 0..degree {
            let (low, high) = (knot[4 + k - degree], knot[4 + k]);
            let share = quadratic[k] / (high - low);
            values[k] += (high - t) * share;
            values[k + 1] += (t - low) * share;
        }
    }
    let mut slopes = [0.0; 4];
    for k in 0..3 {
        let share = 3.0 * quadratic[k] / (knot[4 + k] - knot[1 + k]);
        slopes[k] -= share;
        slopes[k + 1] += share;
    }
    Some((span, values, slopes))
}

impl SplinePatch {
    /// Poles along u and along v.
    pub fn pole_counts(&self) -> [usize; 2] {
        [self.knots_u.len().saturating_sub(4), self.knots_v.len().saturating_sub(4)]
    }

    /// True where the patch is the limit surface itself.
    pub fn is_exact(&self) -> bool {
        self.irregular == [false; 4] && self.deviation == 0.0
    }

    /// The patch at (u, v), which is moved into the range of the knots; `None` for NaN.
    pub fn evaluate(&self, u: f64, v: f64) -> Option<SplinePoint> {
        if u.is_nan() || v.is_nan() {
            return None;
        }
        let within = |knots: &[f64], t: f64| Some(t.max(*knots.first()?).min(*knots.last()?));
        let (first_u, basis_u, slopes_u) = basis(&self.knots_u, within(&self.knots_u, u)?)?;
        let (first_v, basis_v, slopes_v) = basis(&self.knots_v, within(&self.knots_v, v)?)?;
        let width = self.pole_counts()[0];
        let mut found = SplinePoint::default();
        for (j, (b, db)) in basis_v.into_iter().zip(slopes_v).enumerate() {
            let start = (first_v + j) * width + first_u;
            for (i, &pole) in self.poles.get(start..start + 4)?.iter().enumerate() {
                found.position += basis_u[i] * b * pole;
                found.du += slopes_u[i] * b * pole;
                found.dv += basis_u[i] * db * pole;
            }
        }
        Some(found)
    }

    /// Indices of the poles along side `side`, counter-clockwise.
    pub fn side_poles(&self, side: usize) -> Vec<usize> {
        let [m, n] = self.pole_counts();
        match side % 4 {
            0 => (0..m).collect(),
            1 => (0..n).map(|j| j * m + m - 1).collect(),
            2 => (0..m).rev().map(|i| (n - 1) * m + i).collect(),
            _ => (0..n).rev().map(|j| j * m).collect(),
        }
    }

    /// The length of a side in units of the parameter.
    pub(super) fn side_length(&self, side: usize) -> Option<f64> {
        self.side_knots(side).last().copied()
    }

    /// The knots along side `side`, in the sense of the parameter.
    pub(super) fn side_knots(&self, side: usize) -> &[f64] {
        if side.is_multiple_of(2) { &self.knots_u } else { &self.knots_v }
    }

    /// The patch at the distance `along` from the start of a side, counter-clockwise, in units of the parameter.
    pub(super) fn at_side(&self, side: usize, along: f64) -> Option<SplinePoint> {
        let (u, v) = (*self.knots_u.last()?, *self.knots_v.last()?);
        let (u, v) = match side % 4 {
            0 => (along, 0.0),
            1 => (u, along),
            2 => (u - along, v),
            _ => (0.0, v - along),
        };
        self.evaluate(u, v)
    }
}
