//! Characters to tokens: the part that scripts and rule files share, and the tokens of scripts.

use super::source::{Diagnostic, MOST_MISTAKES, Source, Span};
use glam::{DVec2, DVec3};
use std::sync::Arc;

/// A place in a source that moves forward.
#[derive(Clone, Debug)]
pub struct Cursor {
    source: Arc<Source>,
    at: usize,
}

/// A token of a script.
#[derive(Clone, PartialEq, Debug)]
pub enum Token {
    /// `1.5`
    Number(f64),
    /// `"text"`
    Text(String),
    /// `(x, y)`
    Vec2(DVec2),
    /// `(x, y, z)`
    Vec3(DVec3),
    /// `name`, to be executed.
    Name(String),
    /// `/name`
    Literal(String),
    /// `.name` right after a name or a register.
    Member(String),
    /// `!name`
    Store(String),
    /// `:name`
    Load(String),
    /// `;name`
    LoadRaw(String),
    /// `[`
    OpenArray,
    /// `]`
    CloseArray,
    /// `{`
    OpenBlock,
    /// `}`
    CloseBlock,
}

/// Characters that end a name, besides space. `%` begins a comment; `, = < > "` belong to vectors, patterns, texts.
const STOP: &str = "()[]{}/;:!.,=<>\"%";

fn is_name_character(c: char) -> bool {
    !c.is_whitespace() && !c.is_control() && !STOP.contains(c)
}

impl Cursor {
    /// At the beginning of `source`.
    pub fn new(source: &Arc<Source>) -> Self {
        Self { source: Arc::clone(source), at: 0 }
    }

    /// The source.
    pub fn source(&self) -> &Arc<Source> {
        &self.source
    }

    /// Offset in bytes.
    pub fn offset(&self) -> u32 {
        self.at as u32
    }

    /// The character here.
    pub fn peek(&self) -> Option<char> {
        self.rest().chars().next()
    }

    /// Steps over the character here and returns it.
    pub fn bump(&mut self) -> Option<char> {
        let c = self.peek()?;
        self.at += c.len_utf8();
        Some(c)
    }

    /// Steps over `c` if it is here.
    pub fn eat(&mut self, c: char) -> bool {
        let here = self.peek() == Some(c);
        if here {
            self.at += c.len_utf8();
        }
        here
    }

    /// Goes to the end of the text when `errors` holds so many mistakes that reading ends.
    pub fn give_up(&mut self, errors: &[Diagnostic]) -> bool {
        let enough = errors.len() >= MOST_MISTAKES;
        if enough {
            self.give_up_at_once();
        }
        enough
    }

    /// Goes to byte `offset`, which lies on a character border.
    pub fn go_to(&mut self, offset: u32) {
        self.at = offset as usize;
    }

    /// Goes to the end of the text.
    pub fn give_up_at_once(&mut self) {
        self.at = self.source.text.len();
    }

    /// Steps over space and comments.
    pub fn skip_space(&mut self) {
        while let Some(c) = self.peek() {
            if c == '%' {
                self.at += self.rest().find('\n').unwrap_or(self.rest().len());
            } else if c.is_whitespace() {
                self.bump();
            } else {
                break;
            }
        }
    }

    /// The name that begins here; empty when there is none.
    pub fn name(&mut self) -> String {
        let rest = self.rest();
        let end = rest.find(|c| !is_name_character(c)).unwrap_or(rest.len());
        let name = rest[..end].to_owned();
        self.at += end;
        name
    }

    /// From `start` to here.
    pub fn span_from(&self, start: u32) -> Span {
        Span { start, end: self.offset() }
    }

    /// The single character here (nothing at the end of the text).
    pub fn span_here(&self) -> Span {
        let length = self.peek().map_or(0, char::len_utf8);
        Span { start: self.offset(), end: (self.at + length) as u32 }
    }

    /// A message about `span`.
    pub fn error(&self, span: Span, message: impl Into<String>) -> Diagnostic {
        Diagnostic::new(&self.source, span, message)
    }

    /// True when a number begins here.
    pub fn at_number(&self) -> bool {
        let mut rest = self.rest().chars();
        let mut c = rest.next();
        if matches!(c, Some('+' | '-')) {
            c = rest.next();
        }
        if c == Some('.') {
            c = rest.next();
        }
        c.is_some_and(|c| c.is_ascii_digit())
    }

    /// The number that begins here.
    ///
    /// # Errors
    /// It is not a finite decimal number.
    pub fn number(&mut self) -> Result<f64, Diagnostic> {
        let start = self.offset();
        let mut previous = ' ';
        while let Some(c) = self.peek() {
            let sign = matches!(c, '+' | '-');
            let in_number =
                if sign { matches!(previous, ' ' | 'e' | 'E') } else { is_name_character(c) || c == '.' };
            if !in_number {
                break;
            }
            previous = c;
            self.bump();
        }
        let span = self.span_from(start);
        match self.source.slice(span).parse::<f64>() {
            Ok(x) if x.is_finite() => Ok(x),
            Ok(_) => Err(self.error(span, "this number is too large")),
            Err(_) => Err(self.error(span, format!("`{}` is not a number", self.source.slice(span)))),
        }
    }

