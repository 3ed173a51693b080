//! Compiled scripts.

use super::source::{Diagnostic, Source, Span};
use super::value::Value;
use super::word::Word;
use crate::mesh::Domain;
use rustc_hash::FxHashMap;
use std::sync::Arc;

/// A text or a name, interned: equal texts have equal ids.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub struct StringId(pub u32);

/// The interned texts of a set of scripts.
#[derive(Clone, Default, Debug)]
pub struct Strings {
    texts: Vec<Arc<str>>,
    ids: FxHashMap<Arc<str>, StringId>,
}

impl Strings {
    /// The id of `text`.
    pub fn intern(&mut self, text: &str) -> StringId {
        if let Some(&id) = self.ids.get(text) {
            return id;
        }
        let text: Arc<str> = text.into();
        let id = StringId(self.texts.len() as u32);
        self.texts.push(Arc::clone(&text));
        self.ids.insert(text, id);
        id
    }

    /// The text of an id.
    pub fn get(&self, id: StringId) -> Arc<str> {
        self.texts.get(id.0 as usize).map_or_else(|| "".into(), Arc::clone)
    }

    /// All texts, by ascending id.
    pub fn iter(&self) -> impl Iterator<Item = &str> {
        self.texts.iter().map(|text| &**text)
    }

    /// How many texts there are.
    pub fn len(&self) -> usize {
        self.texts.len()
    }

    /// True when there is none.
    pub fn is_empty(&self) -> bool {
        self.texts.is_empty()
    }
}

/// One operation.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) enum Op {
    Push(Value),
    /// Node of the pattern, by its number.
    Node {
        index: u32,
        domain: Domain,
    },
    Parameter(u32),
    /// Pushes a register; executes it when it is a procedure.
    Load(u32),
    LoadRaw(u32),
    Store(u32),
    /// Begins a fresh set of registers for the rest of the block.
    UseRegisters {
        first: u32,
        count: u32,
    },
    Word(Word),
    /// Looks a name up in the dictionary stack and executes what it finds.
    Lookup(StringId),
    /// Replaces a dictionary by its entry and executes that when it is a procedure.
    Member(StringId),
    /// Ends a block.
    Return,
}

/// A compiled script. Block 0 is the script itself, the others are its procedures.
#[derive(Clone, Debug)]
pub struct Program {
    pub(crate) source: Arc<Source>,
    pub(crate) ops: Vec<Op>,
    /// Place of each operation.
    pub(crate) spans: Vec<Span>,
    /// Index of each block's first operation.
    pub(crate) blocks: Vec<u32>,
    pub(crate) registers: u32,
}

impl Program {
    /// The words that operation `op` was compiled from.
    pub fn word(&self, op: usize) -> &str {
        self.source.slice(self.spans.get(op).copied().unwrap_or_default())
    }

    /// A message about operation `op`.
    pub(crate) fn error(&self, op: usize, message: impl Into<String>) -> Diagnostic {
        Diagnostic::new(&self.source, self.spans.get(op).copied().unwrap_or_default(), message)
    }

    /// The operation that ends the script: what is said about the script as a whole points there.
    pub(crate) fn last_op(&self) -> usize {
        self.blocks.get(1).map_or(self.ops.len(), |&next| next as usize).saturating_sub(1)
    }

    /// The first operation of block `block`.
    pub(crate) fn block(&self, block: u32) -> usize {
        self.blocks.get(block as usize).map_or(0, |&start| start as usize)
    }
}
