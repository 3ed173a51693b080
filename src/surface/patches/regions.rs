//! Rectangles of cells.

use super::cells::{Cell, Side};
use super::lines::Lines;

/// A rectangle of cells between cuts.
#[derive(Clone, Debug)]
pub(super) struct Region {
    /// Cells along u and along v.
    pub(super) size: [usize; 2],
    /// Row by row, u running fastest: each cell by its side at the lower end of v.
    pub(super) cells: Vec<Side>,
    /// Corners at extraordinary vertices.
    pub(super) irregular: [bool; 4],
}

impl Region {
    pub(super) fn at(&self, i: usize, j: usize) -> Side {
        self.cells[j * self.size[0] + i]
    }

    fn holds(&self, cell: usize) -> bool {
        self.cells.iter().any(|at| at.cell == cell)
    }

    /// The cell at corner `corner`, by the side of the region that begins there.
    pub(super) fn corner(&self, corner: usize) -> Side {
        let [m, n] = self.size.map(|count| count - 1);
        let (i, j) = [(0, 0), (m, 0), (m, n), (0, n)][corner % 4];
        let Side { cell, side } = self.at(i, j);
        Side::new(cell, side + corner)
    }

    /// The last cell along side `side`, by its side there.
    pub(super) fn end_of(&self, side: usize) -> Side {
        let Side { cell, side: there } = self.corner(side + 1);
        Side::new(cell, there + 3)
    }
}

/// Cuts the cells into rectangles of at most `most` by `most` cells. All sides of regions meet end to end, and none meets
/// another of the same region, which CAD kernels dislike.
pub(super) fn regions(cells: &[Cell], most: usize) -> Vec<Region> {
    let mut lines = Lines::new(cells);
    loop {
        let (regions, cuts) = gather(&lines, cells, most.max(1));
        if cuts.is_empty() {
            return regions;
        }
        for side in cuts {
            if lines.across(side).is_some() {
                lines.trace_both(side);
            }
        }
    }
}

/// The rectangles between `lines`, and where to cut those that are too long or have no end.
fn gather(lines: &Lines, cells: &[Cell], most: usize) -> (Vec<Region>, Vec<Side>) {
    let mut taken = vec![false; cells.len()];
    let (mut regions, mut cuts) = (Vec::new(), Vec::new());
    for cell in 0..cells.len() {
        if taken[cell] {
            continue;
        }
        let start = Side::new(cell, 0);
        let Some(origin) = last(lines, start, 3).and_then(|left| last(lines, left, 0)) else {
            // A ring: cut it here, once.
            let across = if last(lines, start, 3).is_none() { 3 } else { 0 };
            cuts.push(Side::new(cell, across));
            take_all(lines, &mut taken, cell);
            continue;
        };
        let rows = row(lines, origin, 2);
        let grid: Vec<Vec<Side>> = rows.iter().map(|&first| row(lines, first, 1)).collect();
        let size = [grid[0].len(), grid.len()];
        let found = grid.concat();
        let fits = grid.iter().all(|row| row.len() == size[0]) && found.iter().all(|at| !taken[at.cell]);
        if !fits {
            // Cannot be while cuts run straight on; cells on their own are rectangles in any case.
            taken[cell] = true;
            cuts.extend(
                (0..4).map(|side| Side::new(cell, side)).filter(|&side| lines.across(side).is_some()),
            );
            continue;
        }
        found.iter().for_each(|at| taken[at.cell] = true);
        let mut region = Region { size, cells: found, irregular: [false; 4] };
        region.irregular = std::array::from_fn(|corner| {
            let Side { cell, side } = region.corner(corner);
            lines.is_end(cell, side) && cells[cell].irregular[side]
        });
        for (axis, count) in size.into_iter().enumerate() {
            let meets_itself = [1 - axis, 3 - axis].into_iter().any(|side| {
                let Side { cell, side } = region.corner(side);
                cells[cell].beyond[side].is_some_and(|beyond| region.holds(beyond.cell))
            });
            let parts = count.div_ceil(most).max(if meets_itself { 2.min(count) } else { 1 });
            for part in 1..parts {
                let at = part * count / parts;
                // The lower side of that cell along the axis.
                let Side { cell, side } = if axis == 0 { region.at(at, 0) } else { region.at(0, at) };
                cuts.push(Side::new(cell, side + if axis == 0 { 3 } else { 0 }));
            }
        }
        regions.push(region);
    }
    (regions, cuts)
}

/// Marks all cells between the same cuts as `cell`.
fn take_all(lines: &Lines, taken: &mut [bool], cell: usize) {
    let mut open = vec![cell];
    while let Some(cell) = open.pop() {
        if !std::mem::replace(&mut taken[cell], true) {
            open.extend((0..4).filter_map(|side| lines.across(Side::new(cell, side))).map(|at| at.cell));
        }
    }
}

/// The cell beyond, in the same orientation: `direction` 0 is down, 1 right, 2 up, 3 left.
fn step(lines: &Lines, at: Side, direction: usize) -> Option<Side> {
    let beyond = lines.across(Side::new(at.cell, at.side + direction))?;
    // The side it is entered by is opposite to the direction.
    Some(Side::new(beyond.cell, beyond.side + 6 - direction))
}

/// The last cell in a direction; `None` in a ring.
fn last(lines: &Lines, start: Side, direction: usize) -> Option<Side> {
    let mut at = start;
    while let Some(next) = step(lines, at, direction) {
        at = next;
        if at == start {
            return None;
        }
    }
    Some(at)
}

/// The cells from `first` on in a direction.
fn row(lines: &Lines, first: Side, direction: usize) -> Vec<Side> {
    let mut row = vec![first];
    while let Some(next) = row.last().and_then(|&at| step(lines, at, direction)).filter(|&at| at != first) {
        row.push(next);
    }
    row
}
