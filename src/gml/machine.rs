//! Runs compiled scripts: a stack machine whose calls and loops stand on a stack of their own, so that no script can
//! make this program recurse.

use super::budget::{Budget, Stop};
use super::kind::Kinds;
use super::program::{Op, Program, StringId, Strings};
use super::value::{Heap, HeapFull, Value};
use crate::mesh::{Checkpoint, EulerError, Mesh, Node, Symbol};
use std::collections::BTreeMap;

/// Values that may be on the stack.
const TALLEST: usize = 1 << 20;

/// Why a script failed.
#[derive(Clone, PartialEq, Debug)]
pub enum Fault {
    /// A mistake of the script, in words.
    Error(String),
    /// A value that was thrown and not caught, in words.
    Thrown(String),
    /// The run was stopped from outside.
    Stopped(Stop),
}

/// A [`Fault`] and the operation that raised it.
#[derive(Clone, PartialEq, Debug)]
pub struct Failure {
    /// Why.
    pub fault: Fault,
    /// Index of the operation in the program.
    pub op: usize,
}

impl From<HeapFull> for Fault {
    fn from(_: HeapFull) -> Self {
        Self::Error("the arrays and dictionaries of this script take too much memory".to_owned())
    }
}

impl From<Stop> for Fault {
    fn from(stop: Stop) -> Self {
        Self::Stopped(stop)
    }
}

/// What runs when a block ends.
#[derive(Clone, Copy, Debug)]
pub(super) enum Then {
    Call,
    /// Puts the registers of an outer call back.
    Registers {
        first: u32,
        saved: u32,
    },
    EndDict {
        depth: u32,
    },
    Repeat {
        left: u64,
    },
    For {
        value: f64,
        step: f64,
        limit: f64,
        inclusive: bool,
    },
    Loop,
    ForAll {
        array: u32,
        index: u32,
    },
    TwoForAll {
        arrays: [u32; 2],
        index: u32,
    },
    Map {
        array: u32,
        index: u32,
        result: u32,
        height: u32,
    },
    TwoMap {
        arrays: [u32; 2],
        index: u32,
        result: u32,
        height: u32,
    },
    Catch {
        handler: u32,
        height: u32,
        dicts: u32,
        checkpoint: Checkpoint,
    },
}

#[derive(Clone, Copy, Debug)]
pub(super) struct Frame {
    pub(super) then: Then,
    /// The block that a loop repeats.
    pub(super) block: u32,
    /// The operation to go on with.
    pub(super) back: usize,
}

/// The memory of running scripts; kept between runs so that they need not ask for it again.
#[derive(Debug)]
pub struct Machine {
    pub(super) strings: Strings,
    /// The mesh's symbol of each string, once it was asked for.
    pub(super) symbols: Vec<Option<Symbol>>,
    pub(super) stack: Vec<Value>,
    pub(super) frames: Vec<Frame>,
    pub(super) registers: Vec<Option<Value>>,
    pub(super) saved: Vec<Option<Value>>,
    pub(super) dicts: Vec<u32>,
    pub(super) heap: Heap,
}

/// What a script works on.
#[derive(Debug)]
pub struct Environment<'a, 'job> {
    /// The mesh.
    pub mesh: &'a mut Mesh,
    /// Ids of the nodes of the pattern, in the order of [`Scope::nodes`](super::Scope).
    pub nodes: &'a [u32],
    /// Values of the parameters, in the order of [`Scope::parameters`](super::Scope).
    pub parameters: &'a [f64],
    /// Values of attributes that are read where they are missing.
    pub examples: Option<&'a BTreeMap<String, crate::mesh::Value>>,
    /// What may still be done.
    pub budget: &'a mut Budget<'job>,
}

impl Machine {
    /// A machine for one mesh and scripts that were compiled with `strings`.
    pub fn new(strings: &Strings) -> Self {
        Self {
            strings: strings.clone(),
            symbols: Vec::new(),
            stack: Vec::new(),
            frames: Vec::new(),
            registers: Vec::new(),
            saved: Vec::new(),
            dicts: Vec::new(),
            heap: Heap::default(),
        }
    }

    /// Runs `program` from an empty stack. What it leaves is in [`stack`](Self::stack).
    ///
    /// # Errors
    /// The first failure. Changes of the mesh stay; the caller takes them back.
    pub fn run(&mut self, program: &Program, environment: &mut Environment<'_, '_>) -> Result<(), Failure> {
        self.stack.clear();
        self.frames.clear();
        self.registers.clear();
        self.registers.resize(program.registers as usize, None);
        self.saved.clear();
        self.dicts.clear();
        self.heap.reset();
        let mut execution =
            Execution { machine: self, program, environment, at: program.block(0), current: 0 };
        execution.run().map_err(|fault| Failure { fault, op: execution.current })
    }

    /// The values on the stack, the top one last.
    pub fn stack(&self) -> &[Value] {
        &self.stack
    }

    /// The elements of an array that the last run left on the stack.
    pub fn array(&self, id: u32) -> &[Value] {
        self.heap.array(id)
    }

