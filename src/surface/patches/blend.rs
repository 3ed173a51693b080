//! How patches meet along the sides from extraordinary vertices: with nearly the same normals.
//!
//! Free are the heights, over the tangent plane at the vertex, of the poles of which none belongs to pieces outside: per side its
//! third pole, and on either side of it the second and third one of the next row. They are found in least squares of the
//! angle between normals along all sides at once, by Gauss-Newton steps with conjugate gradients.

use super::seam::Neighbours;
use super::spline::{SplinePatch, basis};
use glam::DVec3;
use rustc_hash::FxHashMap;

/// Gauss-Newton steps: the system is nearly linear.
const STEPS: usize = 3;
/// Steps of the conjugate gradients in each at most, and what is left of the residual when they end.
const INNER_STEPS: usize = 200;
const LEFT: f64 = 1e-6;
/// Samples in each of the three spans.
const SAMPLES: usize = 4;
/// What a height as large as the distance to the next pole costs, as an angle in radians.
const COST: f64 = 0.02;

/// Moves the poles, whose `normals` are those at the corners of each patch, along the sides that are `smooth`.
pub(super) fn blend(
    patches: &mut [SplinePatch],
    normals: &[[Option<DVec3>; 4]],
    neighbours: &Neighbours,
    smooth: impl Fn(usize, usize) -> bool,
) {
    let mut unknowns = Unknowns::default();
    let mut ends = Vec::new();
    for (number, sides) in neighbours.iter().enumerate() {
        for (side, beyond) in sides.iter().enumerate() {
            let Some((other, there)) = beyond.filter(|&beyond| beyond > (number, side)) else { continue };
            for at_start in [true, false] {
                let corner = if at_start { side } else { (side + 1) % 4 };
                if let Some(normal) = normals[number][corner].filter(|_| smooth(number, side)) {
                    let own = Place { patch: number, side, at_start };
                    let their = Place { patch: other, side: there, at_start: !at_start };
                    ends.extend(End::new(patches, &mut unknowns, own, their, normal));
                }
            }
        }
    }
    for _ in 0..STEPS {
        let mut rows: Vec<Row> = ends.iter().flat_map(|end| end.rows(patches)).collect();
        for row in &mut rows {
            for (slope, &unknown) in row.slopes.iter_mut().zip(&row.unknowns) {
                *slope *= unknowns.all[unknown].unit;
            }
        }
        let moved: Vec<f64> = unknowns.all.iter().map(|unknown| unknown.moved).collect();
        for (unknown, step) in unknowns.all.iter_mut().zip(least_squares(&rows, &moved)) {
            unknown.moved += step;
            for &(patch, pole) in &unknown.poles {
                patches[patch].poles[pole] += step * unknown.unit * unknown.normal;
            }
        }
    }
}

/// A height that is free.
struct Unknown {
    /// The poles that have it, by patch: one, or the same of both patches at a side.
    poles: Vec<(usize, usize)>,
    normal: DVec3,
    /// Distance from the vertex to the next pole; the height is counted in parts of it.
    unit: f64,
    moved: f64,
}

#[derive(Default)]
struct Unknowns {
    all: Vec<Unknown>,
    /// By patch and pole.
    numbers: FxHashMap<(usize, usize), usize>,
}

impl Unknowns {
    /// The number of the height of `pole`, of which `same` are further names.
    fn number(&mut self, pole: (usize, usize), same: &[(usize, usize)], normal: DVec3, unit: f64) -> usize {
        let next = self.all.len();
        let number = *self.numbers.entry(pole).or_insert(next);
        if number == next {
            let poles = std::iter::once(pole).chain(same.iter().copied()).collect();
            self.all.push(Unknown { poles, normal, unit, moved: 0.0 });
        }
        number
    }
}

