//! What can go wrong with rule files and with their runs.

use crate::gml::Diagnostic;
use crate::job::Cancelled;
use crate::mesh::{Mesh, Node, show_point};
use glam::DVec3;
use std::fmt;

/// Mistakes in a rule file and the files it includes, in the order of the texts.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct RulesError {
    /// All mistakes that were found; at least one.
    pub diagnostics: Vec<Diagnostic>,
    /// The file itself could not be read: the one diagnostic says why, and its place means nothing.
    pub unreadable: bool,
}

impl fmt::Display for RulesError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, diagnostic) in self.diagnostics.iter().enumerate() {
            if self.unreadable {
                return f.write_str(&diagnostic.message);
            }
            let gap = if i == 0 { "" } else { "\n\n" };
            write!(f, "{gap}{diagnostic}")?;
        }
        Ok(())
    }
}

impl std::error::Error for RulesError {}

/// Where a rule was applied.
#[derive(Clone, PartialEq, Debug)]
pub struct Place {
    /// The name of each node of the pattern, the element, and the element in words ([`Mesh::describe`]).
    pub nodes: Vec<(String, Node, String)>,
    /// A point to look at.
    pub position: DVec3,
}

impl Place {
    pub(super) fn new<'a>(mesh: &Mesh, nodes: impl Iterator<Item = (&'a str, Node)>) -> Self {
        let nodes: Vec<_> = nodes.map(|(name, node)| (name.to_owned(), node, mesh.describe(node))).collect();
        let position = nodes.first().map_or(DVec3::ZERO, |(_, node, _)| mesh.place(*node));
        Self { nodes, position }
    }
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        const SHOWN: usize = 8;
        for (name, _, element) in self.nodes.iter().take(SHOWN) {
            write!(f, "{name} = {element}, ")?;
        }
        if self.nodes.len() > SHOWN {
            write!(f, "{} more, ", self.nodes.len() - SHOWN)?;
        }
        write!(f, "near {}", show_point(self.position))
    }
}

/// Why a run of rules failed. The mesh is as it was before the run.
#[derive(Clone, PartialEq, Debug, thiserror::Error)]
pub enum RunError {
    /// A parameter that the rule set does not declare.
    #[error("the rules have no parameter `{name}`; {}", known_parameters(.known))]
    UnknownParameter {
        /// The name given.
        name: String,
        /// The names there are.
        known: Vec<String>,
    },
    /// A parameter out of its range.
    #[error("parameter `{name}` is {value}; it must lie in [{low}, {high}]")]
    ParameterOutOfRange {
        /// Its name.
        name: String,
        /// The value given.
        value: f64,
        /// Least value.
        low: f64,
        /// Greatest value.
        high: f64,
    },
    /// A script failed.
    #[error("rule {rule} failed at {place}\n{diagnostic}")]
    Script {
        /// Name of the rule.
        rule: String,
        /// What the pattern was matched with.
        place: Place,
        /// The mistake and its place in the rule file.
        diagnostic: Box<Diagnostic>,
    },
    /// The run took more steps than allowed.
    #[error(
        "the rules do not come to an end: {limit}. The last rule was {rule} at {place}; end the rules, or raise the limit\n{diagnostic}"
    )]
    Runaway {
        /// The limit that was reached, in words.
        limit: String,
        /// Name of the rule at work.
        rule: String,
        /// What its pattern was matched with last.
        place: Place,
        /// Its place in the rule file.
        diagnostic: Box<Diagnostic>,
    },
    /// The rules left a face that no control mesh can have.
    #[error("rule {rule} left a broken face near {}: {problem}\n{diagnostic}", show_point(*.position))]
    BrokenFace {
        /// The last rule that changed the face.
        rule: String,
        /// What is wrong with the face.
        problem: String,
        /// The mean of the face's vertices.
        position: DVec3,
        /// The rule's place in its file.
        diagnostic: Box<Diagnostic>,
    },
    /// The rules do not do what a trace says.
    #[error("the trace cannot be played: {problem}")]
    Replay {
        /// What differs, and where.
        problem: String,
    },
    /// The caller cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

fn known_parameters(known: &[String]) -> String {
    if known.is_empty() { "they have none".to_owned() } else { format!("they have {}", known.join(", ")) }
}
