//! Settings as text, `width=30%`, the same for the program and the C ABI.

use super::Length;
use super::Options;

/// A setting that cannot be read.
#[derive(Clone, PartialEq, Eq, Debug, thiserror::Error)]
#[error("setting '{text}': {problem}")]
pub struct SettingError {
    /// The setting as given.
    pub text: String,
    /// What is wrong and what would be right.
    pub problem: String,
}

impl Options {
    /// Takes over `NAME=VALUE`: a length of the feature's profile, or a number for a rule set when `for_rules`.
    /// Whether the name exists is found when the feature is applied.
    ///
    /// # Errors
    /// Text that is no setting.
    pub fn set(&mut self, text: &str, for_rules: bool) -> Result<(), SettingError> {
        let error = |problem: String| SettingError { text: text.to_owned(), problem };
        let (name, value) =
            text.split_once('=').ok_or_else(|| error("write NAME=VALUE, for instance width=30%".into()))?;
        let length: Length = value.parse().map_err(error)?;
        match length {
            Length::Units(x) if for_rules => {
                self.numbers.insert(name.to_owned(), x);
            }
            Length::OfEdge(_) if for_rules => {
                return Err(error("parameters of rule files are plain numbers".into()));
            }
            length => {
                self.lengths.insert(name.to_owned(), length);
            }
        }
        Ok(())
    }
}
