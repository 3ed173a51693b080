//! What is fuzzed: each target takes any bytes and must return, whatever they say. `tests/bad_inputs.rs` calls the
//! same functions without a fuzzer.

mod abi;
mod files;
mod language;
mod marks;
mod models;

pub use abi::abi;
pub use files::{obj, ply};
pub use language::{profile, rules, script, trace};
pub use marks::{marks, selectors};

/// Takes any bytes; says whether they were accepted, false where they were refused with a message.
pub type Target = fn(&[u8]) -> bool;

/// All targets, by the name of their corpus.
pub const TARGETS: &[(&str, Target)] = &[
    ("obj", obj),
    ("ply", ply),
    ("marks", marks),
    ("selectors", selectors),
    ("rules", rules),
    ("script", script),
    ("profile", profile),
    ("trace", trace),
    ("abi", abi),
];
