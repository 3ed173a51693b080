//! The script language of rule actions: a subset of the Generative Modeling Language (Havemann 2005).
//!
//! A script is read by [`compile`] into a [`Program`], which a [`Machine`] runs on a mesh. `docs/rules.md` is the
//! reference of the language.

mod arithmetic;
mod budget;
mod check;
mod collection;
mod compile;
mod control;
mod dispatch;
mod edit;
mod graph;
mod kind;
mod lex;
mod machine;
mod program;
mod query;
mod source;
mod stack;
mod value;
mod vector;
mod word;

pub use budget::{Allowance, Budget, Stop};
pub use compile::{Scope, compile};
pub use machine::{Environment, Failure, Fault, Machine};
pub use program::{Program, StringId, Strings};
pub use source::{Diagnostic, Severity, Source, Span};
pub use value::Value;

pub(crate) use check::{Effects, Leaves, check};
pub(crate) use compile::{Definition, compile_tokens, is_word};
pub(crate) use lex::{Cursor, script};
pub(crate) use program::Op;
pub(crate) use word::Word;

/// Names of the words of the language, in the order of the reference.
pub fn words() -> impl Iterator<Item = &'static str> {
    word::Word::ALL.iter().map(|word| word.signature().name)
}
