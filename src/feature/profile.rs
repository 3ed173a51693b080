//! Profiles: the cross-section of a linear feature as data, from `profiles/*.toml` or a file of the user.

use super::length::Length;
use serde::Serialize;

/// What a parameter counts in.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Unit {
    /// Model units, or a share of the crossed edge.
    Length,
    /// A whole number.
    Count,
}

/// A parameter that a feature declares, for hosts that build dialogs.
#[derive(Clone, PartialEq, Debug, Serialize)]
pub struct Parameter {
    /// Name, as in `width=0.1`.
    pub name: String,
    /// What it counts in.
    pub unit: Unit,
    /// Value unless set.
    pub default: Length,
    /// Least value, in model units or as a fraction of the edge.
    pub low: f64,
    /// Greatest value; `None` where only the mesh sets a bound.
    pub high: Option<f64>,
    /// One line of help.
    pub help: String,
}

/// A height over the base surface: a multiple of a parameter.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Height {
    /// Index of the parameter.
    pub parameter: usize,
    /// Its factor; negative is inwards.
    pub times: f64,
}

/// One line of control vertices along a feature.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Line {
    /// Place across the feature, in half widths of the control band: -1 and 1 are the rims.
    pub across: f64,
    /// Height of the limit surface over the base at this line; `None` leaves the control vertices of the line in the
    /// base surface.
    pub height: Option<Height>,
}

/// The cross-section of a linear feature.
#[derive(Clone, PartialEq, Debug, Serialize)]
pub struct Profile {
    /// Name of the feature.
    pub name: String,
    /// One line of help.
    pub help: String,
    /// What can be set.
    pub parameters: Vec<Parameter>,
    /// The lines, from the side of the mark's first vertex to the other. Empty where they are spread.
    #[serde(skip)]
    pub lines: Vec<Line>,
    /// Index of the parameter that counts lines spread evenly over the edge.
    #[serde(skip)]
    pub spread: Option<usize>,
    /// Height of everything on the side of the first line; marks must form closed loops then.
    #[serde(skip)]
    pub inside: Option<Height>,
}

/// The files that ship.
const SHIPPED: [(&str, &str); 7] = [
    ("groove", include_str!("../../profiles/groove.toml")),
    ("ridge", include_str!("../../profiles/ridge.toml")),
    ("piping", include_str!("../../profiles/piping.toml")),
    ("step", include_str!("../../profiles/step.toml")),
    ("bead", include_str!("../../profiles/bead.toml")),
    ("dent", include_str!("../../profiles/dent.toml")),
    ("loop", include_str!("../../profiles/loop.toml")),
];

/// A profile that cannot be had.
#[derive(Clone, PartialEq, Eq, Debug, thiserror::Error)]
pub enum ProfileError {
    /// No such feature.
    #[error("there is no feature '{name}'; there are {}, and profile files ending in .toml", known.join(", "))]
    Unknown {
        /// The name asked for.
        name: String,
        /// The features that ship.
        known: Vec<String>,
    },
    /// A profile file that cannot be read, or says what makes no sense. The message names file and line.
    #[error("{message}")]
    File {
        /// What is wrong and what would be right.
        message: String,
    },
}

impl Profile {
    /// Names of the features that ship, in the order of a menu.
    pub fn names() -> impl Iterator<Item = &'static str> {
        SHIPPED.iter().map(|(name, _)| *name)
    }

    /// A feature that ships, or the profile in a file when the name ends in `.toml`.
    ///
    /// # Errors
    /// An unknown name, a file that cannot be used.
    pub fn named(name: &str) -> Result<Self, ProfileError> {
        if name.ends_with(".toml") {
            let text = crate::io::read_text(name.as_ref()).map_err(|e| ProfileError::File {
                message: format!(
                    "cannot read the profile file {name}: {e}; give the path of a profile (the folder profiles of the \
                     sources shows how one is written), or one of {}",
                    Self::names().collect::<Vec<_>>().join(", ")
                ),
            })?;
            return Self::parse(name, &text);
        }
        match SHIPPED.iter().find(|entry| entry.0 == name) {
            Some((name, text)) => Self::parse(&format!("{name}.toml"), text),
            None => Err(ProfileError::Unknown {
                name: name.to_owned(),
                known: Self::names().map(str::to_owned).collect(),
            }),
        }
    }

    /// All features that ship.
    ///
    /// # Errors
    /// None in a library that was tested.
    pub fn shipped() -> Result<Vec<Self>, ProfileError> {
        Self::names().map(Self::named).collect()
    }

    /// Index of the parameter called `name`.
    pub fn parameter(&self, name: &str) -> Option<usize> {
        self.parameters.iter().position(|p| p.name == name)
    }

    /// Index of the parameter that is the width across the feature.
    pub(super) fn width(&self) -> Option<usize> {
        self.parameter("width")
    }

    /// The line in the middle, which lies on the curve that a feature follows; from 0.
    pub(super) fn middle(&self) -> Option<usize> {
        let place = |i: &usize| self.lines[*i].across.abs();
        (0..self.lines.len()).min_by(|a, b| place(a).total_cmp(&place(b)))
    }

    /// Indices of the parameters that heights are multiples of, each with its greatest factor.
    pub(super) fn extents(&self) -> impl Iterator<Item = Height> + '_ {
        (0..self.parameters.len()).filter_map(|p| {
            self.lines
                .iter()
                .filter_map(|line| line.height)
                .chain(self.inside)
                .filter(|height| height.parameter == p)
                .max_by(|a, b| a.times.abs().total_cmp(&b.times.abs()))
        })
    }

    /// The lines for these values of the parameters.
    pub(super) fn lines_for(&self, values: &[f64]) -> Vec<Line> {
        match self.spread {
            None => self.lines.clone(),
            Some(parameter) => {
                let count = values.get(parameter).map_or(1, |x| x.round().max(1.0) as usize);
                // -1 and 1 are the edge's ends here.
                let place = |i: usize| 2.0 * (i + 1) as f64 / (count + 1) as f64 - 1.0;
                (0..count).map(|i| Line { across: place(i), height: None }).collect()
            }
        }
    }
}

impl Height {
    /// The height for these values of the parameters.
    pub(super) fn of(self, values: &[f64]) -> f64 {
        self.times * values.get(self.parameter).copied().unwrap_or(0.0)
    }
}
