//! Source texts, places in them, and messages that show the place.

use annotate_snippets::{AnnotationKind, Level, Renderer, Snippet};
use std::fmt;
use std::sync::Arc;

/// A text that scripts or rules were read from.
#[derive(PartialEq, Eq, Default)]
pub struct Source {
    /// Name shown in messages: a path, or the name of a built-in file.
    pub name: String,
    /// The whole text.
    pub text: String,
}

/// The text would drown the rest.
impl fmt::Debug for Source {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Source({})", self.name)
    }
}

/// Mistakes after which reading ends: who has so many wants to see the first ones.
pub(crate) const MOST_MISTAKES: usize = 100;

/// A range of bytes in a [`Source`].
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug)]
pub struct Span {
    /// First byte.
    pub start: u32,
    /// One past the last byte.
    pub end: u32,
}

/// How bad something is.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Severity {
    /// The text cannot be used.
    Error,
    /// The text can be used, but is probably not what was meant.
    Warning,
}

/// A mistake in a script or a rule file, with its place. [`Display`](fmt::Display) shows the line and a caret.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Diagnostic {
    /// How bad it is.
    pub severity: Severity,
    /// What is wrong, and what to do about it.
    pub message: String,
    /// Name of the file.
    pub file: String,
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
    /// The words at the place.
    pub word: String,
    source: Arc<Source>,
    span: Span,
}

impl Source {
    /// A text called `name`.
    pub fn new(name: &str, text: &str) -> Arc<Self> {
        Arc::new(Self { name: name.to_owned(), text: text.to_owned() })
    }

    /// The text in `span`; empty when the span does not lie on character borders.
    pub fn slice(&self, span: Span) -> &str {
        self.text.get(span.start as usize..span.end as usize).unwrap_or("")
    }
}

impl Diagnostic {
    /// A mistake at `span` of `source`.
    pub fn new(source: &Arc<Source>, span: Span, message: impl Into<String>) -> Self {
        let before = source.text.get(..span.start as usize).unwrap_or(&source.text);
        let line_start = before.rfind('\n').map_or(0, |at| at + 1);
        Self {
            severity: Severity::Error,
            message: message.into(),
            file: source.name.clone(),
            line: before.matches('\n').count() + 1,
            column: before[line_start..].chars().count() + 1,
            word: source.slice(span).to_owned(),
            source: Arc::clone(source),
            span,
        }
    }

    /// The same, as a warning.
    pub(crate) fn into_warning(self) -> Self {
        Self { severity: Severity::Warning, ..self }
    }

    /// Sort key that puts messages of one file in the order of the text.
    pub(crate) fn offset(&self) -> u32 {
        self.span.start
    }
}

impl fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let span = self.span.start as usize..self.span.end as usize;
        let snippet = Snippet::source(self.source.text.as_str())
            .path(self.file.as_str())
            .annotation(AnnotationKind::Primary.span(span));
        let level = match self.severity {
            Severity::Error => Level::ERROR,
            Severity::Warning => Level::WARNING,
        };
        let report = [level.primary_title(self.message.as_str()).element(snippet)];
        f.write_str(&Renderer::plain().render(&report))
    }
}

impl std::error::Error for Diagnostic {}
