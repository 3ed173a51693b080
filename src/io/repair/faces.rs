//! Rewriting the face arrays, with all that travels with faces.

use crate::io::source::Source;

/// Lets `change` rewrite each face: it gets the face's index and its corners, as (vertex, texture coordinate) with
/// `None` where the mesh has none, and gives false to remove the face.
pub(super) fn rewrite(
    source: &mut Source,
    mut change: impl FnMut(u32, &mut Vec<(u32, Option<u32>)>) -> bool,
) {
    let old = std::mem::take(&mut source.polygons.face_vertices);
    let old_texcoords = std::mem::take(&mut source.polygons.face_texcoords);
    let old_sizes = std::mem::take(&mut source.polygons.face_sizes);
    let old_sets = std::mem::take(&mut source.polygons.face_sets);
    let mut old_holes = std::mem::take(&mut source.polygons.holes);
    old_holes.sort_unstable();
    let old_numbers = std::mem::take(&mut source.file_faces);
    let polygons = &mut source.polygons;
    let (mut start, mut removed) = (0, false);
    let mut corners = Vec::new();
    for (face, &size) in old_sizes.iter().enumerate() {
        let end = start + size as usize;
        let Some(vertices) = old.get(start..end) else { break };
        let texcoords = old_texcoords.get(start..end);
        start = end;
        corners.clear();
        corners.extend(vertices.iter().enumerate().map(|(i, &vertex)| (vertex, texcoords.map(|t| t[i]))));
        if !change(face as u32, &mut corners) {
            removed = true;
            continue;
        }
        polygons.face_vertices.extend(corners.iter().map(|corner| corner.0));
        polygons.face_texcoords.extend(corners.iter().filter_map(|corner| corner.1));
        polygons.face_sizes.push(corners.len() as u32);
        if old_holes.binary_search(&(face as u32)).is_ok() {
            polygons.holes.push(polygons.face_sizes.len() as u32 - 1);
        }
        polygons.face_sets.extend(old_sets.get(face));
        source.file_faces.push(old_numbers.get(face).copied().unwrap_or(face as u32));
    }
    if !removed && old_numbers.is_empty() {
        source.file_faces.clear();
    }
}
