//! Normal equations that are put together from dense blocks of few unknowns each.

use faer::linalg::solvers::SolveCore;
use faer::sparse::linalg::solvers::{Llt, SymbolicLlt};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, Side};

/// A symmetric positive definite system whose unknowns come in groups (the freedoms of a vertex). The lower triangle is
/// kept column by column; where what goes is known from the start, so that it can be filled and solved repeatedly.
pub(super) struct Assembly {
    /// First unknown of each group, and the number of unknowns.
    firsts: Vec<usize>,
    /// Per block and pair of its groups, row by row of the lower triangle, the row within the columns of the lower group at
    /// which the higher one begins.
    places: Vec<Vec<u32>>,
    column_starts: Vec<usize>,
    rows: Vec<usize>,
    values: Vec<f64>,
    pub(super) right: Vec<f64>,
    symbolic: Option<SymbolicLlt<usize>>,
}

impl Assembly {
    /// A system of groups of `sizes` unknowns, of which those named together in one of `blocks` meet.
    pub(super) fn new<'b>(sizes: &[usize], blocks: impl Iterator<Item = &'b [u32]> + Clone) -> Self {
        let mut firsts = vec![0];
        for size in sizes {
            firsts.push(firsts[firsts.len() - 1] + size);
        }
        let unknowns = firsts[sizes.len()];
        // Per group the groups it meets that are not before it, ascending, each with its row within the group's columns
        // as counted from the first unknown of the group.
        let mut met: Vec<Vec<(u32, usize)>> = (0..sizes.len() as u32).map(|group| vec![(group, 0)]).collect();
        for block in blocks.clone() {
            for &a in block {
                met[a as usize].extend(block.iter().filter(|&&b| b > a).map(|&b| (b, 0)));
            }
        }
        let (mut column_starts, mut rows) = (vec![0], Vec::new());
        for (group, others) in met.iter_mut().enumerate() {
            others.sort_unstable();
            others.dedup();
            let mut place = 0;
            for (other, at) in others.iter_mut() {
                *at = place;
                place += sizes[*other as usize];
            }
            for k in 0..sizes[group] {
                let all =
                    others.iter().flat_map(|&(other, _)| firsts[other as usize]..firsts[other as usize + 1]);
                rows.extend(all.skip(k));
                column_starts.push(rows.len());
            }
        }
        let values = vec![0.0; rows.len()];
        let place = |a: u32, b: u32| {
            let others = &met[a.min(b) as usize];
            let found = others.partition_point(|other| other.0 < a.max(b));
            others.get(found).map_or(0, |other| other.1 as u32)
        };
        let places_of = |block: &[u32]| {
            block
                .iter()
                .enumerate()
                .flat_map(|(i, &a)| block[..=i].iter().map(move |&b| (a, b)))
                .map(|(a, b)| place(a, b))
                .collect()
        };
        let places = blocks.map(places_of).collect();
        Self { firsts, places, column_starts, rows, values, right: vec![0.0; unknowns], symbolic: None }
    }

    pub(super) fn unknowns(&self) -> usize {
        self.right.len()
    }

    /// Unknowns of a group.
    pub(super) fn of_group(&self, group: u32) -> std::ops::Range<usize> {
        self.firsts[group as usize]..self.firsts[group as usize + 1]
    }

    pub(super) fn clear(&mut self) {
        self.values.fill(0.0);
        self.right.fill(0.0);
    }

    /// Adds to a diagonal entry.
    pub(super) fn add_diagonal(&mut self, unknown: usize, value: f64) {
        self.values[self.column_starts[unknown]] += value;
    }

    /// Adds the lower triangle of a dense matrix over the unknowns of the groups of a block, given row by row, to the
    /// system; `number` is that of the block, whose groups these are.
    pub(super) fn add_block(&mut self, number: usize, block: &[u32], matrix: &[f64], vector: &[f64]) {
        let count = vector.len();
        let mut places = self.places[number].iter();
        let mut a = 0;
        for (i, &row_group) in block.iter().enumerate() {
            let rows = self.firsts[row_group as usize]..self.firsts[row_group as usize + 1];
            self.right[rows.clone()].iter_mut().zip(&vector[a..]).for_each(|(sum, x)| *sum += x);
            let mut b = 0;
            for (&column_group, &place) in block[..=i].iter().zip(&mut places) {
                let columns = self.firsts[column_group as usize]..self.firsts[column_group as usize + 1];
                let low = row_group.min(column_group);
                // Column l of a group lacks the l entries above the diagonal.
                let starts = &self.column_starts[self.firsts[low as usize]..];
                let start = |column: usize| starts[column] + place as usize - column;
                for k in 0..rows.len() {
                    let entries = &matrix[(a + k) * count + b..][..columns.len()];
                    if row_group == column_group {
                        entries[..=k].iter().enumerate().for_each(|(l, x)| self.values[start(l) + k] += x);
                    } else if column_group < row_group {
                        entries.iter().enumerate().for_each(|(l, x)| self.values[start(l) + k] += x);
                    } else {
                        let column = &mut self.values[start(k)..][..entries.len()];
                        column.iter_mut().zip(entries).for_each(|(sum, x)| *sum += x);
                    }
                }
                b += columns.len();
            }
            a += rows.len();
        }
    }

    /// The unknowns; `None` when the numbers do not allow a factorisation.
    pub(super) fn solve(&mut self) -> Option<Vec<f64>> {
        let unknowns = self.unknowns();
        if unknowns == 0 || !self.values.iter().chain(&self.right).all(|x| x.is_finite()) {
            return None;
        }
        let pattern =
            SymbolicSparseColMatRef::new_checked(unknowns, unknowns, &self.column_starts, None, &self.rows);
        if self.symbolic.is_none() {
            self.symbolic = SymbolicLlt::try_new(pattern, Side::Lower).ok();
        }
        let matrix = SparseColMatRef::new(pattern, &self.values);
        let factor = Llt::try_new_with_symbolic(self.symbolic.clone()?, matrix, Side::Lower).ok()?;
        let mut x = self.right.clone();
        factor.solve_in_place_with_conj(Conj::No, MatMut::from_column_major_slice_mut(&mut x, unknowns, 1));
        Some(x)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_add_up() {
        // Groups {0}, {1, 2}, {3}; blocks (group 1, group 0) and (group 2, group 1), given out of order.
        let mut system = Assembly::new(&[1, 2, 1], [&[1u32, 0][..], &[1, 2]].into_iter());
        for _ in 0..2 {
            system.clear();
            // Over the unknowns 1, 2, 0: rows of the lower triangle.
            system.add_block(0, &[1, 0], &[4.0, 0.0, 0.0, 1.0, 5.0, 0.0, 0.5, 0.0, 3.0], &[1.0, 2.0, 3.0]);
            // Over 1, 2, 3.
            system.add_block(1, &[1, 2], &[1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 2.0, 6.0], &[0.0, 1.0, 4.0]);
            system.add_diagonal(3, 1.0);
            let x = system.solve().expect("definite");
            let rows = [
                ([3.0, 0.5, 0.0, 0.0], 3.0),
                ([0.5, 5.0, 1.0, 0.0], 1.0),
                ([0.0, 1.0, 6.0, 2.0], 3.0),
                ([0.0, 0.0, 2.0, 7.0], 4.0),
            ];
            for (row, right) in rows {
                let left: f64 = row.iter().zip(&x).map(|(a, x)| a * x).sum();
                assert!((left - right).abs() < 1e-12, "{x:?}");
            }
        }
    }

    #[test]
    fn nothing_to_solve() {
        assert!(Assembly::new(&[], std::iter::empty()).solve().is_none());
        let mut system = Assembly::new(&[1], std::iter::empty());
        system.add_diagonal(0, f64::NAN);
        assert!(system.solve().is_none());
    }
}
