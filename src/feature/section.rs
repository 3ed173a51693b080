//! The cross-section of a straight band: a uniform cubic B-spline in place and height, whatever the spacing of its
//! lines (docs/linear-features.md, section 1).

use super::profile::{Line, Profile};

/// Samples per span in the search for crests and flanks.
const SAMPLES: usize = 32;
/// Waves lower than this fraction of the greatest height are no part of the feature.
const FAINT: f64 = 0.1;

/// Weight of the control point at distance `x`, in spans.
fn weight(x: f64) -> f64 {
    let x = x.abs();
    if x <= 1.0 { 2.0 / 3.0 - x * x + x * x * x / 2.0 } else { (2.0 - x).max(0.0).powi(3) / 6.0 }
}

/// Control heights and width of a straight band.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct Section {
    pub(super) lines: Vec<Line>,
    /// Control height per line, in model units.
    pub(super) control: Vec<f64>,
    /// The width is `per_half_width` times the half width of the control band, plus `per_gap` times the gaps between the
    /// rims and the ends of the edge.
    per_half_width: f64,
    per_gap: [f64; 2],
}

impl Section {
    /// The section for these values of the profile's parameters, model units.
    pub(super) fn new(profile: &Profile, values: &[f64]) -> Self {
        let lines = profile.lines_for(values);
        let inside = profile.inside.map_or(0.0, |height| height.of(values));
        let mut section = Self {
            control: control_heights(&lines, inside, values),
            lines,
            per_half_width: 0.0,
            per_gap: [0.0; 2],
        };
        if profile.width().is_some() {
            // The width does not depend on the scale of the heights: a flat band is as wide as a low one.
            let shape = match section.control.iter().any(|h| *h != 0.0) {
                true => section.control.clone(),
                false => control_heights(
                    &section.lines,
                    profile.inside.map_or(0.0, |h| h.times),
                    &vec![1.0; profile.parameters.len()],
                ),
            };
            let beyond = if profile.inside.is_some() { shape.first().copied().unwrap_or(0.0) } else { 0.0 };
            let count = section.lines.len() as f64;
            let height = |u: f64| {
                let inner: f64 = shape.iter().zip(1..).map(|(h, i)| h * weight(u - f64::from(i))).sum();
                inner + beyond * weight(u)
            };
            if let Some([low, high]) = flanks(height, [1.0, count], profile.inside.is_some()) {
                section.measure_between(low, high);
            }
        }
        section
    }

    /// Least distance between lines, in half widths.
    pub(super) fn least_gap(&self) -> f64 {
        self.lines.windows(2).map(|pair| pair[1].across - pair[0].across).fold(1.0, f64::min)
    }

    /// Sets the width to the distance between two parameters of the section.
    fn measure_between(&mut self, low: f64, high: f64) {
        let last = self.lines.len() as f64 + 1.0;
        // Weights of the control points at `u`: on the half width and on the two gaps.
        let place = |u: f64| {
            let [first_rim, last_rim] =
                [self.lines.first(), self.lines.last()].map(|line| line.map_or(0.0, |line| line.across));
            let lines: f64 =
                self.lines.iter().zip(1..).map(|(line, i)| line.across * weight(u - f64::from(i))).sum();
            let (before, after) = (weight(u), weight(u - last));
            [lines + first_rim * before + last_rim * after, -before, after]
        };
        let [low, high] = [place(low), place(high)];
        self.per_half_width = high[0] - low[0];
        self.per_gap = [high[1] - low[1], high[2] - low[2]];
    }

    /// Full width on the limit surface of a control band of this half width that crosses an edge `length` long at the
    /// fraction `t`; lengths along the edge.
    pub(super) fn full_width(&self, half_width: f64, length: f64, t: f64) -> f64 {
        self.per_half_width * half_width
            + self.per_gap[0] * (t * length - half_width)
            + self.per_gap[1] * ((1.0 - t) * length - half_width)
    }

    /// The inverse of [`Section::full_width`].
    pub(super) fn half_width(&self, width: f64, length: f64, t: f64) -> f64 {
        let gaps = self.per_gap[0] * t * length + self.per_gap[1] * (1.0 - t) * length;
        (width - gaps) / (self.per_half_width - self.per_gap[0] - self.per_gap[1])
    }
}

/// Control heights whose limit has the asked height at every line that has one: (a + 4 h + b) / 6 there.
fn control_heights(lines: &[Line], inside: f64, values: &[f64]) -> Vec<f64> {
    let mut control = vec![0.0; lines.len()];
    // Neighbours weigh half as much as the diagonal: 60 sweeps reach the last bit.
    for _ in 0..60 {
        for i in 0..lines.len() {
            let Some(height) = lines[i].height else { continue };
            let before = if i == 0 { inside } else { control[i - 1] };
            let after = control.get(i + 1).copied().unwrap_or(0.0);
            control[i] = (6.0 * height.of(values) - before - after) / 4.0;
        }
    }
    control
}

