//! The numbers behind the header, whatever their storage.

use super::header::{Scalar, Storage};
use crate::io::text::{Cursor, Place, shown};

/// Reads one number after the other.
pub(super) enum Body<'a> {
    Ascii(Cursor<'a>),
    Binary { bytes: &'a [u8], big_endian: bool },
}

impl<'a> Body<'a> {
    /// The body that begins where `text` stands; `bytes` is the whole file.
    pub(super) fn new(storage: Storage, text: Cursor<'a>, bytes: &'a [u8]) -> Self {
        let rest = bytes.get(text.offset()..).unwrap_or_default();
        match storage {
            Storage::Ascii => Self::Ascii(text),
            Storage::BinaryLittleEndian => Self::Binary { bytes: rest, big_endian: false },
            Storage::BinaryBigEndian => Self::Binary { bytes: rest, big_endian: true },
        }
    }

    /// Where the next number stands, in a text file.
    pub(super) fn place(&self) -> Option<Place> {
        match self {
            Self::Ascii(text) => Some(text.place()),
            Self::Binary { .. } => None,
        }
    }

    /// Goes to the next number, which may be on a later line.
    pub(super) fn seek(&mut self) {
        if let Self::Ascii(text) = self {
            while !text.next_token_on_line() && text.next_line() {}
        }
    }

    /// Bytes that are left: bounds what can still come.
    pub(super) fn remaining(&self) -> usize {
        match self {
            Self::Ascii(text) => text.remaining(),
            Self::Binary { bytes, .. } => bytes.len(),
        }
    }

    /// Reads one number.
    ///
    /// # Errors
    /// What is wrong, in words.
    pub(super) fn scalar(&mut self, kind: Scalar) -> Result<f64, String> {
        self.seek();
        match self {
            Self::Ascii(text) => match text.number() {
                Ok(number) => Ok(number),
                Err(b"") => Err("the file ends too early".into()),
                Err(token) => Err(format!("'{}' is not a number", shown(token))),
            },
            Self::Binary { bytes, big_endian } => {
                binary_scalar(bytes, *big_endian, kind).ok_or_else(|| "the file ends too early".into())
            }
        }
    }

    /// Reads a number that must be whole and at least 0.
    ///
    /// # Errors
    /// What is wrong, in words.
    pub(super) fn index(&mut self, kind: Scalar) -> Result<u32, String> {
        let number = self.scalar(kind)?;
        let whole = number as u32;
        if f64::from(whole) == number { Ok(whole) } else { Err(format!("{number} is not an index")) }
    }
}

fn binary_scalar(bytes: &mut &[u8], big_endian: bool, kind: Scalar) -> Option<f64> {
    macro_rules! take {
        ($type:ty) => {{
            let (first, rest) = bytes.split_first_chunk()?;
            *bytes = rest;
            let number =
                if big_endian { <$type>::from_be_bytes(*first) } else { <$type>::from_le_bytes(*first) };
            f64::from(number)
        }};
    }
    Some(match kind {
        Scalar::I8 => take!(i8),
        Scalar::U8 => take!(u8),
        Scalar::I16 => take!(i16),
        Scalar::U16 => take!(u16),
        Scalar::I32 => take!(i32),
        Scalar::U32 => take!(u32),
        Scalar::F32 => take!(f32),
        Scalar::F64 => take!(f64),
    })
}
