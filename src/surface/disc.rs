//! Discs of some thickness round parts of the surface, however they lie: far tighter than boxes along the axes, which
//! are as thick as they are wide where the surface runs across the axes.

use glam::DVec3;

/// All points within `half` of the plane through `centre` across `normal`, and within `radius` of its axis. Where
/// `normal` is zero, a ball. See the [module](self).
#[derive(Clone, Copy, Debug)]
pub(super) struct Disc {
    centre: DVec3,
    /// Of length 1, or zero.
    normal: DVec3,
    radius: f64,
    half: f64,
}

impl Disc {
    /// The disc across `normal`, of any length, round `points`.
    pub(super) fn around(points: impl Iterator<Item = DVec3> + Clone, normal: DVec3) -> Self {
        let normal = normal.normalize_or_zero();
        let (sum, count) = points.clone().fold((DVec3::ZERO, 0.0), |(sum, count), p| (sum + p, count + 1.0));
        let centre = sum / f64::max(count, 1.0);
        let mut disc = Self { centre, normal, radius: 0.0, half: 0.0 };
        let (mut low, mut high) = (0.0f64, 0.0f64);
        for p in points {
            let (height, aside) = disc.split(p);
            disc.radius = disc.radius.max(aside.length());
            (low, high) = (low.min(height), high.max(height));
        }
        disc.level(low, high)
    }

    /// The disc round two.
    pub(super) fn join(&self, other: &Self) -> Self {
        let side = if self.normal.dot(other.normal) < 0.0 { -1.0 } else { 1.0 };
        let sum =
            self.normal * (self.radius * self.radius) + other.normal * (side * other.radius * other.radius);
        let mut disc = Self { normal: sum.normalize_or_zero(), ..*self };
        let extents = |part: &Self| {
            let (along, across) =
                (part.normal.dot(disc.normal).abs(), part.normal.cross(disc.normal).length());
            if part.normal == DVec3::ZERO {
                (part.radius, part.radius)
            } else {
                (part.half * along + part.radius * across, part.radius + part.half * across)
            }
        };
        let ((half, radius), (other_half, other_radius)) = (extents(self), extents(other));
        let (height, aside) = disc.split(other.centre);
        let apart = aside.length();
        disc.radius = radius.max(other_radius);
        if apart + radius.min(other_radius) > disc.radius {
            disc.radius = 0.5 * (apart + radius + other_radius);
            disc.centre += aside * ((disc.radius - radius) / apart);
        } else if other_radius > radius {
            disc.centre += aside;
        }
        disc.level((-half).min(height - other_half), half.max(height + other_half))
    }

    /// The height of a point over the plane, and the way to it from the axis.
    fn split(&self, point: DVec3) -> (f64, DVec3) {
        let way = point - self.centre;
        let height = way.dot(self.normal);
        (height, way - self.normal * height)
    }

    /// The same, from height `low` to `high`.
    fn level(self, low: f64, high: f64) -> Self {
        Self { centre: self.centre + self.normal * (0.5 * (low + high)), half: 0.5 * (high - low), ..self }
    }

    /// The distance of `point` to the disc.
    pub(super) fn distance(&self, point: DVec3) -> f64 {
        let (height, aside) = self.split(point);
        let (over, beside) = ((height.abs() - self.half).max(0.0), (aside.length() - self.radius).max(0.0));
        (over * over + beside * beside).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Points on a grid of a paraboloid that is not along the axes.
    fn points(from: i32) -> impl Iterator<Item = DVec3> + Clone {
        let turned = glam::DMat3::from_axis_angle(DVec3::new(1.0, 2.0, 3.0).normalize(), 0.7);
        (0..25).map(move |k| {
            let (x, y) = (f64::from(from + k % 5) * 0.1, f64::from(k / 5) * 0.1);
            turned * DVec3::new(x, y, 0.2 * (x * x + y * y))
        })
    }

    #[test]
    fn distances_are_never_above_those_of_the_points() {
        let turned = glam::DMat3::from_axis_angle(DVec3::new(1.0, 2.0, 3.0).normalize(), 0.7);
        let normal = turned * DVec3::Z;
        let whole = DVec3::ZERO;
        for normals in
            [[normal, -normal], [whole, normal], [normal, whole], [whole, whole], [DVec3::X, normal]]
        {
            let (a, b) = (Disc::around(points(0), normals[0]), Disc::around(points(5), normals[1]));
            let both = a.join(&b);
            for k in 0..1000 {
                let axis = |factor: f64| (f64::from(k) * factor).sin();
                let q = DVec3::new(axis(12.9), axis(78.2), axis(37.7)) * 2.0;
                let least = |points: &mut dyn Iterator<Item = DVec3>| {
                    points.map(|p| p.distance(q)).fold(f64::INFINITY, f64::min)
                };
                let (to_a, to_b) = (least(&mut points(0)), least(&mut points(5)));
                assert!(a.distance(q) <= to_a + 1e-14 && b.distance(q) <= to_b + 1e-14);
                assert!(both.distance(q) <= to_a.min(to_b) + 1e-14);
                assert!(both.distance(q) <= a.distance(q).min(b.distance(q)) + 1e-14);
            }
        }
        // It is no thicker than the paraboloid is high, and a little for the tilt of the parts.
        let flat = Disc::around(points(0), normal).join(&Disc::around(points(5), normal));
        let above = turned * DVec3::new(0.5, 0.2, 1.2);
        assert!(flat.distance(above) > 1.0, "{}", flat.distance(above));
    }
}
