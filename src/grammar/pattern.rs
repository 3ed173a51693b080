//! Patterns as they are written: `node (label> node)*` chains with tests.

use crate::gml::{Cursor, Diagnostic, Source, Span};
use crate::mesh::{Domain, Value};
use std::sync::Arc;

/// Nodes that a rule may name, those of its `not` patterns included.
pub(super) const MOST_NODES: usize = 200;

/// A label of an edge of the pattern.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) enum Label {
    FaceCcw,
    FaceCw,
    VertexCcw,
    VertexCw,
    Mate,
    Source,
    Target,
    Face,
    Link(String),
}

impl Label {
    fn named(name: &str) -> Self {
        match name {
            "faceCCW" => Self::FaceCcw,
            "faceCW" => Self::FaceCw,
            "vertexCCW" => Self::VertexCcw,
            "vertexCW" => Self::VertexCw,
            "mate" => Self::Mate,
            "source" => Self::Source,
            "target" => Self::Target,
            "face" => Self::Face,
            link => Self::Link(link.to_owned()),
        }
    }

    /// The label of a link.
    pub(super) fn link(&self) -> Option<&str> {
        match self {
            Self::Link(name) => Some(name),
            _ => None,
        }
    }

    /// Kinds of the nodes at its ends; links join any.
    fn kinds(&self) -> Option<[Domain; 2]> {
        match self {
            Self::Link(_) => None,
            Self::Source | Self::Target => Some([Domain::HalfEdge, Domain::Vertex]),
            Self::Face => Some([Domain::HalfEdge, Domain::Face]),
            _ => Some([Domain::HalfEdge, Domain::HalfEdge]),
        }
    }
}

#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Comparison {
    Equal,
    NotEqual,
    Less,
    LessOrEqual,
    Greater,
    GreaterOrEqual,
}

/// A test of an attribute.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct Test {
    pub(super) attribute: String,
    pub(super) span: Span,
    /// `None`: the attribute must be there.
    pub(super) value: Option<(Comparison, Value)>,
}

#[derive(Clone, Debug)]
pub(super) struct PatternNode {
    pub(super) name: String,
    pub(super) span: Span,
    pub(super) tests: Vec<Test>,
    /// Must lie on the boundary; without it a half-edge or a face must not.
    pub(super) boundary: bool,
}

#[derive(Clone, Debug)]
pub(super) struct PatternEdge {
    pub(super) from: usize,
    pub(super) label: Label,
    pub(super) to: usize,
    pub(super) span: Span,
}

#[derive(Clone, Default, Debug)]
pub(super) struct Pattern {
    pub(super) nodes: Vec<PatternNode>,
    pub(super) edges: Vec<PatternEdge>,
}

impl Pattern {
    /// Reads a pattern, opened by the brace at `opened`, up to its `}`, which is stepped over. Mistakes are added to
    /// `errors`.
    pub(super) fn parse(cursor: &mut Cursor, opened: Span, errors: &mut Vec<Diagnostic>) -> Self {
        let mut pattern = Self::default();
        // The node and the label that the next node continues.
        let mut pending: Option<(usize, Label, Span)> = None;
        let mut last: Option<usize> = None;
        loop {
            cursor.skip_space();
            let start = cursor.offset();
            if cursor.give_up(errors) {
                break;
            }
            match cursor.peek() {
                None => {
                    errors.push(cursor.error(opened, "this pattern is not closed: a `}` is missing"));
                    break;
                }
                Some('}') => {
                    cursor.bump();
                    break;
                }
                Some(_) => {}
            }
            let name = cursor.name();
            let span = cursor.span_from(start);
            if name.is_empty() {
                let found = cursor.peek().unwrap_or(' ').escape_debug();
                errors.push(cursor.error(
                    cursor.span_here(),
                    format!("`{found}` has no meaning here; a pattern is made of nodes and `label>`"),
                ));
                cursor.bump();
                continue;
            }
            if cursor.eat('>') {
                let span = cursor.span_from(start);
                match last.take() {
                    Some(node) if pending.is_none() => pending = Some((node, Label::named(&name), span)),
                    _ => errors.push(cursor.error(span, "a label must stand between two nodes")),
                }
                continue;
            }
            if name.starts_with(|c: char| c.is_ascii_digit()) {
                errors.push(cursor.error(span, "the name of a node must not begin with a digit"));
            }
            if pattern.nodes.len() > MOST_NODES {
                errors.push(cursor.error(span, format!("a rule may have {MOST_NODES} nodes at most")));
                cursor.give_up_at_once();
                return Self { nodes: pattern.nodes[..1].to_vec(), edges: Vec::new() };
            }
            let node = pattern.node(name, span);
            if cursor.eat('(') {
                parse_tests(cursor, &mut pattern.nodes[node], errors);
            }
            if let Some((from, label, span)) = pending.take() {
                pattern.edges.push(PatternEdge { from, label, to: node, span });
            }
            last = Some(node);
        }
        if let Some((_, _, span)) = pending {
            errors.push(cursor.error(span, "a label must stand between two nodes"));
        }
        if pattern.nodes.is_empty() {
            errors.push(cursor.error(opened, "the pattern is empty"));
        }
        pattern
    }

