//! Profile files (TOML): see `profiles/piping.toml` for one with everything in it.

use super::length::Length;
use super::profile::{Height, Line, Parameter, Profile, ProfileError, Unit};
use serde::Deserialize;
use std::collections::BTreeMap;
use toml::Spanned;

/// Lines of a profile at most: a crossing of two makes its square of vertices.
const MOST_LINES: usize = 32;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    name: Spanned<String>,
    help: String,
    #[serde(default)]
    inside: Option<Spanned<BTreeMap<String, f64>>>,
    #[serde(default)]
    spread: Option<Spanned<String>>,
    #[serde(default, rename = "parameter")]
    parameters: Vec<Spanned<FileParameter>>,
    #[serde(default, rename = "line")]
    lines: Vec<Spanned<FileLine>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct FileParameter {
    name: String,
    #[serde(default = "length")]
    unit: Unit,
    default: Number,
    #[serde(default)]
    low: f64,
    high: Option<f64>,
    help: String,
}

fn length() -> Unit {
    Unit::Length
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct FileLine {
    across: f64,
    height: Option<BTreeMap<String, f64>>,
}

/// A number, or a text such as "30%".
#[derive(Deserialize)]
#[serde(untagged)]
enum Number {
    Plain(f64),
    Text(String),
}

/// What is wrong, and where in the file (a byte offset).
struct Problem {
    at: usize,
    message: String,
}

impl Profile {
    /// Reads a profile; `file` is what errors call it.
    ///
    /// # Errors
    /// [`ProfileError::File`] with file and line.
    pub fn parse(file: &str, text: &str) -> Result<Self, ProfileError> {
        let error = |at: usize, message: &str| ProfileError::File {
            message: format!(
                "{file}:{}: {message}",
                1 + text.as_bytes().iter().take(at).filter(|b| **b == b'\n').count()
            ),
        };
        let parsed: File =
            toml::from_str(text).map_err(|e| error(e.span().map_or(0, |span| span.start), e.message()))?;
        convert(parsed).map_err(|problem| error(problem.at, &problem.message))
    }
}

fn convert(file: File) -> Result<Profile, Problem> {
    let mut parameters: Vec<Parameter> = Vec::new();
    for entry in file.parameters {
        let at = entry.span().start;
        let parameter = parameter(entry.into_inner()).map_err(|message| Problem { at, message })?;
        if parameters.iter().any(|p| p.name == parameter.name) {
            return Err(Problem {
                at,
                message: format!("the parameter {} is declared twice", parameter.name),
            });
        }
        parameters.push(parameter);
    }
    let height = |at: usize, entry: BTreeMap<String, f64>| {
        height(&parameters, entry).map_err(|message| Problem { at, message })
    };
    let inside = match file.inside {
        Some(entry) => Some(height(entry.span().start, entry.into_inner())?),
        None => None,
    };
    let spread = match file.spread {
        Some(name) => {
            let index = parameters.iter().position(|p| p.name == *name.get_ref() && p.unit == Unit::Count);
            Some(index.ok_or_else(|| Problem {
                at: name.span().start,
                message: format!(
                    "spread names '{}', which is no parameter with unit = \"count\"",
                    name.get_ref()
                ),
            })?)
        }
        None => None,
    };
    let name_at = file.name.span().start;
    let mut lines: Vec<Line> = Vec::new();
    let count = file.lines.len();
    for (i, entry) in file.lines.into_iter().enumerate() {
        let at = entry.span().start;
        let FileLine { across, height: of } = entry.into_inner();
        let problem = |message: String| Err(Problem { at, message });
        if !(-1.0..=1.0).contains(&across) {
            return problem(format!("across is {across}; it lies between -1 (one rim) and 1 (the other)"));
        }
        if lines.last().is_some_and(|last| last.across >= across) {
            return problem(format!(
                "across is {across}; lines are listed from one rim to the other, each further than the one before"
            ));
        }
        let line = Line { across, height: of.map(|of| height(at, of)).transpose()? };
        let held = i + 1 == count || (i == 0 && inside.is_none());
        if held && line.height.is_some() {
            return problem(
                "the outer lines hold the surface beside the feature; they take no height".into(),
            );
        }
        if i == 0 && inside.is_some() && line.height != inside {
            return problem("the first line takes the height of the inside".into());
        }
        lines.push(line);
    }
    let whole = Err::<(), _>;
    match (spread, lines.len()) {
        (None, 0) => whole("a profile has at least one [[line]], or spread = \"count\""),
        (Some(_), 1..) => whole("a profile with spread has no lines of its own"),
        (_, count) if count > MOST_LINES => whole("a profile has at most 32 lines"),
        (_, 2..) if !parameters.iter().any(|p| p.name == "width") => {
            whole("a profile with several lines declares a parameter width")
        }
        _ => Ok(()),
    }
    .map_err(|message| Problem { at: name_at, message: message.into() })?;
    Ok(Profile { name: file.name.into_inner(), help: file.help, parameters, lines, spread, inside })
}

fn parameter(entry: FileParameter) -> Result<Parameter, String> {
    let FileParameter { name, unit, default, low, high, help } = entry;
    let fine = |c: char| c.is_ascii_alphanumeric() || c == '_';
    if name.is_empty() || !name.chars().all(fine) {
        return Err(format!("'{name}' is no name; names are letters, digits and _"));
    }
    let default = match default {
        Number::Plain(x) => Length::Units(x),
        Number::Text(text) => text.parse()?,
    };
    let parameter = Parameter { name, unit, default, low, high, help };
    match parameter.problem(default) {
        Some(problem) => Err(format!("default of {}: {problem}", parameter.name)),
        None => Ok(parameter),
    }
}

impl Parameter {
    /// Why `value` cannot be taken.
    pub(super) fn problem(&self, value: Length) -> Option<String> {
        let Self { low, high, .. } = self;
        let x = value.value();
        match (self.unit, value) {
            (Unit::Count, Length::OfEdge(_)) => Some("it is a number, no share of an edge".into()),
            (Unit::Count, Length::Units(x)) if x.fract() != 0.0 => Some("it is a whole number".into()),
            _ if x >= *low && high.is_none_or(|high| x <= high) => None,
            _ => Some(match high {
                Some(high) => format!("it lies between {low} and {high}"),
                None => format!("it must not be less than {low}"),
            }),
        }
    }
}

/// `{ depth = -1.0 }`: one parameter and its factor.
fn height(parameters: &[Parameter], entry: BTreeMap<String, f64>) -> Result<Height, String> {
    const FORM: &str = "a height is { PARAMETER = FACTOR }, such as { depth = -1.0 }";
    let mut entries = entry.into_iter();
    let (Some((name, times)), None) = (entries.next(), entries.next()) else { return Err(FORM.into()) };
    let parameter = parameters
        .iter()
        .position(|p| p.name == name && p.unit == Unit::Length && p.name != "width")
        .ok_or_else(|| format!("'{name}' is no parameter that can be a height; {FORM}"))?;
    if !times.is_finite() || times == 0.0 {
        return Err(format!("the factor of {name} is {times}; {FORM}"));
    }
    Ok(Height { parameter, times })
}
