//! PLY (Stanford polygon format): ascii, binary little and big endian in; ascii and binary little endian out.

mod body;
mod header;
mod read;
mod write;

pub(super) use read::read;
pub use write::{Encoding, Options, write};
