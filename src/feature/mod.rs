//! What users call: features on control meshes.
//!
//! A [`Request`] names features and what they are set to. [`apply`] is one pipeline: place the lines of the profiles on
//! the marked edges, rewrite by rules, fit to the frozen surface, displace, measure; again with corrected width and
//! depth; report.

mod aftermath;
mod clock;
mod correct;
mod curve;
mod deviation;
mod displace;
mod enclosed;
mod length;
mod linear;
mod measure;
mod place;
mod prepare;
mod profile;
mod profile_file;
mod report;
mod report_text;
mod request;
mod section;
mod settings;
mod summary;

pub use displace::raise;
pub use length::{Length, significant};
pub use linear::apply;
pub use place::WidthError;
pub use profile::{Height, Line, Parameter, Profile, ProfileError, Unit};
pub use report::{
    Counts, Difference, Dimension, FeatureReport, Leftover, LeftoverMark, OffCurve, Report, Warning,
};
pub use request::{Feature, FeatureError, Options, Request, RequestError};
pub use settings::SettingError;

use crate::grammar::{RuleSet, RulesError};

/// The rules of linear features, `rules/linear.rules` and what it includes.
///
/// # Errors
/// None in a library that was tested; kept so that a mistake in the file is a message and not a panic.
pub fn linear_rules() -> Result<RuleSet, RulesError> {
    macro_rules! file {
        ($name:literal) => {
            include_str!(concat!("../../rules/", $name))
        };
    }
    let included = |file: &str| {
        let text = match file {
            "room.rules" => file!("room.rules"),
            "split.rules" => file!("split.rules"),
            "sides.rules" => file!("sides.rules"),
            "crossings.rules" => file!("crossings.rules"),
            "bands.rules" => file!("bands.rules"),
            "parity.rules" => file!("parity.rules"),
            "paper_tees.rules" => file!("paper_tees.rules"),
            "tees.rules" => file!("tees.rules"),
            "ends.rules" => file!("ends.rules"),
            "meets.rules" => file!("meets.rules"),
            _ => return None,
        };
        Some(text.to_owned())
    };
    RuleSet::parse("linear.rules", file!("linear.rules"), &included)
}
