//! Attribute values: a small closed type, so that the kernel need not know the script language.

use glam::DVec3;
use std::sync::Arc;

/// The value of an attribute.
#[derive(Clone, PartialEq, Debug)]
pub enum Value {
    /// A number; the script language has no other kind.
    Number(f64),
    /// A text such as `"red"`.
    Text(Arc<str>),
    /// A point or a direction.
    Vector(DVec3),
    /// A list of numbers, such as the places where the lines of a profile cross an edge.
    Numbers(Arc<[f64]>),
}

impl Value {
    /// A text value.
    pub fn text(text: &str) -> Self {
        Self::Text(text.into())
    }

    /// The number, if this is one.
    pub fn as_number(&self) -> Option<f64> {
        match self {
            Self::Number(x) => Some(*x),
            _ => None,
        }
    }

    /// The text, if this is one.
    pub fn as_text(&self) -> Option<&str> {
        match self {
            Self::Text(t) => Some(t),
            _ => None,
        }
    }

    /// The list of numbers, if this is one.
    pub fn as_numbers(&self) -> Option<&[f64]> {
        match self {
            Self::Numbers(n) => Some(n),
            _ => None,
        }
    }
}

impl From<f64> for Value {
    fn from(x: f64) -> Self {
        Self::Number(x)
    }
}

/// What a value index is keyed by. Lists and vectors are kept together: nothing anchors on their value.
#[derive(Clone, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub(crate) enum Key {
    Number(u64),
    Text(Arc<str>),
    Other,
}

impl From<&Value> for Key {
    fn from(value: &Value) -> Self {
        match value {
            // 0.0 and -0.0 compare equal, so they share a key.
            Value::Number(x) => Self::Number((x + 0.0).to_bits()),
            Value::Text(t) => Self::Text(t.clone()),
            Value::Vector(_) | Value::Numbers(_) => Self::Other,
        }
    }
}
