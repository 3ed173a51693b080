//! Cuts along rows of edges, which part the surface into rectangles.

use super::cells::{Cell, Side};

/// Which sides of cells are cut.
pub(super) struct Lines<'a> {
    cells: &'a [Cell],
    /// Per cell and side.
    pub(super) cut: Vec<[bool; 4]>,
    /// Per cell and corner: cuts end here.
    ends: Vec<[bool; 4]>,
}

impl<'a> Lines<'a> {
    /// Cuts along the border, along infinitely sharp edges, and from every extraordinary vertex along all its edges
    /// straight on to the next one or to the border. What is left between are rectangles, or rings without an end.
    pub(super) fn new(cells: &'a [Cell]) -> Self {
        let cut = cells
            .iter()
            .map(|cell| std::array::from_fn(|side| cell.sharp[side] || cell.beyond[side].is_none()))
            .collect();
        let mut lines = Self { cells, cut, ends: vec![[false; 4]; cells.len()] };
        for cell in 0..cells.len() {
            for corner in 0..4 {
                if !lines.ends[cell][corner] {
                    lines.mark_end(cell, corner);
                }
            }
        }
        for cell in 0..cells.len() {
            for corner in 0..4 {
                if lines.ends[cell][corner] {
                    lines.trace(Side::new(cell, corner));
                }
            }
        }
        lines
    }

    /// The corners of cells round a vertex, counter-clockwise, as the sides that leave it; and whether the vertex lies
    /// inside the surface.
    fn round(&self, cell: usize, corner: usize) -> (Vec<Side>, bool) {
        let start = Side::new(cell, corner);
        let mut around = vec![start];
        let mut at = start;
        // Counter-clockwise: across the side that arrives at the vertex.
        while let Some(next) = self.cells[at.cell].beyond[(at.side + 3) % 4] {
            if next == start {
                return (around, true);
            }
            if around.len() > 4 * self.cells.len() {
                break;
            }
            around.push(next);
            at = next;
        }
        let mut at = start;
        let mut before = Vec::new();
        while let Some(next) = self.cells[at.cell].beyond[at.side] {
            at = Side::new(next.cell, next.side + 1);
            if before.len() > 4 * self.cells.len() {
                break;
            }
            before.push(at);
        }
        before.reverse();
        before.extend(around);
        (before, false)
    }

    /// Marks the vertex as an end of cuts unless it is regular.
    fn mark_end(&mut self, cell: usize, corner: usize) {
        let (around, inside) = self.round(cell, corner);
        let irregular = around.iter().any(|at| self.cells[at.cell].irregular[at.side]);
        let usual = if inside { around.len() == 4 } else { around.len() <= 2 };
        if irregular || !usual {
            around.iter().for_each(|at| self.ends[at.cell][at.side] = true);
        }
    }

    /// Cuts along `side` and straight on.
    fn trace(&mut self, side: Side) {
        let mut at = side;
        loop {
            let Side { cell, side } = at;
            if std::mem::replace(&mut self.cut[cell][side], true) {
                return;
            }
            if let Some(beyond) = self.cells[cell].beyond[side] {
                self.cut[beyond.cell][beyond.side] = true;
            }
            let corner = (side + 1) % 4;
            if self.ends[cell][corner] {
                return;
            }
            match self.cells[cell].beyond[corner] {
                Some(next) => at = Side::new(next.cell, next.side + 1),
                None => return,
            }
        }
    }

    /// Cuts along `side`, which is not cut, and straight on both ways.
    pub(super) fn trace_both(&mut self, side: Side) {
        self.trace(side);
        if let Some(beyond) = self.cells[side.cell].beyond[side.side] {
            self.cut[beyond.cell][beyond.side] = false;
            self.trace(beyond);
        }
    }

    /// True where cuts end at extraordinary vertices.
    pub(super) fn is_end(&self, cell: usize, corner: usize) -> bool {
        self.ends[cell][corner]
    }

    /// Beyond `side`, where it is not cut.
    pub(super) fn across(&self, side: Side) -> Option<Side> {
        if self.cut[side.cell][side.side] { None } else { self.cells[side.cell].beyond[side.side] }
    }
}
