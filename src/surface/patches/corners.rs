//! The poles round extraordinary vertices: all patches at a vertex share its tangent plane, and meet along the sides from it with
//! nearly the same normals.

use super::cells::Cell;
use super::pieces::corner_of;
use super::regions::Region;
use super::seam::Neighbours;
use super::spline::{SplinePatch, basis};
use crate::surface::LimitSurface;
use glam::DVec3;

/// Rounds over all sides, and samples along a side in each: more change normals by less than a hundredth of a degree.
const ROUNDS: usize = 16;
const SAMPLES: usize = 8;

/// Indices of the poles next to a corner: along the side that begins there, and inside.
fn next_poles(patch: &SplinePatch, corner: usize) -> [usize; 2] {
    let [m, n] = patch.pole_counts();
    match corner % 4 {
        0 => [1, m + 1],
        1 => [2 * m - 1, 2 * m - 2],
        2 => [m * n - 2, m * n - m - 2],
        _ => [m * (n - 2), m * (n - 2) + 1],
    }
}

/// The normals of the limit surface at the corners that are extraordinary vertices; `None` elsewhere and where it has none.
pub(super) fn normals(surface: &LimitSurface, cells: &[Cell], region: &Region) -> [Option<DVec3>; 4] {
    std::array::from_fn(|corner| {
        let (patch, at) = region.irregular[corner].then(|| corner_of(cells, region, corner))?;
        let point = surface.evaluate_patch(patch, at.x, at.y);
        point.du.cross(point.dv).try_normalize()
    })
}

/// Moves the poles beside extraordinary corners along the sides into the tangent plane there.
pub(super) fn flatten(patch: &mut SplinePatch, normals: [Option<DVec3>; 4]) {
    for (corner, normal) in normals.into_iter().enumerate() {
        let Some(normal) = normal else { continue };
        // The last pole of the side that ends here is that of the corner, the one before it the next.
        let ends = patch.side_poles(corner + 3);
        let [.., before, origin] = ends[..] else { continue };
        for pole in [next_poles(patch, corner)[0], before] {
            let height = (patch.poles[pole] - patch.poles[origin]).dot(normal);
            patch.poles[pole] -= height * normal;
        }
    }
}

/// Moves the poles inside beside extraordinary corners along the normal, so that the patches on both sides of `seams` have
/// nearly the same normals: a round goes over all sides and takes each side's mean angle, in least squares, away
/// (Kaczmarz 1937).
pub(super) fn balance(
    patches: &mut [SplinePatch],
    normals: &[[Option<DVec3>; 4]],
    neighbours: &Neighbours,
    smooth: impl Fn(usize, usize) -> bool,
) {
    let mut ends = Vec::new();
    for (number, sides) in neighbours.iter().enumerate() {
        for (side, beyond) in sides.iter().enumerate() {
            let Some((other, there)) = beyond.filter(|&beyond| beyond > (number, side)) else { continue };
            for (corner, opposite) in [(side, there + 1), (side + 1, there)] {
                if let Some(normal) = normals[number][corner % 4].filter(|_| smooth(number, side)) {
                    ends.push(End {
                        patch: number,
                        side,
                        pole: next_poles(&patches[number], corner)[1],
                        other,
                        there,
                        opposite: next_poles(&patches[other], opposite)[1],
                        at_start: corner == side,
                        normal,
                    });
                }
            }
        }
    }
    for _ in 0..ROUNDS {
        for end in &ends {
            if let Some(height) = end.height(patches) {
                patches[end.patch].poles[end.pole] += height * end.normal;
                patches[end.other].poles[end.opposite] += height * end.normal;
            }
        }
    }
}

/// An end of a shared side at an extraordinary vertex.
struct End {
    patch: usize,
    side: usize,
    /// Its pole inside.
    pole: usize,
    other: usize,
    there: usize,
    opposite: usize,
    at_start: bool,
    normal: DVec3,
}

impl End {
    /// How far to move both poles inside; `None` where the patches have no normals.
    fn height(&self, patches: &[SplinePatch]) -> Option<f64> {
        let (patch, other) = (patches.get(self.patch)?, patches.get(self.other)?);
        let [near, far] = [1, 2].map(|count| inner_knot(patch, self.side, self.at_start, count));
        let (near, far) = (near?, far?);
        let knots = [0.0, 0.0, 0.0, 0.0, near, far, far, far, far];
        let length = patch.side_length(self.side)?;
        // The first knot inside, along the sides that begin where these end.
        let depth = inner_knot(patch, self.side + 1, true, 1)?;
        let depth_there = inner_knot(other, self.there + 1, true, 1)?;
        let (mut product, mut square) = (0.0, 0.0);
        for k in 0..SAMPLES {
            let t = far * (k as f64 + 0.5) / SAMPLES as f64;
            let along = if self.at_start { t } else { length - t };
            let (tangent, own) = patch.at_side(self.side, along)?.beside(self.side);
            let (_, their) = other.at_side(self.there, length - along)?.beside(self.there);
            let tangent = tangent.try_normalize()?;
            let normal = tangent.cross(own - their).try_normalize()?;
            let [width, width_there] =
                [own, their].map(|inside| inside.reject_from_normalized(tangent).length());
            let jump = normal.dot(own) / width + normal.dot(their) / width_there;
            let (first, values, _) = basis(&knots, t)?;
            let slope = 3.0 * values.get(1_usize.checked_sub(first)?)? * normal.dot(self.normal);
            let by_height = slope / (depth * width) + slope / (depth_there * width_there);
            product += jump * by_height;
            square += by_height * by_height;
        }
        Some(-product / square).filter(|height| height.is_finite())
    }
}

/// How far from an end of a side, its start or its end, the knot inside with this number lies: 1 is the first.
fn inner_knot(patch: &SplinePatch, side: usize, at_start: bool, number: usize) -> Option<f64> {
    let knots = patch.side_knots(side);
    if at_start == (side % 4 < 2) {
        return Some(knots.get(3 + number)? - knots.first()?);
    }
    Some(knots.last()? - knots.get(knots.len().checked_sub(4 + number)?)?)
}
