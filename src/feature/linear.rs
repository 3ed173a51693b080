//! The pipeline of a linear feature, and of any rule set on marked edges.

use super::correct::worst;
use super::curve::centre;
use super::displace::{Asked, Green, LineVertex, displace, greens, line_vertices};
use super::measure::{Station, stations};
use super::prepare::Run;
use super::report::Report;
use super::{FeatureError, Options, Request, deviation};
use crate::grammar;
use crate::job::Job;
use crate::mark::{self, Mark, Selection, parity};
use crate::mesh::{FaceId, Mesh, Node, Value, VertexId, is_place};
use crate::optimise::{self, FitReport, Target};
use crate::subdivision::limit_normal;
use crate::surface::Sampling;
use glam::DVec3;
use rustc_hash::FxHashMap;

/// Reached width or depth within this fraction of the asked one needs no correction.
const GOOD_ENOUGH: f64 = 3e-3;
/// Corrections at most. One is enough on even grids; where the length of the crossed edges jumps, the widths of
/// neighbouring edges work on each other.
const MOST_CORRECTIONS: u32 = 4;

/// Applies the features of `request` to the edges of `selection`.
///
/// The mesh is changed in place and compacted; the report speaks of the result.
///
/// # Errors
/// See [`FeatureError`]; the mesh is as it was then.
pub fn apply(
    mesh: &mut Mesh,
    selection: &Selection,
    request: &Request,
    options: &Options,
    job: &Job,
) -> Result<Report, FeatureError> {
    let mut run = Run::prepare(mesh, selection, request, options)?;
    let checkpoint = mesh.begin();
    match run.execute(mesh, job) {
        Ok(mut report) => {
            mesh.commit(checkpoint);
            let map = mesh.compact();
            report.renumber(&map);
            Ok(report)
        }
        Err(error) => {
            mesh.rollback(checkpoint);
            Err(error)
        }
    }
}

/// What one pass through place, rewrite, fit, displace, measure gave.
pub(super) struct Pass {
    pub(super) outcome: grammar::Outcome,
    pub(super) changed: Vec<FaceId>,
    pub(super) fit: FitReport,
    pub(super) lines: Vec<LineVertex>,
    pub(super) greens: Vec<Green>,
    pub(super) stations: Vec<Station>,
    /// What was reached of the parameters at each station.
    pub(super) reached: Vec<Vec<Option<f64>>>,
    pub(super) folds: Vec<u32>,
    /// Positions of the displaced vertices before displacement.
    pub(super) flat: Vec<(VertexId, DVec3)>,
    /// Positions of the vertices that the fit may move, before it.
    pub(super) unfitted: Vec<(VertexId, DVec3)>,
}

