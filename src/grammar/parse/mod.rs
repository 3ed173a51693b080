//! Rule files: includes, parameters, phases, rules. The grammar is in `docs/rules.md`.

mod expect;
mod rule;

use super::error::RulesError;
use super::ruleset::{Input, Loader, Parameter, Rule, RuleSet};
use crate::gml::{Cursor, Definition, Diagnostic, Scope, Source, Span, compile_tokens, script};
use crate::mesh::Value;
use expect::{
    check_free, expect_brace, expect_help, expect_keyword, expect_name, expect_number, numbers,
    skip_to_keyword,
};
use glam::DVec3;
use std::sync::Arc;

/// Files that may include one another in a row.
const DEEPEST_INCLUDE: usize = 50;
/// Bytes that a file may have.
const LONGEST: usize = 1 << 24;
/// Parameters and rules that a rule set may have.
const MOST_PARAMETERS: usize = 1000;
const MOST_RULES: usize = 10_000;
/// Definitions may use one another in a row, which takes a call each to read.
const MOST_DEFINITIONS: usize = 300;
const KEYWORDS: [&str; 8] =
    ["define", "example", "include", "input", "parameter", "phase", "rule", "straight"];

pub(super) fn parse(name: &str, text: &str, loader: &Loader<'_>) -> Result<RuleSet, RulesError> {
    let mut reader = Reader {
        rules: RuleSet { name: name.to_owned(), ..RuleSet::default() },
        errors: Vec::new(),
        loader,
        finished: Vec::new(),
        open: Vec::new(),
        definitions: Vec::new(),
        phase: String::new(),
        known_phases: Vec::new(),
    };
    reader.file(name, text);
    if reader.errors.is_empty() {
        reader.rules.phases = phases(&reader.rules.rules);
        Ok(reader.rules)
    } else {
        Err(RulesError { diagnostics: reader.errors, unreadable: false })
    }
}

/// Runs of rules of one phase.
pub(super) fn phases(rules: &[Rule]) -> Vec<std::ops::Range<usize>> {
    let mut start = 0;
    rules
        .chunk_by(|a, b| a.phase == b.phase)
        .map(|phase| {
            start += phase.len();
            start - phase.len()..start
        })
        .collect()
}

struct Reader<'a> {
    rules: RuleSet,
    errors: Vec<Diagnostic>,
    loader: &'a Loader<'a>,
    /// Files that were read to their end.
    finished: Vec<String>,
    /// Files that are being read.
    open: Vec<String>,
    definitions: Vec<Definition>,
    phase: String,
    known_phases: Vec<String>,
}

