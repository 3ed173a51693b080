//! Words of arrays and dictionaries.

use super::kind::Kinds;
use super::machine::{Execution, Fault, error};
use super::value::Value;

/// Dictionaries that may be open at once.
const DICTS: usize = 1000;

impl Execution<'_, '_, '_> {
    pub(super) fn close_array(&mut self) -> Result<(), Fault> {
        let count = self.above_mark()?;
        let machine = &mut *self.machine;
        let start = machine.stack.len() - count;
        let array = machine.heap.new_array(machine.stack.drain(start..))?;
        machine.stack.pop();
        self.push(Value::Array(array))
    }

    /// A new array of `values`.
    pub(super) fn push_array(&mut self, values: Vec<Value>) -> Result<(), Fault> {
        self.environment.budget.spend_many(values.len() as u64)?;
        let array = self.machine.heap.new_array(values.into_iter())?;
        self.push(Value::Array(array))
    }

    /// The place of an index that wraps round.
    fn place(&self, array: u32, index: i64) -> Result<usize, Fault> {
        let length = self.machine.heap.array(array).len();
        if length == 0 {
            return Err(error("the array is empty"));
        }
        Ok(index.rem_euclid(length as i64) as usize)
    }

    pub(super) fn get(&mut self) -> Result<(), Fault> {
        let value = match self.peek(1)? {
            Value::Array(array) => {
                let index = self.pop_integer()?;
                let place = self.place(array, index)?;
                self.machine.heap.array(array)[place]
            }
            Value::Dict(dict) => {
                let key = self.pop_key()?;
                self.entry(dict, key)?
            }
            other => return Err(self.mismatch(Kinds::ARRAY.or(Kinds::DICT), other)),
        };
        self.pop()?;
        self.push(value)
    }

    pub(super) fn put(&mut self) -> Result<(), Fault> {
        match self.peek(2)? {
            Value::Array(array) => {
                let value = self.pop()?;
                let index = self.pop_integer()?;
                let place = self.place(array, index)?;
                self.machine.heap.array_mut(array)[place] = value;
            }
            Value::Dict(dict) => {
                let value = self.pop()?;
                let key = self.pop_key()?;
                self.machine.heap.define(dict, key, value)?;
            }
            other => return Err(self.mismatch(Kinds::ARRAY.or(Kinds::DICT), other)),
        }
        self.pop().map(drop)
    }

    pub(super) fn append(&mut self) -> Result<(), Fault> {
        let value = self.pop()?;
        let array = self.pop_array()?;
        Ok(self.machine.heap.append(array, value)?)
    }

    pub(super) fn length(&mut self) -> Result<(), Fault> {
        let length = match self.pop()? {
            Value::Array(array) => self.machine.heap.array(array).len(),
            Value::Dict(dict) => self.machine.heap.dict(dict).map_or(0, |entries| entries.len()),
            other => return Err(self.mismatch(Kinds::ARRAY.or(Kinds::DICT), other)),
        };
        self.push(Value::Number(length as f64))
    }

    pub(super) fn aload(&mut self) -> Result<(), Fault> {
        let array = self.pop_array()?;
        let length = self.machine.heap.array(array).len();
        self.environment.budget.spend_many(length as u64)?;
        for i in 0..length {
            let value = self.machine.heap.array(array)[i];
            self.push(value)?;
        }
        Ok(())
    }

    pub(super) fn reverse(&mut self) -> Result<(), Fault> {
        let array = self.pop_array()?;
        let values = self.machine.heap.array(array).iter().rev().copied().collect();
        self.push_array(values)
    }

    /// `array start count subarray`; indices wrap round.
    pub(super) fn subarray(&mut self) -> Result<(), Fault> {
        let count = self.pop_count()?;
        let start = self.pop_integer()?;
        let array = self.pop_array()?;
        let values = self.machine.heap.array(array);
        if count > values.len() {
            return Err(error(format!("the array has {} elements, fewer than {count}", values.len())));
        }
        if count == 0 {
            return self.push_array(Vec::new());
        }
        let start = self.place(array, start)?;
        let values = self.machine.heap.array(array).iter().cycle().skip(start).take(count).copied().collect();
        self.push_array(values)
    }

    /// Replaces arrays in an array by their elements, one level deep.
    pub(super) fn flatten(&mut self) -> Result<(), Fault> {
        let array = self.pop_array()?;
        let mut flat = Vec::new();
        for &value in self.machine.heap.array(array) {
            match value {
                Value::Array(inner) => {
                    let inner = self.machine.heap.array(inner);
                    self.environment.budget.spend_many(inner.len() as u64)?;
                    // Refused by the heap below if it is too much; kept from growing far beyond before that.
                    if flat.len() > 1 << 22 {
                        return Err(super::value::HeapFull.into());
                    }
                    flat.extend_from_slice(inner);
                }
                value => flat.push(value),
            }
        }
        self.push_array(flat)
    }

    pub(super) fn copy(&mut self) -> Result<(), Fault> {
        match self.pop()? {
            Value::Array(array) => {
                let values = self.machine.heap.array(array).to_vec();
                self.push_array(values)
            }
            Value::Dict(dict) => {
                let copy = self.machine.heap.new_dict()?;
                let entries: Vec<_> = self
                    .machine
                    .heap
                    .dict(dict)
                    .into_iter()
                    .flatten()
                    .map(|(name, value)| (*name, *value))
                    .collect();
                self.environment.budget.spend_many(entries.len() as u64)?;
                for (name, value) in entries {
                    self.machine.heap.define(copy, name, value)?;
                }
                self.push(Value::Dict(copy))
            }
            other => Err(self.mismatch(Kinds::ARRAY.or(Kinds::DICT), other)),
        }
    }

    pub(super) fn dict(&mut self) -> Result<(), Fault> {
        let dict = self.machine.heap.new_dict()?;
        self.push(Value::Dict(dict))
    }

    pub(super) fn begin(&mut self) -> Result<(), Fault> {
        let dict = self.pop_dict()?;
        self.open_dict(dict)
    }

    pub(super) fn open_dict(&mut self, dict: u32) -> Result<(), Fault> {
        if self.machine.dicts.len() >= DICTS {
            return Err(error(format!("more than {DICTS} dictionaries are open")));
        }
        self.machine.dicts.push(dict);
        Ok(())
    }

    pub(super) fn end(&mut self) -> Result<(), Fault> {
        self.machine.dicts.pop().map(drop).ok_or_else(|| error("`end` without its `begin`"))
    }

    /// Defines in the innermost dictionary; a script that opened none has one of its own.
    pub(super) fn def(&mut self) -> Result<(), Fault> {
        let value = self.pop()?;
        let name = self.pop_name()?;
        let dict = match self.machine.dicts.last() {
            Some(&dict) => dict,
            None => {
                let dict = self.machine.heap.new_dict()?;
                self.machine.dicts.push(dict);
                dict
            }
        };
        Ok(self.machine.heap.define(dict, name, value)?)
    }

    pub(super) fn known(&mut self) -> Result<(), Fault> {
        let key = self.pop_key()?;
        let dict = self.pop_dict()?;
        let known = self.machine.heap.dict(dict).is_some_and(|entries| entries.contains_key(&key));
        self.push_boolean(known)
    }

    /// `/name where`: the dictionary that defines it and 1, or 0.
    pub(super) fn where_defined(&mut self) -> Result<(), Fault> {
        let name = self.pop_name()?;
        let found = self.find_dict(name);
        if let Some(dict) = found {
            self.push(Value::Dict(dict))?;
        }
        self.push_boolean(found.is_some())
    }

    pub(super) fn load(&mut self) -> Result<(), Fault> {
        let name = self.pop_name()?;
        let value = self.find(name)?;
        self.push(value)
    }
}
