//! Text files as bytes: lines, tokens and numbers, with the place of each.

use super::error::ImportError;
use crate::memory::OutOfMemory;

/// Reads tokens from a text file held in memory. Lines end with LF, CRLF or CR; a backslash before the end of a line
/// joins the next one to it; `#` at the start of a token begins a comment.
pub(super) struct Cursor<'a> {
    bytes: &'a [u8],
    at: usize,
    line: u32,
    line_start: usize,
}

/// A place in a text file, both numbers 1-based; the column counts bytes.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Place {
    pub(super) line: u32,
    pub(super) column: u32,
}

/// What is wrong at a place, and what to do about it.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) struct Fault {
    pub(super) place: Place,
    pub(super) message: String,
    pub(super) remedy: &'static str,
    /// Nothing is wrong but this.
    pub(super) memory: Option<OutOfMemory>,
}

impl From<OutOfMemory> for Box<Fault> {
    fn from(error: OutOfMemory) -> Self {
        let place = Place { line: 0, column: 0 };
        Self::new(Fault { place, message: String::new(), remedy: "", memory: Some(error) })
    }
}

impl Fault {
    /// The error of the file called `file`.
    pub(super) fn into_error(self, file: &str) -> ImportError {
        if let Some(source) = self.memory {
            return ImportError::Memory { file: file.into(), source };
        }
        let Place { line, column } = self.place;
        ImportError::Text { file: file.into(), line, column, message: self.message, remedy: self.remedy }
    }
}

impl<'a> Cursor<'a> {
    /// Starts at the first byte, or after a byte order mark.
    pub(super) fn new(bytes: &'a [u8]) -> Self {
        let at = if bytes.starts_with(b"\xEF\xBB\xBF") { 3 } else { 0 };
        Self { bytes, at, line: 1, line_start: at }
    }

    /// Where the next byte stands.
    #[inline]
    pub(super) fn place(&self) -> Place {
        let column = u32::try_from(self.at - self.line_start).unwrap_or(u32::MAX - 1) + 1;
        Place { line: self.line, column }
    }

    /// Offset of the next byte.
    pub(super) fn offset(&self) -> usize {
        self.at
    }

    #[inline]
    pub(super) fn peek(&self) -> Option<u8> {
        self.bytes.get(self.at).copied()
    }

    #[inline]
    pub(super) fn advance(&mut self) {
        self.at += 1;
    }

