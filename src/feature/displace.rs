//! Heights: how far the control vertices of a feature move so that its limit surface has the asked depth.
//!
//! One sparse system over the green vertices: the limit point of each is to lie at its target height along its
//! normal. In straight bands this gives the closed form 3/2 of the depth, in crossings the centre at half height
//! (docs/linear-features.md, sections 1 and 2).

use super::profile::Profile;
use crate::mesh::{Domain, Mesh, Node, Value, VertexId};
use crate::optimise::{LeastSquares, Row};
use crate::subdivision::{limit_mask, limit_normal, limit_position};
use glam::DVec3;
use rustc_hash::FxHashMap;

/// A vertex that belongs to a line of the profile.
#[derive(Clone, Copy, Debug)]
pub(super) struct LineVertex {
    pub(super) vertex: VertexId,
    /// Which line, from 0.
    pub(super) line: usize,
    /// Which line of the other feature, where two cross.
    pub(super) cross: Option<usize>,
    /// The mark on whose edge it was inserted; `None` inside a junction.
    pub(super) mark: Option<usize>,
    /// Control height as a fraction of that in a straight band, where a rule fixes it.
    pub(super) hold: Option<f64>,
}

impl LineVertex {
    /// Height of the limit surface here in units of the extent; the greater one where two features cross.
    fn height(&self, profile: &Profile) -> Option<f64> {
        [Some(self.line), self.cross]
            .into_iter()
            .flatten()
            .filter_map(|line| profile.lines.get(line)?.height)
            .max_by(|a, b| a.abs().total_cmp(&b.abs()))
    }

    /// True when both lie on one line of a feature with `count` lines. Marks may count their lines from either side.
    pub(super) fn shares_line(&self, other: &Self, count: usize) -> bool {
        let lines = |v: &Self| [Some(v.line), v.cross].into_iter().flatten();
        lines(self).any(|line| lines(other).any(|other| line == other || line + other + 1 == count))
    }
}

/// The vertices that the rules assigned to lines of the profile, by id.
pub(super) fn line_vertices(mesh: &Mesh) -> Vec<LineVertex> {
    let Some(line) = mesh.symbol("line") else { return Vec::new() };
    let number =
        |v: VertexId, name: &str| mesh.attribute_named(Node::Vertex(v), name).and_then(Value::as_number);
    mesh.nodes_with_attribute(Domain::Vertex, line)
        .into_iter()
        .map(VertexId)
        .filter_map(|vertex| {
            // Lines count from 1 in rules; a cast of anything else saturates and finds no line.
            let index = |name: &str| number(vertex, name).map(|line| (line - 1.0) as usize);
            Some(LineVertex {
                vertex,
                line: index("line")?,
                cross: index("cross"),
                mark: number(vertex, "mark").map(|mark| mark as usize),
                hold: number(vertex, "hold"),
            })
        })
        .collect()
}

/// A displaced vertex.
#[derive(Clone, Copy, Debug)]
pub(super) struct Green {
    pub(super) vertex: VertexId,
    /// Limit point before displacement.
    pub(super) base: DVec3,
    /// Unit normal of the limit surface before displacement.
    pub(super) normal: DVec3,
    /// Asked height of the limit surface along the normal, model units.
    pub(super) target: f64,
    /// Height asked for by the user, without corrections and sign.
    pub(super) asked: f64,
    hold: Option<f64>,
}

