//! What a run needs to know before the mesh is changed: which feature each mark asks for, in which direction it
//! counts, and what it is to measure.

use super::clock::Clock;
use super::enclosed::enclosed;
use super::place::{crossing_sine, cuts};
use super::profile::Unit;
use super::report::Counts;
use super::request::{Feature, feature_of};
use super::section::Section;
use super::{FeatureError, Options, Request};
use crate::mark::{Mark, Selection, orient};
use crate::mesh::{Mesh, VertexId};

/// Everything that stays the same while the pipeline runs.
pub(super) struct Run<'a> {
    pub(super) request: &'a Request,
    pub(super) options: &'a Options,
    pub(super) selection: &'a Selection,
    /// The features of the request, and those that marks ask for by name.
    pub(super) features: Vec<Feature>,
    /// The marks, turned so that those of one chain count in the same direction.
    pub(super) marks: Vec<Mark>,
    /// The vertices of the marked edges, as the selection names them.
    pub(super) edges: Vec<(u32, u32)>,
    /// The feature of each mark; empty without features.
    pub(super) feature_of: Vec<usize>,
    /// Parameters asked for per mark, in model units; empty without features.
    pub(super) asked: Vec<Vec<f64>>,
    /// Vertices inside of closed loops and their features.
    pub(super) inside: Vec<(VertexId, usize)>,
    pub(super) before: Counts,
    /// Ids below these were there before.
    pub(super) first_vertex: usize,
    pub(super) first_face: usize,
    pub(super) clock: Clock,
}

impl<'a> Run<'a> {
    pub(super) fn prepare(
        mesh: &Mesh,
        selection: &'a Selection,
        request: &'a Request,
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
            feature_of: Vec::new(),
            asked: Vec::new(),
            inside: Vec::new(),
            before: Counts { vertices, edges, faces },
            first_vertex: mesh.vertex_bound(),
            first_face: mesh.face_bound(),
            clock: Clock::start(),
        };
        if !request.features.is_empty() {
            run.assign(mesh)?;
        }
        Ok(run)
    }

    fn assign(&mut self, mesh: &Mesh) -> Result<(), FeatureError> {
        for (mark, &edge) in self.marks.iter().zip(&self.edges) {
            let Some(feature) = feature_of(&mut self.features, &mark.kind) else {
                return Err(FeatureError::UnknownKind {
                    edge,
                    kind: mark.kind.clone(),
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
            let values = feature.profile.parameters.iter().enumerate().map(|(p, parameter)| {
                match parameter.unit {
                    Unit::Count => feature.length(p).value(),
                    // A share of an edge that is crossed at a slant is a share of its extent across the feature.
                    Unit::Length if Some(p) == feature.profile.width() => {
                        feature.length(p).on_edge(length * crossing_sine(mesh, mark))
                    }
                    Unit::Length => feature.length(p).on_edge(length),
                }
            });
            self.asked.push(values.collect());
        }
        // Refuse widths that do not fit before anything is done.
        for (mark, values) in self.asked.iter().enumerate() {
            self.cuts(mesh, mark, values)?;
        }
        Ok(())
    }

    /// Where the lines of mark number `mark` lie on its edge, for these values of the feature's parameters.
    pub(super) fn cuts(
        &self,
        mesh: &Mesh,
        mark: usize,
        values: &[f64],
    ) -> Result<Vec<f64>, super::WidthError> {
        let profile = &self.features[self.feature_of[mark]].profile;
        let width = profile.width().map(|p| values[p]);
        cuts(mesh, &self.marks[mark], &Section::new(profile, values), width)
    }
}
