//! Words of vectors.

use super::kind::Kinds;
use super::machine::{Execution, Fault, error};
use super::value::Value;
use glam::{DQuat, DVec2, DVec3};

impl Execution<'_, '_, '_> {
    pub(super) fn pop_vec3(&mut self) -> Result<DVec3, Fault> {
        match self.pop()? {
            Value::Vec3(v) => Ok(v),
            other => Err(self.mismatch(Kinds::VEC3, other)),
        }
    }

    fn pop_vec2(&mut self) -> Result<DVec2, Fault> {
        match self.pop()? {
            Value::Vec2(v) => Ok(v),
            other => Err(self.mismatch(Kinds::VEC2, other)),
        }
    }

    /// A vector of length 1 along the one on top.
    fn pop_direction(&mut self) -> Result<DVec3, Fault> {
        let v = self.pop_vec3()?;
        v.try_normalize().ok_or_else(|| error("a vector of length zero has no direction"))
    }

    pub(super) fn push_vec3(&mut self, v: DVec3) -> Result<(), Fault> {
        self.push_linear(Value::Vec3(v))
    }

    pub(super) fn vector2(&mut self) -> Result<(), Fault> {
        let y = self.pop_number()?;
        let x = self.pop_number()?;
        self.push(Value::Vec2(DVec2::new(x, y)))
    }

    pub(super) fn vector3(&mut self) -> Result<(), Fault> {
        let z = self.pop_number()?;
        let y = self.pop_number()?;
        let x = self.pop_number()?;
        self.push(Value::Vec3(DVec3::new(x, y, z)))
    }

    pub(super) fn coordinate(&mut self, axis: usize) -> Result<(), Fault> {
        let value = self.pop()?;
        let found = match value {
            Value::Vec2(v) => v.to_array().get(axis).copied(),
            Value::Vec3(v) => v.to_array().get(axis).copied(),
            _ => None,
        };
        let wanted = if axis < 2 { Kinds::VECTOR } else { Kinds::VEC3 };
        let x = found.ok_or_else(|| self.mismatch(wanted, value))?;
        self.push(Value::Number(x))
    }

    pub(super) fn cross(&mut self) -> Result<(), Fault> {
        let b = self.pop_vec3()?;
        let a = self.pop_vec3()?;
        self.push_vec3(a.cross(b))
    }

    pub(super) fn dist(&mut self) -> Result<(), Fault> {
        let b = self.pop()?;
        let a = self.pop()?;
        match (a, b) {
            (Value::Vec3(a), Value::Vec3(b)) => self.push_number(a.distance(b)),
            (Value::Vec2(a), Value::Vec2(b)) => self.push_number(a.distance(b)),
            (Value::Vec2(_) | Value::Vec3(_), b) => Err(self.mismatch(Kinds::of_value(&a), b)),
            (a, _) => Err(self.mismatch(Kinds::VECTOR, a)),
        }
    }

    pub(super) fn normalize(&mut self) -> Result<(), Fault> {
        if let Value::Vec2(v) = self.peek(0)? {
            self.pop()?;
            let unit = v.try_normalize().ok_or_else(|| error("a vector of length zero has no direction"))?;
            return self.push(Value::Vec2(unit));
        }
        let unit = self.pop_direction()?;
        self.push(Value::Vec3(unit))
    }

    /// `v axis degrees rot_vec`.
    pub(super) fn rotate(&mut self) -> Result<(), Fault> {
        let angle = self.pop_number()?;
        let axis = self.pop_direction()?;
        let v = self.pop_vec3()?;
        self.push_vec3(DQuat::from_axis_angle(axis, angle.to_radians()) * v)
    }

    /// `a b t lerp`: a + t (b - a).
    pub(super) fn lerp(&mut self) -> Result<(), Fault> {
        let t = self.pop_number()?;
        let b = self.pop()?;
        let a = self.pop()?;
        let between = match (a, b) {
            (Value::Number(a), Value::Number(b)) => Value::Number(a + (b - a) * t),
            (Value::Vec2(a), Value::Vec2(b)) => Value::Vec2(a.lerp(b, t)),
            (Value::Vec3(a), Value::Vec3(b)) => Value::Vec3(a.lerp(b, t)),
            (Value::Number(_) | Value::Vec2(_) | Value::Vec3(_), b) => {
                return Err(self.mismatch(Kinds::of_value(&a), b));
            }
            (a, _) => return Err(self.mismatch(Kinds::LINEAR, a)),
        };
        self.push_linear(between)
    }

    /// `x y (a,b) planemul`: a x + b y.
    pub(super) fn plane_mul(&mut self) -> Result<(), Fault> {
        let factors = self.pop_vec2()?;
        let y = self.pop_vec3()?;
        let x = self.pop_vec3()?;
        self.push_vec3(x * factors.x + y * factors.y)
    }

    /// `p q d project_ptline`: the point nearest to p on the line through q along d.
    pub(super) fn project_line(&mut self) -> Result<(), Fault> {
        let direction = self.pop_direction()?;
        let q = self.pop_vec3()?;
        let p = self.pop_vec3()?;
        self.push_vec3(q + direction * (p - q).dot(direction))
    }

    /// `p q n project_ptplane`: the point nearest to p in the plane through q with normal n.
    pub(super) fn project_plane(&mut self) -> Result<(), Fault> {
        let normal = self.pop_direction()?;
        let q = self.pop_vec3()?;
        let p = self.pop_vec3()?;
        self.push_vec3(p - normal * (p - q).dot(normal))
    }
}
