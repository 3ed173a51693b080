//! The camera: a parallel projection that frames given points, and its fit to a canvas.

use glam::{DVec2, DVec3};

/// Share of the framed extent that stays free on each side.
const MARGIN: f64 = 0.04;
/// Coordinates beyond this are not framed: their differences would overflow.
const LARGEST_COORDINATE: f64 = 1e150;
/// Extents in view for which the scale is a finite number.
const HALF_EXTENTS: std::ops::Range<f64> = 1e-290..1e290;

/// A parallel projection. All panels of a figure share one, so that they can be compared.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Camera {
    centre: DVec3,
    right: DVec3,
    up: DVec3,
    /// From the object to the viewer.
    back: DVec3,
    /// Half the width and height of what is in view.
    half_extent: DVec2,
}

impl Camera {
    /// Looks at `points` so that they fill the picture, from the side to which `viewer` points (any length), with
    /// `up` upwards in the picture.
    ///
    /// To zoom in on a feature give only its vertices and [widen](Self::widened) the view to show what is around.
    /// Points that are not finite are left out; without points a box of 2 units around the origin is framed. Where
    /// `viewer` is no direction it is +z; where `up` is none or lies along `viewer` some upright is chosen.
    pub fn framing(points: &[DVec3], viewer: DVec3, up: DVec3) -> Self {
        let back = viewer.try_normalize().unwrap_or(DVec3::Z);
        let right = up.cross(back).try_normalize().unwrap_or_else(|| back.any_orthonormal_vector());
        let up = back.cross(right);

        let mut low = DVec3::INFINITY;
        let mut high = DVec3::NEG_INFINITY;
        for p in points.iter().filter(|p| p.abs().cmple(DVec3::splat(LARGEST_COORDINATE)).all()) {
            let seen = DVec3::new(p.dot(right), p.dot(up), p.dot(back));
            low = low.min(seen);
            high = high.max(seen);
        }
        if low.x > high.x {
            (low, high) = (DVec3::NEG_ONE, DVec3::ONE);
        }
        let middle = (low + high) / 2.0;
        let centre = right * middle.x + up * middle.y + back * middle.z;
        let half_extent = (high - low).truncate() / 2.0 * (1.0 + 2.0 * MARGIN);
        Self { centre, right, up, back, half_extent: DVec2::ONE }.showing(half_extent)
    }

    /// The same view of a part that is `factor` times as wide and high. A factor that is not positive and finite, or
    /// leads out of the numbers of a computer, changes nothing.
    pub fn widened(self, factor: f64) -> Self {
        self.showing(self.half_extent * factor)
    }

    fn showing(self, half_extent: DVec2) -> Self {
        let usable = half_extent.min_element() >= 0.0 && HALF_EXTENTS.contains(&half_extent.max_element());
        if usable { Self { half_extent, ..self } } else { self }
    }

    /// `direction` in the axes of the picture: right, up, towards the viewer.
    pub(super) fn turned(&self, direction: DVec3) -> [f32; 3] {
        [direction.dot(self.right) as f32, direction.dot(self.up) as f32, direction.dot(self.back) as f32]
    }
}

/// A camera fitted to a canvas.
pub(super) struct View {
    camera: Camera,
    /// Samples per unit of length.
    scale: f64,
    middle: DVec2,
}

impl View {
    /// Fits the view of `camera` into `width` x `height` samples.
    pub(super) fn new(camera: &Camera, width: usize, height: usize) -> Self {
        let middle = DVec2::new(width as f64, height as f64) / 2.0;
        Self { camera: *camera, scale: (middle / camera.half_extent).min_element(), middle }
    }

    /// Where `p` falls: x to the right and y down from the top left corner, z away from the viewer, all in samples.
    /// Not finite where `p` is not.
    pub(super) fn project(&self, p: DVec3) -> DVec3 {
        let d = p - self.camera.centre;
        DVec3::new(
            self.middle.x + self.scale * d.dot(self.camera.right),
            self.middle.y - self.scale * d.dot(self.camera.up),
            -self.scale * d.dot(self.camera.back),
        )
    }

    pub(super) fn camera(&self) -> &Camera {
        &self.camera
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn framed_points_fill_the_canvas_up_to_the_margin() {
        let points = [DVec3::new(10.0, 0.0, 5.0), DVec3::new(14.0, 2.0, 9.0), DVec3::new(12.0, 1.0, 7.0)];
        let view = View::new(&Camera::framing(&points, DVec3::Z, DVec3::Y), 400, 400);
        let left = view.project(points[0]);
        let right = view.project(points[1]);
        assert!((right.x - left.x - 400.0 / 1.08).abs() < 1e-9);
        assert!((left.y - right.y - 200.0 / 1.08).abs() < 1e-9, "half as high as wide, and up is up");
        assert!(left.z > right.z, "what is nearer to the viewer has less depth");
        let centre = view.project(points[2]);
        assert!((centre - DVec3::new(200.0, 200.0, centre.z)).length() < 1e-9);
    }

    #[test]
    fn every_input_gives_a_finite_view() {
        let bad = [f64::NAN, f64::INFINITY, 1e308, 0.0, -1e308, 1e-310];
        for a in bad {
            for b in bad {
                let points = [DVec3::new(a, b, a), DVec3::new(b, a, 0.0)];
                let camera = Camera::framing(&points, DVec3::new(b, a, b), DVec3::new(a, a, b)).widened(a);
                let view = View::new(&camera, 10, 10);
                assert!(view.project(camera.centre).is_finite(), "{a} {b} {camera:?}");
            }
        }
    }
}
