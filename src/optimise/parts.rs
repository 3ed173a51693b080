//! Parts of the surface that a fit can be judged by, one without another.

use super::samples::Samples;
use crate::mesh::VertexId;
use rustc_hash::FxHashMap;

/// The sampled faces, by their numbers, in parts that share no vertex of `free`, which is ascending.
pub(super) fn parts(free: &[VertexId], samples: &Samples) -> Vec<Vec<usize>> {
    let mut part_of: Vec<usize> = (0..free.len()).collect();
    fn root(part_of: &mut [usize], mut k: usize) -> usize {
        while part_of[k] != k {
            part_of[k] = part_of[part_of[k]];
            k = part_of[k];
        }
        k
    }
    let of_face = |k: usize| samples.faces[k].control.iter().filter_map(|v| free.binary_search(v).ok());
    for face in 0..samples.faces.len() {
        let mut numbers = of_face(face);
        if let Some(first) = numbers.next() {
            let first = root(&mut part_of, first);
            for other in numbers {
                let other = root(&mut part_of, other);
                part_of[other] = first;
            }
        }
    }
    let mut parts: FxHashMap<usize, Vec<usize>> = FxHashMap::default();
    for face in 0..samples.faces.len() {
        if let Some(first) = of_face(face).next() {
            parts.entry(root(&mut part_of, first)).or_default().push(face);
        }
    }
    let mut parts: Vec<Vec<usize>> = parts.into_values().collect();
    parts.sort_unstable();
    parts
}