    /// The text in quotes that begins here, on one line.
    ///
    /// # Errors
    /// The closing quote is missing.
    pub fn text(&mut self) -> Result<String, Diagnostic> {
        let start = self.offset();
        self.bump();
        let rest = self.rest();
        let end = rest.find(['"', '\n']).unwrap_or(rest.len());
        let text = rest[..end].to_owned();
        self.at += end;
        if self.eat('"') {
            Ok(text)
        } else {
            Err(self.error(self.span_from(start), "this text has no closing quote on its line"))
        }
    }

    fn rest(&self) -> &str {
        &self.source.text[self.at..]
    }
}

/// The tokens of a script: up to the `}` that closes the brace at `opened` (stepped over), else to the end of the
/// text. Mistakes are added to `errors` and left out of the tokens.
pub fn script(cursor: &mut Cursor, opened: Option<Span>, errors: &mut Vec<Diagnostic>) -> Vec<(Token, Span)> {
    let mut tokens: Vec<(Token, Span)> = Vec::new();
    let mut depth = 0usize;
    loop {
        cursor.skip_space();
        let start = cursor.offset();
        if cursor.give_up(errors) {
            return tokens;
        }
        if cursor.peek().is_none() {
            if let Some(opened) = opened {
                errors.push(cursor.error(opened, "this script is not closed: a `}` is missing"));
            }
            return tokens;
        }
        if cursor.peek() == Some('}') {
            if depth == 0 && opened.is_some() {
                cursor.bump();
                return tokens;
            }
            depth = depth.saturating_sub(1);
        }
        match token(cursor, tokens.last()) {
            Ok(token) => {
                depth += usize::from(token == Token::OpenBlock);
                tokens.push((token, cursor.span_from(start)));
            }
            Err(error) => {
                errors.push(error);
                if cursor.offset() == start {
                    cursor.bump();
                }
            }
        }
    }
}

fn token(cursor: &mut Cursor, last: Option<&(Token, Span)>) -> Result<Token, Diagnostic> {
    let start = cursor.offset();
    let Some(c) = cursor.peek() else {
        return Err(cursor.error(cursor.span_here(), "the text ends here"));
    };
    if c == '.' && last.is_some_and(|(token, span)| span.end == start && can_have_members(token)) {
        return prefixed(cursor).map(Token::Member);
    }
    if cursor.at_number() {
        return cursor.number().map(Token::Number);
    }
    match c {
        '"' => cursor.text().map(Token::Text),
        '(' => vector(cursor),
        '/' => prefixed(cursor).map(Token::Literal),
        '!' => prefixed(cursor).map(Token::Store),
        ':' => prefixed(cursor).map(Token::Load),
        ';' => prefixed(cursor).map(Token::LoadRaw),
        '[' | ']' | '{' | '}' => {
            cursor.bump();
            Ok(match c {
                '[' => Token::OpenArray,
                ']' => Token::CloseArray,
                '{' => Token::OpenBlock,
                _ => Token::CloseBlock,
            })
        }
        _ if is_name_character(c) => Ok(Token::Name(cursor.name())),
        _ => Err(cursor.error(cursor.span_here(), format!("`{}` has no meaning here", c.escape_debug()))),
    }
}

fn can_have_members(token: &Token) -> bool {
    matches!(token, Token::Name(_) | Token::Load(_) | Token::LoadRaw(_) | Token::Member(_))
}

/// The name after the character here.
fn prefixed(cursor: &mut Cursor) -> Result<String, Diagnostic> {
    let start = cursor.offset();
    let prefix = cursor.bump().unwrap_or(' ');
    let name = cursor.name();
    if name.is_empty() {
        return Err(cursor.error(cursor.span_from(start), format!("a name must follow `{prefix}`")));
    }
    Ok(name)
}

fn vector(cursor: &mut Cursor) -> Result<Token, Diagnostic> {
    const FORM: &str = "a vector is written (x, y) or (x, y, z) with numbers";
    let start = cursor.offset();
    cursor.bump();
    let mut numbers = [0.0; 3];
    for count in 0..3 {
        cursor.skip_space();
        if !cursor.at_number() {
            return Err(cursor.error(cursor.span_from(start), FORM));
        }
        numbers[count] = cursor.number()?;
        cursor.skip_space();
        if cursor.eat(')') {
            let [x, y, z] = numbers;
            return match count {
                1 => Ok(Token::Vec2(DVec2::new(x, y))),
                2 => Ok(Token::Vec3(DVec3::new(x, y, z))),
                _ => Err(cursor.error(cursor.span_from(start), FORM)),
            };
        }
        if !cursor.eat(',') {
            break;
        }
    }
    Err(cursor.error(cursor.span_from(start), FORM))
}
