//! Words of numbers and the arithmetic that numbers and vectors share.

use super::kind::Kinds;
use super::machine::{Execution, Fault, error};
use super::value::Value;

impl Execution<'_, '_, '_> {
    /// A function of the number on top.
    pub(super) fn number(&mut self, f: impl Fn(f64) -> f64) -> Result<(), Fault> {
        let x = self.pop_number()?;
        self.push_number(f(x))
    }

    /// A function of the two numbers on top.
    pub(super) fn numbers(&mut self, f: impl Fn(f64, f64) -> f64) -> Result<(), Fault> {
        let y = self.pop_number()?;
        let x = self.pop_number()?;
        self.push_number(f(x, y))
    }

    pub(super) fn compare(&mut self, f: impl Fn(f64, f64) -> bool) -> Result<(), Fault> {
        let y = self.pop_number()?;
        let x = self.pop_number()?;
        self.push_boolean(f(x, y))
    }

    /// Pushes a number or a vector after a look at its coordinates.
    pub(super) fn push_linear(&mut self, value: Value) -> Result<(), Fault> {
        let finite = match value {
            Value::Number(x) => x.is_finite(),
            Value::Vec2(v) => v.is_finite(),
            Value::Vec3(v) => v.is_finite(),
            _ => true,
        };
        if !finite {
            return Err(error("the result is not finite"));
        }
        self.push(value)
    }

    fn two_kinds(&self, word: &str, a: Value, b: Value) -> Fault {
        error(format!("`{word}` cannot take {} and {}", self.describe(&a), self.describe(&b)))
    }

    pub(super) fn add(&mut self) -> Result<(), Fault> {
        let b = self.pop()?;
        let a = self.pop()?;
        let sum = match (a, b) {
            (Value::Number(a), Value::Number(b)) => Value::Number(a + b),
            (Value::Vec2(a), Value::Vec2(b)) => Value::Vec2(a + b),
            (Value::Vec3(a), Value::Vec3(b)) => Value::Vec3(a + b),
            _ => return Err(self.two_kinds("add", a, b)),
        };
        self.push_linear(sum)
    }

    pub(super) fn sub(&mut self) -> Result<(), Fault> {
        let b = self.pop()?;
        let a = self.pop()?;
        let difference = match (a, b) {
            (Value::Number(a), Value::Number(b)) => Value::Number(a - b),
            (Value::Vec2(a), Value::Vec2(b)) => Value::Vec2(a - b),
            (Value::Vec3(a), Value::Vec3(b)) => Value::Vec3(a - b),
            _ => return Err(self.two_kinds("sub", a, b)),
        };
        self.push_linear(difference)
    }

    /// Of two vectors the scalar product.
    pub(super) fn mul(&mut self) -> Result<(), Fault> {
        let b = self.pop()?;
        let a = self.pop()?;
        let product = match (a, b) {
            (Value::Number(a), Value::Number(b)) => Value::Number(a * b),
            (Value::Vec2(v), Value::Number(x)) | (Value::Number(x), Value::Vec2(v)) => Value::Vec2(v * x),
            (Value::Vec3(v), Value::Number(x)) | (Value::Number(x), Value::Vec3(v)) => Value::Vec3(v * x),
            (Value::Vec2(a), Value::Vec2(b)) => Value::Number(a.dot(b)),
            (Value::Vec3(a), Value::Vec3(b)) => Value::Number(a.dot(b)),
            _ => return Err(self.two_kinds("mul", a, b)),
        };
        self.push_linear(product)
    }

    pub(super) fn div(&mut self) -> Result<(), Fault> {
        let divisor = self.pop_number()?;
        let value = self.pop()?;
        if divisor == 0.0 {
            return Err(error("division by zero"));
        }
        let quotient = match value {
            Value::Number(x) => Value::Number(x / divisor),
            Value::Vec2(v) => Value::Vec2(v / divisor),
            Value::Vec3(v) => Value::Vec3(v / divisor),
            other => return Err(self.mismatch(Kinds::LINEAR, other)),
        };
        self.push_linear(quotient)
    }

    /// The remainder with the sign of the divisor.
    pub(super) fn modulo(&mut self) -> Result<(), Fault> {
        let divisor = self.pop_number()?;
        let x = self.pop_number()?;
        if divisor == 0.0 {
            return Err(error("division by zero"));
        }
        self.push_number(x - divisor * (x / divisor).floor())
    }

    pub(super) fn neg(&mut self) -> Result<(), Fault> {
        let negative = match self.pop()? {
            Value::Number(x) => Value::Number(-x),
            Value::Vec2(v) => Value::Vec2(-v),
            Value::Vec3(v) => Value::Vec3(-v),
            other => return Err(self.mismatch(Kinds::LINEAR, other)),
        };
        self.push(negative)
    }

    /// Of a vector its length.
    pub(super) fn abs(&mut self) -> Result<(), Fault> {
        let size = match self.pop()? {
            Value::Number(x) => x.abs(),
            Value::Vec2(v) => v.length(),
            Value::Vec3(v) => v.length(),
            other => return Err(self.mismatch(Kinds::LINEAR, other)),
        };
        self.push_number(size)
    }

    /// True for equal values; arrays are equal when their elements are, arrays inside of them only when they are
    /// the same array.
    pub(super) fn equal(&mut self) -> Result<bool, Fault> {
        let b = self.pop()?;
        let a = self.pop()?;
        if let (Value::Array(a), Value::Array(b)) = (a, b) {
            let [a, b] = [a, b].map(|array| self.machine.heap.array(array));
            self.environment.budget.spend_many(a.len() as u64)?;
            return Ok(a == b);
        }
        Ok(a == b)
    }
}
