//! Aims that make up for what a pass missed: width and heights are reached on the limit surface, not only in the
//! closed forms of straight bands.

use super::WidthError;
use super::linear::Pass;
use super::prepare::Run;
use crate::mesh::Mesh;

/// A correction changes a value by at most this factor.
const LARGEST_CORRECTION: f64 = 2.0;

/// Asked over reached value of each parameter of a mark.
pub(super) type Misses = Vec<Option<Vec<f64>>>;

/// The largest relative miss.
pub(super) fn worst(misses: &Misses) -> f64 {
    misses.iter().flatten().flatten().fold(0.0, |worst, ratio| worst.max((ratio - 1.0).abs()))
}

impl Run<'_> {
    /// What was missed per mark: measured, or the mean of the measured neighbours.
    pub(super) fn misses(&self, pass: &Pass) -> Misses {
        let mut measured: Misses = vec![None; self.asked.len()];
        let mut around: Vec<(f64, Vec<f64>)> =
            self.asked.iter().map(|values| (0.0, vec![0.0; values.len()])).collect();
        for (station, reached) in pass.stations.iter().zip(&pass.reached) {
            if reached.iter().all(Option::is_none) {
                continue;
            }
            let ratio = |(asked, reached): (&f64, &Option<f64>)| {
                let ratio = reached.map_or(1.0, |reached| asked / reached);
                if ratio.is_finite() {
                    ratio.clamp(1.0 / LARGEST_CORRECTION, LARGEST_CORRECTION)
                } else {
                    1.0
                }
            };
            let ratios: Vec<f64> = self.asked[station.mark].iter().zip(reached).map(ratio).collect();
            for neighbour in station.neighbours {
                let (count, sum) = &mut around[neighbour];
                *count += 1.0;
                sum.iter_mut().zip(&ratios).for_each(|(sum, ratio)| *sum += ratio);
            }
            measured[station.mark] = Some(ratios);
        }
        measured
            .into_iter()
            .zip(around)
            .map(|(own, (count, sum))| {
                own.or_else(|| (count > 0.0).then(|| sum.iter().map(|sum| sum / count).collect()))
            })
            .collect()
    }

    /// Changes what is aimed at by what was missed. The mesh is as before the pass.
    pub(super) fn correct(&self, mesh: &Mesh, misses: &Misses, aims: &mut [Vec<f64>]) {
        for (mark, miss) in misses.iter().enumerate() {
            let Some(miss) = miss else { continue };
            let width = self.features[self.feature_of[mark]].profile.width();
            for (p, ratio) in miss.iter().enumerate() {
                if Some(p) != width {
                    aims[mark][p] *= ratio;
                    continue;
                }
                // The formula is affine in the width: what is missing is added, not multiplied.
                let wanted = aims[mark][p] + self.asked[mark][p] * (1.0 - 1.0 / ratio);
                let with = |width: f64| {
                    let mut values = aims[mark].clone();
                    values[p] = width;
                    self.cuts(mesh, mark, &values)
                };
                match with(wanted) {
                    Ok(_) => aims[mark][p] = wanted,
                    Err(WidthError { low, high, .. }) => {
                        // As near as the edge allows; the report says what was reached.
                        let inside = wanted.min(high * (1.0 - 1e-9)).max(low * (1.0 + 1e-9));
                        if with(inside).is_ok() {
                            aims[mark][p] = inside;
                        }
                    }
                }
            }
        }
    }
}
