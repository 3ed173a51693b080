//! What a run needs to know before the mesh is changed: which feature each mark asks for, in which direction it
//! counts, and what it is to measure.

use super::clock::Clock;
use super::curve::{Track, trace};
use super::enclosed::enclosed;
use super::place::{crossing_sine, cuts, freedom};
use super::report::Counts;
use super::request::{Feature, feature_of};
use super::section::Section;
use super::{FeatureError, Options, Request};
use crate::mark::{Mark, Selection, orient, parity};
use crate::mesh::{HalfEdgeId, Mesh, VertexId};
use glam::DVec3;
use rustc_hash::{FxHashMap, FxHashSet};

/// Distance that vertices keep from a curve, in half widths of the control band: a third of a half width beyond the rim
/// (docs/linear-features.md, section 6).
const CLEARANCE: f64 = 4.0 / 3.0;
/// Room that a curve without width keeps from vertices, as a fraction of the edge.
const LEAST_ROOM: f64 = 0.03;

/// Everything that stays the same while the pipeline runs.
pub(super) struct Run<'a> {
    pub(super) request: &'a Request,
    pub(super) options: &'a Options,
    pub(super) selection: &'a Selection,
    /// The features of the request, and those that marks ask for by name.
    pub(super) features: Vec<Feature>,
    /// The marks, turned so that those of one chain count in the same direction.
    pub(super) marks: Vec<Mark>,
    /// Marks that make odd faces even, and what was done about those; none without features.
    pub(super) parity: Vec<Mark>,
    pub(super) parity_report: Option<parity::Report>,
    /// The vertices of the marked edges, as the selection names them; those of the parity lines follow.
    pub(super) edges: Vec<(u32, u32)>,
    /// The feature of each mark; empty without features.
    pub(super) feature_of: Vec<usize>,
    /// Parameters asked for per mark, in model units; empty without features.
    pub(super) asked: Vec<Vec<f64>>,
    /// The straight band that these make at each mark.
    sections: Vec<Section>,
    /// How far the ends of each marked edge may make room, in model units.
    freedom: Vec<[f64; 2]>,
    /// Vertices inside of closed loops and their features.
    pub(super) inside: Vec<(VertexId, usize)>,
    /// Curves on the surface, and the curve that each mark lies on.
    pub(super) tracks: Vec<Track>,
    pub(super) track_of: Vec<Option<usize>>,
    /// Vertices that lie in the way of bands along curves, and where they go.
    pub(super) moved: Vec<(VertexId, DVec3)>,
    /// Sides of edges behind which a curve ends, and how far into the face.
    pub(super) ends: Vec<(HalfEdgeId, f64)>,
    pub(super) before: Counts,
    /// Ids below these were there before.
    pub(super) first_vertex: usize,
    pub(super) first_face: usize,
    /// Vertices that the fit of an earlier pass took back, ascending: it would come to the same in the next one.
    pub(super) taken_back: Vec<VertexId>,
    pub(super) clock: Clock,
}

impl<'a> Run<'a> {
    pub(super) fn prepare(
        mesh: &Mesh,
        selection: &'a Selection,
        request: &'a Request,
        options: &'a Options,
    ) -> Result<Self, FeatureError> {
        if request.features.is_empty() && !selection.curves.is_empty() {
            let problem = "rules alone follow no curve; ask for a feature".to_owned();
            return Err(FeatureError::Curve { curve: 0, problem });
        }
        if selection.marks.is_empty() && selection.curves.is_empty() {
            return Err(FeatureError::NoMarks);
        }
        if let Some(mark) = selection.marks.iter().position(|mark| !mesh.has_half_edge(mark.half_edge)) {
            return Err(FeatureError::NoSuchEdge { mark });
        }
        let [vertices, edges, faces] = mesh.counts();
        let mut run = Self {
            request,
            options,
            selection,
            features: request.features.clone(),
            marks: selection.marks.clone(),
            edges: selection
                .marks
                .iter()
                .map(|mark| (mesh.source(mark.half_edge).0, mesh.target(mark.half_edge).0))
                .collect(),
            parity: Vec::new(),
            parity_report: None,
            feature_of: Vec::new(),
            asked: Vec::new(),
            sections: Vec::new(),
            freedom: Vec::new(),
            inside: Vec::new(),
            tracks: Vec::new(),
            track_of: vec![None; selection.marks.len()],
            moved: Vec::new(),
            ends: Vec::new(),
            before: Counts { vertices, edges, faces },
            first_vertex: mesh.vertex_bound(),
            first_face: mesh.face_bound(),
            taken_back: Vec::new(),
            clock: Clock::start(),
        };
        if !request.features.is_empty() {
            run.trace_curves(mesh)?;
            run.assign(mesh)?;
        }
        Ok(run)
    }

