//! The points round extraordinary vertices, held once per vertex however many faces meet there.

use super::kernel::{self, Four};
use super::valence::{LEVELS, Tables};
use super::{Corner, Jet};
use crate::memory::{self, OutOfMemory};
use crate::mesh::{HalfEdgeId, Mesh};
use crate::subdivision::eigenvalue;
use crate::subdivision::patch::{Evaluated, evaluate_corner};
use crate::subdivision::patch_corner::{Centre, FanKey, Tip};
use crate::subdivision::patch_direct::{place_round, quads_round};
use glam::DVec3;
use rustc_hash::FxHashMap;
use std::f64::consts::PI;

/// What corners of the same vertex share; see [`Corner`].
#[derive(Clone, Debug)]
struct Fan {
    closed: bool,
    tip: Tip,
    origin: DVec3,
    vertex: DVec3,
    /// Of its points.
    first: u32,
    spokes: u32,
    diagonals: u32,
    /// Valence whose table serves, or 0.
    table: u32,
    /// Factor of the tangents at the vertex.
    tangents: f64,
}

/// An extraordinary quad without the points of its vertex' fan.
#[derive(Clone, Debug)]
pub(super) struct CornerEntry {
    fan: u32,
    home: u32,
    outer: [DVec3; 7],
}

/// Extraordinary quads, and what evaluation beside them needs.
#[derive(Clone, Default, Debug)]
pub(super) struct Corners {
    fans: Vec<Fan>,
    /// Spokes and then diagonals of each fan, relative to its origin.
    points: Vec<DVec3>,
    pub(super) entries: Vec<CornerEntry>,
    pub(super) tables: Tables,
}

/// The fans that faces may share while a surface is frozen.
#[derive(Default)]
pub(super) struct Shared(FxHashMap<FanKey, Option<u32>>);

impl Corners {
    /// Makes room for `count` corners, whose vertices may have as many faces each.
    pub(super) fn reserve(&mut self, count: usize) -> Result<(), OutOfMemory> {
        memory::reserve(&mut self.fans, count)?;
        memory::reserve(&mut self.points, 2 * count)?;
        memory::reserve(&mut self.entries, count)
    }

    /// Adds a corner and gives its number.
    pub(super) fn add(&mut self, corner: Corner, shared: &mut Shared) -> u32 {
        let known = corner.key.and_then(|key| shared.0.get(&key).copied().flatten());
        let fan = known.unwrap_or_else(|| {
            let fan = self.add_fan(&corner, 1.0);
            if let Some(key) = corner.key {
                shared.0.insert(key, Some(fan));
            }
            fan
        });
        self.entries.push(CornerEntry { fan, home: corner.home as u32, outer: corner.outer });
        self.entries.len() as u32 - 1
    }

    fn add_fan(&mut self, corner: &Corner, tangents: f64) -> u32 {
        let plain = corner.closed && matches!(corner.tip, Tip::Moving);
        let table = if plain { self.tables.add(corner.spokes.len()) } else { 0 };
        self.fans.push(Fan {
            closed: corner.closed,
            tip: corner.tip.clone(),
            origin: corner.origin,
            vertex: corner.vertex,
            first: self.points.len() as u32,
            spokes: corner.spokes.len() as u32,
            diagonals: corner.diagonals.len() as u32,
            table,
            tangents,
        });
        self.points.extend_from_slice(&corner.spokes);
        self.points.extend_from_slice(&corner.diagonals);
        self.fans.len() as u32 - 1
    }

    /// Adds the corner of the face of `half_edge` at its source; `None` unless all faces there are quads.
    pub(super) fn add_at_vertex(
        &mut self,
        mesh: &Mesh,
        half_edge: HalfEdgeId,
        outer: [DVec3; 7],
        shared: &mut Shared,
    ) -> Option<u32> {
        let vertex = mesh.source(half_edge);
        let key = FanKey { centre: Centre::Vertex(vertex), level: 0 };
        let known = shared.0.get(&key).copied();
        let fan = known.unwrap_or_else(|| {
            let fan = quads_round(mesh, vertex).map(|(spokes, diagonals)| {
                let mut corner = Corner {
                    closed: true,
                    tip: Tip::Moving,
                    home: 0,
                    key: None,
                    origin: DVec3::ZERO,
                    vertex: mesh.position(vertex),
                    spokes: spokes.into(),
                    diagonals: diagonals.into(),
                    outer: [DVec3::ZERO; 7],
                };
                corner.recentre();
                // As long as they are one level on, where the corners of other faces are taken.
                let shrinking = eigenvalue(2.0 * PI / corner.spokes.len() as f64);
                self.add_fan(&corner, 2.0 * shrinking)
            });
            shared.0.insert(key, fan);
            fan
        })?;
        let origin = self.fans[fan as usize].origin;
        let home = place_round(mesh, half_edge) as u32;
        self.entries.push(CornerEntry { fan, home, outer: outer.map(|p| p - origin) });
        Some(self.entries.len() as u32 - 1)
    }