    fn node(&mut self, name: String, span: Span) -> usize {
        self.nodes.iter().position(|node| node.name == name).unwrap_or_else(|| {
            self.nodes.push(PatternNode { name, span, tests: Vec::new(), boundary: false });
            self.nodes.len() - 1
        })
    }
}

/// Tests after `(`, up to `)`.
fn parse_tests(cursor: &mut Cursor, node: &mut PatternNode, errors: &mut Vec<Diagnostic>) {
    while !cursor.give_up(errors) {
        match parse_test(cursor) {
            Ok(test) if test.value.is_none() && test.attribute == "boundary" => node.boundary = true,
            Ok(test) => node.tests.push(test),
            Err(error) => {
                errors.push(error);
                while cursor.peek().is_some_and(|c| !",)}\n".contains(c)) {
                    cursor.bump();
                }
            }
        }
        cursor.skip_space();
        if cursor.eat(')') {
            return;
        }
        if !cursor.eat(',') {
            errors.push(cursor.error(cursor.span_here(), "expected `,` or `)` after a test"));
            while cursor.peek().is_some_and(|c| !")}\n".contains(c)) {
                cursor.bump();
            }
            cursor.eat(')');
            return;
        }
    }
}

fn parse_test(cursor: &mut Cursor) -> Result<Test, Diagnostic> {
    cursor.skip_space();
    let start = cursor.offset();
    let attribute = cursor.name();
    let span = cursor.span_from(start);
    if attribute.is_empty() {
        return Err(cursor.error(cursor.span_here(), "expected the name of an attribute"));
    }
    cursor.skip_space();
    let begin = cursor.offset();
    let comparison = match cursor.peek() {
        Some('=') => Comparison::Equal,
        Some('!') => Comparison::NotEqual,
        Some('<') => Comparison::Less,
        Some('>') => Comparison::Greater,
        _ => return Ok(Test { attribute, span, value: None }),
    };
    cursor.bump();
    let comparison = match (comparison, cursor.peek() == Some('=')) {
        (Comparison::Equal, _) => Comparison::Equal,
        (Comparison::NotEqual, false) => {
            return Err(cursor.error(cursor.span_from(begin), "expected `!=`"));
        }
        (Comparison::Less, true) => Comparison::LessOrEqual,
        (Comparison::Greater, true) => Comparison::GreaterOrEqual,
        (other, _) => other,
    };
    if !matches!(comparison, Comparison::Equal | Comparison::Less | Comparison::Greater) {
        cursor.bump();
    }
    cursor.skip_space();
    let value = if cursor.peek() == Some('"') {
        Value::text(&cursor.text()?)
    } else if cursor.at_number() {
        Value::Number(cursor.number()?)
    } else {
        return Err(cursor.error(cursor.span_here(), "expected a number or a text in quotes"));
    };
    if value.as_text().is_some() && !matches!(comparison, Comparison::Equal | Comparison::NotEqual) {
        return Err(cursor.error(cursor.span_from(start), "a text can be compared with `=` and `!=` only"));
    }
    Ok(Test { attribute, span: cursor.span_from(start), value: Some((comparison, value)) })
}

/// Kinds of the nodes: what the labels say, else half-edges. `kinds` holds what is known already.
pub(super) fn infer_kinds(
    source: &Arc<Source>,
    pattern: &Pattern,
    mut kinds: Vec<Option<Domain>>,
    errors: &mut Vec<Diagnostic>,
) -> Vec<Domain> {
    kinds.resize(pattern.nodes.len(), None);
    for edge in &pattern.edges {
        let Some(ends) = edge.label.kinds() else { continue };
        for (node, wanted) in [edge.from, edge.to].into_iter().zip(ends) {
            let known = *kinds[node].get_or_insert(wanted);
            if known != wanted {
                let message = format!(
                    "`{}` is a {} here, but a {} elsewhere in the rule",
                    pattern.nodes[node].name,
                    kind_name(wanted),
                    kind_name(known)
                );
                errors.push(Diagnostic::new(source, edge.span, message));
            }
        }
    }
    kinds.into_iter().map(|kind| kind.unwrap_or(Domain::HalfEdge)).collect()
}

pub(super) fn kind_name(domain: Domain) -> &'static str {
    match domain {
        Domain::Vertex => "vertex",
        Domain::HalfEdge => "half-edge",
        Domain::Face => "face",
    }
}
