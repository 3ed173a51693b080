//! Rule sets as they are kept after reading.

use super::error::RulesError;
use super::lint;
use super::parse;
use super::pattern::Pattern;
use super::plan::{Anchor, NodePlan, Plan, Reach};
use crate::gml::{Diagnostic, Effects, Program, Source, Span, Strings};
use crate::io;
use crate::mesh::{Domain, Value};
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::sync::Arc;

/// A number that a rule set lets its user choose.
#[derive(Clone, PartialEq, Debug, Serialize)]
pub struct Parameter {
    /// Its name in the scripts.
    pub name: String,
    /// Value when nothing is chosen.
    pub default: f64,
    /// Least value allowed; may be minus infinity.
    pub low: f64,
    /// Greatest value allowed; may be infinity.
    pub high: f64,
    /// What it measures: `length`, `fraction`, `count`, `angle`, ...
    pub unit: String,
    /// One line of help.
    pub help: String,
}

/// An attribute or a link that the caller brings, and that the rules work on.
#[derive(Clone, PartialEq, Debug, Serialize)]
pub struct Input {
    /// Its name.
    pub name: String,
    /// One line of help.
    pub help: String,
}

/// A rule: a pattern, conditions, and the script that changes the mesh where the pattern matches.
#[derive(Clone, Debug)]
pub struct Rule {
    /// Its name.
    pub name: String,
    /// Name of the phase it belongs to; empty when the file has none.
    pub phase: String,
    pub(super) source: Arc<Source>,
    /// Place of the name in the source.
    pub(super) span: Span,
    /// Name and kind of the nodes of the pattern, in the order of the text.
    pub(super) nodes: Vec<(String, Domain)>,
    /// The pattern as it is written.
    pub(super) pattern: Pattern,
    pub(super) plans: Vec<NodePlan>,
    pub(super) plan: Plan,
    pub(super) anchor: Anchor,
    pub(super) anchor_node: usize,
    pub(super) forbidden: Vec<Forbidden>,
    pub(super) conditions: Vec<Program>,
    pub(super) action: Program,
    /// What the action does to attributes and links.
    pub(super) effects: Effects,
    /// The ways from every node, those of `not` patterns included, back to the anchor.
    pub(super) reach: Vec<Reach>,
    /// A match can come about by changes that `reach` does not see: what a condition looks at, or a part of the
    /// pattern that nothing joins to the anchor.
    pub(super) looks_further: bool,
}

/// A `not` pattern. Its nodes are those of the main pattern and then its own.
#[derive(Clone, Debug)]
pub(super) struct Forbidden {
    /// The pattern as it is written, and the place of its keyword.
    pub(super) pattern: Pattern,
    pub(super) span: Span,
    pub(super) plans: Vec<NodePlan>,
    pub(super) plan: Plan,
}

impl Rule {
    /// A message about this rule.
    pub(super) fn diagnostic(&self, message: &str) -> Box<Diagnostic> {
        Box::new(Diagnostic::new(&self.source, self.span, message))
    }
}

/// Values that drawings give to attributes.
pub(crate) type Examples = BTreeMap<String, Value>;

/// The rules of a file and of the files it includes.
#[derive(Clone, Default, Debug)]
pub struct RuleSet {
    pub(super) name: String,
    pub(super) parameters: Vec<Parameter>,
    /// Where each parameter is declared.
    pub(super) declared: Vec<(Arc<Source>, Span)>,
    pub(super) inputs: Vec<Input>,
    pub(super) examples: Examples,
    /// Vertices with one of these attributes lie inside of straight sides in drawings.
    pub(super) straight: BTreeSet<String>,
    pub(super) rules: Vec<Rule>,
    /// Phases in their order, as ranges of `rules`.
    pub(super) phases: Vec<std::ops::Range<usize>>,
    /// Phases after which the run goes back to an earlier one when they applied a rule.
    pub(super) again: BTreeMap<String, String>,
    /// Names of attributes and links that patterns mention.
    pub(super) names: Strings,
    pub(super) strings: Strings,
    /// What the scripts are warned of.
    pub(super) script_warnings: Vec<Diagnostic>,
}

/// Gives the text of an included file; the path is relative to where the first file's name is.
pub type Loader<'a> = dyn Fn(&str) -> Option<String> + 'a;

impl RuleSet {
    /// Reads rules from `text`. `name` is the file's name in messages; paths of `include` are joined to its folder
    /// before `loader` is asked for them.
    ///
    /// # Errors
    /// All mistakes in the text and in what it includes.
    pub fn parse(name: &str, text: &str, loader: &Loader<'_>) -> Result<Self, RulesError> {
        parse::parse(name, text, loader)
    }

    /// Reads a rule file.
    ///
    /// # Errors
    /// The file cannot be read as text, or [`parse`](Self::parse) finds mistakes.
    pub fn load(path: &Path) -> Result<Self, RulesError> {
        let name = path.to_string_lossy();
        let text = io::read_text(path).map_err(|error| {
            let source = Source::new(&name, "");
            let message = format!("cannot read the rule file {name}: {error}");
            RulesError {
                diagnostics: vec![Diagnostic::new(&source, Span::default(), message)],
                unreadable: true,
            }
        })?;
        Self::parse(&name, &text, &|file| io::read_text(Path::new(file)).ok())
    }

    /// The rules called `names` only, in the order of the text.
    ///
    /// # Errors
    /// The first name that no rule has.
    pub fn only<'n>(&self, names: &[&'n str]) -> Result<Self, &'n str> {
        if let Some(unknown) = names.iter().find(|name| !self.rules.iter().any(|rule| rule.name == **name)) {
            return Err(unknown);
        }
        let mut set = self.clone();
        set.rules.retain(|rule| names.contains(&rule.name.as_str()));
        set.phases = parse::phases(&set.rules);
        Ok(set)
    }

    /// Name of the file.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Parameters, in the order of the text.
    pub fn parameters(&self) -> &[Parameter] {
        &self.parameters
    }

    /// Attributes and links that the caller brings, in the order of the text.
    pub fn inputs(&self) -> &[Input] {
        &self.inputs
    }

    /// What is probably not meant as it is written: rules that may never end or never match, marks that stay,
    /// parameters that nothing uses. `docs/rules.md` lists what is looked for.
    pub fn warnings(&self) -> Vec<Diagnostic> {
        lint::warnings(self)
    }

    /// Rules, in the order of the text.
    pub fn rules(&self) -> &[Rule] {
        &self.rules
    }
}
