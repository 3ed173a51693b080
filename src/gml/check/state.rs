//! What is known of the stack and the registers at one place of a script.

use crate::gml::kind::Kinds;
use crate::gml::value::Value;

/// What is known of a value.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct Known {
    pub(super) kinds: Kinds,
    /// The value, if it is written in the script.
    pub(super) value: Option<Value>,
    /// Kinds of the elements, of an array.
    pub(super) elements: Kinds,
    /// The node of the pattern that it is, if that is certain.
    pub(super) node: Option<u32>,
}

impl Known {
    pub(super) const ANY: Self = Self { kinds: Kinds::ANY, value: None, elements: Kinds::ANY, node: None };

    pub(super) fn of(kinds: Kinds) -> Self {
        Self { kinds, ..Self::ANY }
    }

    /// What is known when it is one or the other.
    pub(super) fn join(self, other: Self) -> Self {
        Self {
            kinds: self.kinds.or(other.kinds),
            value: if self.value == other.value { self.value } else { None },
            elements: self.elements.or(other.elements),
            node: if self.node == other.node { self.node } else { None },
        }
    }
}

#[derive(Clone, PartialEq, Debug)]
pub(super) struct State {
    /// The values on top of the stack, the top one last.
    pub(super) stack: Vec<Known>,
    /// Further values of unknown number and kind may lie below.
    pub(super) open: bool,
    /// `None`: nothing is known.
    pub(super) registers: Vec<Option<Known>>,
}

impl State {
    pub(super) fn new(registers: usize) -> Self {
        Self { stack: Vec::new(), open: false, registers: vec![None; registers] }
    }

    /// Nothing is known any more.
    pub(super) fn forget(&mut self) {
        self.forget_stack();
        self.registers.fill(None);
    }

    pub(super) fn forget_stack(&mut self) {
        self.stack.clear();
        self.open = true;
    }

    /// What is known when the script came here in one of two ways.
    pub(super) fn join(&mut self, other: &Self) {
        self.open |= other.open || self.stack.len() != other.stack.len();
        let both = self.stack.len().min(other.stack.len());
        self.stack.drain(..self.stack.len() - both);
        let tops = &other.stack[other.stack.len() - both..];
        self.stack.iter_mut().zip(tops).for_each(|(a, b)| *a = a.join(*b));
        self.registers
            .iter_mut()
            .zip(&other.registers)
            .for_each(|(a, b)| *a = (*a).zip(*b).map(|(a, b)| a.join(b)));
    }
}
