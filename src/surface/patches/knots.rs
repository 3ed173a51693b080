//! Where regions have knots: the same on both sides of a shared edge, so that the edges have the same poles.

use super::cells::Cell;
use super::regions::Region;

/// Knots inside each cell along u and along v, in (0, 1), ascending.
pub(super) type Inner = Vec<[Vec<f64>; 2]>;

/// The knots inside cells: those that lines inside them ask for, and beside extraordinary vertices 1/2, 1/4 and so on
/// towards the vertex, `levels` of them. What one cell needs, all cells of the strip of cells have
/// that it lies across.
pub(super) fn inner_knots(cells: &[Cell], levels: u32) -> Inner {
    let mut inner: Inner = vec![[Vec::new(), Vec::new()]; cells.len()];
    let mut sense = vec![[None; 2]; cells.len()];
    for cell in 0..cells.len() {
        for axis in 0..2 {
            if sense[cell][axis].is_some() {
                continue;
            }
            let (strip, folded) = strip(cells, &mut sense, cell, axis);
            let mut knots = Vec::new();
            for member in &strip {
                let own = own_knots(&cells[member.cell], member.axis, levels);
                knots.extend(own.into_iter().map(|at| if member.reversed { 1.0 - at } else { at }));
            }
            if folded {
                knots.extend(knots.clone().into_iter().map(|at| 1.0 - at));
            }
            knots.sort_unstable_by(f64::total_cmp);
            knots.dedup();
            for member in strip {
                let mut own = knots.clone();
                if member.reversed {
                    own = own.into_iter().rev().map(|at| 1.0 - at).collect();
                }
                inner[member.cell][member.axis] = own;
            }
        }
    }
    inner
}

/// An axis of a cell in a strip.
#[derive(Clone, Copy)]
struct Member {
    cell: usize,
    /// 0 for u, 1 for v.
    axis: usize,
    /// Whether it runs against the axis of the first member.
    reversed: bool,
}

/// The cells reached from `cell` across the sides along `axis`, and whether the strip also comes back reversed. `sense` holds
/// `reversed` of all that were reached.
fn strip(cells: &[Cell], sense: &mut [[Option<bool>; 2]], cell: usize, axis: usize) -> (Vec<Member>, bool) {
    let mut strip = vec![Member { cell, axis, reversed: false }];
    sense[cell][axis] = Some(false);
    let (mut folded, mut next) = (false, 0);
    while let Some(&Member { cell, axis, reversed }) = strip.get(next) {
        next += 1;
        for side in [axis, axis + 2] {
            let Some(beyond) = cells[cell].beyond[side] else { continue };
            // Sides 0 and 1 run along their axis, 2 and 3 against it; the two cells see the side in opposite senses.
            let turned = (side < 2) == (beyond.side < 2);
            let member = Member { cell: beyond.cell, axis: beyond.side % 2, reversed: reversed != turned };
            match &mut sense[member.cell][member.axis] {
                Some(known) => folded |= *known != member.reversed,
                unknown => {
                    *unknown = Some(member.reversed);
                    strip.push(member);
                }
            }
        }
    }
    (strip, folded)
}

fn own_knots(cell: &Cell, axis: usize, levels: u32) -> Vec<f64> {
    let mut knots = cell.lines[axis].clone();
    let ends = if axis == 0 { [[0, 3], [1, 2]] } else { [[0, 1], [3, 2]] };
    for (end, corners) in ends.into_iter().enumerate() {
        if corners.iter().any(|&corner| cell.irregular[corner]) {
            let towards = (1..=levels).map(|level| 0.5_f64.powi(level as i32));
            knots.extend(towards.map(|at| if end == 0 { at } else { 1.0 - at }));
        }
    }
    knots
}

/// The knots of a region along `axis`, each once, from 0 to the number of its cells.
pub(super) fn region_knots(region: &Region, inner: &Inner, axis: usize) -> Vec<f64> {
    let mut knots = vec![0.0];
    for k in 0..region.size[axis] {
        let at = if axis == 0 { region.at(k, 0) } else { region.at(0, k) };
        // The side along the axis, and the sense in which it runs.
        let side = (at.side + if axis == 0 { 0 } else { 1 }) % 4;
        let own = &inner[at.cell][side % 2];
        let start = k as f64;
        if side < 2 {
            knots.extend(own.iter().map(|knot| start + knot));
        } else {
            knots.extend(own.iter().rev().map(|knot| start + (1.0 - knot)));
        }
        knots.push(start + 1.0);
    }
    knots
}
