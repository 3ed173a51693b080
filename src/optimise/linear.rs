//! Sparse linear least squares, the one place where the factorisation library is used.

use faer::linalg::solvers::SolveCore;
use faer::sparse::linalg::solvers::Llt;
use faer::sparse::{SparseColMat, Triplet};
use faer::{Conj, MatMut, Side};
use smallvec::SmallVec;

/// One equation: (unknown, coefficient) pairs, unknowns all different.
pub(crate) type Row = SmallVec<[(u32, f64); 12]>;

/// Ridge relative to the largest diagonal entry of the normal matrix: far below what a result shows, enough to keep
/// the factorisation going where the limit matrix is singular (a cube's is).
const RIDGE: f64 = 1e-12;

/// A factorised least-squares problem `min |A x - b|^2`.
pub(crate) struct LeastSquares {
    rows: Vec<Row>,
    unknowns: usize,
    factor: Llt<usize, f64>,
}

impl LeastSquares {
    /// Factorises the normal equations of `rows`. `None` when there is nothing to solve or the numbers are not finite.
    pub(crate) fn new(rows: Vec<Row>, unknowns: usize) -> Option<Self> {
        if unknowns == 0 {
            return None;
        }
        let mut products: Vec<Triplet<usize, usize, f64>> = Vec::new();
        let mut largest = 0.0_f64;
        let mut diagonal = vec![0.0; unknowns];
        for row in &rows {
            for &(i, a) in row {
                for &(j, b) in row.iter().filter(|entry| entry.0 <= i) {
                    products.push(Triplet::new(i as usize, j as usize, a * b));
                }
                diagonal[i as usize] += a * a;
                largest = largest.max(diagonal[i as usize]);
            }
        }
        if !largest.is_finite() || largest == 0.0 {
            return None;
        }
        products.extend((0..unknowns).map(|i| Triplet::new(i, i, RIDGE * largest)));
        let normal = SparseColMat::try_new_from_triplets(unknowns, unknowns, &products).ok()?;
        let factor = normal.sp_cholesky(Side::Lower).ok()?;
        Some(Self { rows, unknowns, factor })
    }

    /// The unknowns for right-hand side `b`, one entry per row.
    pub(crate) fn solve(&self, b: impl Iterator<Item = f64>) -> Vec<f64> {
        let mut x = vec![0.0; self.unknowns];
        for (row, b) in self.rows.iter().zip(b) {
            for &(i, a) in row {
                x[i as usize] += a * b;
            }
        }
        let rows = x.len();
        self.factor.solve_in_place_with_conj(Conj::No, MatMut::from_column_major_slice_mut(&mut x, rows, 1));
        x
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn solves_a_tridiagonal_system() {
        // (1, 4, 1)/6 with solution 1, 2, 3.
        let rows = vec![
            Row::from_slice(&[(0, 4.0), (1, 1.0)]),
            Row::from_slice(&[(0, 1.0), (1, 4.0), (2, 1.0)]),
            Row::from_slice(&[(1, 1.0), (2, 4.0)]),
        ];
        let system = LeastSquares::new(rows, 3).expect("regular");
        let x = system.solve([6.0, 12.0, 14.0].into_iter());
        for (x, expected) in x.iter().zip([1.0, 2.0, 3.0]) {
            assert!((x - expected).abs() < 1e-9, "{x} {expected}");
        }
    }

    #[test]
    fn a_singular_system_gets_its_small_solution() {
        let rows = vec![Row::from_slice(&[(0, 1.0), (1, 1.0)]), Row::from_slice(&[(0, 2.0), (1, 2.0)])];
        let x = LeastSquares::new(rows, 2).expect("ridge").solve([2.0, 4.0].into_iter());
        assert!((x[0] - 1.0).abs() < 1e-3 && (x[1] - 1.0).abs() < 1e-3, "{x:?}");
    }

    #[test]
    fn nothing_to_solve() {
        assert!(LeastSquares::new(Vec::new(), 0).is_none());
        assert!(LeastSquares::new(vec![Row::from_slice(&[(0, f64::NAN)])], 1).is_none());
    }
}