    /// The bytes from `offset` up to here.
    pub(super) fn since(&self, offset: usize) -> &'a [u8] {
        self.bytes.get(offset..self.at).unwrap_or_default()
    }

    /// Number of bytes left.
    pub(super) fn remaining(&self) -> usize {
        self.rest().len()
    }

    #[inline]
    fn rest(&self) -> &'a [u8] {
        self.bytes.get(self.at..).unwrap_or_default()
    }

    /// Length of the line end at the next byte, 0 when there is none.
    #[inline]
    fn line_end_at(&self, at: usize) -> usize {
        match self.bytes.get(at) {
            Some(b'\n') => 1,
            Some(b'\r') if self.bytes.get(at + 1) == Some(&b'\n') => 2,
            Some(b'\r') => 1,
            _ => 0,
        }
    }

    fn new_line(&mut self, at: usize) {
        self.at = at;
        self.line = self.line.saturating_add(1);
        self.line_start = at;
    }

    /// Skips blanks and joined line ends; true when a token follows on the (joined) line.
    #[inline]
    pub(super) fn next_token_on_line(&mut self) -> bool {
        loop {
            match self.peek() {
                Some(b' ' | b'\t' | 0x0B | 0x0C) => self.at += 1,
                Some(b'\\') => match self.line_end_at(self.at + 1) {
                    0 => return true,
                    length => self.new_line(self.at + 1 + length),
                },
                Some(b'\n' | b'\r' | b'#') | None => return false,
                Some(_) => return true,
            }
        }
    }

    /// Goes to the start of the next line; false at the end of the file.
    pub(super) fn next_line(&mut self) -> bool {
        while self.next_token_on_line() {
            self.token();
        }
        // What is left of the line is a comment; it does not join lines.
        self.end_line()
    }

    /// Goes to the start of the next line of the file, whatever comes before it; false at the end of the file.
    pub(super) fn end_line(&mut self) -> bool {
        let rest = self.rest();
        match rest.iter().position(|byte| matches!(byte, b'\n' | b'\r')) {
            None => {
                self.at = self.bytes.len();
                false
            }
            Some(length) => {
                let at = self.at + length;
                self.new_line(at + self.line_end_at(at));
                true
            }
        }
    }

    /// Reads up to the next blank, line end or joined line end; empty only at one of these.
    #[inline]
    pub(super) fn token(&mut self) -> &'a [u8] {
        let start = self.at;
        loop {
            match self.peek() {
                None | Some(b' ' | b'\t' | 0x0B | 0x0C | b'\n' | b'\r') => break,
                Some(b'\\') if self.line_end_at(self.at + 1) > 0 => break,
                Some(_) => self.at += 1,
            }
        }
        &self.bytes[start..self.at]
    }

    /// The tokens left on the line, joined by single blanks: a name that may contain blanks.
    pub(super) fn words(&mut self) -> Vec<u8> {
        let mut words = Vec::new();
        while self.next_token_on_line() {
            if !words.is_empty() {
                words.push(b' ');
            }
            words.extend_from_slice(self.token());
        }
        words
    }

    /// True when the next byte ends a token.
    #[inline]
    pub(super) fn is_token_end(&self) -> bool {
        match self.peek() {
            None | Some(b' ' | b'\t' | 0x0B | 0x0C | b'\n' | b'\r') => true,
            Some(b'\\') => self.line_end_at(self.at + 1) > 0,
            Some(_) => false,
        }
    }

    /// Reads a number in any spelling (`1`, `+1.`, `.5`, `1e2`, `nan`). `Err` gives the token that is none.
    #[inline]
    pub(super) fn number(&mut self) -> Result<f64, &'a [u8]> {
        let start = self.at;
        if let Some((value, length)) = exact_decimal(self.rest()) {
            self.at += length;
            if self.is_token_end() {
                return Ok(value);
            }
            self.at = start;
        }
        let token = self.token();
        std::str::from_utf8(token).ok().and_then(|text| text.parse().ok()).ok_or(token)
    }

    /// Reads an optional sign and decimal digits, saturating; `None` (and no byte read) when there is no digit.
    #[inline]
    pub(super) fn integer(&mut self) -> Option<i64> {
        let rest = self.rest();
        let negative = rest.first() == Some(&b'-');
        let sign = usize::from(matches!(rest.first(), Some(b'-' | b'+')));
        let mut value: i64 = 0;
        let mut length = sign;
        while let Some(digit) = rest.get(length).map(|byte| byte.wrapping_sub(b'0')).filter(|&d| d < 10) {
            // Wraps beyond 18 digits; then the value is not used.
            value = value.wrapping_mul(10).wrapping_add(i64::from(digit));
            length += 1;
        }
        if length == sign {
            return None;
        }
        if length - sign > 18 {
            let digits = rest[sign..length].iter().map(|byte| i64::from(byte - b'0'));
            value = digits.fold(0, |value: i64, digit| value.saturating_mul(10).saturating_add(digit));
        }
        self.at += length;
        Some(if negative { -value } else { value })
    }
}

/// A token for a message: readable, and short whatever the file holds.
pub(super) fn shown(token: &[u8]) -> String {
    const LONGEST: usize = 40;
    let text = String::from_utf8_lossy(token);
    let mut shown: String =
        text.chars().take(LONGEST).map(|c| if c.is_control() { '?' } else { c }).collect();
    if text.chars().count() > LONGEST {
        shown.push_str("...");
    }
    shown
}

