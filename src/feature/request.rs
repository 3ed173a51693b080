//! What a caller asks for, and why it may be refused.

use super::{Length, Profile, WidthError};
use crate::grammar::{self, RuleSet};
use crate::job::Cancelled;
use crate::optimise::Method;
use std::collections::BTreeMap;

/// What to apply.
#[derive(Clone, Copy, Debug)]
pub struct Feature<'a> {
    /// The rules that rewrite the mesh.
    pub rules: &'a RuleSet,
    /// The cross-section; without one the rules run on the marks as they are and nothing is displaced.
    pub profile: Option<&'a Profile>,
}

/// How to apply it.
#[derive(Clone, Debug)]
pub struct Options {
    /// Parameters of the profile that differ from their defaults (`width`, `depth`, `height`).
    pub lengths: BTreeMap<String, Length>,
    /// Parameters of the rule set that differ from their defaults.
    pub numbers: BTreeMap<String, f64>,
    /// How to fit the changed mesh to the surface as it was.
    pub method: Method,
    /// Samples per side of a face for measuring deviations, 8 as a rule; 0 measures none. Measuring also looks for
    /// walls thinner than the feature is deep. It costs more than the feature itself.
    pub samples: usize,
    /// Threads for measuring deviations, 0 for all; the result does not depend on it.
    pub threads: usize,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            lengths: BTreeMap::new(),
            numbers: BTreeMap::new(),
            method: Method::Solve,
            samples: 0,
            threads: 1,
        }
    }
}

/// Why a feature was not applied. The mesh is as it was.
#[derive(Clone, Debug, thiserror::Error)]
pub enum FeatureError {
    /// Nothing is marked.
    #[error("no edge is marked; name at least one edge the feature is to cross")]
    NoMarks,
    /// A mark of another mesh, or of this one before it was changed.
    #[error("mark {mark} is on an edge that the mesh does not have; select the edges anew on this mesh")]
    NoSuchEdge {
        /// The mark, counted from 0 in the order of the selection.
        mark: usize,
    },
    /// A parameter that the feature does not have.
    #[error("{feature} has no parameter '{name}'; it has {}", known.join(", "))]
    UnknownParameter {
        /// The feature or rule set.
        feature: String,
        /// The name given.
        name: String,
        /// The names there are.
        known: Vec<String>,
    },
    /// A parameter out of its range.
    #[error("{name} is {value}; {remedy}")]
    BadParameter {
        /// Its name.
        name: String,
        /// The value given.
        value: String,
        /// What it should be.
        remedy: &'static str,
    },
    /// A width that an edge cannot take.
    #[error(transparent)]
    Width(#[from] WidthError),
    /// The rules failed.
    #[error(transparent)]
    Rules(#[from] grammar::RunError),
    /// The caller cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}
