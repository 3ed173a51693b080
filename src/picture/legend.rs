//! Legends: the bar of a colour map with ticks at round numbers, and the swatches of a cage.

use super::colour::{DivergingMap, to_srgb};
use super::image::Image;
use super::text::Type;

/// Ticks on each side of zero.
const MOST_TICKS: f64 = 4.0;
/// Bounds that read well, between 1 and 10.
const ROUND: [f64; 10] = [1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0];
/// Outside of these, numbers on the bar are written without a common power of ten, which the label names.
const PLAIN_NUMBERS: std::ops::Range<f64> = 1e-3..1e5;
/// Ranges that can be drawn; beyond them powers of ten leave the numbers of a computer.
pub(super) const DRAWABLE_RANGES: std::ops::Range<f64> = 1e-290..1e290;

/// The smallest round number that is no less than `value`; 1 for zero and for what cannot be drawn.
pub(super) fn round_up(value: f64) -> f64 {
    if !DRAWABLE_RANGES.contains(&value) {
        return 1.0;
    }
    let power = 10f64.powi(value.log10().floor() as i32);
    ROUND.into_iter().map(|round| round * power).find(|&round| round >= value).unwrap_or(10.0 * power)
}

/// Ticks at `-count * step ..= count * step`.
#[derive(Clone, Copy, PartialEq, Debug)]
struct Ticks {
    /// 1, 2 or 5.
    mantissa: i32,
    /// The step is `mantissa * 10^exponent`.
    exponent: i32,
    count: i32,
}

impl Ticks {
    /// Ticks for a bar from `-range` to `range`.
    fn new(range: f64) -> Self {
        let start = range.log10().floor() as i32 - 1;
        let steps = (start..).flat_map(|exponent| [1, 2, 5].map(|mantissa| (mantissa, exponent)));
        // Numbers such as 0.3 / 0.1 fall short of 3 by a rounding error.
        let count = |mantissa, exponent| range / (f64::from(mantissa) * 10f64.powi(exponent)) + 1e-9;
        let fitting =
            steps.take(9).find(|&(mantissa, exponent)| count(mantissa, exponent) < MOST_TICKS + 1.0);
        let (mantissa, exponent) = fitting.unwrap_or((1, start + 1));
        Self { mantissa, exponent, count: count(mantissa, exponent) as i32 }
    }

    /// The number at tick `i`, divided by `10^power`.
    fn text(&self, i: i32, power: i32) -> String {
        let exponent = self.exponent - power;
        let decimals = usize::try_from(-exponent).unwrap_or(0);
        let value = f64::from(i * self.mantissa) * 10f64.powi(exponent);
        if i == 0 { "0".to_owned() } else { format!("{value:+.decimals$}") }
    }

    fn step(&self) -> f64 {
        f64::from(self.mantissa) * 10f64.powi(self.exponent)
    }
}

/// Draws the bar of the diverging map over [-`range`, `range`], centred on `x`, with numbers and `label` beneath.
pub(super) fn bar(image: &mut Image, range: f64, label: &str, x: f64, y: f64, width: f64, text: Type) {
    let map = DivergingMap::new();
    let height = (text.height * 0.7).round() as i64;
    let (left, top) = ((x - width / 2.0).round() as i64, y.round() as i64);
    let columns = width.round() as i64;
    image.fill(left - 1, top - 1, columns + 2, height + 2, text.colour);
    for column in 0..columns {
        let t = (2.0 * (column as f64 + 0.5) / width - 1.0) as f32;
        image.fill(left + column, top, 1, height, to_srgb(map.colour(t)));
    }

    let ticks = Ticks::new(range);
    let power = if PLAIN_NUMBERS.contains(&range) { 0 } else { (range.log10() / 3.0).floor() as i32 * 3 };
    let spacing = width / 2.0 * ticks.step() / range;
    let widest = text.width(&ticks.text(-ticks.count, power)).max(text.width(&ticks.text(-1, power)));
    let stride = (1..=ticks.count)
        .find(|&n| f64::from(n) * spacing >= widest + text.height * 0.6)
        .unwrap_or(ticks.count);
    for i in -ticks.count..=ticks.count {
        let at = x + f64::from(i) * spacing;
        let length = (text.height * 0.25).round() as i64;
        image.fill(at.round() as i64, top + height + 1, 1, length, text.colour);
        if i % stride.max(1) == 0 {
            text.draw_centred(image, &ticks.text(i, power), at, y + height as f64 + text.height * 0.3);
        }
    }
    let label = if power == 0 { label.to_owned() } else { format!("{label} x 1e{power}") };
    for line in text.wrapped(&label, width * 1.25, 1) {
        text.draw_centred(image, &line, x, y + height as f64 + text.height * 1.35);
    }
}

