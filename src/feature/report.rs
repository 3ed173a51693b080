//! What a feature did, for people and programs.

use super::length::{Length, significant};
use crate::mark::{StripEnd, parity};
use crate::mesh::{FaceId, Renumbering, VertexId};
use crate::optimise::FitReport;
use crate::surface::Deviation;
use serde::Serialize;
use std::collections::BTreeMap;
use std::fmt;

/// Numbers of elements.
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug, Serialize)]
pub struct Counts {
    /// Vertices.
    pub vertices: usize,
    /// Edges.
    pub edges: usize,
    /// Faces.
    pub faces: usize,
}

/// Asked and reached dimension over the straight stretches of a feature, in model units.
#[derive(Clone, PartialEq, Debug, Serialize)]
pub struct Dimension {
    /// Name of the parameter.
    pub name: String,
    /// What was asked for, as given.
    pub asked: Length,
    /// Marked edges at which the band runs straight, where it was measured.
    pub stations: usize,
    /// Mean of what was asked for at those edges (not a number, `null` in JSON, where there are none; so are the rest).
    pub asked_mean: f64,
    /// Mean of what was reached.
    pub reached_mean: f64,
    /// Marked edges (numbers of vertices before the feature) that are off by more than 3 %: what the edge allows, or
    /// what its neighbours leave.
    pub off: Vec<(u32, u32)>,
    /// Least reached as a fraction of what was asked for.
    pub worst_low: f64,
    /// Greatest reached as a fraction of what was asked for.
    pub worst_high: f64,
}

/// Distance, in the surface, between the middle line of a feature and the curves it follows; model units.
#[derive(Clone, Copy, PartialEq, Debug, Serialize)]
pub struct OffCurve {
    /// Greatest.
    pub max: f64,
    /// Root mean square.
    pub rms: f64,
}

/// What one of the features reached.
#[derive(Clone, PartialEq, Debug, Serialize)]
pub struct FeatureReport {
    /// The kind of its marks.
    pub kind: String,
    /// Its profile.
    pub profile: String,
    /// Its marked edges.
    pub marks: usize,
    /// How far it is off the curves it follows; `None` where it follows edges.
    pub off_curve: Option<OffCurve>,
    /// Where curves end inside the surface: how far, in the surface, the tips of the feature (where half of the depth is
    /// left) are from the ends of the curves, in model units.
    pub off_ends: Vec<f64>,
    /// Its dimensions, asked and reached.
    pub dimensions: Vec<Dimension>,
}

/// A mark that no rule could handle on one side of its edge.
#[derive(Clone, PartialEq, Eq, Debug, Serialize)]
pub struct LeftoverMark {
    /// The marked edge, by its vertices, which keep their numbers.
    pub edge: (u32, u32),
    /// The kind of the mark.
    pub kind: String,
}

/// A face that no rule could handle. Its marks are kept on the mesh, as the attribute `unresolved` of its half-edges:
/// the kind of the mark, on the half-edge of the face where the marked edge begins.
#[derive(Clone, PartialEq, Eq, Debug, Serialize)]
pub struct Leftover {
    /// The face, in the numbering of the result.
    pub face: u32,
    /// Its vertices.
    pub vertices: Vec<u32>,
    /// The marks on its sides.
    pub marks: Vec<LeftoverMark>,
}

/// Something the user should look at.
#[derive(Clone, PartialEq, Debug, Serialize)]
#[serde(rename_all = "snake_case", tag = "kind")]
pub enum Warning {
    /// The normal of the limit surface turned over at these vertices: the feature is too deep for the curvature.
    Fold {
        /// Vertices in the numbering of the result.
        vertices: Vec<u32>,
    },
    /// The feature is deeper than the material: the opposite wall is closer than the depth.
    Wall {
        /// The thinnest place, in model units.
        thickness: f64,
        /// The depth asked for there.
        depth: f64,
        /// The vertex in the numbering of the result.
        vertex: u32,
    },
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Fold { vertices } => write!(
                f,
                "the limit surface folds at {} vertices (first: {}); ask for less depth or more width",
                vertices.len(),
                vertices.first().copied().unwrap_or_default()
            ),
            Self::Wall { thickness, depth, vertex } => write!(
                f,
                "a depth of {} exceeds the wall, which is {} thick at vertex {vertex}",
                significant(*depth),
                significant(*thickness)
            ),
        }
    }
}

