//! The C ABI: one file per handle, in the order of the sections of `include/welt.h`, which is generated from here.
//!
//! Every exported function does its work inside [`boundary`], so that no panic crosses into C, and takes its
//! arguments through [`arguments`] and [`options`], which check every pointer and count. These files and the exported
//! functions hold all `unsafe` code of the crate. What C readers need to know stands in the comments of the exported functions.

// The comments of exported functions become the header; its first page says what callers answer for.
#![allow(clippy::missing_safety_doc)]

mod arguments;
mod boundary;
mod deviation;
mod error;
mod evaluate;
mod failure;
#[cfg(feature = "fault-injection")]
mod fault;
mod feature;
mod file;
mod job;
mod limit;
mod loop_surface;
mod mesh;
mod options;
mod patches;
mod query;
#[cfg(test)]
mod query_tests;
mod refinement;
mod report;
mod rules;
mod scheme;
mod selection;
mod status;
mod surface;
#[cfg(test)]
mod tests;
mod version;

pub use deviation::*;
pub use error::*;
pub use evaluate::*;
#[cfg(feature = "fault-injection")]
pub use fault::*;
pub use feature::*;
pub use file::*;
pub use job::*;
pub use limit::*;
pub use loop_surface::*;
pub use mesh::*;
pub use patches::*;
pub use query::*;
pub use refinement::*;
pub use report::*;
pub use rules::*;
pub use scheme::*;
pub use selection::*;
pub use status::*;
pub use surface::*;
pub use version::*;
