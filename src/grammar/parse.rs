//! Rule files: includes, parameters, phases, rules. The grammar is in `docs/rules.md`.

use super::error::RulesError;
use super::pattern::{Pattern, infer_kinds};
use super::plan::{Graph, NodePlan, Step, edges, number_tests};
use super::ruleset::{Forbidden, Input, Loader, Parameter, Rule, RuleSet};
use crate::gml::{
    Cursor, Definition, Diagnostic, Effects, Leaves, Scope, Source, Span, Strings, check, compile_tokens,
    is_word, script,
};
use crate::mesh::{Domain, Value};
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

    fn rule(&mut self, cursor: &mut Cursor) -> Result<(), Diagnostic> {
        let source = Arc::clone(cursor.source());
        let (name, span) = expect_name(cursor, "the name of a rule")?;
        if self.rules.rules.len() == MOST_RULES {
            cursor.give_up_at_once();
            return Err(cursor.error(span, format!("there are more than {MOST_RULES} rules")));
        }
        if self.rules.rules.iter().any(|known| known.name == name) {
            self.errors.push(cursor.error(span, format!("rule `{name}` is there twice")));
        }
        let brace = expect_brace(cursor, "the pattern of the rule")?;
        let pattern = Pattern::parse(cursor, brace, &mut self.errors);
        for node in &pattern.nodes {
            if let Err(error) = self.check_node_name(cursor, &node.name, node.span) {
                self.errors.push(error);
            }
        }
        let kinds = infer_kinds(&source, &pattern, Vec::new(), &mut self.errors);
        let nodes: Vec<(String, Domain)> =
            pattern.nodes.iter().map(|node| node.name.clone()).zip(kinds.iter().copied()).collect();
        let names = &mut self.rules.names;
        let place: Vec<usize> = (0..nodes.len()).collect();
        let main_edges = edges(&pattern, &place, names);
        let node_plan = |node: &super::pattern::PatternNode, domain: Domain, names: &mut Strings| NodePlan {
            domain,
            tests: number_tests(names, &node.tests),
            boundary: node.boundary,
            others: Vec::new(),
        };
        let plans: Vec<NodePlan> =
            pattern.nodes.iter().zip(&kinds).map(|(node, &domain)| node_plan(node, domain, names)).collect();
        let mut graph = Graph { nodes: plans, edges: main_edges };
        let (plan, seeds) = graph.plan();
        let Some(Step::Seed { anchor, to: anchor_node }) = plan.steps.first().cloned() else {
            // Only an empty pattern has no steps, and that was reported.
            skip_to_keyword(cursor);
            return Ok(());
        };
        let mut reach = graph.reach(anchor_node);
        let mut forbidden = Vec::new();
        let mut conditions = Vec::new();
        let mut effects = Effects::default();
        let parameters = self.parameter_names();
        let action = loop {
            cursor.skip_space();
            let start = cursor.offset();
            let before = cursor.clone();
            let part = cursor.name();
            let part_span = if part.is_empty() { cursor.span_here() } else { cursor.span_from(start) };
            match part.as_str() {
                "not" => {
                    let brace = expect_brace(cursor, "a pattern")?;
                    let inner = Pattern::parse(cursor, brace, &mut self.errors);
                    let mut place = Vec::new();
                    let mut known = Vec::new();
                    let mut count = nodes.len();
                    for node in &inner.nodes {
                        let main = nodes.iter().position(|(name, _)| *name == node.name);
                        known.push(main.map(|index| nodes[index].1));
                        place.push(main.unwrap_or(count));
                        if main.is_none() {
                            count += 1;
                            if let Err(error) = self.check_node_name(cursor, &node.name, node.span) {
                                self.errors.push(error);
                            }
                        }
                    }
                    let kinds = infer_kinds(&source, &inner, known, &mut self.errors);
                    let names = &mut self.rules.names;
                    let mut all = graph.nodes.clone();
                    let mut tests = Vec::new();
                    for ((node, &domain), &at) in inner.nodes.iter().zip(&kinds).zip(&place) {
                        if at >= nodes.len() {
                            all.push(node_plan(node, domain, names));
                        } else if !node.tests.is_empty() || node.boundary {
                            let further = number_tests(names, &node.tests);
                            tests.push(Step::Test { node: at, tests: further, boundary: node.boundary });
                        }
                    }
                    let own = edges(&inner, &place, names);
                    let mut rest = Graph { nodes: all, edges: own };
                    let (mut plan, seeds) = rest.plan_rest(nodes.len());
                    if seeds > 0 {
                        self.errors.push(
                            cursor
                                .error(part_span, "a part of this `not` is not joined to the rule's pattern"),
                        );
                    }
                    plan.steps.splice(0..0, tests);
                    let mut joined = Graph { nodes: rest.nodes.clone(), edges: graph.edges.clone() };
                    joined.edges.extend(rest.edges.iter().copied());
                    reach.extend(joined.reach(anchor_node).into_iter().skip(nodes.len()));
                    forbidden.push(Forbidden { pattern: inner, span: part_span, plans: rest.nodes, plan });
                }
                "where" | "action" => {
                    let brace = expect_brace(cursor, "a script")?;
                    let tokens = script(cursor, Some(brace), &mut self.errors);
                    let end = cursor.offset();
                    let end = Span { start: end.saturating_sub(1), end };
                    let scope = Scope { nodes: &nodes, parameters: &parameters, read_only: part == "where" };
                    let strings = &mut self.rules.strings;
                    let mistakes = self.errors.len();
                    let program = compile_tokens(
                        &source,
                        &tokens,
                        end,
                        &scope,
                        &self.definitions,
                        strings,
                        &mut self.errors,
                    );
                    if mistakes == self.errors.len() {
                        let leaves = if part == "action" { Leaves::Nothing } else { Leaves::OneNumber };
                        let checked = check(&program, leaves);
                        self.errors.extend(checked.mistake);
                        self.rules.script_warnings.extend(checked.warnings);
                        effects = checked.effects;
                    }
                    if part == "action" {
                        break program;
                    }
                    conditions.push(program);
                }
                _ => {
                    *cursor = before;
                    return Err(cursor.error(
                        part_span,
                        format!("expected `not`, `where` or `action` of rule `{name}` here"),
                    ));
                }
            }
        };
        self.rules.rules.push(Rule {
            name,
            phase: self.phase.clone(),
            source,
            span,
            nodes,
            pattern,
            plans: graph.nodes,
            plan,
            anchor,
            anchor_node,
            forbidden,
            looks_further: !conditions.is_empty() || seeds > 1,
            conditions,
            action,
            effects,
            reach,
        });
        Ok(())
    }

    fn check_node_name(&self, cursor: &Cursor, name: &str, span: Span) -> Result<(), Diagnostic> {
        check_free(cursor, name, span)?;
        if self.rules.parameters.iter().any(|parameter| parameter.name == name) {
            return Err(
                cursor.error(span, format!("`{name}` is a parameter; a node needs a name of its own"))
            );
        }
        if self.definitions.iter().any(|definition| definition.name == name) {
            return Err(cursor.error(span, format!("`{name}` is defined above; a node needs another name")));
        }
        Ok(())
    }
}

