//! Faces that enclose no area because of the vertices they name.

use super::faces::rewrite;
use crate::io::report::Repair;
use crate::io::source::Source;
use rustc_hash::FxHashSet;

/// Takes out repetitions of a vertex in a row, then the faces that are left with fewer than three vertices or still
/// meet a vertex twice.
pub(in crate::io) fn remove_degenerate_faces(source: &mut Source) {
    let mut repairs = Vec::new();
    let file_faces: Vec<u32> = source.file_faces.clone();
    let file_vertices: Vec<u32> = source.file_vertices.clone();
    let number = |table: &[u32], id: u32| table.get(id as usize).copied().unwrap_or(id);
    let mut seen = FxHashSet::default();
    rewrite(source, |face, corners| {
        let file_face = number(&file_faces, face);
        let mut removed = drop_repetitions(corners);
        removed.sort_unstable();
        removed.dedup();
        seen.clear();
        let sound = corners.len() >= 3 && corners.iter().all(|corner| seen.insert(corner.0));
        if sound {
            repairs.extend(removed.into_iter().map(|vertex| Repair::RepetitionRemoved {
                face: file_face,
                vertex: number(&file_vertices, vertex),
            }));
        } else {
            repairs.push(Repair::FaceRemoved { face: file_face });
        }
        sound
    });
    source.report.repairs.extend(repairs);
}

/// Keeps one corner of each run of corners at the same vertex, the run across the end of the list included; gives
/// the vertices of the corners it took out.
pub(super) fn drop_repetitions(corners: &mut Vec<(u32, Option<u32>)>) -> Vec<u32> {
    let mut removed = Vec::new();
    corners.dedup_by(|next, kept| {
        let same = next.0 == kept.0;
        if same {
            removed.push(next.0);
        }
        same
    });
    while corners.len() > 1
        && let [first, .., last] = corners.as_slice()
        && first.0 == last.0
    {
        removed.push(last.0);
        corners.pop();
    }
    removed
}