/// Reads a decimal number whose value one multiplication or division gives exactly rounded: at most 2^53 as an
/// integer, scaled by at most 10^22 (Clinger 1990, "How to read floating point numbers accurately").
/// `None` leaves the number to the general algorithm.
#[inline]
fn exact_decimal(bytes: &[u8]) -> Option<(f64, usize)> {
    const POWERS: [f64; 23] = [
        1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16, 1e17,
        1e18, 1e19, 1e20, 1e21, 1e22,
    ];
    const MOST_DIGITS: usize = 19;
    let digit = |at: usize| bytes.get(at).map(|byte| byte.wrapping_sub(b'0')).filter(|&d| d < 10);
    let negative = bytes.first() == Some(&b'-');
    let start = usize::from(matches!(bytes.first(), Some(b'-' | b'+')));
    let mut at = start;
    let mut integer: u64 = 0;
    while let Some(d) = digit(at) {
        // Wraps beyond 19 digits; then the value is not used.
        integer = integer.wrapping_mul(10).wrapping_add(u64::from(d));
        at += 1;
    }
    let mut digits = at - start;
    let mut exponent: i32 = 0;
    if bytes.get(at) == Some(&b'.') {
        at += 1;
        let first = at;
        while let Some(d) = digit(at) {
            integer = integer.wrapping_mul(10).wrapping_add(u64::from(d));
            at += 1;
        }
        digits += at - first;
        exponent = i32::try_from(first).ok()? - i32::try_from(at).ok()?;
    }
    if digits > MOST_DIGITS {
        return None;
    }
    if digits == 0 || integer > 1 << 53 {
        return None;
    }
    if matches!(bytes.get(at), Some(b'e' | b'E')) {
        at += 1;
        let down = bytes.get(at) == Some(&b'-');
        at += usize::from(matches!(bytes.get(at), Some(b'-' | b'+')));
        let first = at;
        let mut scale: i32 = 0;
        while let Some(d) = digit(at) {
            if at - first >= 4 {
                return None;
            }
            scale = scale * 10 + i32::from(d);
            at += 1;
        }
        if at == first {
            return None;
        }
        exponent += if down { -scale } else { scale };
    }
    let power = *POWERS.get(exponent.unsigned_abs() as usize)?;
    let value = if exponent < 0 { integer as f64 / power } else { integer as f64 * power };
    Some((if negative { -value } else { value }, at))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn odd_spellings_of_numbers() {
        for (text, value) in [
            ("+1.", 1.0),
            (".5", 0.5),
            ("-.7e+02", -70.0),
            (".8e-001", 0.08),
            ("2.E1", 20.0),
            ("9007199254740993", 9007199254740992.0),
            ("00000000000000000000.50", 0.5),
            ("0.000000000000000000000000000001", 1e-30),
            ("18446744073709551617", 18446744073709551616.0),
            ("1e-400", 0.0),
        ] {
            assert_eq!(Cursor::new(text.as_bytes()).number(), Ok(value), "{text}");
        }
        for text in ["3.1+e2", ".", "1e", "0x10", "1_0", "1,5", "--1", "e5", ""] {
            assert!(Cursor::new(text.as_bytes()).number().is_err(), "{text}");
        }
    }

    #[test]
    fn integers_saturate() {
        for (text, value) in [
            ("-12/3", Some(-12)),
            ("+7", Some(7)),
            ("000000000000000000000000012", Some(12)),
            ("9223372036854775807", Some(i64::MAX)),
            ("18446744073709551617", Some(i64::MAX)),
            ("-99999999999999999999", Some(-i64::MAX)),
            ("-", None),
            ("x1", None),
        ] {
            assert_eq!(Cursor::new(text.as_bytes()).integer(), value, "{text}");
        }
    }

    #[test]
    fn lines_tokens_and_places() {
        let mut cursor = Cursor::new(b"\xEF\xBB\xBFa\tb \\\r\n c # d \\\ne\rf");
        let mut seen = Vec::new();
        loop {
            while cursor.next_token_on_line() {
                let place = cursor.place();
                seen.push((shown(cursor.token()), place.line, place.column));
            }
            if !cursor.next_line() {
                break;
            }
        }
        let expected = [("a", 1, 1), ("b", 1, 3), ("c", 2, 2), ("e", 3, 1), ("f", 4, 1)];
        assert_eq!(seen, expected.map(|(t, l, c)| (t.to_string(), l, c)));
    }

    proptest! {
        #[test]
        fn numbers_are_those_of_the_standard_library(value in any::<f64>(), digits in 0usize..20) {
            for text in [format!("{value}"), format!("{value:e}"), format!("{value:.digits$e}")] {
                let read = Cursor::new(text.as_bytes()).number().map(f64::to_bits);
                let parsed: f64 = text.parse().expect("a formatted number parses");
                prop_assert_eq!(read, Ok(parsed.to_bits()));
            }
        }
    }
}
