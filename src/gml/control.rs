//! Conditions, loops, `catch` and `throw`.

use super::machine::{Execution, Fault, Frame, Then, error};
use super::value::Value;

impl Execution<'_, '_, '_> {
    pub(super) fn eval(&mut self) -> Result<(), Fault> {
        let block = self.pop_procedure()?;
        let dict = self.pop_dict()?;
        let depth = self.machine.dicts.len() as u32;
        self.open_dict(dict)?;
        self.enter(block, Then::EndDict { depth })
    }

    pub(super) fn if_true(&mut self) -> Result<(), Fault> {
        let block = self.pop_procedure()?;
        if self.pop_number()? != 0.0 { self.call(block) } else { Ok(()) }
    }

    pub(super) fn if_else(&mut self) -> Result<(), Fault> {
        let no = self.pop_procedure()?;
        let yes = self.pop_procedure()?;
        let block = if self.pop_number()? != 0.0 { yes } else { no };
        self.call(block)
    }

    /// Pushes the frame of a loop whose first turn is still to come.
    fn start_loop(&mut self, block: u32, then: Then) -> Result<(), Fault> {
        self.push_frame(Frame { then, block, back: self.at })?;
        self.next_turn()
    }

    pub(super) fn repeat(&mut self) -> Result<(), Fault> {
        let block = self.pop_procedure()?;
        let count = self.pop_count()?;
        self.start_loop(block, Then::Repeat { left: count as u64 })
    }

    /// `first step last { } for`, and `forx`, which leaves out `last`.
    pub(super) fn count_through(&mut self, inclusive: bool) -> Result<(), Fault> {
        let block = self.pop_procedure()?;
        let limit = self.pop_number()?;
        let step = self.pop_number()?;
        let value = self.pop_number()?;
        if step == 0.0 || value + step == value {
            return Err(error(format!("a step of {step} never gets from {value} to {limit}")));
        }
        self.start_loop(block, Then::For { value, step, limit, inclusive })
    }

    pub(super) fn forever(&mut self) -> Result<(), Fault> {
        let block = self.pop_procedure()?;
        self.start_loop(block, Then::Loop)
    }

    pub(super) fn for_all(&mut self) -> Result<(), Fault> {
        let block = self.pop_procedure()?;
        let array = self.pop_array()?;
        self.start_loop(block, Then::ForAll { array, index: 0 })
    }

    fn pop_two_arrays(&mut self) -> Result<[u32; 2], Fault> {
        let b = self.pop_array()?;
        let a = self.pop_array()?;
        let [m, n] = [a, b].map(|array| self.machine.heap.array(array).len());
        if m == n { Ok([a, b]) } else { Err(error(format!("the arrays have {m} and {n} elements"))) }
    }

    pub(super) fn two_for_all(&mut self) -> Result<(), Fault> {
        let block = self.pop_procedure()?;
        let arrays = self.pop_two_arrays()?;
        self.start_loop(block, Then::TwoForAll { arrays, index: 0 })
    }

    pub(super) fn map(&mut self) -> Result<(), Fault> {
        let block = self.pop_procedure()?;
        let array = self.pop_array()?;
        let result = self.machine.heap.new_array(std::iter::empty())?;
        let height = self.machine.stack.len() as u32;
        self.start_loop(block, Then::Map { array, index: 0, result, height })
    }

    pub(super) fn two_map(&mut self) -> Result<(), Fault> {
        let block = self.pop_procedure()?;
        let arrays = self.pop_two_arrays()?;
        let result = self.machine.heap.new_array(std::iter::empty())?;
        let height = self.machine.stack.len() as u32;
        self.start_loop(block, Then::TwoMap { arrays, index: 0, result, height })
    }

    /// What comes after a block has ended: the frame on top decides.
    pub(super) fn block_ended(&mut self) -> Result<(), Fault> {
        let Some(&frame) = self.machine.frames.last() else { return Ok(()) };
        match frame.then {
            Then::Call => {
                self.machine.frames.pop();
                self.at = frame.back;
                Ok(())
            }
            Then::Registers { first, saved } => {
                self.machine.frames.pop();
                self.restore_registers(first, saved);
                self.block_ended()
            }
            Then::EndDict { depth } => {
                self.machine.frames.pop();
                self.machine.dicts.truncate(depth as usize);
                self.at = frame.back;
                Ok(())
            }
            Then::Catch { checkpoint, .. } => {
                self.machine.frames.pop();
                self.environment.mesh.commit(checkpoint);
                self.at = frame.back;
                Ok(())
            }
            Then::Map { result, height, .. } | Then::TwoMap { result, height, .. } => {
                if self.machine.stack.len() != height as usize + 1 {
                    return Err(error("the procedure of this map must leave one value"));
                }
                let value = self.pop()?;
                self.machine.heap.append(result, value)?;
                self.next_turn()
            }
            _ => self.next_turn(),
        }
    }

    /// Begins the next turn of the loop on top, or leaves it.
    fn next_turn(&mut self) -> Result<(), Fault> {
        let Some(frame) = self.machine.frames.last().copied() else { return Ok(()) };
        let element = |array: u32, index: u32| self.machine.heap.array(array).get(index as usize).copied();
        // What to push, and the loop after this turn; `None` when there is no further turn.
        let turn = match frame.then {
            Then::Repeat { left } => left.checked_sub(1).map(|left| ([None; 2], Then::Repeat { left })),
            Then::Loop => Some(([None; 2], Then::Loop)),
            Then::For { value, step, limit, inclusive } => {
                let before = if step > 0.0 { value < limit } else { value > limit };
                (before || inclusive && value == limit).then(|| {
                    let then = Then::For { value: value + step, step, limit, inclusive };
                    ([Some(Value::Number(value)), None], then)
                })
            }
            Then::ForAll { array, index } => element(array, index)
                .map(|value| ([Some(value), None], Then::ForAll { array, index: index + 1 })),
            Then::Map { array, index, result, height } => element(array, index)
                .map(|value| ([Some(value), None], Then::Map { array, index: index + 1, result, height })),
            Then::TwoForAll { arrays, index } => element(arrays[0], index)
                .zip(element(arrays[1], index))
                .map(|(a, b)| ([Some(a), Some(b)], Then::TwoForAll { arrays, index: index + 1 })),
            Then::TwoMap { arrays, index, result, height } => {
                element(arrays[0], index).zip(element(arrays[1], index)).map(|(a, b)| {
                    ([Some(a), Some(b)], Then::TwoMap { arrays, index: index + 1, result, height })
                })
            }
            Then::Call | Then::Registers { .. } | Then::EndDict { .. } | Then::Catch { .. } => None,
        };
        let Some((values, then)) = turn else {
            self.machine.frames.pop();
            self.at = frame.back;
            if let Then::Map { result, .. } | Then::TwoMap { result, .. } = frame.then {
                self.push(Value::Array(result))?;
            }
            return Ok(());
        };
        for value in values.into_iter().flatten() {
            self.push(value)?;
        }
        if let Some(top) = self.machine.frames.last_mut() {
            top.then = then;
        }
        self.at = self.program.block(frame.block);
        Ok(())
    }

    /// Ends what `frame` stands for before its time.
    fn abandon(&mut self, frame: Frame) {
        match frame.then {
            Then::Registers { first, saved } => self.restore_registers(first, saved),
            Then::EndDict { depth } => self.machine.dicts.truncate(depth as usize),
            Then::Catch { checkpoint, .. } => self.environment.mesh.commit(checkpoint),
            _ => {}
        }
    }

    pub(super) fn exit(&mut self) -> Result<(), Fault> {
        while let Some(frame) = self.machine.frames.pop() {
            match frame.then {
                Then::Repeat { .. }
                | Then::For { .. }
                | Then::Loop
                | Then::ForAll { .. }
                | Then::TwoForAll { .. } => {
                    self.at = frame.back;
                    return Ok(());
                }
                Then::Map { result, height, .. } | Then::TwoMap { result, height, .. } => {
                    self.machine.stack.truncate(height as usize);
                    self.at = frame.back;
                    return self.push(Value::Array(result));
                }
                _ => self.abandon(frame),
            }
        }
        Err(error("`exit` outside of a loop"))
    }

    pub(super) fn catch(&mut self) -> Result<(), Fault> {
        let handler = self.pop_procedure()?;
        let block = self.pop_procedure()?;
        let (height, dicts) = (self.machine.stack.len() as u32, self.machine.dicts.len() as u32);
        let checkpoint = self.environment.mesh.begin();
        self.enter(block, Then::Catch { handler, height, dicts, checkpoint })
    }

    /// Goes on with the handler of the innermost `catch`; what its procedure did to mesh and stack is taken back.
    pub(super) fn throw(&mut self) -> Result<(), Fault> {
        let value = self.pop()?;
        while let Some(frame) = self.machine.frames.pop() {
            let Then::Catch { handler, height, dicts, checkpoint } = frame.then else {
                self.abandon(frame);
                continue;
            };
            self.environment.mesh.rollback(checkpoint);
            if self.machine.stack.len() < height as usize {
                return Err(error("a procedure under `catch` took values that were on the stack before it"));
            }
            self.machine.stack.truncate(height as usize);
            self.machine.dicts.truncate(dicts as usize);
            self.at = frame.back;
            self.push(value)?;
            return self.call(handler);
        }
        Err(Fault::Thrown(self.show(&value)))
    }
}
