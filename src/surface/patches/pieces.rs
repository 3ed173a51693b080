//! The bicubic pieces of the limit surface, and poles from them.

use super::cells::{Cell, Side};
use super::frame::Frame;
use super::regions::Region;
use super::spline::SplinePoint;
use crate::subdivision::patch::to_quarter;
use crate::subdivision::patch_bicubic::Bicubic;
use crate::subdivision::patch_corner::{Corner, Points};
use crate::surface::LimitSurface;
use crate::surface::places::Entry;
use glam::{DVec2, DVec3};

/// Deeper than any knots go.
const DEEPEST: usize = 40;

/// An extraordinary quad refined as far as was asked.
struct Ladder {
    corner: Corner,
    /// Per level the sides that [`Corner::refine`] gives.
    levels: Vec<[Bicubic; 3]>,
}

/// Gives the pieces of a surface.
pub(super) struct Pieces<'a> {
    surface: &'a LimitSurface,
    ladders: Vec<Option<Ladder>>,
    scratch: Points,
}

impl<'a> Pieces<'a> {
    pub(super) fn new(surface: &'a LimitSurface) -> Self {
        let ladders = surface.corners.entries.iter().map(|_| None).collect();
        Self { surface, ladders, scratch: Points::new() }
    }

    /// The piece that holds (u, v) of a region, and its frame there; `None` at an extraordinary vertex.
    fn find(&mut self, cells: &[Cell], region: &Region, at: DVec2) -> Option<(Bicubic, Frame)> {
        let (patch, mut frame) = patch_of(cells, region, at);
        let mut entry = *self.surface.patches.get(patch)?;
        loop {
            match entry {
                Entry::Regular(piece) => return Some((*self.surface.bicubics.get(piece as usize)?, frame)),
                Entry::Split(first) => {
                    let local = frame.local(at);
                    let (quarter, _, _) = to_quarter(local.x, local.y);
                    frame = frame.quarter(quarter);
                    entry = *self.surface.parts.get(first as usize + quarter)?;
                }
                Entry::Corner { corner, turns } => {
                    return self.side(corner, frame.turned(usize::from(turns)), at);
                }
            }
        }
    }

    /// The surface at a point of a region, with derivatives by the parameters of the region; `None` at an extraordinary vertex.
    pub(super) fn point(&mut self, cells: &[Cell], region: &Region, at: DVec2) -> Option<SplinePoint> {
        let (piece, frame) = self.find(cells, region, at)?;
        let local = frame.local(at);
        let jet = piece.tangents(local.x, local.y);
        let derivative = |axis: DVec2| {
            let by = frame.local(frame.origin + axis);
            jet.du * by.x + jet.dv * by.y
        };
        Some(SplinePoint { position: jet.position, du: derivative(DVec2::X), dv: derivative(DVec2::Y) })
    }

    /// The side of a corner's refinements that holds `at`.
    fn side(&mut self, corner: u32, frame: Frame, at: DVec2) -> Option<(Bicubic, Frame)> {
        let local = frame.local(at);
        let (mut scale, mut level) = (0.5, 0);
        while local.max_element() < scale {
            (scale, level) = (0.5 * scale, level + 1);
            if level > DEEPEST {
                return None;
            }
        }
        let (side, x, y) = match (local.x >= scale, local.y >= scale) {
            (true, false) => (0, scale, 0.0),
            (true, true) => (1, scale, scale),
            _ => (2, 0.0, scale),
        };
        let surface = self.surface;
        let ladder = self.ladders.get_mut(corner as usize)?;
        let ladder = ladder
            .get_or_insert_with(|| Ladder { corner: surface.corners.corner(corner), levels: Vec::new() });
        while ladder.levels.len() <= level {
            let sides = ladder.corner.refine(&mut self.scratch);
            let origin = ladder.corner.origin;
            ladder.levels.push(
                sides.map(|grid| Bicubic::from_bspline(&grid.map(|row| row.map(|point| point + origin)))),
            );
        }
        let origin = frame.origin + x * frame.x + y * frame.y;
        Some((ladder.levels[level][side], Frame { origin, ..frame.scaled(scale) }))
    }

