//! Words that move values on the stack.

use super::machine::{Execution, Fault, error};
use super::value::Value;

impl Execution<'_, '_, '_> {
    /// A whole number from 0.
    pub(super) fn pop_count(&mut self) -> Result<usize, Fault> {
        let n = self.pop_integer()?;
        usize::try_from(n)
            .map_err(|_| error(format!("this needs a number from 0, but finds {n} on the stack")))
    }

    pub(super) fn exch(&mut self) -> Result<(), Fault> {
        let (top, below) = (self.peek(0)?, self.peek(1)?);
        let stack = &mut self.machine.stack;
        stack.truncate(stack.len() - 2);
        stack.extend([top, below]);
        Ok(())
    }

    pub(super) fn index(&mut self) -> Result<(), Fault> {
        let depth = self.pop_count()?;
        let value = self.peek(depth)?;
        self.push(value)
    }

    /// `n j roll`: turns the top n values by j places towards the top.
    pub(super) fn roll(&mut self) -> Result<(), Fault> {
        let turns = self.pop_integer()?;
        let count = self.pop_count()?;
        if count == 0 {
            return Ok(());
        }
        self.peek(count - 1)?;
        self.environment.budget.spend_many(count as u64)?;
        let stack = &mut self.machine.stack;
        let start = stack.len() - count;
        stack[start..].rotate_right(turns.rem_euclid(count as i64) as usize);
        Ok(())
    }

    /// Number of values above the topmost mark.
    pub(super) fn above_mark(&mut self) -> Result<usize, Fault> {
        let count = self.machine.stack.iter().rev().position(|value| *value == Value::Mark);
        let count = count.ok_or_else(|| error("there is no mark on the stack"))?;
        self.environment.budget.spend_many(count as u64)?;
        Ok(count)
    }

    pub(super) fn clear_to_mark(&mut self) -> Result<(), Fault> {
        let count = self.above_mark()?;
        let stack = &mut self.machine.stack;
        stack.truncate(stack.len() - count - 1);
        Ok(())
    }

    pub(super) fn count_to_mark(&mut self) -> Result<(), Fault> {
        let count = self.above_mark()?;
        self.push(Value::Number(count as f64))
    }
}