impl Run<'_> {
    fn execute(&mut self, mesh: &mut Mesh, job: &Job) -> Result<Report, FeatureError> {
        self.route_parity(mesh, job)?;
        let crossed = self.crossed_faces(mesh);
        let mut region = crossed.clone();
        // Rules change the faces around the crossed ones too.
        for _ in 0..1 + self.options.method.frozen_rings() {
            region = mesh.grow_faces(&region);
        }
        let footprint = mesh.grow_faces(&crossed);
        let measured = self.options.samples > 0;
        let sampling = Sampling { per_side: self.options.samples, threads: self.options.threads };
        let deepest = self.deepest();
        let active_rings = self.options.method.active_rings();
        let reference = measured
            .then(|| deviation::Reference::freeze(mesh, &crossed, footprint, sampling, active_rings))
            .transpose()?;
        let walls = measured.then(|| deviation::Walls::around(mesh, &crossed, deepest)).transpose()?;
        let mut target = Target::freeze(mesh, &region, job)?;
        self.clock.lap("freeze");

        let mut corrections = 0;
        // Parameters per mark that a pass aims at, so that the asked ones are reached.
        let mut aims = self.asked.clone();
        // The best pass so far: its worst miss, and what it aimed at.
        let mut best: Option<(f64, Vec<Vec<f64>>)> = None;
        let pass = loop {
            let checkpoint = mesh.begin();
            let pass = self.pass(mesh, &aims, &target, job)?;
            if let Some(wider) = self.uncovered(mesh, &pass.changed, &region) {
                // Rules reached further than the frozen surface: freeze more and start again.
                mesh.rollback(checkpoint);
                region = mesh.grow_faces(&wider);
                target = Target::freeze(mesh, &region, job)?;
                self.taken_back.clear();
                continue;
            }
            let misses = self.misses(&pass);
            let miss = worst(&misses);
            let is_best = best.as_ref().is_none_or(|best| miss <= best.0);
            if miss <= GOOD_ENOUGH || (is_best && corrections >= MOST_CORRECTIONS) {
                mesh.commit(checkpoint);
                break pass;
            }
            if !is_best && corrections >= MOST_CORRECTIONS {
                // The last correction made it worse: do the best one again.
                mesh.rollback(checkpoint);
                if let Some((_, best)) = best.take() {
                    aims = best;
                }
                continue;
            }
            mesh.rollback(checkpoint);
            if is_best {
                best = Some((miss, aims.clone()));
            }
            self.correct(mesh, &misses, &mut aims);
            corrections += 1;
        };
        let is_beyond = |v: &VertexId| !is_place(mesh.position(*v));
        if let Some(vertex) = pass.unfitted.iter().map(|entry| entry.0).find(is_beyond) {
            return Err(FeatureError::Beyond { vertex: vertex.0 });
        }
        self.report(mesh, pass, corrections, reference.as_ref(), walls.as_ref(), job)
    }

    /// Marks the edges that make odd faces even.
    fn route_parity(&mut self, mesh: &Mesh, job: &Job) -> Result<(), FeatureError> {
        if self.features.is_empty() {
            return Ok(());
        }
        let marks: Vec<_> =
            self.marks.iter().enumerate().map(|(i, mark)| (mark.half_edge, self.line_count(i))).collect();
        let (marks, report) = parity::route(mesh, &marks, self.options.parity, job)?;
        self.edges.extend(marks.iter().map(|m| (mesh.source(m.half_edge).0, mesh.target(m.half_edge).0)));
        self.parity = marks;
        self.parity_report = Some(report);
        self.clock.lap("parity");
        Ok(())
    }

    /// The real faces beside the marked edges.
    fn crossed_faces(&self, mesh: &Mesh) -> Vec<FaceId> {
        let mut faces: Vec<FaceId> = self
            .marks
            .iter()
            .chain(&self.parity)
            .flat_map(|mark| [mark.half_edge, mark.half_edge.mate()])
            .map(|h| mesh.face(h))
            .filter(|f| !f.is_boundary())
            .collect();
        faces.sort_unstable();
        faces.dedup();
        faces
    }

    /// The frozen faces and those that are missing among them, when the fit needs more than `region`.
    fn uncovered(&self, mesh: &Mesh, changed: &[FaceId], region: &[FaceId]) -> Option<Vec<FaceId>> {
        let rings = self.options.method.frozen_rings();
        let needed = (0..rings).fold(changed.to_vec(), |faces, _| mesh.grow_faces(&faces));
        let mut needed: Vec<FaceId> = needed.into_iter().map(|f| mesh.original_face(f)).collect();
        needed.sort_unstable();
        needed.dedup();
        needed.retain(|f| region.binary_search(f).is_err() && f.index() < self.first_face);
        if needed.is_empty() {
            return None;
        }
        needed.extend_from_slice(region);
        Some(needed)
    }

    fn pass(
        &mut self,
        mesh: &mut Mesh,
        aims: &[Vec<f64>],
        target: &Target,
        job: &Job,
    ) -> Result<Pass, FeatureError> {
        job.step("rules", 0.1)?;
        self.moved.iter().for_each(|&(v, position)| mesh.set_position(v, position));
        self.place_marks(mesh, aims)?;
        let run_options = grammar::RunOptions {
            parameters: self.request.numbers.clone(),
            job: Some(job),
            tracer: self.options.tracer.as_deref(),
            limits: self.options.limits,
        };
        let outcome = grammar::run(&self.request.rules, mesh, &run_options)?;
        let changed = self.changed(mesh, &outcome);
        let lines = line_vertices(mesh, |kind| self.kind(kind));
        let track_of = |mark: usize| self.track_of.get(mark).copied().flatten();
        centre(mesh, &lines, &self.tracks, track_of, |feature| self.features[feature].profile.middle());
        self.clock.lap("rules");

        job.step("fit", 0.3)?;
        let active = optimise::active_set(mesh, &changed, self.options.method);
        let unfitted = active.iter().map(|&v| (v, mesh.position(v))).collect();
        let is_free = |v: &VertexId| self.taken_back.binary_search(v).is_err();
        let free: Vec<VertexId> = active.iter().copied().filter(is_free).collect();
        let mut fit = optimise::fit(mesh, &free, target, self.options.method, job)?;
        fit.active = active.len();
        fit.held += active.len() - free.len();
        self.taken_back.extend_from_slice(&fit.taken_back);
        self.taken_back.sort_unstable();
        self.clock.lap("fit");

        job.step("displace", 0.6)?;
        let mut pass = Pass {
            outcome,
            changed,
            fit,
            lines,
            greens: Vec::new(),
            stations: Vec::new(),
            reached: Vec::new(),
            folds: Vec::new(),
            flat: Vec::new(),
            unfitted,
        };
        if !self.features.is_empty() {
            let asked = Asked {
                features: &self.features,
                feature_of: &self.feature_of,
                aims,
                asked: &self.asked,
                inside: &self.inside,
            };
            pass.greens = greens(mesh, &pass.lines, &asked);
            self.raise(mesh, &active, &mut pass);
        }
        self.clock.lap("displace");
        Ok(pass)
    }

    /// Faces that the rules touched, and those whose vertices made room for a curve.
    fn changed(&self, mesh: &Mesh, outcome: &grammar::Outcome) -> Vec<FaceId> {
        let mut changed = outcome.touched.clone();
        if !self.moved.is_empty() {
            let around = self.moved.iter().flat_map(|&(v, _)| mesh.outgoing(v)).map(|h| mesh.face(h));
            changed.extend(around.filter(|f| !f.is_boundary()));
            changed.sort_unstable();
            changed.dedup();
        }
        changed
    }

    /// The feature that a kind on a vertex names.
    fn kind(&self, kind: &str) -> Option<usize> {
        self.features.iter().position(|feature| feature.kind == kind)
    }

    /// The greatest distance that anything is to move inwards or outwards.
    fn deepest(&self) -> f64 {
        self.asked
            .iter()
            .zip(&self.feature_of)
            .flat_map(|(values, &f)| self.features[f].profile.extents().map(|extent| extent.of(values).abs()))
            .fold(0.0, f64::max)
    }

    fn place_marks(&self, mesh: &mut Mesh, aims: &[Vec<f64>]) -> Result<(), FeatureError> {
        mark::place(mesh, &self.marks);
        for (i, (mark, values)) in self.marks.iter().zip(aims).enumerate() {
            let kind = &self.features[self.feature_of[i]].kind;
            place_lines(mesh, mark, i, self.cuts(mesh, i, values)?, kind);
        }
        let end = mesh.intern("end");
        for &(h, depth) in &self.ends {
            mesh.set_attribute(Node::HalfEdge(h), end, Some(Value::Number(depth)));
        }
        mark::place(mesh, &self.parity);
        for (i, mark) in (self.marks.len()..).zip(&self.parity) {
            place_lines(mesh, mark, i, vec![mark.t], &mark.kind);
        }
        Ok(())
    }

    /// Displaces the green vertices, measures what was reached and looks for folds.
    fn raise(&self, mesh: &mut Mesh, active: &[VertexId], pass: &mut Pass) {
        pass.flat = pass.greens.iter().map(|green| (green.vertex, mesh.position(green.vertex))).collect();
        let flat: FxHashMap<VertexId, DVec3> = pass.flat.iter().copied().collect();
        let normals: Vec<Option<DVec3>> = active.iter().map(|&v| limit_normal(mesh, v)).collect();
        displace(mesh, &pass.greens);
        let line_counts: Vec<usize> =
            self.feature_of.iter().map(|&f| self.features[f].profile.lines.len()).collect();
        pass.stations = stations(mesh, &pass.lines, &line_counts);
        pass.reached = pass
            .stations
            .iter()
            .map(|station| {
                station.measure(
                    &self.features[self.feature_of[station.mark]].profile,
                    |v| flat.get(&v).copied().unwrap_or_else(|| mesh.position(v)),
                    |v| mesh.position(v),
                )
            })
            .collect();
        pass.folds = active
            .iter()
            .zip(normals)
            .filter(|&(&v, before)| {
                before.zip(limit_normal(mesh, v)).is_some_and(|(before, after)| before.dot(after) <= 0.0)
            })
            .map(|(&v, _)| v.0)
            .collect();
    }
}

