//! Curves that a feature follows, whatever the edges do.

use glam::DVec3;
use serde::Deserialize;

/// A curve on or near the surface: the centre line of a feature that does not follow the edges.
#[derive(Clone, PartialEq, Debug)]
pub struct Curve {
    /// Points it goes through, model units.
    pub points: Vec<DVec3>,
    /// Straight between the points, or a smooth spline through them.
    pub course: Course,
    /// Whether it goes on from the last point to the first.
    pub closed: bool,
    /// The kind of the marks it makes.
    pub kind: String,
}

/// How a curve runs between its points.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Course {
    /// Straight pieces.
    Polyline,
    /// A centripetal Catmull-Rom spline (Yuksel, Schaefer, Keyser 2011: no loops or cusps within a piece).
    Spline,
}

/// Points of a curve at most.
pub(super) const MOST_POINTS: usize = 100_000;

impl Curve {
    /// What is wrong with the points, if anything.
    pub(super) fn problem(&self) -> Option<String> {
        let least = if self.closed { 3 } else { 2 };
        if let Some(i) = self.points.iter().position(|p| !p.is_finite()) {
            return Some(format!("point {i} of the curve is not finite"));
        }
        if self.points.len() > MOST_POINTS {
            return Some(format!("the curve has more than {MOST_POINTS} points"));
        }
        let mut different = self.points.clone();
        different.dedup();
        if self.closed && different.len() > 1 && different.first() == different.last() {
            different.pop();
        }
        (different.len() < least).then(|| format!("the curve has less than {least} different points"))
    }

    /// Points along the curve, at most `step` apart where that needs no more than a million. A closed curve does not
    /// repeat its first point.
    pub fn sample(&self, step: f64) -> Vec<DVec3> {
        let mut points = self.points.clone();
        points.dedup();
        if self.closed && points.len() > 1 && points.first() == points.last() {
            points.pop();
        }
        let count = points.len();
        let pieces = if self.closed { count } else { count.saturating_sub(1) };
        let length: f64 = (0..pieces).map(|i| points[i].distance(points[(i + 1) % count])).sum();
        let step = step.max(length * 1e-6);
        let mut sampled = Vec::new();
        for i in 0..pieces {
            let (a, b) = (points[i], points[(i + 1) % count]);
            let neighbour = |offset: isize, beyond: DVec3| {
                let j = i as isize + offset;
                if self.closed {
                    points[j.rem_euclid(count as isize) as usize]
                } else {
                    usize::try_from(j).ok().and_then(|j| points.get(j)).copied().unwrap_or(beyond)
                }
            };
            // Open ends go on as they came.
            let (before, after) = (neighbour(-1, a + (a - b)), neighbour(2, b + (b - a)));
            let parts = (a.distance(b) / step).ceil().max(1.0) as usize;
            sampled.extend((0..parts).map(|k| {
                let t = k as f64 / parts as f64;
                match self.course {
                    Course::Polyline => a.lerp(b, t),
                    Course::Spline => centripetal([before, a, b, after], t),
                }
            }));
        }
        if !self.closed {
            sampled.extend(points.last());
        }
        sampled
    }
}

/// The centripetal Catmull-Rom spline between the inner two of four points, by Barry and Goldman's pyramid.
fn centripetal(p: [DVec3; 4], t: f64) -> DVec3 {
    let mut knots = [0.0; 4];
    for i in 1..4 {
        knots[i] = knots[i - 1] + p[i].distance(p[i - 1]).sqrt().max(1e-12);
    }
    let x = knots[1] + (knots[2] - knots[1]) * t;
    let mix = |a: DVec3, b: DVec3, i: usize, j: usize| {
        a * ((knots[j] - x) / (knots[j] - knots[i])) + b * ((x - knots[i]) / (knots[j] - knots[i]))
    };
    let [a, b, c] = [0, 1, 2].map(|i| mix(p[i], p[i + 1], i, i + 1));
    let (d, e) = (mix(a, b, 0, 2), mix(b, c, 1, 3));
    mix(d, e, 1, 2)
}

/// `X,Y,Z;X,Y,Z;...` with `;closed` at the end if wanted.
pub(super) fn parse(text: &str) -> Result<(Vec<DVec3>, bool), String> {
    let (text, closed) = match text.strip_suffix(";closed") {
        Some(text) => (text, true),
        None => (text, false),
    };
    let point = |part: &str| {
        let numbers: Vec<f64> = part.split(',').filter_map(|x| x.trim().parse().ok()).collect();
        match numbers.as_slice() {
            [x, y, z] if part.split(',').count() == 3 => Ok(DVec3::new(*x, *y, *z)),
            _ => Err(format!(
                "'{part}' is not a point; a curve is X,Y,Z;X,Y,Z;... with ;closed at the end if wanted"
            )),
        }
    };
    Ok((text.split(';').map(point).collect::<Result<_, _>>()?, closed))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn curve(course: Course, closed: bool) -> Curve {
        let points = vec![DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::Y];
        Curve { points, course, closed, kind: "red".into() }
    }

    #[test]
    fn samples_are_close_together_and_hold_the_points() {
        for course in [Course::Polyline, Course::Spline] {
            for closed in [false, true] {
                let curve = curve(course, closed);
                let sampled = curve.sample(0.1);
                for point in &curve.points {
                    assert!(
                        sampled.iter().any(|p| p.distance(*point) < 1e-12),
                        "{course:?} {closed} {point}"
                    );
                }
                assert!(sampled.windows(2).all(|w| w[0].distance(w[1]) < 0.15), "{course:?}");
                assert_eq!(sampled.len(), if closed { 40 } else { 31 });
            }
        }
    }

    /// Points of a circle: the spline between them stays near the circle.
    #[test]
    fn a_spline_through_a_circle_is_round() {
        let at = |k: usize, n: usize| {
            let angle = std::f64::consts::TAU * k as f64 / n as f64;
            DVec3::new(angle.cos(), angle.sin(), 0.0)
        };
        let points = (0..12).map(|k| at(k, 12)).collect();
        let curve = Curve { points, course: Course::Spline, closed: true, kind: "red".into() };
        let worst = curve.sample(0.01).iter().map(|p| (p.length() - 1.0).abs()).fold(0.0, f64::max);
        assert!(worst < 0.004, "{worst}");
    }

    #[test]
    fn what_is_wrong_is_said() {
        assert_eq!(parse("0,0,0;1,0,0"), Ok((vec![DVec3::ZERO, DVec3::X], false)));
        assert_eq!(parse("0,0,0;1,0,0;0,1,0;closed").map(|p| p.1), Ok(true));
        assert!(parse("0,0").is_err_and(|e| e.starts_with("'0,0' is not a point")));
        assert!(parse("0,0,x;1,0,0").is_err());
        let short = Curve { points: vec![DVec3::X; 5], ..curve(Course::Polyline, false) };
        assert_eq!(short.problem().as_deref(), Some("the curve has less than 2 different points"));
        assert_eq!(curve(Course::Spline, true).problem(), None);
    }
}
