//! Lines and discs on the canvas: smooth edges, even width, hidden where a surface lies before them.

use super::canvas::{Canvas, is_drawable};
use super::colour::Light;
use glam::{DVec2, DVec3};

/// How far behind a surface, in samples, a point of a line may lie and still show. It absorbs the snapping of corners.
const SLACK: f64 = 3.0;
/// Parts that show over fewer samples of a longer line are left out: they are the ends of hidden lines, within the slack of
/// a vertex that is seen.
const SHORTEST_RUN: usize = 6;
/// Discs are seen as flat marks above the surface, so they need more than lines.
const DISC_SLACK: f64 = 6.0;

/// A colour and a width.
#[derive(Clone, Copy)]
pub(super) struct Pen {
    pub(super) colour: Light,
    /// Half the width, in samples.
    pub(super) half_width: f64,
}

impl Canvas {
    /// Draws the parts of the segment from `a` to `b` that show. Whether a part shows is asked along its centre only, which
    /// keeps the width even where neighbouring faces are steep.
    pub(super) fn line(&mut self, a: DVec3, b: DVec3, pen: Pen) {
        if !is_drawable(a) || !is_drawable(b) {
            return;
        }
        let Some((start, end)) = self.clip(a, b, pen.half_width) else { return };
        let (a, b) = (a.lerp(b, start), a.lerp(b, end));
        let steps = (b - a).truncate().length().ceil().max(1.0) as usize;
        let at = |i: usize| a.lerp(b, i as f64 / steps as f64);
        let shortest = SHORTEST_RUN.min(steps);
        let mut from = 0;
        for i in 0..=steps + 1 {
            if i <= steps && self.shows(at(i), SLACK) {
                continue;
            }
            if i > from + shortest {
                self.capsule(at(from).truncate(), at(i - 1).truncate(), pen);
            }
            from = i + 1;
        }
    }

    /// Draws a disc around `at` if its centre shows.
    pub(super) fn disc(&mut self, at: DVec3, pen: Pen) {
        if is_drawable(at) && self.shows(at, DISC_SLACK) {
            self.capsule(at.truncate(), at.truncate(), pen);
        }
    }

    /// The range of parameters in [0, 1] for which the segment lies within `margin` of the canvas (Liang and Barsky 1984).
    fn clip(&self, a: DVec3, b: DVec3, margin: f64) -> Option<(f64, f64)> {
        let (mut start, mut end) = (0.0f64, 1.0f64);
        for (from, to, size) in [(a.x, b.x, self.width()), (a.y, b.y, self.height())] {
            for (distance, change) in [(from + margin, to - from), (size as f64 + margin - from, from - to)] {
                if change == 0.0 {
                    if distance < 0.0 {
                        return None;
                    }
                } else if change > 0.0 {
                    start = start.max(-distance / change);
                } else {
                    end = end.min(-distance / change);
                }
            }
        }
        (start <= end).then_some((start, end))
    }

    /// Paints all points within the pen's half width of the segment, fading over one sample at the rim.
    fn capsule(&mut self, a: DVec2, b: DVec2, pen: Pen) {
        let along = b - a;
        let squared = along.length_squared();
        let reach = pen.half_width + 1.0;
        let span = |low: f64, high: f64, bound: usize| {
            // Casts of negative numbers give 0.
            (low - reach).floor() as usize..((high + reach).ceil() as usize).min(bound)
        };
        let rows = span(a.y.min(b.y), a.y.max(b.y), self.height());
        let all = span(a.x.min(b.x), a.x.max(b.x), self.width());
        for y in rows {
            let centre = y as f64 + 0.5;
            let mut columns = all.clone();
            // The round ends, too, lie in the strip around the infinite line.
            if along.y.abs() > 1e-9 {
                let middle = a.x + (centre - a.y) * along.x / along.y;
                let half = reach * squared.sqrt() / along.y.abs();
                let near = span(middle - half, middle + half, self.width());
                columns = columns.start.max(near.start)..columns.end.min(near.end);
            }
            self.blend_row(y, columns, pen.colour, |x| {
                let p = DVec2::new(x, centre) - a;
                let t = if squared > 0.0 { (p.dot(along) / squared).clamp(0.0, 1.0) } else { 0.0 };
                (pen.half_width + 0.5 - p.distance(along * t)).clamp(0.0, 1.0)
            });
        }
    }
}
