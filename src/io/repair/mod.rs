//! Makes polygons fit for the kernel, on request; every change is listed in the report.

mod degenerate;
mod faces;
mod split;
mod weld;

pub(super) use degenerate::remove_degenerate_faces;
pub(super) use weld::{coincident, weld};

use super::source::Source;

/// More corners than this cannot become a mesh (ids have 31 bits), so that they are not worth a repair.
const MOST_CORNERS: usize = 1 << 30;

/// Removes degenerate faces, then orients, cuts and splits what remains.
pub(super) fn repair(source: &mut Source) {
    remove_degenerate_faces(source);
    if source.polygons.face_vertices.len() <= MOST_CORNERS {
        split::orient_and_split(source);
    }
}
