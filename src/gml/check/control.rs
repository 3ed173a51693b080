//! Branches, loops, `exit`, `catch` and `throw` in the check.

use super::state::{Known, State};
use super::{Checker, End, MOST_TURNS};
use crate::gml::kind::Kinds;
use crate::gml::value::Value;

impl Checker<'_> {
    /// A copy of what is known.
    fn copy(&mut self) -> Result<State, End> {
        let size = self.state.stack.len() + self.state.registers.len();
        self.left = self.left.checked_sub(size).ok_or(End::Unknown)?;
        Ok(self.state.clone())
    }

    /// The script may also have come here with `other`.
    fn join(&mut self, other: State) {
        if self.live {
            self.state.join(&other);
        } else {
            self.state = other;
            self.live = true;
        }
    }

    /// Follows a procedure that is taken from the stack and run.
    pub(super) fn call(&mut self, procedure: Known) -> Result<(), End> {
        match procedure.value {
            Some(Value::Procedure(block)) => self.block(block),
            _ => {
                self.anything();
                Ok(())
            }
        }
    }

    /// A procedure that may or may not run.
    pub(super) fn branch(&mut self, body: Known) -> Result<(), End> {
        let before = self.copy()?;
        self.call(body)?;
        self.join(before);
        Ok(())
    }

    pub(super) fn branches(&mut self, yes: Known, no: Known) -> Result<(), End> {
        let before = self.copy()?;
        self.call(yes)?;
        let after = std::mem::replace(&mut self.state, before);
        let ended = std::mem::replace(&mut self.live, true);
        self.call(no)?;
        if ended {
            self.join(after);
        }
        Ok(())
    }

    /// The turns of a loop that begins each with `elements` on the stack, followed until nothing new is learnt. A
    /// loop without an end of its own is left by `exit` only.
    pub(super) fn turns(
        &mut self,
        at: usize,
        body: Known,
        elements: &[Kinds],
        ends: bool,
    ) -> Result<(), End> {
        let throws = self.throws;
        let mut entry = self.copy()?;
        self.exits.push(None);
        for turn in 0.. {
            let learnt = self.learnt;
            elements.iter().for_each(|kinds| self.push(*kinds));
            self.call(body)?;
            if !self.settle(&mut entry, turn, learnt)? {
                break;
            }
        }
        let exit = self.exits.pop().flatten();
        if !ends && exit.is_none() && self.throws == throws {
            let message = "this loop never ends: nothing in its procedure is an `exit`";
            self.warnings.push((at, message.to_owned()));
        }
        self.live = ends;
        self.state = entry;
        if let Some(exit) = exit {
            self.join(exit);
        }
        Ok(())
    }

    /// After a turn: goes back to the beginning of the loop with what is known there now. False when nothing changed,
    /// also not since so much was `learnt`.
    fn settle(&mut self, entry: &mut State, turn: usize, learnt: usize) -> Result<bool, End> {
        let before = entry.clone();
        if self.live {
            entry.join(&self.state);
        }
        if turn >= MOST_TURNS {
            entry.forget();
        }
        self.state = entry.clone();
        self.live = true;
        // The copy is paid for.
        self.copy()?;
        Ok(*entry != before || self.learnt != learnt)
    }

    /// The turns of a map over arrays with these elements.
    pub(super) fn collect(&mut self, at: usize, body: Known, elements: &[Kinds]) -> Result<(), End> {
        let mut entry = self.copy()?;
        let height = entry.stack.len();
        let mut found: Option<Known> = None;
        self.exits.push(None);
        for turn in 0.. {
            let learnt = self.learnt;
            elements.iter().for_each(|kinds| self.push(*kinds));
            self.call(body)?;
            if self.live && !self.state.open && self.state.stack.len() != height + 1 {
                return Err(End::Mistake(at, "the procedure of this map must leave one value".to_owned()));
            }
            if self.live {
                let value = self.pop(at, "map")?;
                found = Some(found.map_or(value, |found| found.join(value)));
            }
            if !self.settle(&mut entry, turn, learnt)? {
                break;
            }
        }
        if let Some(mut exit) = self.exits.pop().flatten() {
            exit.stack.truncate(height);
            self.join(exit);
        }
        let elements =
            if self.arrays_change { Kinds::ANY } else { found.map_or(Kinds::ANY, |found| found.kinds) };
        self.state.stack.push(Known { elements, ..Known::of(Kinds::ARRAY) });
        Ok(())
    }

    pub(super) fn exit(&mut self, at: usize) -> Result<(), End> {
        let here = self.copy()?;
        let Some(exit) = self.exits.last_mut() else {
            return Err(End::Mistake(at, "`exit` outside of a loop".to_owned()));
        };
        match exit {
            Some(exit) => exit.join(&here),
            None => *exit = Some(here),
        }
        self.live = false;
        Ok(())
    }

    /// The handler runs with the stack from before and the thrown value; anything may have been stored meanwhile.
    pub(super) fn catch(&mut self, body: Known, handler: Known) -> Result<(), End> {
        let mut before = self.copy()?;
        self.call(body)?;
        before.registers.fill(None);
        let after = std::mem::replace(&mut self.state, before);
        let ended = std::mem::replace(&mut self.live, true);
        self.state.stack.push(Known::ANY);
        self.call(handler)?;
        if ended {
            self.join(after);
        }
        Ok(())
    }
}