/// How far two limit surfaces are apart, over everything near the feature and outside its footprint.
#[derive(Clone, PartialEq, Debug, Serialize)]
pub struct Difference {
    /// Over all faces whose limit surface can have changed.
    pub total: Deviation,
    /// Without the footprint: the faces the band crosses and the faces around them.
    pub outside: Deviation,
}

/// The report of a feature. Ids are those of the result.
#[derive(Clone, PartialEq, Debug, Serialize)]
pub struct Report {
    /// Names of the features, or of the rule file.
    pub feature: String,
    /// Elements before.
    pub before: Counts,
    /// Elements after.
    pub after: Counts,
    /// Marked edges.
    pub marks: usize,
    /// Where rings stopped before they closed.
    pub ends: Vec<StripEnd>,
    /// Faces of the result that are no quads, among those the rules made or changed: (face, edges).
    pub non_quads: Vec<(u32, usize)>,
    /// Valences of the new vertices: valence -> how many.
    pub new_valences: BTreeMap<usize, usize>,
    /// Applications of each rule, in the order of the file.
    pub rules: Vec<(String, u64)>,
    /// Faces that no rule could handle.
    pub leftovers: Vec<Leftover>,
    /// What was done about odd faces; `None` for rule sets without a profile.
    pub parity: Option<parity::Report>,
    /// What the optimiser did.
    pub fit: FitReport,
    /// The features that were marked.
    pub features: Vec<FeatureReport>,
    /// Corrections of width and depth after a first measurement.
    pub corrections: u32,
    /// Deviation before the fit and the displacement; `None` unless asked for.
    pub inserted: Option<Difference>,
    /// Deviation after the fit, before displacement; `None` unless asked for.
    pub fitted: Option<Difference>,
    /// Deviation of the result; `None` unless asked for.
    pub displaced: Option<Difference>,
    /// Diagonal of the bounding box that relative figures refer to, when deviations were asked for.
    pub size: Option<f64>,
    /// Changed faces that lost their texture coordinates: a new corner has none, and a face keeps all or nothing.
    pub without_texcoords: usize,
    /// What to look at.
    pub warnings: Vec<Warning>,
    /// Vertices that were displaced, in the numbering of the result.
    pub green: Vec<u32>,
    /// Edges along the lines of the feature, for figures.
    #[serde(skip)]
    pub feature_edges: Vec<(u32, u32)>,
    /// Faces whose limit surface can differ from what it was, ascending.
    #[serde(skip)]
    pub affected: Vec<u32>,
    /// Time per stage in milliseconds, in order. Left out when results are compared.
    pub times: Vec<(&'static str, f64)>,
}

impl Report {
    /// The dimension called `name` of the first feature that has it.
    pub fn dimension(&self, name: &str) -> Option<&Dimension> {
        self.features.iter().flat_map(|feature| &feature.dimensions).find(|d| d.name == name)
    }

    /// Follows a compaction of the mesh.
    pub(super) fn renumber(&mut self, map: &Renumbering) {
        let vertex = |v: u32| map.vertex(VertexId(v)).map(|v| v.0);
        let face = |f: u32| map.face(FaceId(f)).map(|f| f.0);
        let vertices = |ids: &mut Vec<u32>| *ids = ids.iter().filter_map(|&v| vertex(v)).collect();
        vertices(&mut self.green);
        self.feature_edges =
            self.feature_edges.iter().filter_map(|&(a, b)| Some((vertex(a)?, vertex(b)?))).collect();
        self.affected = self.affected.iter().filter_map(|&f| face(f)).collect();
        vertices(&mut self.fit.missed);
        self.non_quads.retain_mut(|entry| face(entry.0).map(|f| entry.0 = f).is_some());
        for leftover in &mut self.leftovers {
            leftover.face = face(leftover.face).unwrap_or(leftover.face);
            vertices(&mut leftover.vertices);
            for mark in &mut leftover.marks {
                let (a, b) = mark.edge;
                mark.edge = (vertex(a).unwrap_or(a), vertex(b).unwrap_or(b));
            }
        }
        for warning in &mut self.warnings {
            match warning {
                Warning::Fold { vertices: ids } => vertices(ids),
                Warning::Wall { vertex: v, .. } => *v = vertex(*v).unwrap_or(*v),
            }
        }
    }
}