fn keywords() -> String {
    KEYWORDS.map(|keyword| format!("`{keyword}`")).join(" or ")
}

fn check_free(cursor: &Cursor, name: &str, span: Span) -> Result<(), Diagnostic> {
    if is_word(name) {
        return Err(cursor.error(span, format!("`{name}` is a word of the language; choose another name")));
    }
    Ok(())
}

fn expect_name(cursor: &mut Cursor, what: &str) -> Result<(String, Span), Diagnostic> {
    cursor.skip_space();
    let start = cursor.offset();
    let name = cursor.name();
    if name.is_empty() || name.starts_with(|c: char| c.is_ascii_digit()) {
        let span = if name.is_empty() { cursor.span_here() } else { cursor.span_from(start) };
        return Err(cursor.error(span, format!("expected {what}")));
    }
    Ok((name, cursor.span_from(start)))
}

fn expect_keyword(cursor: &mut Cursor, keyword: &str) -> Result<(), Diagnostic> {
    let what = format!("`{keyword}`");
    let (name, span) = expect_name(cursor, &what)?;
    if name == keyword { Ok(()) } else { Err(cursor.error(span, format!("expected {what}"))) }
}

fn expect_help(cursor: &mut Cursor) -> Result<String, Diagnostic> {
    cursor.skip_space();
    if cursor.peek() != Some('"') {
        return Err(cursor.error(cursor.span_here(), "expected one line of help in quotes"));
    }
    cursor.text()
}

/// Numbers between brackets, with or without commas.
fn numbers(cursor: &mut Cursor, close: char) -> Result<Vec<f64>, Diagnostic> {
    cursor.bump();
    let mut numbers = Vec::new();
    loop {
        cursor.skip_space();
        if cursor.eat(close) {
            return Ok(numbers);
        }
        if !numbers.is_empty() && cursor.eat(',') {
            cursor.skip_space();
        }
        numbers.push(expect_number(cursor)?.0);
    }
}

/// A number, `inf` or `-inf`.
fn expect_number(cursor: &mut Cursor) -> Result<(f64, Span), Diagnostic> {
    cursor.skip_space();
    let start = cursor.offset();
    let x = if cursor.at_number() {
        cursor.number()?
    } else {
        let before = cursor.clone();
        match cursor.name().as_str() {
            "inf" => f64::INFINITY,
            "-inf" => f64::NEG_INFINITY,
            _ => {
                let mut span = cursor.span_from(start);
                if span.start == span.end {
                    span = cursor.span_here();
                }
                // What stands here may be a keyword at which reading goes on.
                *cursor = before;
                return Err(cursor.error(span, "expected a number"));
            }
        }
    };
    Ok((x, cursor.span_from(start)))
}

/// Steps over `{`; gives its place.
fn expect_brace(cursor: &mut Cursor, what: &str) -> Result<Span, Diagnostic> {
    cursor.skip_space();
    let brace = cursor.span_here();
    if cursor.eat('{') { Ok(brace) } else { Err(cursor.error(brace, format!("expected `{{` and {what}"))) }
}

/// To the next keyword of the file level: where reading goes on after a mistake.
fn skip_to_keyword(cursor: &mut Cursor) {
    loop {
        cursor.skip_space();
        let mut ahead = cursor.clone();
        if ahead.peek().is_none() || KEYWORDS.contains(&ahead.name().as_str()) {
            return;
        }
        if cursor.name().is_empty() {
            cursor.bump();
        }
    }
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
