//! What evaluation beside an extraordinary vertex has in common for all vertices of a valence: the pieces of the first levels
//! as linear combinations of the points round the vertex.
//!
//! Stam (1998) diagonalises the subdivision matrix; here its first powers are tabulated, which needs no eigenvectors and
//! serves the same points. Weights are for points relative to the limit position of the vertex, and so are the results: near
//! the vertex they keep their relative precision.

use super::kernel::{Four, accumulate, point};
use super::{Bicubic, Corner};
use crate::subdivision::patch_corner::{Points, Tip};
use glam::DVec3;

/// Levels that are tabulated; a parameter lies deeper with a chance of 4^-6.
pub(super) const LEVELS: usize = 6;
/// Vertices with more edges are refined level by level, which costs less then.
pub(super) const MOST: usize = 16;
/// Points of a quad's ring that do not belong to the fan round the vertex.
const OUTER: usize = 7;

/// The table of one valence.
#[derive(Clone, Debug)]
pub(super) struct Table {
    /// Per level and side one row per point (vertex, edges' ends from the quad's first edge on, opposite vertices from the
    /// quad on, outer points), with its weights in the sixteen Bezier points.
    weights: Vec<[[f64; 8]; 2]>,
    points: usize,
}

/// The tables that a surface needs.
#[derive(Clone, Default, Debug)]
pub(super) struct Tables(Vec<Option<Table>>);

impl Tables {
    /// Makes the table of a valence, if it is to have one, and gives the number for it, or 0.
    pub(super) fn add(&mut self, valence: usize) -> u32 {
        if valence > MOST {
            return 0;
        }
        if self.0.len() <= valence {
            self.0.resize_with(valence + 1, || None);
        }
        self.0[valence].get_or_insert_with(|| Table::new(valence));
        valence as u32
    }

    pub(super) fn get(&self, valence: usize) -> Option<&Table> {
        self.0.get(valence)?.as_ref()
    }
}

impl Table {
    /// Refines the unit vectors, three at a time.
    fn new(valence: usize) -> Self {
        let points = 1 + 2 * valence + OUTER;
        let mut weights = vec![[[0.0; 8]; 2]; LEVELS * 3 * points];
        let mut scratch = Points::new();
        for first in (0..points).step_by(3) {
            let unit =
                |k: usize| DVec3::from(std::array::from_fn(|axis| f64::from(u8::from(first + axis == k))));
            let mut corner = Corner {
                closed: true,
                tip: Tip::Moving,
                home: 0,
                key: None,
                origin: DVec3::ZERO,
                vertex: unit(0),
                spokes: (1..=valence).map(unit).collect(),
                diagonals: (valence + 1..=2 * valence).map(unit).collect(),
                outer: std::array::from_fn(|k| unit(2 * valence + 1 + k)),
            };
            corner.recentre();
            for level in 0..LEVELS {
                for (side, grid) in corner.refine(&mut scratch).iter().enumerate() {
                    let net = Bicubic::from_bspline(grid).net();
                    let rows = &mut weights[(3 * level + side) * points..][..points];
                    for (axis, row) in rows[first..].iter_mut().take(3).enumerate() {
                        *row = std::array::from_fn(|half| std::array::from_fn(|k| net[8 * half + k][axis]));
                    }
                }
            }
        }
        Self { weights, points }
    }

    /// A piece: side `side` after `level` + 1 refinements, from the points in the order of the rows.
    #[inline(always)]
    pub(super) fn piece<F: Four>(
        &self,
        four: F,
        level: usize,
        side: usize,
        points: [&[DVec3]; 6],
    ) -> Bicubic {
        let rows = &self.weights[(3 * level + side) * self.points..][..self.points];
        let mut halves = [[four.of([0.0; 4]); 8]; 2];
        for (half, sums) in halves.iter_mut().enumerate() {
            let mut rows = rows;
            for part in points {
                let (here, rest) = rows.split_at(part.len().min(rows.len()));
                rows = rest;
                for (row, point) in here.iter().zip(part) {
                    accumulate(four, sums, &row[half], point);
                }
            }
        }
        let [low, high] = halves;
        let row = |p: &[F::Value]| [0, 1, 2, 3].map(|i| point(four.numbers(p[i])));
        Bicubic { points: [row(&low[..4]), row(&low[4..]), row(&high[..4]), row(&high[4..])] }
    }
}