/// Where the width of a section is taken, as parameters in `range`: at half of the outermost crests; with a plateau on
/// the low side, at three quarters and at a quarter of its height. `None` where the section has no height.
pub(super) fn flanks(height: impl Fn(f64) -> f64, range: [f64; 2], plateau: bool) -> Option<[f64; 2]> {
    let [low, high] = range;
    let count = ((high - low).ceil().max(1.0) as usize) * SAMPLES;
    let at = |i: usize| low + (high - low) * i as f64 / count as f64;
    let heights: Vec<f64> = (0..=count).map(|i| height(at(i)).abs()).collect();
    let top = heights.iter().copied().fold(0.0, f64::max);
    if !(top > 0.0 && top.is_finite()) {
        return None;
    }
    // The parameter between `inside` and `outside` where the height passes `level`.
    let crossing = |mut inside: f64, mut outside: f64, level: f64| {
        for _ in 0..60 {
            let middle = (inside + outside) / 2.0;
            if height(middle).abs() > level { inside = middle } else { outside = middle }
        }
        inside
    };
    if plateau {
        let level = height(low).abs();
        return Some([crossing(low, high, 0.75 * level), crossing(low, high, 0.25 * level)]);
    }
    let crest = |order: &mut dyn Iterator<Item = usize>| {
        let mut best = None;
        for i in order {
            match best {
                Some(b) if heights[i] < heights[b] && heights[b] > FAINT * top => break,
                Some(b) if heights[i] <= heights[b] => {}
                _ => best = Some(i),
            }
        }
        best
    };
    let first = crest(&mut (0..=count))?;
    let last = crest(&mut (0..=count).rev())?;
    Some([crossing(at(first), low, heights[first] / 2.0), crossing(at(last), high, heights[last] / 2.0)])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn section(name: &str, values: &[f64]) -> Section {
        Section::new(&Profile::named(name).expect("ships"), values)
    }

    /// JUNCTIONS study, section 5: W = 1.3191 w + 0.1257 g; depth 2h/3.
    #[test]
    fn a_groove_has_the_closed_form() {
        let groove = section("groove", &[0.3, 0.1]);
        assert!((groove.control[1] + 0.15).abs() < 1e-12, "{:?}", groove.control);
        for (w, g) in [(0.15, 0.35), (0.08, 0.42)] {
            let width = groove.full_width(w, 2.0 * (w + g), 0.5);
            assert!((width - 1.3191 * w - 0.1257 * g).abs() < 1e-4, "{width}");
            assert!((groove.half_width(width, 2.0 * (w + g), 0.5) - w).abs() < 1e-12);
        }
    }

    /// The same study: piping with D = H has the control heights (.577, -2.308, 2.654, -2.308, .577) D when its rims
    /// lie at the base in the limit; with rims whose control points stay, T h = (-D, H, -D) in the inner lines.
    #[test]
    fn piping_reaches_its_heights_at_the_lines() {
        let piping = section("piping", &[0.5, 0.05, 0.05]);
        let c = &piping.control;
        for (i, limit) in [(1, -0.05), (2, 0.05), (3, -0.05)] {
            assert!(((c[i - 1] + 4.0 * c[i] + c[i + 1]) / 6.0 - limit).abs() < 1e-12);
        }
        assert_eq!((c[0], c[4]), (0.0, 0.0));
    }

    #[test]
    fn a_dent_has_a_flat_floor() {
        let dent = section("dent", &[0.3, 0.1]);
        assert!(
            (dent.control[0] + 0.1).abs() < 1e-6 && (dent.control[1] + 0.1).abs() < 1e-6,
            "{:?}",
            dent.control
        );
        // Heights 1, 1, 1, 0, 0 over equal spans: from a quarter to three quarters.
        let height = |u: f64| [-1.0, 0.0, 1.0, 2.0].iter().map(|i| weight(u - i)).sum::<f64>();
        let (mut inner, mut outer) = (f64::NAN, f64::NAN);
        for i in 0..=200_000 {
            let u = 1.0 + 2.0 * f64::from(i) / 200_000.0;
            if height(u) >= 0.75 {
                inner = u
            }
            if height(u) >= 0.25 {
                outer = u
            }
        }
        let width = dent.full_width(1.0, 4.0, 0.5);
        assert!((width - (outer - inner)).abs() < 1e-4, "{width} {}", outer - inner);
    }

    #[test]
    fn a_flat_band_is_as_wide_as_a_low_one() {
        for name in ["groove", "piping", "bead", "step", "dent"] {
            let profile = Profile::named(name).expect("ships");
            let flat = Section::new(&profile, &vec![0.0; profile.parameters.len()]);
            let low = Section::new(&profile, &vec![1e-3; profile.parameters.len()]);
            assert!((flat.full_width(0.1, 1.0, 0.5) - low.full_width(0.1, 1.0, 0.5)).abs() < 1e-9, "{name}");
            assert!(low.full_width(0.1, 1.0, 0.5) > 0.05, "{name}");
        }
    }
}
