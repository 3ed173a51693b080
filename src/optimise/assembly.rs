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
    /// Per group the groups it meets that are not before it, ascending, each with its row within the group's columns
    /// as counted from the first unknown of the group.
    met: Vec<Vec<(u32, usize)>>,
    column_starts: Vec<usize>,
    rows: Vec<usize>,
    values: Vec<f64>,
    pub(super) right: Vec<f64>,
    symbolic: Option<SymbolicLlt<usize>>,
}

impl Assembly {
    /// A system of groups of `sizes` unknowns, of which those named together in one of `blocks` meet.
    pub(super) fn new<'b>(sizes: &[usize], blocks: impl Iterator<Item = &'b [u32]>) -> Self {
        let mut firsts = vec![0];
        for size in sizes {
            firsts.push(firsts[firsts.len() - 1] + size);
        }
        let unknowns = firsts[sizes.len()];
        let mut met: Vec<Vec<(u32, usize)>> = (0..sizes.len() as u32).map(|group| vec![(group, 0)]).collect();
        for block in blocks {
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
        Self { firsts, met, column_starts, rows, values, right: vec![0.0; unknowns], symbolic: None }
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

    /// Adds the lower triangle of a dense matrix over the unknowns of the groups of one block, row by row.
    pub(super) fn add_block(&mut self, block: &[u32], matrix: &[f64], vector: &[f64]) {
        let count = vector.len();
        let mut a = 0;
        for (i, &row_group) in block.iter().enumerate() {
            let rows = self.of_group(row_group);
            self.right[rows.clone()].iter_mut().zip(&vector[a..]).for_each(|(sum, x)| *sum += x);
            let mut b = 0;
            for &column_group in &block[..=i] {
                let columns = self.of_group(column_group);
                self.add_pair([row_group, column_group], |k, l| {
                    let (k, l) = (a + k, b + l);
                    matrix[k.max(l) * count + k.min(l)]
                });
                b += columns.len();
            }
            a += rows.len();
        }
    }

    /// Adds the block of two groups, `entry(k, l)` for unknown k of the first and l of the second.
    fn add_pair(&mut self, [first, second]: [u32; 2], entry: impl Fn(usize, usize) -> f64) {
        let (low, high) = (first.min(second), first.max(second));
        let swapped = first < second;
        let others = &self.met[low as usize];
        let Ok(found) = others.binary_search_by_key(&high, |other| other.0) else { return };
        let place = others[found].1;
        let (rows, columns) = (self.of_group(high).len(), self.of_group(low));
        for (l, column) in columns.enumerate() {
            // Column l of the group lacks the l entries above the diagonal.
            let start = self.column_starts[column] + place;
            for k in if low == high { l } else { 0 }..rows {
                self.values[start + k - l] += if swapped { entry(l, k) } else { entry(k, l) };
            }
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
            system.add_block(&[1, 0], &[4.0, 0.0, 0.0, 1.0, 5.0, 0.0, 0.5, 0.0, 3.0], &[1.0, 2.0, 3.0]);
            // Over 1, 2, 3.
            system.add_block(&[1, 2], &[1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 2.0, 6.0], &[0.0, 1.0, 4.0]);
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
