//! The canvas: linear light and depth of samples, and triangles filled into it.

use super::colour::{Light, to_srgb};
use super::image::Image;
use glam::DVec3;

/// Samples per pixel in each direction.
pub(super) const SUPERSAMPLING: usize = 2;
/// Corners are snapped to this fraction of a sample: integer edge functions leave neither gaps nor double hits between
/// neighbours.
const SUBSAMPLES: i64 = 256;
/// Corners further off than this many samples are not drawn; the products of edge functions stay within 64 bits.
const FARTHEST: f64 = 2_097_152.0;

/// A corner of a triangle on the canvas: where it is (samples, z away from the viewer) and what is interpolated.
#[derive(Clone, Copy, Debug)]
pub(super) struct Corner<const N: usize> {
    pub(super) at: DVec3,
    pub(super) data: [f32; N],
}

/// Samples of linear light with a depth buffer.
pub(super) struct Canvas {
    width: usize,
    height: usize,
    light: Vec<Light>,
    depth: Vec<f32>,
}

impl Canvas {
    /// White, infinitely deep paper of `width` x `height` samples. The caller has capped the size.
    pub(super) fn new(width: usize, height: usize) -> Self {
        Self {
            width,
            height,
            light: vec![[1.0; 3]; width * height],
            depth: vec![f32::INFINITY; width * height],
        }
    }

    pub(super) fn width(&self) -> usize {
        self.width
    }

    pub(super) fn height(&self) -> usize {
        self.height
    }

    /// Fills a triangle of either orientation where it is nearer than what is there. `shade` turns the interpolated data
    /// into light. A sample on an edge shared by two triangles belongs to exactly one of them.
    pub(super) fn triangle<const N: usize>(
        &mut self,
        corners: [Corner<N>; 3],
        shade: impl Fn([f32; N]) -> Light,
    ) {
        if !corners.iter().all(|c| is_drawable(c.at)) {
            return;
        }
        let [mut a, mut b, c] = corners;
        let [mut p, mut q, r] = corners.map(|corner| snapped(corner.at));
        let mut area = doubled_area(p, q, r);
        if area < 0 {
            std::mem::swap(&mut a, &mut b);
            std::mem::swap(&mut p, &mut q);
            area = -area;
        }
        if area == 0 {
            return;
        }
        let Some((columns, rows)) = self.covered(p, q, r) else { return };

        let first = [columns.start, rows.start].map(|i| i as i64 * SUBSAMPLES + SUBSAMPLES / 2);
        let edges = [Edge::new(q, r, first), Edge::new(r, p, first), Edge::new(p, q, first)];
        let mut at_row = edges.map(|edge| edge.value);
        let inverse_area = 1.0 / area as f32;
        let depth_rise = [(b.at.z - a.at.z) as f32, (c.at.z - a.at.z) as f32];
        let data_rise: [[f32; 2]; N] =
            std::array::from_fn(|i| [b.data[i] - a.data[i], c.data[i] - a.data[i]]);

        for y in rows {
            let mut at = at_row;
            let line = y * self.width;
            for index in line + columns.start..line + columns.end {
                if at[0] + edges[0].bias >= 0 && at[1] + edges[1].bias >= 0 && at[2] + edges[2].bias >= 0 {
                    let share = [at[1] as f32 * inverse_area, at[2] as f32 * inverse_area];
                    let z = a.at.z as f32 + share[0] * depth_rise[0] + share[1] * depth_rise[1];
                    if z < self.depth[index] {
                        self.depth[index] = z;
                        self.light[index] = shade(std::array::from_fn(|i| {
                            a.data[i] + share[0] * data_rise[i][0] + share[1] * data_rise[i][1]
                        }));
                    }
                }
                for (value, edge) in at.iter_mut().zip(&edges) {
                    *value += edge.step_x;
                }
            }
            for (value, edge) in at_row.iter_mut().zip(&edges) {
                *value += edge.step_y;
            }
        }
    }

    /// The columns and rows of samples whose centres a snapped triangle can cover, if there are any.
    fn covered(&self, p: [i64; 2], q: [i64; 2], r: [i64; 2]) -> Option<(Span, Span)> {
        let span = |axis: usize, bound: usize| {
            let low = p[axis].min(q[axis]).min(r[axis]);
            let high = p[axis].max(q[axis]).max(r[axis]);
            let start = (low - SUBSAMPLES / 2).div_euclid(SUBSAMPLES).clamp(0, bound as i64);
            let end = ((high - SUBSAMPLES / 2).div_euclid(SUBSAMPLES) + 1).clamp(0, bound as i64);
            (start < end).then_some(start as usize..end as usize)
        };
        Some((span(0, self.width)?, span(1, self.height)?))
    }

