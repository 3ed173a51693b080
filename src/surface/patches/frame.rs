//! Squares with axes, in the parameters of a region.

use glam::DVec2;

/// A square: its origin and its two sides from there, counter-clockwise.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct Frame {
    pub(super) origin: DVec2,
    pub(super) x: DVec2,
    pub(super) y: DVec2,
}

impl Frame {
    /// The square of side 1 whose lower left corner is (i, j).
    pub(super) fn unit(i: usize, j: usize) -> Self {
        Self { origin: DVec2::new(i as f64, j as f64), x: DVec2::X, y: DVec2::Y }
    }

    /// The same square seen from its corner `turns`.
    pub(super) fn turned(self, turns: usize) -> Self {
        let Self { origin, x, y } = self;
        match turns % 4 {
            0 => self,
            1 => Self { origin: origin + x, x: y, y: -x },
            2 => Self { origin: origin + x + y, x: -x, y: -y },
            _ => Self { origin: origin + y, x: -y, y: x },
        }
    }

    /// The square with the same origin and sides `factor` times as long.
    pub(super) fn scaled(self, factor: f64) -> Self {
        Self { origin: self.origin, x: self.x * factor, y: self.y * factor }
    }

    /// Quarter `corner`, whose origin is that corner, as [`to_quarter`](crate::subdivision::patch::to_quarter) has it.
    pub(super) fn quarter(self, corner: usize) -> Self {
        self.turned(corner).scaled(0.5)
    }

    /// The square of which this one is quarter `corner`.
    pub(super) fn whole(self, corner: usize) -> Self {
        self.scaled(2.0).turned(4 - corner % 4)
    }

    /// A point of the region in the axes of the square, whose sides are 1 there.
    pub(super) fn local(&self, point: DVec2) -> DVec2 {
        let offset = point - self.origin;
        DVec2::new(offset.dot(self.x) / self.x.length_squared(), offset.dot(self.y) / self.y.length_squared())
    }

    /// [`local`](Self::local) for each of three pairs.
    pub(super) fn local_each(&self, u: [f64; 3], v: [f64; 3]) -> [[f64; 3]; 2] {
        let points: [DVec2; 3] = std::array::from_fn(|k| self.local(DVec2::new(u[k], v[k])));
        [points.map(|p| p.x), points.map(|p| p.y)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::subdivision::patch::to_quarter;

    #[test]
    fn quarters_are_those_of_patches() {
        for point in [DVec2::new(0.2, 0.3), DVec2::new(0.7, 0.1), DVec2::new(0.9, 0.8), DVec2::new(0.4, 0.6)]
        {
            let (quarter, x, y) = to_quarter(point.x, point.y);
            let frame = Frame::unit(0, 0).quarter(quarter);
            assert!(frame.local(point).distance(DVec2::new(x, y)) < 1e-15);
            assert_eq!(frame.whole(quarter), Frame::unit(0, 0));
        }
    }
}
