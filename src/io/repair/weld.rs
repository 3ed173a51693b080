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
    // Cells four times as wide as the distance: what is within it of a vertex lies in one or two of them per axis, and
    // few vertices that stand for themselves, being further apart than the distance, fit into one.
    let width = 4.0 * distance;
    let cell = |x: f64| {
        let cell = if width > 0.0 { (x / width).floor() } else { x };
        // Where the quotient overflows every number is a cell of its own. Adding 0 turns -0 into 0.
        (if cell.is_finite() { cell } else { x } + 0.0).to_bits()
    };
    // The last vertex that stands for itself in each cell, and for each such vertex the one before it in its cell.
    let mut last_in_cell: FxHashMap<[u64; 3], u32> = FxHashMap::default();
    let mut before = vec![u32::MAX; positions.len()];
    let mut stands_for = Vec::with_capacity(positions.len());
    for (vertex, &position) in (0u32..).zip(positions) {
        let low = (position - distance).to_array().map(cell);
        let high = (position + distance).to_array().map(cell);
        let mut found = vertex;
        for corner in 0..8 {
            let upper = [0, 1, 2].map(|axis| corner >> axis & 1 == 1);
            if (0..3).any(|axis| upper[axis] && low[axis] == high[axis]) {
                continue;
            }
            let key = [0, 1, 2].map(|axis| if upper[axis] { high[axis] } else { low[axis] });
            let mut other = last_in_cell.get(&key).copied().unwrap_or(u32::MAX);
            while other != u32::MAX {
                if positions[other as usize].distance(position) <= distance {
                    found = found.min(other);
                }
                other = before[other as usize];
            }
        }
        if found == vertex {
            let last = last_in_cell.insert(position.to_array().map(cell), vertex);
            before[vertex as usize] = last.unwrap_or(u32::MAX);
        }
        stands_for.push(found);
    }
    stands_for
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// Against comparing every vertex with every vertex before it.
        #[test]
        fn the_lowest_vertex_in_reach_is_found(
            grid in prop::collection::vec([-9i32..9, -2i32..2, 0i32..2], 1..60),
            distance in prop::sample::select(vec![0.0, 0.5, 1.0, 1.5, 3.0]),
            scale in prop::sample::select(vec![1.0, 1e-9, 1e9]),
        ) {
            let grid: Vec<DVec3> = grid.iter().map(|p| DVec3::from_array(p.map(f64::from))).collect();
            let mut expected: Vec<u32> = Vec::new();
            for (i, p) in grid.iter().enumerate() {
                let near = |&j: &usize| expected[j] as usize == j && grid[j].distance(*p) <= distance;
                expected.push((0..i).find(near).unwrap_or(i) as u32);
            }
            // A distance that is reached exactly may round to either side; a little more decides.
            let positions: Vec<DVec3> = grid.iter().map(|&p| p * scale).collect();
            prop_assert_eq!(coincident(&positions, distance * scale * (1.0 + 1e-9)), expected);
        }
    }
}