    /// Edges at the vertex of a corner.
    pub(super) fn edges(&self, index: u32) -> usize {
        self.fans[self.entries[index as usize].fan as usize].spokes as usize
    }

    /// The corner in the form that can be refined.
    pub(super) fn corner(&self, index: u32) -> Corner {
        let CornerEntry { fan, home, outer } = &self.entries[index as usize];
        let fan = &self.fans[*fan as usize];
        let (spokes, diagonals) = self.points_of(fan);
        Corner {
            closed: fan.closed,
            tip: fan.tip.clone(),
            home: *home as usize,
            key: None,
            origin: fan.origin,
            vertex: fan.vertex,
            spokes: spokes.into(),
            diagonals: diagonals.into(),
            outer: *outer,
        }
    }

    /// A corner at (u, v), refined level by level.
    #[cold]
    pub(super) fn evaluate(&self, index: u32, u: f64, v: f64) -> Evaluated {
        let mut found = evaluate_corner(&self.corner(index), u, v);
        if !found.smooth {
            let factor = self.fans[self.entries[index as usize].fan as usize].tangents;
            (found.jet.du, found.jet.dv) = (found.jet.du * factor, found.jet.dv * factor);
        }
        found
    }

    /// A box round the surface of the quad.
    pub(super) fn bounds(&self, index: u32) -> (DVec3, DVec3) {
        let CornerEntry { fan, outer, .. } = &self.entries[index as usize];
        let fan = &self.fans[*fan as usize];
        let (spokes, diagonals) = self.points_of(fan);
        let start = (fan.vertex, fan.vertex);
        let points = spokes.iter().chain(diagonals).chain(outer);
        let (low, high) = points.fold(start, |(low, high), &p| (low.min(p), high.max(p)));
        (low + fan.origin, high + fan.origin)
    }

    /// Unit normal at the vertex, zero where there is none.
    pub(super) fn normal(&self, index: u32) -> DVec3 {
        evaluate_corner(&self.corner(index), 0.0, 0.0).normal
    }

    fn points_of(&self, fan: &Fan) -> (&[DVec3], &[DVec3]) {
        let (first, spokes, diagonals) = (fan.first as usize, fan.spokes as usize, fan.diagonals as usize);
        self.points[first..first + spokes + diagonals].split_at(spokes)
    }

    /// A corner at (u, v) by the table of its valence; `None` where there is none for it, and at the vertex and close to it.
    #[inline(always)]
    pub(super) fn jet<const ORDER: usize, F: Four>(
        &self,
        four: F,
        index: u32,
        mut u: f64,
        mut v: f64,
    ) -> Option<Jet> {
        let entry = &self.entries[index as usize];
        let fan = &self.fans[entry.fan as usize];
        let table = self.tables.get(fan.table as usize)?;
        let mut scale = 1.0;
        for level in 0..LEVELS {
            (u, v, scale) = (2.0 * u, 2.0 * v, 2.0 * scale);
            let (side, a, b) = match (u >= 1.0, v >= 1.0) {
                (false, false) => continue,
                (true, false) => (0, u - 1.0, v),
                (true, true) => (1, u - 1.0, v - 1.0),
                (false, true) => (2, u, v - 1.0),
            };
            let (spokes, diagonals) = self.points_of(fan);
            let home = entry.home as usize;
            let [spokes, diagonals] = [spokes, diagonals].map(|points| points.split_at_checked(home));
            let ((s, first_s), (d, first_d)) = (spokes?, diagonals?);
            let bicubic = table.piece(
                four,
                level,
                side,
                [std::slice::from_ref(&fan.vertex), first_s, s, first_d, d, &entry.outer],
            );
            let mut jet = kernel::jet::<ORDER, F>(four, &bicubic, a, b).scaled(scale);
            jet.position += fan.origin;
            return Some(jet);
        }
        None
    }
}
