//! Reading a case: one statement per line.

use super::sketch::{Element, NamedVertex, Sketch};
use super::{Case, CaseError, Expected};
use crate::gml::{Cursor, Diagnostic, Source, Span};
use crate::grammar::RuleSet;
use crate::mesh::Value;
use glam::DVec3;
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

const STATEMENTS: &str =
    "a line begins with rules, only, set, before, after, fired, fails, v, f, h, crease or corner";

pub(super) fn read(name: &str, text: &str) -> Result<Case, CaseError> {
    let source = Source::new(name, text.strip_prefix('\u{feff}').unwrap_or(text));
    let mut reader = Reader { source: Arc::clone(&source), ..Reader::default() };
    let mut start = 0;
    for line in source.text.split_inclusive('\n') {
        let end = start + line.trim_end().len() as u32;
        reader.line(&mut Line::new(&source, start, end))?;
        start += line.len() as u32;
    }
    reader.finish()
}

/// A line and a place in it.
struct Line {
    cursor: Cursor,
    end: u32,
}

impl Line {
    fn new(source: &Arc<Source>, start: u32, end: u32) -> Self {
        let mut cursor = Cursor::new(source);
        cursor.go_to(start);
        cursor.skip_space();
        Self { cursor, end }
    }

    fn is_done(&self) -> bool {
        self.cursor.offset() >= self.end
    }

    /// A mistake at the present place.
    fn error(&self, message: impl Into<String>) -> Diagnostic {
        let start = self.cursor.offset().min(self.end);
        self.cursor.error(Span { start, end: (start + 1).min(self.end).max(start) }, message)
    }

    /// The next name and its place.
    fn name(&mut self, what: &str) -> Result<(String, Span), Diagnostic> {
        let start = self.cursor.offset();
        let name = if self.is_done() { String::new() } else { self.cursor.name() };
        if name.is_empty() {
            return Err(self.error(format!("expected {what}")));
        }
        let span = self.cursor.span_from(start);
        self.cursor.skip_space();
        Ok((name, span))
    }

    fn number(&mut self) -> Result<f64, Diagnostic> {
        if self.is_done() || !self.cursor.at_number() {
            return Err(self.error("expected a number"));
        }
        let x = self.cursor.number()?;
        self.cursor.skip_space();
        Ok(x)
    }

    fn text(&mut self) -> Result<String, Diagnostic> {
        if self.is_done() || self.cursor.peek() != Some('"') {
            return Err(self.error("expected a text in quotes"));
        }
        let text = self.cursor.text()?;
        self.cursor.skip_space();
        Ok(text)
    }

    /// Numbers separated by commas, up to `close`.
    fn numbers(&mut self, close: char) -> Result<Vec<f64>, Diagnostic> {
        self.cursor.bump();
        self.cursor.skip_space();
        let mut numbers = Vec::new();
        while !self.cursor.eat(close) {
            if !numbers.is_empty() && !self.cursor.eat(',') {
                return Err(self.error(format!("expected `,` or `{close}`")));
            }
            self.cursor.skip_space();
            numbers.push(self.number()?);
        }
        self.cursor.skip_space();
        Ok(numbers)
    }

    fn value(&mut self) -> Result<Value, Diagnostic> {
        match self.cursor.peek() {
            Some('"') => self.text().map(|text| Value::text(&text)),
            Some('[') => self.numbers(']').map(|numbers| Value::Numbers(numbers.into())),
            Some('(') => match *self.numbers(')')? {
                [x, y, z] => Ok(Value::Vector(DVec3::new(x, y, z))),
                _ => Err(self.error("a vector has three coordinates")),
            },
            _ => self.number().map(Value::Number),
        }
    }

    /// What the next name is used for: `=` for an attribute, `>` for a link, neither for a vertex.
    fn use_of_name(&self) -> Option<char> {
        let mut ahead = self.cursor.clone();
        ahead.name();
        ahead.peek().filter(|c| "=>".contains(*c))
    }
}

#[derive(Clone, Copy, PartialEq, Eq, Default)]
enum Section {
    #[default]
    Head,
    Before,
    After,
}

