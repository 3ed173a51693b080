//! What must stand next in a rule file.

use super::KEYWORDS;
use crate::gml::{Cursor, Diagnostic, Span, is_word};

pub(super) fn check_free(cursor: &Cursor, name: &str, span: Span) -> Result<(), Diagnostic> {
    if is_word(name) {
        return Err(cursor.error(span, format!("`{name}` is a word of the language; choose another name")));
    }
    Ok(())
}

pub(super) fn expect_name(cursor: &mut Cursor, what: &str) -> Result<(String, Span), Diagnostic> {
    cursor.skip_space();
    let start = cursor.offset();
    let name = cursor.name();
    if name.is_empty() || name.starts_with(|c: char| c.is_ascii_digit()) {
        let span = if name.is_empty() { cursor.span_here() } else { cursor.span_from(start) };
        return Err(cursor.error(span, format!("expected {what}")));
    }
    Ok((name, cursor.span_from(start)))
}

pub(super) fn expect_keyword(cursor: &mut Cursor, keyword: &str) -> Result<(), Diagnostic> {
    let what = format!("`{keyword}`");
    let (name, span) = expect_name(cursor, &what)?;
    if name == keyword { Ok(()) } else { Err(cursor.error(span, format!("expected {what}"))) }
}

pub(super) fn expect_help(cursor: &mut Cursor) -> Result<String, Diagnostic> {
    cursor.skip_space();
    if cursor.peek() != Some('"') {
        return Err(cursor.error(cursor.span_here(), "expected one line of help in quotes"));
    }
    cursor.text()
}

/// Numbers between brackets, with or without commas.
pub(super) fn numbers(cursor: &mut Cursor, close: char) -> Result<Vec<f64>, Diagnostic> {
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
pub(super) fn expect_number(cursor: &mut Cursor) -> Result<(f64, Span), Diagnostic> {
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
pub(super) fn expect_brace(cursor: &mut Cursor, what: &str) -> Result<Span, Diagnostic> {
    cursor.skip_space();
    let brace = cursor.span_here();
    if cursor.eat('{') { Ok(brace) } else { Err(cursor.error(brace, format!("expected `{{` and {what}"))) }
}

/// To the next keyword of the file level: where reading goes on after a mistake.
pub(super) fn skip_to_keyword(cursor: &mut Cursor) {
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
