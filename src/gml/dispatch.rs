//! From words to what they do.

use super::machine::{Execution, Fault};
use super::value::Value;
use super::word::Word as W;
use crate::mesh::{HalfEdgeId, Mesh};

impl Execution<'_, '_, '_> {
    pub(super) fn word(&mut self, word: W) -> Result<(), Fault> {
        match word {
            W::Pop => self.pop().map(drop),
            W::Dup => self.peek(0).and_then(|value| self.push(value)),
            W::Exch => self.exch(),
            W::Index => self.index(),
            W::Roll => self.roll(),
            W::Clear => {
                self.machine.stack.clear();
                Ok(())
            }
            W::Count => self.push(Value::Number(self.machine.stack.len() as f64)),
            W::Mark | W::OpenArray => self.push(Value::Mark),
            W::ClearToMark => self.clear_to_mark(),
            W::CountToMark => self.count_to_mark(),

            W::CloseArray => self.close_array(),
            W::Get => self.get(),
            W::Put => self.put(),
            W::Append => self.append(),
            W::Length => self.length(),
            W::Aload => self.aload(),
            W::Reverse => self.reverse(),
            W::Subarray => self.subarray(),
            W::Flatten => self.flatten(),
            W::Copy => self.copy(),
            W::Dict => self.dict(),
            W::Begin => self.begin(),
            W::End => self.end(),
            W::Def => self.def(),
            W::Edef => self.exch().and_then(|()| self.def()),
            W::Known => self.known(),
            W::Where => self.where_defined(),
            W::Load => self.load(),

            W::Exec => self.pop().and_then(|value| self.execute(value)),
            W::Eval => self.eval(),
            W::If => self.if_true(),
            W::IfElse => self.if_else(),
            W::Repeat => self.repeat(),
            W::For => self.count_through(true),
            W::ForX => self.count_through(false),
            W::Loop => self.forever(),
            W::Exit => self.exit(),
            W::ForAll => self.for_all(),
            W::TwoForAll => self.two_for_all(),
            W::Map => self.map(),
            W::TwoMap => self.two_map(),
            W::Catch => self.catch(),
            W::Throw => self.throw(),

            W::Add => self.add(),
            W::Sub => self.sub(),
            W::Mul => self.mul(),
            W::Div => self.div(),
            W::Mod => self.modulo(),
            W::Neg => self.neg(),
            W::Abs => self.abs(),
            W::Sqrt => self.number(f64::sqrt),
            W::Pow => self.numbers(f64::powf),
            W::Exp => self.number(f64::exp),
            W::Ln => self.number(f64::ln),
            W::Floor => self.number(f64::floor),
            W::Ceiling => self.number(f64::ceil),
            W::Round => self.number(f64::round),
            W::Min => self.numbers(f64::min),
            W::Max => self.numbers(f64::max),
            W::Sin => self.number(|x| x.to_radians().sin()),
            W::Cos => self.number(|x| x.to_radians().cos()),
            W::Tan => self.number(|x| x.to_radians().tan()),
            W::Asin => self.number(|x| x.asin().to_degrees()),
            W::Acos => self.number(|x| x.acos().to_degrees()),
            W::Atan => self.numbers(|y, x| y.atan2(x).to_degrees()),
            W::Eq => self.equal().and_then(|equal| self.push_boolean(equal)),
            W::Ne => self.equal().and_then(|equal| self.push_boolean(!equal)),
            W::Lt => self.compare(|a, b| a < b),
            W::Le => self.compare(|a, b| a <= b),
            W::Gt => self.compare(|a, b| a > b),
            W::Ge => self.compare(|a, b| a >= b),
            W::And => self.compare(|a, b| a != 0.0 && b != 0.0),
            W::Or => self.compare(|a, b| a != 0.0 || b != 0.0),
            W::Not => self.pop_number().and_then(|x| self.push_boolean(x == 0.0)),

            W::Vector2 => self.vector2(),
            W::Vector3 => self.vector3(),
            W::GetX => self.coordinate(0),
            W::GetY => self.coordinate(1),
            W::GetZ => self.coordinate(2),
            W::Cross => self.cross(),
            W::Dist => self.dist(),
            W::Normalize => self.normalize(),
            W::RotVec => self.rotate(),
            W::Lerp => self.lerp(),
            W::PlaneMul => self.plane_mul(),
            W::ProjectLine => self.project_line(),
            W::ProjectPlane => self.project_plane(),

            W::EdgeMate => self.step(|_, h| h.mate()),
            W::FaceCcw => self.walk(Mesh::next),
            W::FaceCw => self.walk(Mesh::prev),
            W::VertexCcw => self.walk(Mesh::vertex_ccw),
            W::VertexCw => self.walk(Mesh::vertex_cw),
            W::Source => self.vertex_of(Mesh::source),
            W::Target => self.vertex_of(Mesh::target),
            W::Face => self.face_of(),
            W::VertexPos => self.vertex_position(),
            W::EdgeDirection => self.edge_direction(),
            W::FaceNormal => self.face_normal(),
            W::FaceMidpoint => self.face_midpoint(),
            W::VertexNormal => self.vertex_normal(),
            W::FaceDegree => self.face_degree(),
            W::Valence => self.valence(),
            W::IsBoundary => self.is_boundary(),
            W::SameEdge => self.same_edge(),
            W::SameFace => self.same_face(),
            W::SameVertex => self.same_vertex(),
            W::Sharpness => self.sharpness().and_then(|s| self.push_number(s)),
            W::IsSharp => self.sharpness().and_then(|s| self.push_boolean(s > 0.0)),

            W::MakeVefs => self.make_vefs(),
            W::MakeEv => self.make_ev(),
            W::MakeEvOne => self.make_ev_one(),
            W::MakeEf => self.make_ef(),
            W::MakeFaces => self.make_faces(),
            W::KillEf => self.kill(Mesh::kill_ef),
            W::KillEv => self.kill(Mesh::kill_ev),
            W::KillVefs => self.kill(Mesh::kill_vefs),
            W::MoveV => self.move_vertex(),
            W::MoveE => self.move_edge(),
            W::MoveF => self.move_face(),
            W::SharpE => self.sharp_edge(),
            W::SharpF => self.sharp_face(),
            W::SharpV => self.sharp_vertex(),
            W::SetSharpness => self.set_sharpness(),

            W::AttrGet => self.attribute_get(),
            W::AttrHas => self.attribute_has(),
            W::AttrSet => self.attribute_set(),
            W::AttrDel => self.attribute_delete(),
            W::LinkSet => self.link_set(),
            W::LinkGet => self.link_get(),
            W::LinkHas => self.link_has(),
            W::LinkDel => self.link_delete(),
        }
    }

    /// Replaces the half-edge on top by another.
    fn step(&mut self, step: impl Fn(&Mesh, HalfEdgeId) -> HalfEdgeId) -> Result<(), Fault> {
        let h = self.pop_half_edge()?;
        let found = step(self.environment.mesh, h);
        self.push_half_edge(found)
    }

    /// A step that a number on top repeats.
    fn walk(&mut self, step: fn(&Mesh, HalfEdgeId) -> HalfEdgeId) -> Result<(), Fault> {
        if !matches!(self.peek(0)?, Value::Number(_)) {
            return self.step(step);
        }
        let count = self.pop_count()?;
        let mut h = self.pop_half_edge()?;
        self.environment.budget.spend_many(count as u64)?;
        for _ in 0..count {
            h = step(self.environment.mesh, h);
        }
        self.push_half_edge(h)
    }
}
