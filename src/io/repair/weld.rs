//! Merging vertices at the same place.

use super::degenerate::drop_repetitions;
use super::faces::rewrite;
use crate::io::error::ImportError;
use crate::io::report::Repair;
use crate::io::source::Source;
use glam::DVec3;
use rustc_hash::FxHashMap;

/// Merges vertices no further apart than `distance` (0: equal ones) and takes out of the faces what that makes
/// degenerate. Vertices keep their order; of merged ones the lowest stays.
pub(in crate::io) fn weld(source: &mut Source, distance: f64) -> Result<(), ImportError> {
    if !(distance >= 0.0 && distance.is_finite()) {
        return Err(ImportError::WeldDistance { distance });
    }
    let stands_for = coincident(&source.polygons.positions, distance);
    let mut repairs = Vec::new();
    let mut new_number = vec![0; stands_for.len()];
    let mut file_vertices = Vec::new();
    for (vertex, &kept) in stands_for.iter().enumerate() {
        if kept as usize == vertex {
            new_number[vertex] = file_vertices.len() as u32;
            file_vertices.push(source.file_vertex(vertex as u32));
        } else {
            new_number[vertex] = new_number[kept as usize];
            let [vertex, into] = [vertex as u32, kept].map(|v| source.file_vertex(v));
            repairs.push(Repair::VertexWelded { vertex, into });
        }
    }
    if repairs.is_empty() {
        return Ok(());
    }
    let renumbered = |vertex: u32| new_number.get(vertex as usize).copied().unwrap_or(vertex);
    let mut index = 0;
    source.polygons.positions.retain(|_| {
        index += 1;
        stands_for[index - 1] as usize == index - 1
    });
    rewrite(source, |face, corners| {
        let before = corners.len();
        let degenerate_before = before < 3;
        corners.iter_mut().for_each(|corner| corner.0 = renumbered(corner.0));
        if degenerate_before {
            return true;
        }
        let removed = drop_repetitions(corners);
        if corners.len() < 3 {
            repairs.push(Repair::FaceRemoved { face });
            return false;
        }
        repairs.extend(
            removed.iter().map(|&v| Repair::RepetitionRemoved { face, vertex: file_vertices[v as usize] }),
        );
        true
    });
    for crease in &mut source.polygons.creases {
        (crease.0, crease.1) = (renumbered(crease.0), renumbered(crease.1));
    }
    for corner in &mut source.polygons.corners {
        corner.0 = renumbered(corner.0);
    }
    source.file_vertices = file_vertices;
    source.report.repairs.extend(repairs);
    Ok(())
}

/// For each vertex, the lowest vertex it coincides with (itself when there is none): the first one within `distance`
/// that stands for itself.
pub(in crate::io) fn coincident(positions: &[DVec3], distance: f64) -> Vec<u32> {
    // A cell is as wide as the distance, so that a cell and its neighbours hold all candidates. Vertices that stand
    // for themselves are further apart than that, which bounds their number per cell.
    let mut cells: FxHashMap<[u64; 3], Vec<u32>> = FxHashMap::default();
    let cell_coordinate = |x: f64| {
        let cell = if distance > 0.0 { (x / distance).floor() } else { x };
        // Adding 0 turns -0 into 0. Where the quotient overflows, every number is a cell of its own.
        if cell.is_finite() { cell + 0.0 } else { x }
    };
    let steps: &[f64] = if distance > 0.0 { &[-1.0, 0.0, 1.0] } else { &[0.0] };
    let mut stands_for = Vec::with_capacity(positions.len());
    for (vertex, &position) in positions.iter().enumerate() {
        let cell = position.to_array().map(cell_coordinate);
        let mut found = vertex as u32;
        for &dx in steps {
            for &dy in steps {
                for &dz in steps {
                    let key = [cell[0] + dx, cell[1] + dy, cell[2] + dz].map(f64::to_bits);
                    for &other in cells.get(&key).into_iter().flatten() {
                        if positions[other as usize].distance(position) <= distance {
                            found = found.min(other);
                        }
                    }
                }
            }
        }
        if found as usize == vertex {
            cells.entry(cell.map(f64::to_bits)).or_default().push(found);
        }
        stands_for.push(found);
    }
    stands_for
}
