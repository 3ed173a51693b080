//! Sides that patches share: the same numbers on both.

use super::cells::{Cell, Side};
use super::regions::Region;
use super::spline::SplinePatch;
use rustc_hash::FxHashMap;

/// Per region and side the region beyond it and its side there.
pub(super) type Neighbours = Vec<[Option<(usize, usize)>; 4]>;

pub(super) fn neighbours(cells: &[Cell], regions: &[Region]) -> Neighbours {
    let mut ends: FxHashMap<(usize, usize), (usize, usize)> = FxHashMap::default();
    for (number, region) in regions.iter().enumerate() {
        for side in 0..4 {
            let Side { cell, side: there } = region.end_of(side);
            ends.insert((cell, there), (number, side));
        }
    }
    let beyond = |region: &Region, side: usize| {
        let Side { cell, side } = region.corner(side);
        let beyond = cells[cell].beyond[side]?;
        ends.get(&(beyond.cell, beyond.side)).copied()
    };
    regions.iter().map(|region| std::array::from_fn(|side| beyond(region, side))).collect()
}

/// Gives corners that are the same vertex the same position, and sides that are the same curve the same poles: those of the
/// first patch that has them.
pub(super) fn join(patches: &mut [SplinePatch], neighbours: &Neighbours) {
    let mut first: Vec<usize> = (0..4 * patches.len()).collect();
    for (number, sides) in neighbours.iter().enumerate() {
        for (side, beyond) in sides.iter().enumerate() {
            let Some((other, there)) = *beyond else { continue };
            unite(&mut first, 4 * number + side, 4 * other + (there + 1) % 4);
            unite(&mut first, 4 * number + (side + 1) % 4, 4 * other + there);
        }
    }
    for corner in 0..first.len() {
        let origin = find(&mut first, corner);
        let position =
            corner_pole(&patches[origin / 4], origin % 4).map(|pole| patches[origin / 4].poles[pole]);
        let place = corner_pole(&patches[corner / 4], corner % 4);
        if let (Some(place), Some(position)) = (place, position) {
            patches[corner / 4].poles[place] = position;
        }
    }
    for (number, sides) in neighbours.iter().enumerate() {
        for (side, beyond) in sides.iter().enumerate() {
            let Some((other, there)) = beyond.filter(|&beyond| beyond > (number, side)) else { continue };
            let from = patches[number].side_poles(side);
            let to = patches[other].side_poles(there);
            for (from, to) in from.into_iter().rev().zip(to) {
                patches[other].poles[to] = patches[number].poles[from];
            }
        }
    }
}

fn corner_pole(patch: &SplinePatch, corner: usize) -> Option<usize> {
    patch.side_poles(corner).first().copied()
}

fn find(first: &mut [usize], mut at: usize) -> usize {
    while first[at] != at {
        first[at] = first[first[at]];
        at = first[at];
    }
    at
}

/// The lower number stays.
fn unite(first: &mut [usize], a: usize, b: usize) {
    let (a, b) = (find(first, a), find(first, b));
    first[a.max(b)] = a.min(b);
}