/// What stands before an entry of a list of swatches.
#[derive(Clone, Copy)]
pub(super) enum Swatch {
    /// A line of this width in pixels.
    Line(f64),
    /// A disc of this diameter in pixels.
    Disc(f64),
}

/// Draws a row of swatches with names, centred on `x`; a second row where they need more than `width`.
pub(super) fn swatches(
    image: &mut Image,
    entries: &[(Swatch, [u8; 3], &str)],
    x: f64,
    y: f64,
    width: f64,
    text: Type,
) {
    let sample = text.height * 1.1;
    let gap = text.height * 0.9;
    let size = |name: &str| sample + text.height * 0.4 + text.width(name);
    let total =
        |row: &[(Swatch, [u8; 3], &str)]| row.iter().map(|entry| size(entry.2) + gap).sum::<f64>() - gap;
    let fitting = (1..=entries.len()).rev().find(|&n| total(&entries[..n]) <= width).unwrap_or(1);
    for (row, entries) in entries.chunks(fitting).enumerate() {
        let mut left = x - total(entries) / 2.0;
        let top = y + row as f64 * text.height * 1.2;
        for &(swatch, colour, name) in entries {
            let middle = top + text.height / 2.0;
            match swatch {
                Swatch::Line(thickness) => {
                    let y = (middle - thickness / 2.0).round() as i64;
                    image.fill(left as i64, y, sample as i64, thickness.round() as i64, colour);
                }
                Swatch::Disc(diameter) => disc(image, left + sample / 2.0, middle, diameter / 2.0, colour),
            }
            text.draw(image, name, left + sample + text.height * 0.4, top);
            left += size(name) + gap;
        }
    }
}

fn disc(image: &mut Image, x: f64, y: f64, radius: f64, colour: [u8; 3]) {
    for row in (y - radius).floor() as i64 - 1..=(y + radius).ceil() as i64 {
        for column in (x - radius).floor() as i64 - 1..=(x + radius).ceil() as i64 {
            let distance = (column as f64 + 0.5 - x).hypot(row as f64 + 0.5 - y);
            let coverage = (radius + 0.5 - distance).clamp(0.0, 1.0);
            image.blend(column, row, colour, (coverage * 255.0).round() as u8);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_stand_at_round_numbers() {
        let cases: [(f64, &[&str]); 5] = [
            (1.0, &["-1.0", "-0.5", "0", "+0.5", "+1.0"]),
            (0.3, &["-0.3", "-0.2", "-0.1", "0", "+0.1", "+0.2", "+0.3"]),
            (45.0, &["-40", "-30", "-20", "-10", "0", "+10", "+20", "+30", "+40"]),
            (0.0025, &["-0.002", "-0.001", "0", "+0.001", "+0.002"]),
            (8.0, &["-8", "-6", "-4", "-2", "0", "+2", "+4", "+6", "+8"]),
        ];
        for (range, expected) in cases {
            let ticks = Ticks::new(range);
            let texts: Vec<String> = (-ticks.count..=ticks.count).map(|i| ticks.text(i, 0)).collect();
            assert_eq!(texts, expected, "{range}");
        }
        assert_eq!(Ticks::new(2e-7).text(1, -9), "+50");
    }

    #[test]
    fn ticks_are_few_and_inside_for_every_range() {
        let mut range = 1e-289;
        while range < 1e289 {
            let ticks = Ticks::new(range);
            assert!((2..=4).contains(&ticks.count), "{range:e} {ticks:?}");
            assert!(f64::from(ticks.count) * ticks.step() <= range * (1.0 + 1e-8), "{range:e}");
            range *= 1.37;
        }
    }

    #[test]
    fn bounds_are_rounded_up() {
        for (value, bound) in
            [(0.0, 1.0), (0.0213, 0.025), (7.0, 8.0), (9.9, 10.0), (1.0, 1.0), (f64::NAN, 1.0)]
        {
            assert!((round_up(value) - bound).abs() < 1e-12, "{value}");
        }
    }
}