    /// Poles of the region with these knots (each once), row by row. Each is a value of the polar form (Ramshaw 1989) of
    /// a bicubic piece in its support; only that at an extraordinary vertex has none, and is the limit of the vertex.
    pub(super) fn poles(&mut self, cells: &[Cell], region: &Region, knots: [&[f64]; 2]) -> Vec<DVec3> {
        let counts = knots.map(|knots| knots.len() + 2);
        let mut poles = Vec::with_capacity(counts[0] * counts[1]);
        for j in 0..counts[1] {
            for i in 0..counts[0] {
                poles.push(self.pole(cells, region, knots, [i, j]).unwrap_or(DVec3::NAN));
            }
        }
        poles
    }

    fn pole(
        &mut self,
        cells: &[Cell],
        region: &Region,
        knots: [&[f64]; 2],
        index: [usize; 2],
    ) -> Option<DVec3> {
        let Some(span) = free_span(region, knots, index) else {
            let corner = match index.map(|index| index == 0) {
                [true, true] => 0,
                [false, true] => 1,
                [false, false] => 2,
                [true, false] => 3,
            };
            let (patch, at) = corner_of(cells, region, corner);
            return Some(self.surface.evaluate_patch(patch, at.x, at.y).position);
        };
        let middle = |axis: usize| 0.5 * (knots[axis][span[axis]] + knots[axis][span[axis] + 1]);
        let (piece, frame) = self.find(cells, region, DVec2::new(middle(0), middle(1)))?;
        let arguments = |axis: usize| -> [f64; 3] {
            let last = knots[axis].len() - 1;
            std::array::from_fn(|k| knots[axis][(index[axis] + k).saturating_sub(2).min(last)])
        };
        let [x, y] = frame.local_each(arguments(0), arguments(1));
        Some(polar(piece.points.map(|row| polar(row, x)), y))
    }
}

/// The patch of the surface that holds a point of a region, and its frame there.
pub(super) fn patch_of(cells: &[Cell], region: &Region, at: DVec2) -> (usize, Frame) {
    let place = |t: f64, count: usize| (t.max(0.0) as usize).min(count - 1);
    let (i, j) = (place(at.x, region.size[0]), place(at.y, region.size[1]));
    let Side { cell, side } = region.at(i, j);
    let cell = &cells[cell];
    (cell.patch, cell.patch_frame(Frame::unit(i, j).turned(4 - side)))
}

/// The patch of the surface at a corner of a region, and where in it the corner lies.
pub(super) fn corner_of(cells: &[Cell], region: &Region, corner: usize) -> (usize, DVec2) {
    let [m, n] = region.size.map(|count| count as f64);
    let at = [DVec2::ZERO, DVec2::new(m, 0.0), DVec2::new(m, n), DVec2::new(0.0, n)][corner % 4];
    let (patch, frame) = patch_of(cells, region, at);
    (patch, frame.local(at))
}

/// A span for a pole, in its support and near the middle, that is no last one beside an extraordinary vertex.
fn free_span(region: &Region, knots: [&[f64]; 2], index: [usize; 2]) -> Option<[usize; 2]> {
    let last = knots.map(|knots| knots.len() - 2);
    let preferred: [usize; 2] = std::array::from_fn(|axis| index[axis].saturating_sub(1).min(last[axis]));
    let taken = |span: [usize; 2]| {
        let corners = [[0, 0], [last[0], 0], last, [0, last[1]]];
        corners.into_iter().zip(region.irregular).any(|(corner, irregular)| irregular && corner == span)
    };
    let supported =
        |axis: usize, span: usize| span <= index[axis] && index[axis] <= span + 3 && span <= last[axis];
    let [a, b] = preferred;
    let choices = [[a, b], [a + 1, b], [a.wrapping_sub(1), b], [a, b + 1], [a, b.wrapping_sub(1)]];
    choices.into_iter().find(|&span| supported(0, span[0]) && supported(1, span[1]) && !taken(span))
}

/// The polar form of a cubic Bezier curve.
fn polar(p: [DVec3; 4], t: [f64; 3]) -> DVec3 {
    let mix = |a: DVec3, b: DVec3, t: f64| a * (1.0 - t) + b * t;
    let [a, b, c] = std::array::from_fn(|k| mix(p[k], p[k + 1], t[0]));
    mix(mix(a, b, t[1]), mix(b, c, t[1]), t[2])
}