    /// True where a point of a line or a disc shows: it is no more than `slack` behind the farthest of the samples around
    /// it. The neighbours are asked because a face seen at a grazing angle changes its depth within a sample.
    pub(super) fn shows(&self, at: DVec3, slack: f64) -> bool {
        let (x, y) = (at.x.floor() as i64, at.y.floor() as i64);
        let limit = (at.z - slack) as f32;
        [(0, 0), (-1, 0), (1, 0), (0, -1), (0, 1)]
            .into_iter()
            .any(|(dx, dy)| self.depth_at(x + dx, y + dy).is_some_and(|depth| depth >= limit))
    }

    fn depth_at(&self, x: i64, y: i64) -> Option<f32> {
        let (x, y) = (usize::try_from(x).ok()?, usize::try_from(y).ok()?);
        if x < self.width { self.depth.get(y * self.width + x).copied() } else { None }
    }

    /// Mixes `colour` into the samples `columns` of row `y`; `coverage` gives the weight in [0, 1] at a sample's centre.
    pub(super) fn blend_row(
        &mut self,
        y: usize,
        columns: Span,
        colour: Light,
        coverage: impl Fn(f64) -> f64,
    ) {
        let line = y * self.width;
        for x in columns.start..columns.end.min(self.width) {
            let weight = coverage(x as f64 + 0.5) as f32;
            if weight > 0.0
                && let Some(light) = self.light.get_mut(line + x)
            {
                for (old, new) in light.iter_mut().zip(colour) {
                    *old += weight * (new - *old);
                }
            }
        }
    }

    /// Averages the samples into the pixels of `image`, with the canvas's corner at pixel (`left`, `top`).
    pub(super) fn resolve(&self, image: &mut Image, left: usize, top: usize) {
        for y in 0..self.height / SUPERSAMPLING {
            for x in 0..self.width / SUPERSAMPLING {
                let mut sum = [0.0; 3];
                for row in 0..SUPERSAMPLING {
                    let start = (y * SUPERSAMPLING + row) * self.width + x * SUPERSAMPLING;
                    for light in &self.light[start..start + SUPERSAMPLING] {
                        for (total, part) in sum.iter_mut().zip(light) {
                            // What is brighter than paper would spread over its neighbours.
                            *total += part.min(1.0);
                        }
                    }
                }
                let mean = sum.map(|total| total / (SUPERSAMPLING * SUPERSAMPLING) as f32);
                image.blend((left + x) as i64, (top + y) as i64, to_srgb(mean), 255);
            }
        }
    }
}

pub(super) type Span = std::ops::Range<usize>;

/// True where a projected point is finite and near enough to the canvas to be drawn.
pub(super) fn is_drawable(at: DVec3) -> bool {
    at.abs().cmplt(DVec3::splat(FARTHEST)).all()
}

fn snapped(at: DVec3) -> [i64; 2] {
    [at.x, at.y].map(|v| (v * SUBSAMPLES as f64).round() as i64)
}

fn doubled_area(p: [i64; 2], q: [i64; 2], r: [i64; 2]) -> i64 {
    (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])
}

/// The edge function of a directed edge: positive on the inner side, its value at the first sample, its steps to the next
/// sample and row.
#[derive(Clone, Copy)]
struct Edge {
    value: i64,
    step_x: i64,
    step_y: i64,
    /// -1 where samples exactly on the edge belong to the neighbour.
    bias: i64,
}

