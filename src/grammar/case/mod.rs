//! Before/after cases of rules, as text files: a small mesh, the rules, and what they must make of it.
//!
//! `docs/rules.md`, section "Cases", describes the files.

mod compare;
mod read;
mod sketch;

use super::{RuleSet, RulesError, RunError, RunOptions, run};
use crate::gml::Diagnostic;
use crate::mesh::Mesh;
use sketch::Sketch;
use std::collections::BTreeMap;
use std::path::Path;

/// Lengths and numbers that differ by no more than this are equal in a case.
const TOLERANCE: f64 = 1e-6;

/// A mesh, rules, and what must become of the mesh.
#[derive(Clone, Debug)]
pub struct Case {
    rules: RuleSet,
    parameters: BTreeMap<String, f64>,
    before: Sketch,
    expected: Expected,
}

#[derive(Clone, Debug)]
enum Expected {
    Mesh {
        after: Sketch,
        /// Names of the rules that are applied, and how often.
        fired: BTreeMap<String, u64>,
    },
    /// The run fails, and its message holds this text.
    Failure(String),
}

/// Why a case did not pass.
#[derive(Clone, PartialEq, Debug, thiserror::Error)]
pub enum CaseError {
    /// The file cannot be read.
    #[error("cannot read the case {0}: {1}")]
    Unreadable(String, String),
    /// A mistake in the file.
    #[error(transparent)]
    Mistake(#[from] Diagnostic),
    /// A mistake in the rules.
    #[error(transparent)]
    Rules(#[from] RulesError),
    /// The rules failed on the mesh.
    #[error("the rules failed: {0}")]
    Run(#[from] RunError),
    /// Something else came out. The lines are those of a case file, `-` what was expected, `+` what was found.
    #[error("the result differs (- expected, + found)\n{0}")]
    Different(String),
    /// The rules were to fail, but did not, or with another message.
    #[error("the rules were to fail with a message that holds \"{expected}\", but {found}")]
    Failure {
        /// The text that was expected.
        expected: String,
        /// What came instead.
        found: String,
    },
}

impl Case {
    /// Reads a case and its rules.
    ///
    /// # Errors
    /// The file cannot be read, or it or its rules have a mistake.
    pub fn load(path: &Path) -> Result<Self, CaseError> {
        let name = path.to_string_lossy();
        let text = crate::io::read_text(path)
            .map_err(|error| CaseError::Unreadable(name.to_string(), error.to_string()))?;
        read::read(&name, &text)
    }

    /// The mesh before the rules, and what they make of it.
    ///
    /// # Errors
    /// The rules fail.
    pub fn before_and_after(&self) -> Result<[Mesh; 2], CaseError> {
        let before = self.mesh()?;
        let mut after = before.clone();
        let options = RunOptions { parameters: self.parameters.clone(), ..RunOptions::default() };
        run(&self.rules, &mut after, &options)?;
        Ok([before, after])
    }

    fn mesh(&self) -> Result<Mesh, CaseError> {
        self.before.mesh().map_err(CaseError::Different)
    }

    /// Names of the rules that the case expects to be applied.
    pub fn fired(&self) -> impl Iterator<Item = &str> {
        let fired = match &self.expected {
            Expected::Mesh { fired, .. } => Some(fired),
            Expected::Failure(_) => None,
        };
        fired.into_iter().flatten().map(|(name, _)| name.as_str())
    }

    /// Runs the rules and compares.
    ///
    /// # Errors
    /// What differs, or why the rules failed.
    pub fn check(&self) -> Result<(), CaseError> {
        let mut mesh = self.mesh()?;
        let options = RunOptions { parameters: self.parameters.clone(), ..RunOptions::default() };
        let outcome = run(&self.rules, &mut mesh, &options);
        let (after, fired) = match (&self.expected, outcome) {
            (Expected::Mesh { after, fired }, outcome) => {
                let counts = outcome?.applications.into_iter().filter(|(_, count)| *count > 0).collect();
                (after, (fired, counts))
            }
            (Expected::Failure(text), Err(error)) if error.to_string().contains(text) => return Ok(()),
            (Expected::Failure(expected), outcome) => {
                let found = match outcome {
                    Ok(_) => "they ran to their end".to_owned(),
                    Err(error) => format!("with this one: {error}"),
                };
                return Err(CaseError::Failure { expected: expected.clone(), found });
            }
        };
        match compare::difference(after, &mesh, fired) {
            Some(difference) => Err(CaseError::Different(difference)),
            None => Ok(()),
        }
    }
}