/// The steps of the unknowns that bring the jumps of all rows, and what was moved before with them, nearest to nothing: normal
/// equations by conjugate gradients, scaled by their diagonal (Hestenes and Stiefel 1952).
fn least_squares(rows: &[Row], moved: &[f64]) -> Vec<f64> {
    let count = moved.len();
    let cost = COST * COST;
    let (mut diagonal, mut residual) = (vec![cost; count], vec![0.0; count]);
    for (value, moved) in residual.iter_mut().zip(moved) {
        *value = -cost * moved;
    }
    for row in rows {
        for (&unknown, slope) in row.unknowns.iter().zip(row.slopes) {
            diagonal[unknown] += slope * slope;
            residual[unknown] -= slope * row.jump;
        }
    }
    let scaled =
        |residual: &[f64]| -> Vec<f64> { residual.iter().zip(&diagonal).map(|(r, d)| r / d).collect() };
    let mut found = vec![0.0; count];
    let mut direction = scaled(&residual);
    let mut square = dot(&residual, &direction);
    let enough = LEFT * LEFT * square;
    for _ in 0..INNER_STEPS {
        if square.is_nan() || square <= enough {
            break;
        }
        let mut image: Vec<f64> = direction.iter().map(|value| cost * value).collect();
        for row in rows {
            let change: f64 =
                row.unknowns.iter().zip(row.slopes).map(|(&k, slope)| slope * direction[k]).sum();
            for (&unknown, slope) in row.unknowns.iter().zip(row.slopes) {
                image[unknown] += slope * change;
            }
        }
        let step = square / dot(&direction, &image);
        for k in 0..count {
            found[k] += step * direction[k];
            residual[k] -= step * image[k];
        }
        let next = scaled(&residual);
        let after = dot(&residual, &next);
        for (value, next) in direction.iter_mut().zip(next) {
            *value = next + after / square * *value;
        }
        square = after;
    }
    if found.iter().all(|step| step.is_finite()) { found } else { vec![0.0; count] }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// A side of a patch, seen from one of its ends.
#[derive(Clone, Copy)]
struct Place {
    patch: usize,
    side: usize,
    at_start: bool,
}

impl Place {
    /// The first three poles from the end, and those of the row beside.
    fn poles(self, patches: &[SplinePatch]) -> Option<[[usize; 3]; 2]> {
        let patch = patches.get(self.patch)?;
        let mut along = patch.side_poles(self.side);
        if !self.at_start {
            along.reverse();
        }
        let first = [*along.first()?, *along.get(1)?, *along.get(2)?];
        let width = patch.pole_counts()[0];
        let beside = first.map(|pole| match self.side % 4 {
            0 => Some(pole + width),
            1 => pole.checked_sub(1),
            2 => pole.checked_sub(width),
            _ => Some(pole + 1),
        });
        Some([first, [beside[0]?, beside[1]?, beside[2]?]])
    }

    /// The first knots inside, from the end.
    fn knots(self, patches: &[SplinePatch]) -> Option<[f64; 3]> {
        let knots = patches.get(self.patch)?.side_knots(self.side);
        let at = |k: usize| {
            if self.at_start == (self.side % 4 < 2) {
                return Some(knots.get(3 + k)? - knots.first()?);
            }
            Some(knots.last()? - knots.get(knots.len().checked_sub(4 + k)?)?)
        };
        Some([at(1)?, at(2)?, at(3)?])
    }
}

/// An end of a shared side at an extraordinary vertex.
struct End {
    own: Place,
    their: Place,
    /// At the vertex.
    normal: DVec3,
    /// The first knots along the side, and the first one away from it on either side.
    knots: [f64; 3],
    depths: [f64; 2],
    /// Own poles beside the side, second and third, those of the other patch, and the third one of the side.
    unknowns: [usize; 5],
}

/// The angle between the normals at a sample, and its derivatives by unknowns.
struct Row {
    jump: f64,
    unknowns: [usize; 5],
    slopes: [f64; 5],
}

impl End {
    fn new(
        patches: &[SplinePatch],
        unknowns: &mut Unknowns,
        own: Place,
        their: Place,
        normal: DVec3,
    ) -> Option<Self> {
        let [[origin, next, third], [_, near, far]] = own.poles(patches)?;
        let [[_, _, their_third], [_, their_near, their_far]] = their.poles(patches)?;
        let poles = &patches.get(own.patch)?.poles;
        let unit = poles.get(origin)?.distance(*poles.get(next)?);
        let depth = |place: Place| {
            Some(Place { side: (place.side + 1) % 4, at_start: true, ..place }.knots(patches)?[0])
        };
        let (a, b) = (own.patch, their.patch);
        Some(Self {
            own,
            their,
            normal,
            knots: own.knots(patches)?,
            depths: [depth(own)?, depth(their)?],
            unknowns: [
                unknowns.number((a, near), &[], normal, unit),
                unknowns.number((a, far), &[], normal, unit),
                unknowns.number((b, their_near), &[], normal, unit),
                unknowns.number((b, their_far), &[], normal, unit),
                unknowns.number((a, third), &[(b, their_third)], normal, unit),
            ],
        })
    }

    /// Samples in the three spans that the poles reach; none where the patches have no normals.
    fn rows(&self, patches: &[SplinePatch]) -> Vec<Row> {
        let [first, second, third] = self.knots;
        let spans = [[0.0, first], [first, second], [second, third]];
        let within = |k: usize| (k as f64 + 0.5) / SAMPLES as f64;
        let places =
            spans.iter().flat_map(|[low, high]| (0..SAMPLES).map(move |k| low + (high - low) * within(k)));
        places.filter_map(|t| self.row(patches, t)).collect()
    }

    fn row(&self, patches: &[SplinePatch], t: f64) -> Option<Row> {
        let (patch, other) = (patches.get(self.own.patch)?, patches.get(self.their.patch)?);
        let length = patch.side_length(self.own.side)?;
        let along = if self.own.at_start { t } else { length - t };
        let (tangent, own) = patch.at_side(self.own.side, along)?.beside(self.own.side);
        let (_, their) = other.at_side(self.their.side, length - along)?.beside(self.their.side);
        let (speed, tangent) = (tangent.length(), tangent.try_normalize()?);
        let normal = tangent.cross(own - their).try_normalize()?;
        let [width, width_there] = [own, their].map(|inside| inside.reject_from_normalized(tangent).length());
        // Of length 2 sin(angle / 2) without its part along the tangent.
        let sum = own / width + their / width_there;

        let [a, b, c] = self.knots;
        let (span, values, slopes) = basis(&[0.0, 0.0, 0.0, 0.0, a, b, c, c, c, c], t)?;
        let of = |basis: [f64; 4], number: usize| {
            number.checked_sub(span).and_then(|at| basis.get(at).copied()).unwrap_or(0.0)
        };
        let (near, far) = (of(values, 1), of(values, 2));
        let [rise, rise_there] = [3.0 / (self.depths[0] * width), 3.0 / (self.depths[1] * width_there)];
        let turn = sum.dot(tangent) / speed * of(slopes, 2) * if self.own.at_start { 1.0 } else { -1.0 };
        let by = normal.dot(self.normal);
        let found = Row {
            jump: normal.dot(sum),
            unknowns: self.unknowns,
            slopes: [
                by * near * rise,
                by * far * rise,
                by * near * rise_there,
                by * far * rise_there,
                -by * (far * (rise + rise_there) + turn),
            ],
        };
        let finite = found.slopes.iter().chain([&found.jump]).all(|value| value.is_finite());
        finite.then_some(found)
    }
}