/// The vertices that are displaced, with their targets. `extents` is the depth or height per mark to aim at, `asked` that which the
/// user asked for.
pub(super) fn greens(
    mesh: &Mesh,
    lines: &[LineVertex],
    profile: &Profile,
    extents: &[f64],
    asked: &[f64],
) -> Vec<Green> {
    let extent_of: FxHashMap<VertexId, [f64; 2]> = lines
        .iter()
        .filter_map(|v| Some((v.vertex, [*extents.get(v.mark?)?, *asked.get(v.mark?)?])))
        .collect();
    let mean = |all: &[f64]| all.iter().sum::<f64>() / all.len().max(1) as f64;
    let means = [mean(extents), mean(asked)];
    lines
        .iter()
        .filter_map(|v| {
            let height = v.height(profile)?;
            let normal = limit_normal(mesh, v.vertex)?;
            let [extent, asked] = extent_of.get(&v.vertex).copied().unwrap_or_else(|| {
                // Inside a junction: what the lines around it have.
                let around: Vec<[f64; 2]> =
                    mesh.outgoing(v.vertex).filter_map(|h| extent_of.get(&mesh.target(h)).copied()).collect();
                if around.is_empty() {
                    return means;
                }
                let count = around.len() as f64;
                [0, 1].map(|i| around.iter().map(|pair| pair[i]).sum::<f64>() / count)
            });
            let base = limit_position(mesh, v.vertex);
            let (target, asked) = (height * extent, height.abs() * asked);
            Some(Green { vertex: v.vertex, base, normal, target, asked, hold: v.hold })
        })
        .collect()
}

/// Displaces single vertices: moves each along the limit normal so that its limit point rises by `height` (model
/// units, negative inwards), all together by one sparse system. Returns the vertices that have no normal and were left
/// out. This is the stage that [`apply`](super::apply) runs on the lines of a profile.
pub fn raise(mesh: &mut Mesh, heights: &[(VertexId, f64)]) -> Vec<VertexId> {
    let mut left_out = Vec::new();
    let mut greens = Vec::new();
    for &(vertex, target) in heights {
        match limit_normal(mesh, vertex) {
            Some(normal) => {
                let base = limit_position(mesh, vertex);
                greens.push(Green { vertex, base, normal, target, asked: target.abs(), hold: None });
            }
            None => left_out.push(vertex),
        }
    }
    displace(mesh, &greens);
    left_out
}

/// Moves the green vertices along their normals so that their limit points reach the targets.
pub(super) fn displace(mesh: &mut Mesh, greens: &[Green]) {
    let unknowns: FxHashMap<VertexId, u32> = greens
        .iter()
        .filter(|green| green.hold.is_none())
        .enumerate()
        .map(|(i, green)| (green.vertex, i as u32))
        .collect();
    let held: FxHashMap<VertexId, DVec3> = greens
        .iter()
        .filter_map(|green| {
            let height = green.hold? * green.target * Profile::straight_control_height();
            Some((green.vertex, green.normal * height))
        })
        .collect();
    let free: Vec<&Green> = greens.iter().filter(|green| green.hold.is_none()).collect();
    let mut rows = Vec::with_capacity(free.len());
    let mut targets = Vec::with_capacity(free.len());
    for green in &free {
        let mut row = Row::new();
        let mut target = green.target;
        for (v, weight) in limit_mask(mesh, green.vertex) {
            if let Some(&j) = unknowns.get(&v) {
                row.push((j, weight * free[j as usize].normal.dot(green.normal)));
            } else if let Some(shift) = held.get(&v) {
                target -= weight * shift.dot(green.normal);
            }
        }
        rows.push(row);
        targets.push(target);
    }
    if let Some(system) = LeastSquares::new(rows, free.len()) {
        let heights = system.solve(targets.into_iter());
        for (green, height) in free.iter().zip(heights) {
            mesh.set_position(green.vertex, mesh.position(green.vertex) + green.normal * height);
        }
    }
    for (v, shift) in held_in_order(greens, &held) {
        mesh.set_position(v, mesh.position(v) + shift);
    }
}

fn held_in_order(
    greens: &[Green],
    held: &FxHashMap<VertexId, DVec3>,
) -> impl Iterator<Item = (VertexId, DVec3)> {
    greens.iter().filter_map(|green| Some((green.vertex, *held.get(&green.vertex)?)))
}
