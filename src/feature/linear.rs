//! The pipeline of a linear feature, and of any rule set on marked edges.

use super::aftermath::{affected_faces, feature_edges, settle, without_texcoords};
use super::clock::Clock;
use super::displace::{Green, LineVertex, displace, greens, line_vertices};
use super::measure::{Reached, Station, stations};
use super::place::{WidthError, crossing_sine, cuts};
use super::report::{Counts, Dimension, Report, Warning};
use super::{Feature, FeatureError, Length, Options, Profile, deviation};
use crate::grammar;
use crate::job::Job;
use crate::mark::{self, Selection};
use crate::mesh::{FaceId, Mesh, Node, Value, VertexId};
use crate::optimise::{self, FitReport, Target};
use crate::subdivision::limit_normal;
use crate::surface::Sampling;
use glam::DVec3;
use rustc_hash::FxHashMap;
use std::collections::BTreeMap;

/// Rings of faces around the marked ones whose limit surface is frozen for the fit: the active vertices lie on the
/// faces around the changed ones.
const FIT_RINGS: usize = 2;
/// Reached width or depth within this fraction of the asked one needs no correction.
const GOOD_ENOUGH: f64 = 3e-3;
/// Dimensions that miss the asked one by more than this fraction are counted in the report.
const NOTICEABLE: f64 = 0.03;
/// Corrections at most. One is enough on even grids; where the length of the crossed edges jumps, the widths of
/// neighbouring edges work on each other.
const MOST_CORRECTIONS: u32 = 4;
/// A correction changes width or depth by at most this factor.
const LARGEST_CORRECTION: f64 = 2.0;

/// Applies `feature` to the edges of `selection`.
///
/// The mesh is changed in place and compacted; the report speaks of the result.
///
/// # Errors
/// See [`FeatureError`]; the mesh is as it was then.
pub fn apply(
    mesh: &mut Mesh,
    selection: &Selection,
    feature: &Feature,
    options: &Options,
    job: &Job,
) -> Result<Report, FeatureError> {
    let mut run = Run::prepare(mesh, selection, feature, options)?;
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

/// Everything that stays the same while the pipeline runs.
struct Run<'a> {
    feature: &'a Feature<'a>,
    options: &'a Options,
    selection: &'a Selection,
    /// The vertices of the marked edges.
    edges: Vec<(u32, u32)>,
    /// Asked width and depth per mark, in model units; empty without a profile.
    widths: Vec<f64>,
    extents: Vec<f64>,
    before: Counts,
    /// Ids below these were there before.
    first_vertex: usize,
    first_face: usize,
    clock: Clock,
}

/// Width and depth per mark that a pass aims at, so that the asked ones are reached.
#[derive(Clone)]
struct Aim {
    widths: Vec<f64>,
    extents: Vec<f64>,
}

/// The largest relative miss.
fn worst(misses: &[Option<[f64; 2]>]) -> f64 {
    misses.iter().flatten().flatten().fold(0.0, |worst, ratio| worst.max((ratio - 1.0).abs()))
}

/// What one pass through place, rewrite, fit, displace, measure gave.
struct Pass {
    outcome: grammar::Outcome,
    changed: Vec<FaceId>,
    fit: FitReport,
    lines: Vec<LineVertex>,
    greens: Vec<Green>,
    stations: Vec<Station>,
    reached: Vec<Option<Reached>>,
    folds: Vec<u32>,
    /// Positions of the displaced vertices before displacement.
    flat: Vec<(VertexId, DVec3)>,
}

impl<'a> Run<'a> {
    fn prepare(
        mesh: &Mesh,
        selection: &'a Selection,
        feature: &'a Feature<'a>,
        options: &'a Options,
    ) -> Result<Self, FeatureError> {
        if selection.marks.is_empty() {
            return Err(FeatureError::NoMarks);
        }
        if let Some(mark) = selection.marks.iter().position(|mark| !mesh.has_half_edge(mark.half_edge)) {
            return Err(FeatureError::NoSuchEdge { mark });
        }
        let [vertices, edges, faces] = mesh.counts();
        let mut run = Self {
            feature,
            options,
            selection,
            edges: selection
                .marks
                .iter()
                .map(|mark| (mesh.source(mark.half_edge).0, mesh.target(mark.half_edge).0))
                .collect(),
            widths: Vec::new(),
            extents: Vec::new(),
            before: Counts { vertices, edges, faces },
            first_vertex: mesh.vertex_bound(),
            first_face: mesh.face_bound(),
            clock: Clock::start(),
        };
        run.check_parameters()?;
        if let Some(profile) = feature.profile {
            let (width, extent) = (run.length(profile, "width"), run.length(profile, profile.extent));
            for mark in &selection.marks {
                let edge = mesh.edge_length(mark.half_edge);
                // A share of an edge that is crossed at a slant is a share of its extent across the feature.
                run.widths.push(width.on_edge(edge * crossing_sine(mesh, mark)));
                run.extents.push(extent.on_edge(edge));
            }
            // Refuse widths that do not fit before anything is done.
            for (mark, width) in selection.marks.iter().zip(&run.widths) {
                cuts(mesh, mark, profile, *width)?;
            }
        }
        Ok(run)
    }