impl Reader<'_> {
    fn file(&mut self, name: &str, text: &str) {
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        if text.len() > LONGEST {
            let source = Source::new(name, "");
            let message = format!("{name} is too long for a rule file: {} bytes", text.len());
            self.errors.push(Diagnostic::new(&source, Span::default(), message));
            return;
        }
        self.open.push(name.to_owned());
        let source = Source::new(name, text);
        let mut cursor = Cursor::new(&source);
        let first_error = self.errors.len();
        loop {
            cursor.skip_space();
            if cursor.give_up(&self.errors) || cursor.peek().is_none() {
                break;
            }
            if let Err(error) = self.item(&mut cursor) {
                self.errors.push(error);
                skip_to_keyword(&mut cursor);
            }
        }
        // Errors of included files stand where the file was included; the others follow the text.
        self.errors[first_error..].sort_by_key(|error| (error.file != name, error.offset()));
        self.open.pop();
        self.finished.push(name.to_owned());
    }

    fn item(&mut self, cursor: &mut Cursor) -> Result<(), Diagnostic> {
        let start = cursor.offset();
        let keyword = cursor.name();
        let span = if keyword.is_empty() { cursor.span_here() } else { cursor.span_from(start) };
        match keyword.as_str() {
            "include" => self.include(cursor),
            "example" => self.example(cursor),
            "input" => self.input(cursor),
            "straight" => {
                let (name, _) = expect_name(cursor, "the name of an attribute")?;
                self.rules.straight.insert(name);
                Ok(())
            }
            "parameter" => self.parameter(cursor),
            "define" => self.define(cursor),
            "phase" => {
                let (name, span) = expect_name(cursor, "the name of a phase")?;
                if self.known_phases.contains(&name) {
                    return Err(cursor.error(span, format!("phase `{name}` was begun before")));
                }
                self.known_phases.push(name.clone());
                self.phase = name;
                self.again(cursor)
            }
            "rule" => self.rule(cursor),
            "" => {
                let found = cursor.bump().unwrap_or(' ').escape_debug().to_string();
                Err(cursor.error(span, format!("`{found}` has no meaning here; expected {}", keywords())))
            }
            other => {
                Err(cursor.error(span, format!("`{other}` has no meaning here; expected {}", keywords())))
            }
        }
    }

    /// `again NAME` after the name of a phase.
    fn again(&mut self, cursor: &mut Cursor) -> Result<(), Diagnostic> {
        let before = cursor.clone();
        cursor.skip_space();
        if cursor.name() != "again" {
            *cursor = before;
            return Ok(());
        }
        let (target, span) = expect_name(cursor, "the name of a phase")?;
        if !self.known_phases.contains(&target) {
            return Err(cursor.error(span, format!("no phase `{target}` was begun before")));
        }
        self.rules.again.insert(self.phase.clone(), target);
        Ok(())
    }

    fn include(&mut self, cursor: &mut Cursor) -> Result<(), Diagnostic> {
        cursor.skip_space();
        let start = cursor.offset();
        if cursor.peek() != Some('"') {
            return Err(cursor.error(cursor.span_here(), "expected the name of a file in quotes"));
        }
        let file = cursor.text()?;
        let span = cursor.span_from(start);
        let path = join(&cursor.source().name, &file);
        if self.open.contains(&path) {
            return Err(
                cursor.error(span, format!("{path} includes itself, by way of {}", self.open.join(", ")))
            );
        }
        if self.finished.contains(&path) {
            return Ok(());
        }
        if self.open.len() > DEEPEST_INCLUDE {
            return Err(cursor.error(span, format!("more than {DEEPEST_INCLUDE} files include one another")));
        }
        let text =
            (self.loader)(&path).ok_or_else(|| cursor.error(span, format!("there is no file {path}")))?;
        self.file(&path, &text);
        Ok(())
    }

    fn parameter(&mut self, cursor: &mut Cursor) -> Result<(), Diagnostic> {
        let (name, span) = expect_name(cursor, "the name of a parameter")?;
        if self.rules.parameters.iter().any(|known| known.name == name) {
            return Err(cursor.error(span, format!("parameter `{name}` is declared twice")));
        }
        if self.rules.parameters.len() == MOST_PARAMETERS {
            return Err(cursor.error(span, format!("there are more than {MOST_PARAMETERS} parameters")));
        }
        check_free(cursor, &name, span)?;
        let (default, default_span) = expect_number(cursor)?;
        expect_keyword(cursor, "range")?;
        let (low, range) = expect_number(cursor)?;
        let (high, _) = expect_number(cursor)?;
        if low.is_nan() || high.is_nan() || low > high {
            return Err(cursor.error(range, "the range is empty: its low end must not be above its high end"));
        }
        if !(low..=high).contains(&default) || !default.is_finite() {
            return Err(
                cursor.error(default_span, format!("the default must lie in the range {low} to {high}"))
            );
        }
        expect_keyword(cursor, "unit")?;
        let (unit, _) = expect_name(cursor, "a unit such as length, fraction, count or angle")?;
        let help = expect_help(cursor)?;
        self.rules.parameters.push(Parameter { name, default, low, high, unit, help });
        self.rules.declared.push((Arc::clone(cursor.source()), span));
        Ok(())
    }

    /// `example NAME VALUE`.
    fn example(&mut self, cursor: &mut Cursor) -> Result<(), Diagnostic> {
        let (name, span) = expect_name(cursor, "the name of an attribute")?;
        if self.rules.examples.contains_key(&name) {
            return Err(cursor.error(span, format!("example `{name}` is there twice")));
        }
        cursor.skip_space();
        let start = cursor.offset();
        let value = match cursor.peek() {
            Some('"') => Value::text(&cursor.text()?),
            Some('[') => Value::Numbers(numbers(cursor, ']')?.into()),
            Some('(') => match *numbers(cursor, ')')? {
                [x, y, z] => Value::Vector(DVec3::new(x, y, z)),
                _ => return Err(cursor.error(cursor.span_from(start), "a vector is written (0.5 0.5 0)")),
            },
            _ => Value::Number(expect_number(cursor)?.0),
        };
        self.rules.examples.insert(name, value);
        Ok(())
    }

    /// `input NAME "help"`.
    fn input(&mut self, cursor: &mut Cursor) -> Result<(), Diagnostic> {
        let (name, span) = expect_name(cursor, "the name of an attribute or a link")?;
        if self.rules.inputs.iter().any(|known| known.name == name) {
            return Err(cursor.error(span, format!("input `{name}` is declared twice")));
        }
        let help = expect_help(cursor)?;
        self.rules.inputs.push(Input { name, help });
        Ok(())
    }

    /// A definition is compiled on its own for its mistakes; what it does to the stack is checked where it is used.
    fn define(&mut self, cursor: &mut Cursor) -> Result<(), Diagnostic> {
        let source = Arc::clone(cursor.source());
        let (name, span) = expect_name(cursor, "the name of a definition")?;
        if self.definitions.iter().any(|known| known.name == name) {
            return Err(cursor.error(span, format!("`{name}` is defined twice")));
        }
        if self.definitions.len() == MOST_DEFINITIONS {
            return Err(cursor.error(span, format!("there are more than {MOST_DEFINITIONS} definitions")));
        }
        check_free(cursor, &name, span)?;
        let brace = expect_brace(cursor, "a script")?;
        let tokens = script(cursor, Some(brace), &mut self.errors);
        let end = cursor.offset();
        let end = Span { start: end.saturating_sub(1), end };
        let scope = Scope { nodes: &[], parameters: &self.parameter_names(), read_only: false };
        let strings = &mut self.rules.strings;
        compile_tokens(&source, &tokens, end, &scope, &self.definitions, strings, &mut self.errors);
        self.definitions.push(Definition { name, tokens });
        Ok(())
    }

    fn parameter_names(&self) -> Vec<String> {
        self.rules.parameters.iter().map(|p| p.name.clone()).collect()
    }
}

fn keywords() -> String {
    KEYWORDS.map(|keyword| format!("`{keyword}`")).join(" or ")
}

/// `file`, relative to the folder of `base`, without `.` and `..` where they can be resolved.
fn join(base: &str, file: &str) -> String {
    let mut parts: Vec<&str> = base.split('/').collect();
    parts.pop();
    if file.starts_with('/') {
        parts = vec![""];
    }
    for part in file.split('/').filter(|part| !part.is_empty()) {
        match part {
            "." => {}
            ".." if parts.last().is_some_and(|last| !last.is_empty() && *last != "..") => {
                parts.pop();
            }
            part => parts.push(part),
        }
    }
    parts.join("/")
}