impl Edge {
    fn new(from: [i64; 2], to: [i64; 2], sample: [i64; 2]) -> Self {
        let (dx, dy) = (to[0] - from[0], to[1] - from[1]);
        let owns = dy < 0 || (dy == 0 && dx > 0);
        Self {
            value: dx * (sample[1] - from[1]) - dy * (sample[0] - from[0]),
            step_x: -dy * SUBSAMPLES,
            step_y: dx * SUBSAMPLES,
            bias: if owns { 0 } else { -1 },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn corner(x: f64, y: f64, z: f64) -> Corner<1> {
        Corner { at: DVec3::new(x, y, z), data: [z as f32] }
    }

    fn count(canvas: &Canvas) -> usize {
        canvas.depth.iter().filter(|depth| depth.is_finite()).count()
    }

    #[test]
    fn covered_samples_match_the_area() {
        for (a, b, c) in [
            ((10.3, 12.7), (180.2, 33.1), (70.9, 190.4)),
            ((190.0, 5.0), (5.0, 100.0), (195.0, 195.0)),
            ((20.0, 20.0), (150.0, 20.0), (20.0, 171.4)),
        ] {
            let mut canvas = Canvas::new(200, 200);
            let corners = [corner(a.0, a.1, 1.0), corner(b.0, b.1, 1.0), corner(c.0, c.1, 1.0)];
            canvas.triangle(corners, |_| [0.0; 3]);
            let area: f64 = ((b.0 - a.0) * (c.1 - a.1) - (b.1 - a.1) * (c.0 - a.0)) / 2.0;
            let error = (count(&canvas) as f64 - area.abs()).abs() / area.abs();
            assert!(error < 0.005, "{error}");
        }
    }

    #[test]
    fn a_fan_covers_each_sample_of_its_square_once() {
        // The hub lies on a sample's centre, edges run through many centres.
        let rim =
            [(8.0, 8.0), (40.5, 8.0), (72.0, 8.0), (72.0, 40.5), (72.0, 72.0), (8.0, 72.0), (8.0, 40.5)];
        let mut canvas = Canvas::new(80, 80);
        let mut sum = 0;
        for i in 0..rim.len() {
            let (p, q) = (rim[i], rim[(i + 1) % rim.len()]);
            let mut alone = Canvas::new(80, 80);
            let corners = [corner(40.5, 40.5, 0.0), corner(q.0, q.1, 0.0), corner(p.0, p.1, 0.0)];
            alone.triangle(corners, |_| [0.0; 3]);
            canvas.triangle(corners, |_| [0.0; 3]);
            sum += count(&alone);
        }
        assert_eq!(count(&canvas), 64 * 64);
        assert_eq!(sum, 64 * 64);
    }

    #[test]
    fn the_nearer_triangle_wins_in_either_order() {
        let near = [corner(0.0, 0.0, 1.0), corner(100.0, 0.0, 1.0), corner(0.0, 100.0, 1.0)];
        let far = near.map(|c| corner(c.at.x, c.at.y, 2.0));
        for order in [[near, far], [far, near]] {
            let mut canvas = Canvas::new(100, 100);
            for triangle in order {
                canvas.triangle(triangle, |[z]| [z; 3]);
            }
            assert_eq!(canvas.light[20 * 100 + 20], [1.0; 3]);
        }
    }

    #[test]
    fn depth_is_interpolated_so_that_crossing_triangles_cut_each_other() {
        let slope = [corner(0.0, 0.0, 0.0), corner(200.0, 0.0, 200.0), corner(0.0, 200.0, 0.0)];
        let wall = [corner(0.0, 0.0, 50.0), corner(200.0, 0.0, 50.0), corner(0.0, 200.0, 50.0)];
        let mut canvas = Canvas::new(200, 200);
        canvas.triangle(slope, |_| [0.0; 3]);
        canvas.triangle(wall, |_| [0.5; 3]);
        assert_eq!(canvas.light[10 * 200 + 40], [0.0; 3]);
        assert_eq!(canvas.light[10 * 200 + 60], [0.5; 3]);
    }

    #[test]
    fn corners_far_off_are_cut_at_the_canvas_or_left_out() {
        let mut canvas = Canvas::new(50, 40);
        let large = [corner(-1e6, -1e6, 1.0), corner(1e6, -1e6, 1.0), corner(0.0, 2e6, 1.0)];
        canvas.triangle(large, |_| [0.0; 3]);
        assert_eq!(count(&canvas), 50 * 40);
        let mut canvas = Canvas::new(50, 40);
        for bad in [f64::NAN, f64::INFINITY, -1e300, 3e6] {
            canvas.triangle([corner(bad, 0.0, 0.0), corner(50.0, 0.0, 0.0), corner(0.0, 40.0, 0.0)], |_| {
                [0.0; 3]
            });
            canvas.triangle([corner(0.0, 0.0, bad), corner(50.0, 0.0, 0.0), corner(0.0, 40.0, 0.0)], |_| {
                [0.0; 3]
            });
        }
        canvas.triangle([corner(1.0, 1.0, 0.0); 3], |_| [0.0; 3]);
        assert_eq!(count(&canvas), 0);
    }
}