#[derive(Default)]
struct Reader {
    source: Arc<Source>,
    rules: Option<RuleSet>,
    only: Vec<(String, Span)>,
    parameters: BTreeMap<String, f64>,
    section: Section,
    before: Sketch,
    before_span: Span,
    after: Sketch,
    /// Vertices of `after` that are known from `before` only: they exist when a face of `after` has them.
    inherited: Vec<bool>,
    /// Elements that must be there, with their place.
    mentioned: Vec<(Section, Element, Span)>,
    fired: Option<BTreeMap<String, u64>>,
    failure: Option<String>,
}

impl Reader {
    fn line(&mut self, line: &mut Line) -> Result<(), CaseError> {
        if line.is_done() {
            return Ok(());
        }
        let (keyword, span) = line.name(STATEMENTS)?;
        let in_mesh = self.section != Section::Head;
        match keyword.as_str() {
            "rules" => {
                let file = line.text()?;
                let folder = Path::new(&self.source.name).parent().unwrap_or(Path::new(""));
                self.rules = Some(RuleSet::load(&folder.join(file))?);
            }
            "only" => {
                while !line.is_done() {
                    self.only.push(line.name("the name of a rule")?);
                }
            }
            "set" => {
                let (name, _) = line.name("the name of a parameter")?;
                self.parameters.insert(name, line.number()?);
            }
            "before" => {
                self.section = Section::Before;
                self.before_span = span;
            }
            "after" => {
                self.section = Section::After;
                self.after.vertices = self.before.vertices.clone();
                self.inherited = vec![true; self.after.vertices.len()];
            }
            "fired" => {
                let fired = self.fired.get_or_insert_default();
                while !line.is_done() {
                    let (name, _) = line.name("the name of a rule")?;
                    fired.insert(name, line.number()? as u64);
                    line.cursor.eat(',');
                    line.cursor.skip_space();
                }
            }
            "fails" => self.failure = Some(line.text()?),
            "v" if in_mesh => self.vertex(line)?,
            "f" | "h" if in_mesh => {
                let element = self.element(line)?;
                let wrong = match (keyword.as_str(), element.len()) {
                    ("f", 0..3) => Some("a face has three vertices or more"),
                    ("h", 2) | ("f", _) => None,
                    _ => Some("a half-edge runs between two vertices"),
                };
                if let Some(wrong) = wrong {
                    return Err(self.error(span, wrong));
                }
                match keyword.as_str() {
                    "f" => self.sketch().faces.push(element.clone()),
                    _ => self.mentioned.push((self.section, element.clone(), span)),
                }
                self.annotations(line, &element)?;
            }
            "crease" | "corner" if in_mesh => {
                let count = if keyword == "crease" { 2 } else { 1 };
                let mut element = Vec::new();
                for _ in 0..count {
                    element.push(self.known_vertex(line)?);
                }
                let sharpness = line.number()?;
                self.mentioned.push((self.section, element.clone(), span));
                self.sketch().sharp.push((element, sharpness));
            }
            "v" | "f" | "h" | "crease" | "corner" => {
                return Err(self.error(span, "elements stand below `before` or `after`"));
            }
            _ => return Err(self.error(span, format!("`{keyword}` has no meaning here; {STATEMENTS}"))),
        }
        if line.is_done() { Ok(()) } else { Err(line.error("the line should end here").into()) }
    }

    fn error(&self, span: Span, message: impl Into<String>) -> CaseError {
        Diagnostic::new(&self.source, span, message).into()
    }

    fn sketch(&mut self) -> &mut Sketch {
        if self.section == Section::After { &mut self.after } else { &mut self.before }
    }

    fn known_vertex(&mut self, line: &mut Line) -> Result<usize, CaseError> {
        let (name, span) = line.name("the name of a vertex")?;
        let found = self.sketch().vertex(&name);
        found.ok_or_else(|| self.error(span, format!("there is no vertex `{name}` here")))
    }

    /// The vertices of an element.
    fn element(&mut self, line: &mut Line) -> Result<Element, CaseError> {
        let mut element = Vec::new();
        while !line.is_done() && line.use_of_name().is_none() {
            element.push(self.known_vertex(line)?);
        }
        Ok(element)
    }

