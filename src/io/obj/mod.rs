//! Wavefront OBJ, with the crease and corner tags that OpenSubdiv writes.

mod faces;
mod read;
mod sets;
mod tags;
mod write;

pub(super) use read::read;
pub use write::write;
