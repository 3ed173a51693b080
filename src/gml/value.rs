//! Values of scripts and the heap that holds the larger ones.

use super::program::StringId;
use crate::mesh::Node;
use glam::{DVec2, DVec3};
use rustc_hash::FxHashMap;

/// A value on the stack. Larger ones are references into the [`Heap`], so that a value is copied without counting
/// and nested arrays are not freed by recursion.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Value {
    /// A finite number.
    Number(f64),
    /// A text.
    Text(StringId),
    /// `/name`.
    Name(StringId),
    /// A vector of the plane.
    Vec2(DVec2),
    /// A vector of space.
    Vec3(DVec3),
    /// An array, by its place in the heap.
    Array(u32),
    /// A dictionary, by its place in the heap.
    Dict(u32),
    /// A procedure, by the number of its block.
    Procedure(u32),
    /// A vertex, a half-edge or a face.
    Node(Node),
    /// The mark that `[` leaves.
    Mark,
}

impl Value {
    /// The kind in words, for messages.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Number(_) => "number",
            Self::Text(_) => "text",
            Self::Name(_) => "name",
            Self::Vec2(_) => "2D vector",
            Self::Vec3(_) => "vector",
            Self::Array(_) => "array",
            Self::Dict(_) => "dictionary",
            Self::Procedure(_) => "procedure",
            Self::Node(Node::Vertex(_)) => "vertex",
            Self::Node(Node::HalfEdge(_)) => "half-edge",
            Self::Node(Node::Face(_)) => "face",
            Self::Mark => "mark",
        }
    }
}

/// Arrays and dictionaries of one run of a script. They stay until the run ends; their memory is used again by the
/// next run.
#[derive(Default, Debug)]
pub struct Heap {
    arrays: Vec<Vec<Value>>,
    used_arrays: usize,
    dicts: Vec<FxHashMap<StringId, Value>>,
    used_dicts: usize,
    /// Values ever put into arrays and dictionaries in this run.
    cells: usize,
}

/// Values that all arrays and dictionaries of one run may hold together (32 bytes each).
const MOST_CELLS: usize = 1 << 22;

/// The heap is full.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct HeapFull;

impl Heap {
    /// Forgets everything.
    pub fn reset(&mut self) {
        self.used_arrays = 0;
        self.used_dicts = 0;
        self.cells = 0;
    }

    /// A new array with `values`.
    ///
    /// # Errors
    /// [`HeapFull`].
    pub fn new_array(&mut self, values: impl ExactSizeIterator<Item = Value>) -> Result<u32, HeapFull> {
        self.reserve(values.len() + 1)?;
        if self.used_arrays == self.arrays.len() {
            self.arrays.push(Vec::new());
        }
        let array = &mut self.arrays[self.used_arrays];
        array.clear();
        array.extend(values);
        self.used_arrays += 1;
        Ok(self.used_arrays as u32 - 1)
    }

    /// A new empty dictionary.
    ///
    /// # Errors
    /// [`HeapFull`].
    pub fn new_dict(&mut self) -> Result<u32, HeapFull> {
        self.reserve(1)?;
        if self.used_dicts == self.dicts.len() {
            self.dicts.push(FxHashMap::default());
        }
        self.dicts[self.used_dicts].clear();
        self.used_dicts += 1;
        Ok(self.used_dicts as u32 - 1)
    }

    /// The values of an array.
    pub fn array(&self, id: u32) -> &[Value] {
        self.arrays.get(id as usize).map_or(&[], Vec::as_slice)
    }

    /// The values of an array, to be changed.
    pub fn array_mut(&mut self, id: u32) -> &mut [Value] {
        self.arrays.get_mut(id as usize).map_or(&mut [], Vec::as_mut_slice)
    }

    /// Adds a value at the end of an array.
    ///
    /// # Errors
    /// [`HeapFull`].
    pub fn append(&mut self, id: u32, value: Value) -> Result<(), HeapFull> {
        self.reserve(1)?;
        if let Some(array) = self.arrays.get_mut(id as usize) {
            array.push(value);
        }
        Ok(())
    }

    /// The entries of a dictionary.
    pub fn dict(&self, id: u32) -> Option<&FxHashMap<StringId, Value>> {
        self.dicts.get(id as usize)
    }

    /// Sets an entry of a dictionary.
    ///
    /// # Errors
    /// [`HeapFull`].
    pub fn define(&mut self, id: u32, name: StringId, value: Value) -> Result<(), HeapFull> {
        self.reserve(1)?;
        if let Some(dict) = self.dicts.get_mut(id as usize) {
            dict.insert(name, value);
        }
        Ok(())
    }

    fn reserve(&mut self, cells: usize) -> Result<(), HeapFull> {
        self.cells = self.cells.saturating_add(cells);
        if self.cells > MOST_CELLS { Err(HeapFull) } else { Ok(()) }
    }
}