    /// `v NAME X Y [Z]`. Below `after` a vertex that was there before may go without a position.
    fn vertex(&mut self, line: &mut Line) -> Result<(), CaseError> {
        let (name, span) = line.name("the name of a vertex")?;
        let known = self.sketch().vertex(&name);
        let mut position = known.map(|v| self.sketch().vertices[v].position);
        if line.cursor.at_number() || known.is_none() {
            let (x, y) = (line.number()?, line.number()?);
            let z = if !line.is_done() && line.cursor.at_number() { line.number()? } else { 0.0 };
            position = Some(DVec3::new(x, y, z));
        }
        let position = position.unwrap_or_default();
        let v = match known {
            Some(v) if self.section == Section::After && self.inherited[v] => {
                self.inherited[v] = false;
                self.after.vertices[v].position = position;
                v
            }
            Some(_) => return Err(self.error(span, format!("vertex `{name}` is there twice"))),
            None => {
                let sketch = self.sketch();
                sketch.vertices.push(NamedVertex { name, position });
                let v = sketch.vertices.len() - 1;
                if self.section == Section::After {
                    self.inherited.push(false);
                }
                v
            }
        };
        self.annotations(line, &[v])
    }

    /// `NAME=VALUE` and `LABEL> VERTICES`, up to the end of the line.
    fn annotations(&mut self, line: &mut Line, element: &[usize]) -> Result<(), CaseError> {
        while !line.is_done() {
            let (name, span) = line.name("an attribute or a link")?;
            let element = element.to_vec();
            if line.cursor.eat('=') {
                line.cursor.skip_space();
                let value = line.value()?;
                self.sketch().attributes.push((element, name, value));
            } else if line.cursor.eat('>') {
                line.cursor.skip_space();
                let to = self.element(line)?;
                if to.is_empty() {
                    return Err(line.error("expected the vertices of an element").into());
                }
                self.mentioned.push((self.section, to.clone(), span));
                self.sketch().links.push((element, name, to));
            } else {
                return Err(
                    self.error(span, format!("expected `{name}=` and a value, or `{name}>` and an element"))
                );
            }
        }
        Ok(())
    }

    fn finish(mut self) -> Result<Case, CaseError> {
        let end = Span { start: self.source.text.len() as u32, end: self.source.text.len() as u32 };
        for (section, element, span) in &self.mentioned {
            let sketch = if *section == Section::After { &self.after } else { &self.before };
            if !sketch.has(element) {
                return Err(self.error(*span, format!("no face has `{}`", sketch.names(element))));
            }
        }
        if let Err(problem) = self.before.mesh() {
            let message = format!("{problem} (vertices and faces are counted from 0, line by line)");
            return Err(self.error(self.before_span, message));
        }
        let Some(mut rules) = self.rules.take() else {
            return Err(self.error(end, "a case names its rules: rules \"FILE\""));
        };
        if !self.only.is_empty() {
            let names: Vec<&str> = self.only.iter().map(|(name, _)| name.as_str()).collect();
            rules = rules.only(&names).map_err(|unknown| {
                let span = self.only.iter().find(|(name, _)| name == unknown).map_or(end, |(_, span)| *span);
                self.error(span, format!("the file has no rule `{unknown}`"))
            })?;
        }
        let expected = match (self.failure.take(), self.fired.take()) {
            (Some(text), _) => Expected::Failure(text),
            (None, Some(fired)) if self.section == Section::After => {
                Expected::Mesh { after: self.remaining(), fired }
            }
            (None, Some(_)) => {
                return Err(
                    self.error(end, "the mesh after the rules is missing: `after`, or `fails \"...\"`")
                );
            }
            (None, None) => return Err(self.error(end, "say which rules are applied: fired NAME COUNT, ...")),
        };
        Ok(Case { rules, parameters: self.parameters, before: self.before, expected })
    }

    /// The mesh after the rules, without the vertices that are gone.
    fn remaining(&mut self) -> Sketch {
        let mut after = std::mem::take(&mut self.after);
        let used: Vec<bool> = (0..after.vertices.len())
            .map(|v| !self.inherited[v] || after.faces.iter().any(|face| face.contains(&v)))
            .collect();
        let number: Vec<usize> =
            (0..used.len()).map(|v| used[..v].iter().filter(|used| **used).count()).collect();
        let mut place = 0;
        after.vertices.retain(|_| {
            place += 1;
            used[place - 1]
        });
        let elements = (after.faces.iter_mut())
            .chain(after.attributes.iter_mut().map(|(element, ..)| element))
            .chain(after.links.iter_mut().flat_map(|(from, _, to)| [from, to]))
            .chain(after.sharp.iter_mut().map(|(element, _)| element));
        for element in elements {
            element.iter_mut().for_each(|v| *v = number[*v]);
        }
        after
    }
}
