//! Lengths as users give them: in model units, or relative to the local edge.

use serde::{Serialize, Serializer};
use std::fmt;
use std::str::FromStr;

/// A width, depth or height.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Length {
    /// In model units. Text that names one gives at most 1e50 either way.
    Units(f64),
    /// As a fraction of the length of the crossed edge (`30%` is 0.3); for a width, of the edge's extent across the
    /// feature, which is its length where it is crossed at a right angle.
    OfEdge(f64),
}

impl Length {
    /// The length in model units on an edge of length `edge`.
    pub fn on_edge(self, edge: f64) -> f64 {
        match self {
            Self::Units(x) => x,
            Self::OfEdge(fraction) => fraction * edge,
        }
    }

    /// The number itself, whatever it counts in.
    pub fn value(self) -> f64 {
        match self {
            Self::Units(x) | Self::OfEdge(x) => x,
        }
    }
}

/// Longer lengths are refused: their squares and products would overflow in what is measured afterwards.
const MOST: f64 = 1e50;

impl FromStr for Length {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let text = text.trim();
        let (number, percent) = match text.strip_suffix('%') {
            Some(number) => (number, true),
            None => (text, false),
        };
        let x: f64 = number
            .trim()
            .parse()
            .ok()
            .filter(|x: &f64| x.is_finite())
            .ok_or_else(|| format!("'{text}' is not a length; give a number in model units, or a percentage of the local edge such as 30%"))?;
        if x.abs() > MOST {
            return Err(format!("'{text}' is out of range; lengths are at most {MOST:e}"));
        }
        Ok(if percent { Self::OfEdge(x / 100.0) } else { Self::Units(x) })
    }
}

impl fmt::Display for Length {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Units(x) => write!(f, "{x}"),
            Self::OfEdge(x) => write!(f, "{}%", x * 100.0),
        }
    }
}

/// Four significant digits, at any scale.
pub fn significant(x: f64) -> String {
    const DIGITS: i32 = 4;
    if x == 0.0 || !x.is_finite() {
        return x.to_string();
    }
    let magnitude = x.abs().log10().floor() as i32;
    if (-4..=6).contains(&magnitude) {
        let decimals = (DIGITS - 1 - magnitude).max(0) as usize;
        format!("{x:.decimals$}")
    } else {
        format!("{x:.3e}")
    }
}

/// A number for model units, a text such as "30%" for a share of the edge.
impl Serialize for Length {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Units(x) => serializer.serialize_f64(*x),
            Self::OfEdge(_) => serializer.serialize_str(&self.to_string()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_as_text() {
        assert_eq!("30%".parse(), Ok(Length::OfEdge(0.3)));
        assert_eq!(" 0.25 ".parse(), Ok(Length::Units(0.25)));
        for bad in ["", "%", "inf", "nan", "1,5"] {
            assert!(bad.parse::<Length>().is_err_and(|e| e.contains("is not a length")), "{bad}");
        }
        assert_eq!(Length::OfEdge(0.3).to_string(), "30%");
    }

    #[test]
    fn four_significant_digits_at_any_scale() {
        let cases = [
            (0.0, "0"),
            (1.6, "1.600"),
            (0.012_345_6, "0.01235"),
            (123_456.0, "123456"),
            (1e300, "1.000e300"),
        ];
        for (x, text) in cases {
            assert_eq!(significant(x), text);
        }
        assert_eq!(significant(-3.2e-9), "-3.200e-9");
    }
}
