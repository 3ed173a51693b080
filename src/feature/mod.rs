//! What users call: features on control meshes.
//!
//! A linear feature ([`apply`]) is one pipeline: place the lines of the profile on the marked edges, rewrite by
//! rules, fit to the frozen surface, displace, measure; once more with corrected width and depth; report.

mod aftermath;
mod clock;
mod deviation;
mod displace;
mod length;
mod linear;
mod measure;
mod place;
mod profile;
mod report;
mod request;
mod settings;

pub use displace::raise;
pub use length::{Length, significant};
pub use linear::apply;
pub use place::WidthError;
pub use profile::{ALL as PROFILES, GROOVE, Line, Parameter, Profile, RIDGE};
pub use report::{Counts, Difference, Dimension, Leftover, Report, Warning};
pub use request::{Feature, FeatureError, Options};
pub use settings::SettingError;

use crate::grammar::{RuleSet, RulesError};

/// The rules of linear features, `rules/linear.rules`.
///
/// # Errors
/// None in a library that was tested; kept so that a mistake in the file is a message and not a panic.
pub fn linear_rules() -> Result<RuleSet, RulesError> {
    crate::grammar::RuleSet::parse("linear.rules", include_str!("../../rules/linear.rules"), &|_| None)
}
