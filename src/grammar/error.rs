//! What can go wrong with rule files and with their runs.

use crate::gml::{Diagnostic, show_node};
use crate::job::Cancelled;
use crate::mesh::Node;
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

/// Where a rule was applied: the name of each node of its pattern, and the element.
#[derive(Clone, PartialEq, Eq, Default, Debug)]
pub struct Place(pub Vec<(String, Node)>);

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, (name, node)) in self.0.iter().enumerate() {
            let comma = if i == 0 { "" } else { ", " };
            write!(f, "{comma}{name} = {}", show_node(*node))?;
        }
        Ok(())
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
    #[error("the rules do not come to an end: {limit}. The last rule was {rule} at {place}\n{diagnostic}")]
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
    #[error("rule {rule} left a broken face: {problem}\n{diagnostic}")]
    BrokenFace {
        /// The last rule that changed the face.
        rule: String,
        /// What is wrong with the face.
        problem: String,
        /// The rule's place in its file.
        diagnostic: Box<Diagnostic>,
    },
    /// The caller cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

fn known_parameters(known: &[String]) -> String {
    if known.is_empty() { "they have none".to_owned() } else { format!("they have {}", known.join(", ")) }
}