/// Writes on both sides of a marked edge where its lines lie.
fn place_lines(mesh: &mut Mesh, mark: &Mark, number: usize, forward: Vec<f64>, kind: &str) {
    let [cuts_name, lines_name, mark_name, color, skew] =
        ["cuts", "lines", "mark", "color", "skew"].map(|name| mesh.intern(name));
    let lines: Vec<f64> = (1..=forward.len()).map(|line| line as f64).collect();
    let backward: Vec<f64> = forward.iter().rev().map(|t| 1.0 - t).collect();
    let reversed: Vec<f64> = lines.iter().rev().copied().collect();
    let kind = Value::text(kind);
    let h = mark.half_edge;
    for (h, cuts, lines) in [(h, forward, lines), (h.mate(), backward, reversed)] {
        let node = Node::HalfEdge(h);
        mesh.set_attribute(node, cuts_name, Some(Value::Numbers(cuts.into())));
        mesh.set_attribute(node, lines_name, Some(Value::Numbers(lines.into())));
        mesh.set_attribute(node, mark_name, Some(Value::Number(number as f64)));
        mesh.set_attribute(node, color, Some(kind.clone()));
        if mark.breadth.is_some() {
            mesh.set_attribute(node, skew, Some(Value::Number(1.0)));
        }
    }
}