    /// A value as a message about `mesh` shows it.
    pub fn show(&self, value: &Value, mesh: &Mesh) -> String {
        match value {
            Value::Number(x) => x.to_string(),
            Value::Text(id) => format!("\"{}\"", self.strings.get(*id)),
            Value::Name(id) => format!("/{}", self.strings.get(*id)),
            Value::Vec2(v) => format!("({}, {})", v.x, v.y),
            Value::Vec3(v) => format!("({}, {}, {})", v.x, v.y, v.z),
            Value::Array(id) => format!("array of {}", self.heap.array(*id).len()),
            Value::Node(node) => mesh.describe(*node),
            Value::Dict(_) | Value::Procedure(_) | Value::Mark => value.kind().to_owned(),
        }
    }
}

/// One run of one program.
pub(super) struct Execution<'a, 'b, 'job> {
    pub(super) machine: &'a mut Machine,
    pub(super) program: &'a Program,
    pub(super) environment: &'a mut Environment<'b, 'job>,
    /// The next operation.
    pub(super) at: usize,
    /// The present operation.
    pub(super) current: usize,
}

impl Execution<'_, '_, '_> {
    fn run(&mut self) -> Result<(), Fault> {
        loop {
            self.environment.budget.spend()?;
            self.current = self.at;
            self.at += 1;
            match self.program.ops[self.current] {
                Op::Push(value) => self.push(value)?,
                Op::Node { index, domain } => {
                    let id = self.environment.nodes[index as usize];
                    self.push(Value::Node(Node::new(domain, id)))?;
                }
                Op::Parameter(index) => {
                    let value = self.environment.parameters[index as usize];
                    self.push(Value::Number(value))?;
                }
                Op::Load(slot) => {
                    let value = self.register(slot)?;
                    self.execute(value)?;
                }
                Op::LoadRaw(slot) => {
                    let value = self.register(slot)?;
                    self.push(value)?;
                }
                Op::Store(slot) => {
                    let value = self.pop()?;
                    self.machine.registers[slot as usize] = Some(value);
                }
                Op::UseRegisters { first, count } => self.use_registers(first, count)?,
                Op::Word(word) => self.word(word)?,
                Op::Lookup(name) => {
                    let value = self.find(name)?;
                    self.execute(value)?;
                }
                Op::Member(name) => {
                    let dict = self.pop_dict()?;
                    let value = self.entry(dict, name)?;
                    self.execute(value)?;
                }
                Op::Return => {
                    if self.machine.frames.is_empty() {
                        return Ok(());
                    }
                    self.block_ended()?;
                }
            }
        }
    }

    pub(super) fn push(&mut self, value: Value) -> Result<(), Fault> {
        if self.machine.stack.len() >= TALLEST {
            return Err(error(format!("more than {TALLEST} values on the stack")));
        }
        self.machine.stack.push(value);
        Ok(())
    }

    /// Pushes a value, or calls it when it is a procedure.
    pub(super) fn execute(&mut self, value: Value) -> Result<(), Fault> {
        match value {
            Value::Procedure(block) => self.call(block),
            value => self.push(value),
        }
    }

    pub(super) fn call(&mut self, block: u32) -> Result<(), Fault> {
        self.enter(block, Then::Call)
    }

    /// Starts `block`; `then` says what happens when it ends.
    pub(super) fn enter(&mut self, block: u32, then: Then) -> Result<(), Fault> {
        self.push_frame(Frame { then, block, back: self.at })?;
        self.at = self.program.block(block);
        Ok(())
    }

    pub(super) fn push_frame(&mut self, frame: Frame) -> Result<(), Fault> {
        let depth = self.environment.budget.depth();
        if self.machine.frames.len() >= depth {
            return Err(error(format!(
                "more than {depth} procedures and loops inside one another; end the recursion, or raise the limit"
            )));
        }
        self.machine.frames.push(frame);
        Ok(())
    }

    fn register(&self, slot: u32) -> Result<Value, Fault> {
        self.machine.registers[slot as usize]
            .ok_or_else(|| error("this register is used before anything is stored in it"))
    }

    fn use_registers(&mut self, first: u32, count: u32) -> Result<(), Fault> {
        let saved = self.machine.saved.len() as u32;
        let range = first as usize..(first + count) as usize;
        self.environment.budget.spend_many(u64::from(count))?;
        // The script itself has nothing to put back.
        if !self.machine.frames.is_empty() {
            self.push_frame(Frame { then: Then::Registers { first, saved }, block: 0, back: 0 })?;
            self.machine.saved.extend_from_slice(&self.machine.registers[range.clone()]);
        }
        self.machine.registers[range].fill(None);
        Ok(())
    }

    pub(super) fn restore_registers(&mut self, first: u32, saved: u32) {
        let machine = &mut *self.machine;
        let values = &machine.saved[saved as usize..];
        machine.registers[first as usize..first as usize + values.len()].copy_from_slice(values);
        machine.saved.truncate(saved as usize);
    }

    /// The value of `name` in the innermost dictionary that has it.
    pub(super) fn find(&self, name: StringId) -> Result<Value, Fault> {
        self.find_dict(name)
            .and_then(|dict| self.machine.heap.dict(dict)?.get(&name).copied())
            .ok_or_else(|| error(format!("`{}` is not defined here", self.machine.strings.get(name))))
    }

    pub(super) fn find_dict(&self, name: StringId) -> Option<u32> {
        let heap = &self.machine.heap;
        self.machine
            .dicts
            .iter()
            .rev()
            .copied()
            .find(|&dict| heap.dict(dict).is_some_and(|entries| entries.contains_key(&name)))
    }

    pub(super) fn entry(&self, dict: u32, name: StringId) -> Result<Value, Fault> {
        self.machine
            .heap
            .dict(dict)
            .and_then(|entries| entries.get(&name))
            .copied()
            .ok_or_else(|| error(format!("the dictionary has no entry `{}`", self.machine.strings.get(name))))
    }

    // Typed access to the stack.

    pub(super) fn pop(&mut self) -> Result<Value, Fault> {
        self.machine.stack.pop().ok_or_else(underflow)
    }

    /// The value `depth` below the top.
    pub(super) fn peek(&self, depth: usize) -> Result<Value, Fault> {
        let stack = &self.machine.stack;
        stack.len().checked_sub(depth + 1).map(|at| stack[at]).ok_or_else(underflow)
    }

    /// A value as a message shows it.
    pub(super) fn show(&self, value: &Value) -> String {
        self.machine.show(value, self.environment.mesh)
    }

    /// What an Euler operator gave, its error in the user's terms.
    pub(super) fn euler<T>(&self, result: Result<T, EulerError>) -> Result<T, Fault> {
        result.map_err(|refused| error(refused.message(|node| self.environment.mesh.describe(node))))
    }

    /// A value with its kind, for messages.
    pub(super) fn describe(&self, value: &Value) -> String {
        let shown = self.show(value);
        match value {
            Value::Number(_) | Value::Text(_) | Value::Name(_) | Value::Vec2(_) | Value::Vec3(_) => {
                format!("the {} {shown}", value.kind())
            }
            Value::Array(_) => format!("an {shown}"),
            Value::Dict(_) | Value::Procedure(_) | Value::Mark => format!("a {shown}"),
            Value::Node(_) => shown,
        }
    }

    pub(super) fn mismatch(&self, wanted: Kinds, found: Value) -> Fault {
        error(format!("this needs {}, but finds {} on the stack", wanted.describe(), self.describe(&found)))
    }

    pub(super) fn pop_number(&mut self) -> Result<f64, Fault> {
        match self.pop()? {
            Value::Number(x) => Ok(x),
            other => Err(self.mismatch(Kinds::NUMBER, other)),
        }
    }

    /// A whole number in the range of `i32`.
    pub(super) fn pop_integer(&mut self) -> Result<i64, Fault> {
        let x = self.pop_number()?;
        if x.fract() == 0.0 && x.abs() <= f64::from(i32::MAX) {
            Ok(x as i64)
        } else {
            Err(error(format!("this needs a whole number, but finds {x} on the stack")))
        }
    }

    pub(super) fn pop_array(&mut self) -> Result<u32, Fault> {
        match self.pop()? {
            Value::Array(id) => Ok(id),
            other => Err(self.mismatch(Kinds::ARRAY, other)),
        }
    }

    pub(super) fn pop_dict(&mut self) -> Result<u32, Fault> {
        match self.pop()? {
            Value::Dict(id) => Ok(id),
            other => Err(self.mismatch(Kinds::DICT, other)),
        }
    }

    pub(super) fn pop_procedure(&mut self) -> Result<u32, Fault> {
        match self.pop()? {
            Value::Procedure(block) => Ok(block),
            other => Err(self.mismatch(Kinds::PROCEDURE, other)),
        }
    }

    pub(super) fn pop_name(&mut self) -> Result<StringId, Fault> {
        match self.pop()? {
            Value::Name(id) => Ok(id),
            other => Err(self.mismatch(Kinds::NAME, other)),
        }
    }

    /// A text or a name: the key of an entry, an attribute or a link.
    pub(super) fn pop_key(&mut self) -> Result<StringId, Fault> {
        match self.pop()? {
            Value::Text(id) | Value::Name(id) => Ok(id),
            other => Err(self.mismatch(Kinds::KEY, other)),
        }
    }

    pub(super) fn push_number(&mut self, x: f64) -> Result<(), Fault> {
        if !x.is_finite() {
            return Err(error("the result is not a finite number"));
        }
        self.push(Value::Number(x))
    }

    pub(super) fn push_boolean(&mut self, truth: bool) -> Result<(), Fault> {
        self.push(Value::Number(f64::from(u8::from(truth))))
    }
}

pub(super) fn error(message: impl Into<String>) -> Fault {
    Fault::Error(message.into())
}

fn underflow() -> Fault {
    error("the stack holds too few values")
}
