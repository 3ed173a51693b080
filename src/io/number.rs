//! Numbers as text.

use std::fmt;

/// The shortest decimal text that reads back as the same number; with an exponent where that is far shorter.
pub(super) fn shortest(value: f64) -> Shortest {
    Shortest(value)
}

pub(super) struct Shortest(f64);

impl fmt::Display for Shortest {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let size = self.0.abs();
        if size != 0.0 && !(1e-5..1e16).contains(&size) {
            write!(f, "{:e}", self.0)
        } else {
            write!(f, "{}", self.0)
        }
    }
}