    /// Finds the edges that the curves of the selection cross, and adds them to the marks.
    fn trace_curves(&mut self, mesh: &Mesh) -> Result<(), FeatureError> {
        let mut crossed: FxHashSet<u32> = self.marks.iter().map(|mark| mark.half_edge.edge()).collect();
        for (index, curve) in self.selection.curves.iter().enumerate() {
            let Some(feature) = feature_of(&mut self.features, &curve.kind) else {
                let known: Vec<&str> = self.features.iter().map(|feature| feature.kind.as_str()).collect();
                let problem = format!(
                    "no feature has the name of its kind, #{}; there are {}",
                    curve.kind,
                    known.join(", ")
                );
                return Err(FeatureError::Curve { curve: index, problem });
            };
            let feature = &self.features[feature];
            // Distance that vertices keep from the curve: where it is least, the width must still be possible.
            let room = |edge: f64| {
                let values = feature.values(edge, edge);
                let section = Section::new(&feature.profile, &values);
                let width = feature.profile.width().map_or(0.0, |p| values[p]);
                let half_width = width / section.full_width(1.0, 2.0 * CLEARANCE, 0.5).max(f64::MIN_POSITIVE);
                (CLEARANCE * half_width).max(LEAST_ROOM * edge)
            };
            let traced = trace(mesh, curve, index, room)?;
            for mark in traced.marks {
                let edge = (mesh.source(mark.half_edge).0, mesh.target(mark.half_edge).0);
                if !crossed.insert(mark.half_edge.edge()) {
                    return Err(FeatureError::CrossedTwice { edge, curve: index });
                }
                self.edges.push(edge);
                self.track_of.push(Some(index));
                self.marks.push(mark);
            }
            self.moved.extend(traced.moved);
            self.ends.extend(traced.ends);
            self.tracks.push(traced.track);
        }
        Ok(())
    }

    fn assign(&mut self, mesh: &Mesh) -> Result<(), FeatureError> {
        for mark in 0..self.marks.len() {
            let kind = &self.marks[mark].kind;
            let Some(feature) = feature_of(&mut self.features, kind) else {
                return Err(FeatureError::UnknownKind {
                    edge: self.edges[mark],
                    kind: kind.clone(),
                    known: self.features.iter().map(|feature| feature.kind.clone()).collect(),
                });
            };
            self.feature_of.push(feature);
        }
        let chains = orient(mesh, &mut self.marks);
        for (index, feature) in self.features.iter().enumerate().filter(|(_, f)| f.profile.inside.is_some()) {
            let chosen: Vec<usize> = (0..self.marks.len()).filter(|&i| self.feature_of[i] == index).collect();
            let found = enclosed(mesh, &mut self.marks, &chosen, &chains, &feature.kind)?;
            self.inside.extend(found.into_iter().map(|v| (v, index)));
        }
        for (mark, &feature) in self.marks.iter().zip(&self.feature_of) {
            let feature = &self.features[feature];
            let length = mesh.edge_length(mark.half_edge);
            // A share of an edge that is crossed at a slant is a share of its extent across the feature.
            let breadth = mark.breadth.unwrap_or_else(|| length * crossing_sine(mesh, mark));
            let values = feature.values(length, breadth);
            self.sections.push(Section::new(&feature.profile, &values));
            self.asked.push(values);
        }
        let by_edge: FxHashMap<u32, &Mark> =
            self.marks.iter().map(|mark| (mark.half_edge.edge(), mark)).collect();
        self.freedom = self.marks.iter().map(|mark| freedom(mesh, mark, &by_edge)).collect();
        // Refuse widths that do not fit before anything is done.
        for (mark, values) in self.asked.iter().enumerate() {
            self.cuts(mesh, mark, values)?;
        }
        Ok(())
    }

    /// Where the lines of mark number `mark` lie on its edge, for these values of the feature's parameters. The heights
    /// are those asked for: a correction of them changes the shape of the section, and its width, very little.
    pub(super) fn cuts(
        &self,
        mesh: &Mesh,
        mark: usize,
        values: &[f64],
    ) -> Result<Vec<f64>, super::WidthError> {
        let width = self.features[self.feature_of[mark]].profile.width().map(|p| values[p]);
        cuts(mesh, &self.marks[mark], &self.sections[mark], width, self.freedom[mark])
    }

    /// Number of lines that cross the edge of mark number `mark`.
    pub(super) fn line_count(&self, mark: usize) -> usize {
        self.sections[mark].lines.len()
    }
}