    fn check_parameters(&self) -> Result<(), FeatureError> {
        let Some(profile) = self.feature.profile else { return Ok(()) };
        for (name, length) in &self.options.lengths {
            if !profile.parameters.iter().any(|p| p.name == name) {
                return Err(FeatureError::UnknownParameter {
                    feature: profile.name.to_owned(),
                    name: name.clone(),
                    known: profile.parameters.iter().map(|p| p.name.to_owned()).collect(),
                });
            }
            let (fine, remedy) = if name == "width" {
                (length.value() > 0.0, "it must be greater than 0")
            } else {
                (length.value() >= 0.0, "it must not be negative; a groove turned outwards is a ridge")
            };
            if !fine || !length.value().is_finite() {
                return Err(FeatureError::BadParameter {
                    name: name.clone(),
                    value: length.to_string(),
                    remedy,
                });
            }
        }
        Ok(())
    }

    fn length(&self, profile: &Profile, name: &str) -> Length {
        let default = profile.parameters.iter().find(|p| p.name == name).map(|p| p.default);
        self.options.lengths.get(name).copied().or(default).unwrap_or(Length::Units(0.0))
    }

    fn execute(&mut self, mesh: &mut Mesh, job: &Job) -> Result<Report, FeatureError> {
        let crossed = self.crossed_faces(mesh);
        let mut region = crossed.clone();
        for _ in 0..FIT_RINGS {
            region = mesh.grow_faces(&region);
        }
        let footprint = mesh.grow_faces(&crossed);
        let measured = self.options.samples > 0;
        let sampling = Sampling { per_side: self.options.samples, threads: self.options.threads };
        let deepest = self.extents.iter().fold(0.0, |a: f64, &b| a.max(b));
        let reference = measured.then(|| deviation::Reference::freeze(mesh, &crossed, footprint, sampling));
        let walls = measured.then(|| deviation::Walls::around(mesh, &crossed, deepest));
        let mut target = Target::freeze(mesh, &region);
        self.clock.lap("freeze");

        let mut corrections = 0;
        let mut aim = Aim { widths: self.widths.clone(), extents: self.extents.clone() };
        // The best pass so far: its worst miss, and what it aimed at.
        let mut best: Option<(f64, Aim)> = None;
        let pass = loop {
            let checkpoint = mesh.begin();
            let pass = self.pass(mesh, &aim, &target, job)?;
            if let Some(wider) = self.uncovered(mesh, &pass.changed, &region) {
                // Rules reached further than the frozen surface: freeze more and start again.
                mesh.rollback(checkpoint);
                region = mesh.grow_faces(&wider);
                target = Target::freeze(mesh, &region);
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
                    aim = best;
                }
                continue;
            }
            mesh.rollback(checkpoint);
            if is_best {
                best = Some((miss, aim.clone()));
            }
            self.correct(mesh, &misses, &mut aim);
            corrections += 1;
        };
        self.report(mesh, pass, corrections, reference.as_ref(), walls.as_ref(), job)
    }

    /// The real faces beside the marked edges.
    fn crossed_faces(&self, mesh: &Mesh) -> Vec<FaceId> {
        let mut faces: Vec<FaceId> = self
            .selection
            .marks
            .iter()
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
        let mut needed: Vec<FaceId> =
            mesh.grow_faces(changed).into_iter().map(|f| mesh.original_face(f)).collect();
        needed.sort_unstable();
        needed.dedup();
        needed.retain(|f| region.binary_search(f).is_err() && f.index() < self.first_face);
        if needed.is_empty() {
            return None;
        }
        needed.extend_from_slice(region);
        Some(needed)
    }

    fn pass(&mut self, mesh: &mut Mesh, aim: &Aim, target: &Target, job: &Job) -> Result<Pass, FeatureError> {
        job.step("rules", 0.1)?;
        self.place_marks(mesh, &aim.widths)?;
        let run_options = grammar::RunOptions {
            parameters: self.options.numbers.clone(),
            job: Some(job),
            ..grammar::RunOptions::default()
        };
        let outcome = grammar::run(self.feature.rules, mesh, &run_options)?;
        let changed = outcome.touched.clone();
        self.clock.lap("rules");

        job.step("fit", 0.3)?;
        let active = optimise::active_set(mesh, &changed);
        let fit = optimise::fit(mesh, &active, target, self.options.method, job)?;
        self.clock.lap("fit");

        job.step("displace", 0.6)?;
        let mut pass = Pass {
            outcome,
            changed,
            fit,
            lines: Vec::new(),
            greens: Vec::new(),
            stations: Vec::new(),
            reached: Vec::new(),
            folds: Vec::new(),
            flat: Vec::new(),
        };
        if let Some(profile) = self.feature.profile {
            pass.lines = line_vertices(mesh);
            pass.greens = greens(mesh, &pass.lines, profile, &aim.extents, &self.extents);
            self.raise(mesh, &active, profile, &mut pass);
        }
        self.clock.lap("displace");
        Ok(pass)
    }

    fn place_marks(&self, mesh: &mut Mesh, widths: &[f64]) -> Result<(), FeatureError> {
        mark::place(mesh, &self.selection.marks);
        let Some(profile) = self.feature.profile else { return Ok(()) };
        let [cuts_name, mark_name] = ["cuts", "mark"].map(|name| mesh.intern(name));
        for (i, (mark, width)) in self.selection.marks.iter().zip(widths).enumerate() {
            let forward = cuts(mesh, mark, profile, *width)?;
            let backward: Vec<f64> = forward.iter().rev().map(|t| 1.0 - t).collect();
            let h = mark.half_edge;
            mesh.set_attribute(Node::HalfEdge(h), cuts_name, Some(Value::Numbers(forward.into())));
            mesh.set_attribute(Node::HalfEdge(h.mate()), cuts_name, Some(Value::Numbers(backward.into())));
            for h in [h, h.mate()] {
                mesh.set_attribute(Node::HalfEdge(h), mark_name, Some(Value::Number(i as f64)));
            }
        }
        Ok(())
    }

    /// Displaces the green vertices, measures what was reached and looks for folds.
    fn raise(&self, mesh: &mut Mesh, active: &[VertexId], profile: &Profile, pass: &mut Pass) {
        pass.flat = pass.greens.iter().map(|green| (green.vertex, mesh.position(green.vertex))).collect();
        let flat: FxHashMap<VertexId, DVec3> = pass.flat.iter().copied().collect();
        let normals: Vec<Option<DVec3>> = active.iter().map(|&v| limit_normal(mesh, v)).collect();
        displace(mesh, &pass.greens);
        pass.stations = stations(mesh, &pass.lines, self.selection.marks.len(), profile.lines.len());
        pass.reached = pass
            .stations
            .iter()
            .map(|station| {
                station.measure(
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

    /// Changes what is aimed at by what was missed. The mesh is as before the pass.
    fn correct(&self, mesh: &Mesh, misses: &[Option<[f64; 2]>], aim: &mut Aim) {
        let Some(profile) = self.feature.profile else { return };
        for (i, miss) in misses.iter().enumerate() {
            let Some([width, extent]) = miss else { continue };
            let mark = &self.selection.marks[i];
            // The formula is affine in the width: what is missing is added, not multiplied.
            let wanted = aim.widths[i] + self.widths[i] * (1.0 - 1.0 / width);
            let fits = |width: f64| cuts(mesh, mark, profile, width).is_ok();
            match cuts(mesh, mark, profile, wanted) {
                Ok(_) => aim.widths[i] = wanted,
                Err(WidthError { low, high, .. }) => {
                    // As near as the edge allows; the report says what was reached.
                    let inside = wanted.min(high * (1.0 - 1e-9)).max(low * (1.0 + 1e-9));
                    if fits(inside) {
                        aim.widths[i] = inside;
                    }
                }
            }
            aim.extents[i] *= extent;
        }
    }

    /// Asked over reached width and extent per mark: measured, or the mean of the measured neighbours.
    fn misses(&self, pass: &Pass) -> Vec<Option<[f64; 2]>> {
        if self.feature.profile.is_none() {
            return Vec::new();
        }
        let mut measured: Vec<Option<[f64; 2]>> = vec![None; self.selection.marks.len()];
        let mut around: Vec<(f64, [f64; 2])> = vec![(0.0, [0.0; 2]); self.selection.marks.len()];
        for (station, reached) in pass.stations.iter().zip(&pass.reached) {
            let Some(reached) = reached else { continue };
            let ratio = |asked: f64, reached: f64| {
                let ratio = asked / reached;
                if ratio.is_finite() {
                    ratio.clamp(1.0 / LARGEST_CORRECTION, LARGEST_CORRECTION)
                } else {
                    1.0
                }
            };
            let correction = [
                ratio(self.widths[station.mark], reached.width),
                ratio(self.extents[station.mark], reached.extent),
            ];
            measured[station.mark] = Some(correction);
            for neighbour in station.neighbours {
                let (count, sum) = &mut around[neighbour];
                *count += 1.0;
                sum[0] += correction[0];
                sum[1] += correction[1];
            }
        }
        measured
            .into_iter()
            .zip(around)
            .map(|(own, (count, sum))| {
                own.or_else(|| (count > 0.0).then(|| [sum[0] / count, sum[1] / count]))
            })
            .collect()
    }

    fn report(
        &mut self,
        mesh: &mut Mesh,
        pass: Pass,
        corrections: u32,
        reference: Option<&deviation::Reference>,
        walls: Option<&deviation::Walls>,
        job: &Job,
    ) -> Result<Report, FeatureError> {
        job.step("report", 0.8)?;
        let leftovers = settle(mesh, self.feature.profile.is_some());
        let mut displaced = None;
        let mut fitted = None;
        if let Some(reference) = reference {
            let raised: Vec<DVec3> = pass.flat.iter().map(|&(v, _)| mesh.position(v)).collect();
            let is_raised = pass.flat.iter().zip(&raised).any(|((_, flat), raised)| flat != raised);
            if is_raised {
                displaced = Some(reference.difference(mesh, &pass.changed, job)?);
            }
            // The surface before displacement once more, for comparison.
            pass.flat.iter().for_each(|&(v, position)| mesh.set_position(v, position));
            fitted = Some(reference.difference(mesh, &pass.changed, job)?);
            pass.flat.iter().zip(raised).for_each(|(&(v, _), position)| mesh.set_position(v, position));
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
        let name = self.feature.profile.map_or(self.feature.rules.name(), |profile| profile.name);
        Ok(Report {
            feature: name.to_owned(),
            before: self.before,
            after: Counts { vertices, edges, faces },
            marks: self.selection.marks.len(),
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
            width: self.dimension("width", &self.widths, &pass, |reached| reached.width),
            extent: self
                .feature
                .profile
                .and_then(|p| self.dimension(p.extent, &self.extents, &pass, |reached| reached.extent)),
            fit: pass.fit,
            corrections,
            fitted,
            displaced,
            size: reference.map(|reference| reference.size()),
            without_texcoords: without_texcoords(mesh, &pass.changed),
            warnings,
            green: pass.greens.iter().map(|green| green.vertex.0).collect(),
            feature_edges: feature_edges(
                mesh,
                &pass.lines,
                self.feature.profile.map_or(0, |p| p.lines.len()),
            ),
            affected: affected_faces(mesh, &pass.changed).into_iter().map(|f| f.0).collect(),
            times: self.clock.laps(),
        })
    }

    fn dimension(
        &self,
        name: &'static str,
        asked: &[f64],
        pass: &Pass,
        part: impl Fn(&Reached) -> f64,
    ) -> Option<Dimension> {
        let profile = self.feature.profile?;
        let found: Vec<(usize, f64)> = pass
            .stations
            .iter()
            .zip(&pass.reached)
            .filter_map(|(station, reached)| Some((station.mark, part(reached.as_ref()?))))
            .collect();
        let count = found.len() as f64;
        let ratios = || found.iter().map(|&(mark, reached)| (mark, reached / asked[mark]));
        // Means and extremes of nothing are no numbers.
        let extreme = |pick: fn(f64, f64) -> f64| ratios().map(|r| r.1).fold(f64::NAN, pick);
        Some(Dimension {
            name,
            asked: self.length(profile, name),
            stations: found.len(),
            asked_mean: found.iter().map(|&(mark, _)| asked[mark]).sum::<f64>() / count,
            reached_mean: found.iter().map(|pair| pair.1).sum::<f64>() / count,
            off: ratios()
                .filter(|(_, ratio)| (ratio - 1.0).abs() > NOTICEABLE)
                .map(|(mark, _)| self.edges[mark])
                .collect(),
            worst_low: extreme(f64::min),
            worst_high: extreme(f64::max),
        })
    }
}
