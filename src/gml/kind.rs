//! Sets of kinds of values, for signatures of words and for the static check.

use super::value::Value;
use crate::mesh::Domain;

/// A set of kinds of values.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) struct Kinds(u16);

const NAMES: [&str; 12] = [
    "number",
    "text",
    "name",
    "2D vector",
    "vector",
    "array",
    "dictionary",
    "procedure",
    "vertex",
    "half-edge",
    "face",
    "mark",
];

impl Kinds {
    pub(crate) const NUMBER: Self = Self(1);
    pub(crate) const TEXT: Self = Self(1 << 1);
    pub(crate) const NAME: Self = Self(1 << 2);
    pub(crate) const VEC2: Self = Self(1 << 3);
    pub(crate) const VEC3: Self = Self(1 << 4);
    pub(crate) const ARRAY: Self = Self(1 << 5);
    pub(crate) const DICT: Self = Self(1 << 6);
    pub(crate) const PROCEDURE: Self = Self(1 << 7);
    pub(crate) const VERTEX: Self = Self(1 << 8);
    pub(crate) const HALF_EDGE: Self = Self(1 << 9);
    pub(crate) const FACE: Self = Self(1 << 10);
    pub(crate) const MARK: Self = Self(1 << 11);
    pub(crate) const ANY: Self = Self((1 << 12) - 1);
    pub(crate) const VECTOR: Self = Self::VEC2.or(Self::VEC3);
    pub(crate) const LINEAR: Self = Self::NUMBER.or(Self::VECTOR);
    pub(crate) const NODE: Self = Self::VERTEX.or(Self::HALF_EDGE).or(Self::FACE);
    /// What stands for a vertex: itself, or a half-edge for its source.
    pub(crate) const PLACE: Self = Self::VERTEX.or(Self::HALF_EDGE);
    /// What stands for a face: itself, or a half-edge for the face on its left.
    pub(crate) const SIDE: Self = Self::FACE.or(Self::HALF_EDGE);
    pub(crate) const KEY: Self = Self::TEXT.or(Self::NAME);

    pub(crate) const fn or(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    pub(crate) const fn and(self, other: Self) -> Self {
        Self(self.0 & other.0)
    }

    /// True when a value may be of both sets.
    pub(crate) fn meets(self, other: Self) -> bool {
        self.0 & other.0 != 0
    }

    /// True when every kind of this set is in `other`.
    pub(crate) fn within(self, other: Self) -> bool {
        self.0 & !other.0 == 0
    }

    pub(crate) fn of_domain(domain: Domain) -> Self {
        match domain {
            Domain::Vertex => Self::VERTEX,
            Domain::HalfEdge => Self::HALF_EDGE,
            Domain::Face => Self::FACE,
        }
    }

    pub(crate) fn of_value(value: &Value) -> Self {
        NAMES.iter().position(|&name| name == value.kind()).map_or(Self::ANY, |bit| Self(1 << bit))
    }

    /// The set in words: "a number or vector".
    pub(crate) fn describe(self) -> String {
        let names: Vec<&str> = NAMES
            .iter()
            .enumerate()
            .filter(|(bit, _)| self.0 & (1 << bit) != 0)
            .map(|(_, name)| *name)
            .collect();
        let names = if self == Self::ANY { "value".to_owned() } else { names.join(" or ") };
        format!("{} {names}", if names.starts_with('a') { "an" } else { "a" })
    }
}
