//! Words of attributes and links.

use super::machine::{Execution, Fault, error};
use super::program::StringId;
use super::value::Value;
use crate::mesh::{Node, Symbol, Value as Attribute};

impl Execution<'_, '_, '_> {
    /// The mesh's symbol of a text, if it has one; remembered once it was found.
    fn symbol(&mut self, id: StringId) -> Option<Symbol> {
        let machine = &mut *self.machine;
        let index = id.0 as usize;
        if index >= machine.symbols.len() {
            machine.symbols.resize(machine.strings.len().max(index + 1), None);
        }
        if machine.symbols[index].is_none() {
            machine.symbols[index] = self.environment.mesh.symbol(&machine.strings.get(id));
        }
        machine.symbols[index]
    }

    /// The mesh's symbol of a text, made where there is none.
    fn intern(&mut self, id: StringId) -> Symbol {
        if let Some(symbol) = self.symbol(id) {
            return symbol;
        }
        self.environment.mesh.intern(&self.machine.strings.get(id))
    }

    pub(super) fn attribute_get(&mut self) -> Result<(), Fault> {
        let key = self.pop_key()?;
        let node = self.pop_node()?;
        let symbol = self.symbol(key);
        let machine = &mut *self.machine;
        let mesh = &*self.environment.mesh;
        let set = symbol.and_then(|symbol| mesh.attribute(node, symbol));
        let example = || self.environment.examples?.get(&*machine.strings.get(key));
        let value = match set.or_else(example) {
            None => {
                let name = machine.strings.get(key);
                return Err(error(format!("{} has no attribute `{name}`", mesh.describe(node))));
            }
            Some(Attribute::Number(x)) => Value::Number(*x),
            Some(Attribute::Vector(v)) => Value::Vec3(*v),
            Some(Attribute::Text(text)) => Value::Text(machine.strings.intern(text)),
            Some(Attribute::Numbers(numbers)) => {
                self.environment.budget.spend_many(numbers.len() as u64)?;
                Value::Array(machine.heap.new_array(numbers.iter().map(|&x| Value::Number(x)))?)
            }
        };
        self.push_linear(value)
    }

    pub(super) fn attribute_has(&mut self) -> Result<(), Fault> {
        let key = self.pop_key()?;
        let node = self.pop_node()?;
        let symbol = self.symbol(key);
        let has = symbol.is_some_and(|symbol| self.environment.mesh.attribute(node, symbol).is_some());
        self.push_boolean(has)
    }

    pub(super) fn attribute_set(&mut self) -> Result<(), Fault> {
        let value = self.pop()?;
        let key = self.pop_key()?;
        let node = self.pop_node()?;
        let stored = match value {
            Value::Number(x) => Attribute::Number(x),
            Value::Text(id) => Attribute::Text(self.machine.strings.get(id)),
            Value::Vec3(v) => Attribute::Vector(v),
            Value::Array(array) => {
                let elements = self.machine.heap.array(array);
                let numbers: Option<Vec<f64>> = elements
                    .iter()
                    .map(|value| if let Value::Number(x) = value { Some(*x) } else { None })
                    .collect();
                self.environment.budget.spend_many(elements.len() as u64)?;
                Attribute::Numbers(numbers.ok_or_else(|| self.unfit(value))?.into())
            }
            other => return Err(self.unfit(other)),
        };
        self.environment.budget.edit(1)?;
        let symbol = self.intern(key);
        self.environment.mesh.set_attribute(node, symbol, Some(stored));
        Ok(())
    }

    fn unfit(&self, value: Value) -> Fault {
        let found = self.show(&value);
        error(format!(
            "an attribute holds a number, a text, a vector or an array of numbers, not {found}; use a link for a node"
        ))
    }

    pub(super) fn attribute_delete(&mut self) -> Result<(), Fault> {
        let key = self.pop_key()?;
        let node = self.pop_node()?;
        if let Some(symbol) = self.symbol(key)
            && self.environment.mesh.attribute(node, symbol).is_some()
        {
            self.environment.budget.edit(1)?;
            self.environment.mesh.set_attribute(node, symbol, None);
        }
        Ok(())
    }

    fn pop_link(&mut self) -> Result<(Node, StringId, Node), Fault> {
        let to = self.pop_node()?;
        let label = self.pop_key()?;
        let from = self.pop_node()?;
        Ok((from, label, to))
    }

    pub(super) fn link_set(&mut self) -> Result<(), Fault> {
        let (from, label, to) = self.pop_link()?;
        self.environment.budget.edit(1)?;
        let symbol = self.intern(label);
        self.environment.mesh.set_link(from, symbol, to, true);
        Ok(())
    }

    pub(super) fn link_delete(&mut self) -> Result<(), Fault> {
        let (from, label, to) = self.pop_link()?;
        self.environment.budget.edit(1)?;
        if let Some(symbol) = self.symbol(label) {
            self.environment.mesh.set_link(from, symbol, to, false);
        }
        Ok(())
    }

    /// The one node to which `from` is linked.
    pub(super) fn link_get(&mut self) -> Result<(), Fault> {
        let label = self.pop_key()?;
        let from = self.pop_node()?;
        let symbol = self.symbol(label);
        let targets = symbol.map_or(&[][..], |symbol| self.environment.mesh.links(from, symbol));
        let &[to] = targets else {
            let name = self.machine.strings.get(label);
            let count = if targets.is_empty() { "no".to_owned() } else { targets.len().to_string() };
            return Err(error(format!(
                "{} has {count} links `{name}`, one is needed",
                self.environment.mesh.describe(from)
            )));
        };
        self.push(Value::Node(to))
    }

    pub(super) fn link_has(&mut self) -> Result<(), Fault> {
        let label = self.pop_key()?;
        let from = self.pop_node()?;
        let symbol = self.symbol(label);
        let has = symbol.is_some_and(|symbol| !self.environment.mesh.links(from, symbol).is_empty());
        self.push_boolean(has)
    }
}
