//! Graph grammar rules: a pattern, conditions, and a script that changes the mesh where the pattern matches
//! (Thaller, Augsdoerfer, Fellner 2016, section 5.2).
//!
//! [`RuleSet::parse`] reads a rule file and checks it; [`run`] applies the rules to a mesh until none matches. A rule
//! starts its search at the most selective attribute of its pattern, through an index, and after an application only
//! what can see the change is examined again: cost follows the marks, not the mesh. `docs/rules.md` is the reference.

mod case;
mod error;
mod layout;
mod lint;
mod parse;
mod pattern;
mod plan;
mod queue;
mod replay;
mod ruleset;
mod run;
mod sample;
mod search;
mod trace;

pub use case::{Case, CaseError};
pub use error::{Place, RulesError, RunError};
pub use ruleset::{Input, Loader, Parameter, Rule, RuleSet};
pub use run::{Limits, Outcome, RunOptions, run};
pub use sample::Sample;
pub use trace::{Application, Pass, Trace, Tracer, digest};
