//! The report of a run that went through.

use super::aftermath::{affected_faces, feature_edges, settle, without_texcoords};
use super::curve::off_curve;
use super::displace::LineVertex;
use super::linear::Pass;
use super::prepare::Run;
use super::profile::Unit;
use super::report::{Counts, Dimension, FeatureReport, OffCurve, Report, Warning};
use super::{FeatureError, deviation};
use crate::job::Job;
use crate::mesh::{Mesh, VertexId};
use crate::subdivision::limit_position;
use glam::DVec3;
use std::collections::BTreeMap;

/// Dimensions that miss the asked one by more than this fraction are counted in the report.
const NOTICEABLE: f64 = 0.03;

/// Puts vertices elsewhere; where they were.
fn exchange(mesh: &mut Mesh, places: &[(VertexId, DVec3)]) -> Vec<(VertexId, DVec3)> {
    let before = places.iter().map(|&(v, _)| (v, mesh.position(v))).collect();
    places.iter().for_each(|&(v, position)| mesh.set_position(v, position));
    before
}

impl Run<'_> {
    pub(super) fn report(
        &mut self,
        mesh: &mut Mesh,
        pass: Pass,
        corrections: u32,
        reference: Option<&deviation::Reference>,
        walls: Option<&deviation::Walls>,
        job: &Job,
    ) -> Result<Report, FeatureError> {
        job.step("report", 0.8)?;
        let leftovers = settle(mesh, !self.features.is_empty(), &self.edges);
        if self.options.strict && !leftovers.is_empty() {
            return Err(FeatureError::Unresolved { leftovers });
        }
        let [mut inserted, mut fitted, mut displaced] = [None, None, None];
        if let Some(reference) = reference {
            let difference = |mesh: &Mesh| reference.difference(mesh, &pass.changed, job);
            let raised = exchange(mesh, &pass.flat);
            let is_raised = pass.flat != raised;
            let flat = difference(mesh)?;
            // The surface before the fit once more, for comparison.
            let moved = exchange(mesh, &pass.unfitted);
            inserted = Some(if moved == pass.unfitted { flat.clone() } else { difference(mesh)? });
            fitted = Some(flat);
            exchange(mesh, &moved);
            exchange(mesh, &raised);
            if is_raised {
                displaced = Some(difference(mesh)?);
            }
        }
        let mut warnings = Vec::new();
        if !pass.folds.is_empty() {
            warnings.push(Warning::Fold { vertices: pass.folds.clone() });
        }
        if let Some(walls) = walls {
            warnings.extend(walls.warning(&pass.greens));
        }
        self.clock.lap("deviation");
        let [vertices, edges, faces] = mesh.counts();
        let mut new_valences = BTreeMap::new();
        for v in (self.first_vertex..mesh.vertex_bound()).map(|v| VertexId(v as u32)) {
            if mesh.has_vertex(v) {
                *new_valences.entry(mesh.valence(v)).or_default() += 1;
            }
        }
        Ok(Report {
            feature: self.request.title(),
            before: self.before,
            after: Counts { vertices, edges, faces },
            marks: self.marks.len(),
            ends: self.selection.ends.clone(),
            non_quads: pass
                .changed
                .iter()
                .map(|&f| (f.0, mesh.arity(f)))
                .filter(|&(_, arity)| arity != 4)
                .collect(),
            new_valences,
            rules: pass.outcome.applications.clone(),
            leftovers,
            parity: self.parity_report.clone(),
            features: self.features(mesh, &pass),
            fit: pass.fit,
            corrections,
            inserted,
            fitted,
            displaced,
            size: reference.map(|reference| reference.size()),
            without_texcoords: without_texcoords(mesh, &pass.changed),
            warnings,
            green: pass.greens.iter().map(|green| green.vertex.0).collect(),
            feature_edges: feature_edges(mesh, &pass.lines),
            affected: affected_faces(mesh, &pass.changed, self.options.method.active_rings())
                .into_iter()
                .map(|f| f.0)
                .collect(),
            times: self.clock.laps(),
        })
    }

    fn features(&self, mesh: &Mesh, pass: &Pass) -> Vec<FeatureReport> {
        self.features
            .iter()
            .enumerate()
            .map(|(index, feature)| FeatureReport {
                kind: feature.kind.clone(),
                profile: feature.profile.name.clone(),
                off_curve: self.off_curve(mesh, index, pass),
                off_ends: self.off_ends(mesh, index, pass),
                marks: self.feature_of.iter().filter(|&&f| f == index).count(),
                dimensions: (0..feature.profile.parameters.len())
                    .filter(|&p| feature.profile.parameters[p].unit == Unit::Length)
                    .map(|p| self.dimension(index, p, pass))
                    .collect(),
            })
            .filter(|entry| entry.marks > 0)
            .collect()
    }

    /// Distance between the middle line of a feature and the curves it follows, on the limit surface.
    fn off_curve(&self, mesh: &Mesh, feature: usize, pass: &Pass) -> Option<OffCurve> {
        let track_of = |mark: usize| {
            self.track_of.get(mark).copied().flatten().filter(|_| self.feature_of[mark] == feature)
        };
        let middle = |feature: usize| self.features[feature].profile.middle();
        let [max, rms] = off_curve(mesh, &pass.lines, &self.tracks, track_of, middle)?;
        Some(OffCurve { max, rms })
    }

    /// Distance between the tips of a feature and the ends of the curves it follows.
    fn off_ends(&self, mesh: &Mesh, feature: usize, pass: &Pass) -> Vec<f64> {
        let middle = self.features[feature].profile.middle();
        let on_middle = |v: &&LineVertex| v.feature == feature && Some(v.line) == middle;
        let find = |v: VertexId| pass.lines.binary_search_by_key(&v, |entry| entry.vertex).ok();
        let middles = |v: VertexId| -> Vec<&LineVertex> {
            let around = mesh.outgoing(v).filter_map(|h| pass.lines.get(find(mesh.target(h))?));
            around.filter(on_middle).collect()
        };
        // A tip lies inside of a face, at the end of the middle line.
        let tips = pass.lines.iter().filter(on_middle).filter(|v| v.mark.is_none() && v.cross.is_none());
        tips.filter_map(|tip| {
            let [last] = middles(tip.vertex)[..] else { return None };
            let track = self.track_of.get(last.mark?).copied().flatten()?;
            self.tracks.get(track)?.off_end(limit_position(mesh, tip.vertex))
        })
        .collect()
    }

    fn dimension(&self, feature: usize, parameter: usize, pass: &Pass) -> Dimension {
        let found: Vec<(usize, f64)> = pass
            .stations
            .iter()
            .zip(&pass.reached)
            .filter(|(station, _)| self.feature_of[station.mark] == feature)
            .filter_map(|(station, reached)| Some((station.mark, (*reached.get(parameter)?)?)))
            .collect();
        let asked = |mark: usize| self.asked[mark][parameter];
        let count = found.len() as f64;
        let ratios = || found.iter().map(|&(mark, reached)| (mark, reached / asked(mark)));
        // Means and extremes of nothing are no numbers.
        let extreme = |pick: fn(f64, f64) -> f64| ratios().map(|r| r.1).fold(f64::NAN, pick);
        let feature = &self.features[feature];
        Dimension {
            name: feature.profile.parameters[parameter].name.clone(),
            asked: feature.length(parameter),
            stations: found.len(),
            asked_mean: found.iter().map(|&(mark, _)| asked(mark)).sum::<f64>() / count,
            reached_mean: found.iter().map(|pair| pair.1).sum::<f64>() / count,
            off: ratios()
                .filter(|(_, ratio)| (ratio - 1.0).abs() > NOTICEABLE)
                .map(|(mark, _)| self.edges[mark])
                .collect(),
            worst_low: extreme(f64::min),
            worst_high: extreme(f64::max),
        }
    }
}
