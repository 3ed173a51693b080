//! Settings as text, `width=30%` or `piping.width=30%`, the same for the program and the C ABI.

use super::Length;
use std::str::FromStr;

/// A setting that cannot be used.
#[derive(Clone, PartialEq, Eq, Debug, thiserror::Error)]
#[error("setting '{text}': {problem}")]
pub struct SettingError {
    /// The setting as given.
    pub text: String,
    /// What is wrong and what would be right.
    pub problem: String,
}

/// `KIND.NAME=VALUE`, or `NAME=VALUE` for all.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct Setting {
    pub(super) kind: Option<String>,
    pub(super) name: String,
    pub(super) value: Length,
}

impl FromStr for Setting {
    type Err = SettingError;

    fn from_str(text: &str) -> Result<Self, SettingError> {
        let error = |problem: String| SettingError { text: text.to_owned(), problem };
        let (name, value) =
            text.split_once('=').ok_or_else(|| error("write NAME=VALUE, for instance width=30%".into()))?;
        let (kind, name) = match name.rsplit_once('.') {
            Some((kind, name)) => (Some(kind.to_owned()), name),
            None => (None, name),
        };
        Ok(Self { kind, name: name.to_owned(), value: value.parse().map_err(error)? })
    }
}
