//! The squares of which regions consist, and what lies beside them.

use super::frame::Frame;
use crate::mesh::{FaceId, HalfEdgeId, Mesh};
use crate::subdivision::sharpness::is_infinite;
use crate::surface::LimitSurface;
use crate::surface::places::Entry;
use rustc_hash::{FxHashMap, FxHashSet};

/// Side `side` of a cell: 0 at v = 0, 1 at u = 1, 2 at v = 1, 3 at u = 0, each from corner `side` to the next,
/// counter-clockwise.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Side {
    pub(super) cell: usize,
    pub(super) side: usize,
}

impl Side {
    pub(super) fn new(cell: usize, side: usize) -> Self {
        Self { cell, side: side % 4 }
    }
}

/// A quad, or a quarter of one and the quadrants of other faces where a component has other faces than quads.
#[derive(Clone, Debug)]
pub(super) struct Cell {
    pub(super) face: FaceId,
    /// Number of the surface's patch.
    pub(super) patch: usize,
    /// Which quarter of that patch it is; `None` for the whole.
    quarter: Option<usize>,
    /// What lies beyond each side; `None` beyond the border of the surface.
    pub(super) beyond: [Option<Side>; 4],
    /// Sides that are infinitely sharp.
    pub(super) sharp: [bool; 4],
    /// Corners at extraordinary vertices, seen from this cell.
    pub(super) irregular: [bool; 4],
    /// Parameters along u and along v at which the surface inside the cell is only as smooth as it is at knots.
    pub(super) lines: [Vec<f64>; 2],
}

/// The finest lines inside a cell that become knots: beside semi-sharp creases the surface has finer ones.
const FINEST: f64 = 1.0 / 64.0;

impl Cell {
    fn new(face: FaceId, patch: usize, quarter: Option<usize>) -> Self {
        Self {
            face,
            patch,
            quarter,
            beyond: [None; 4],
            sharp: [false; 4],
            irregular: [false; 4],
            lines: [Vec::new(), Vec::new()],
        }
    }

    /// The frame of the surface's patch where that of the cell is `frame`.
    pub(super) fn patch_frame(&self, frame: Frame) -> Frame {
        self.quarter.map_or(frame, |quarter| frame.whole(quarter))
    }

    fn examine(&mut self, surface: &LimitSurface) {
        self.examine_entry(surface, surface.patches[self.patch], self.patch_frame(Frame::unit(0, 0)));
        for lines in &mut self.lines {
            lines.sort_unstable_by(f64::total_cmp);
            lines.dedup();
        }
    }

    /// Recursion is as deep as patches are split.
    fn examine_entry(&mut self, surface: &LimitSurface, entry: Entry, frame: Frame) {
        let end = frame.origin + frame.x + frame.y;
        let (low, high) = (frame.origin.min(end), frame.origin.max(end));
        if low.max_element() >= 1.0 || high.min_element() <= 0.0 {
            return;
        }
        match entry {
            Entry::Regular(_) => {}
            Entry::Corner { turns, .. } => {
                let origin = frame.turned(usize::from(turns)).origin;
                for (corner, irregular) in self.irregular.iter_mut().enumerate() {
                    *irregular |= Frame::unit(0, 0).turned(corner).origin == origin;
                }
            }
            Entry::Split(first) => {
                let middle = (low + high) * 0.5;
                if high.x - low.x >= 2.0 * FINEST {
                    for (lines, at) in self.lines.iter_mut().zip(middle.to_array()) {
                        if at > 0.0 && at < 1.0 {
                            lines.push(at);
                        }
                    }
                }
                let quarters = surface.parts.iter().skip(first as usize).take(4);
                for (quarter, &part) in quarters.enumerate() {
                    self.examine_entry(surface, part, frame.quarter(quarter));
                }
            }
        }
    }
}

/// A part of a surface that hangs together across edges.
#[derive(Debug)]
pub(super) struct Component {
    /// Ascending by face.
    pub(super) cells: Vec<Cell>,
    /// Cells to a side of a face: 2 where some face is no quad.
    pub(super) per_side: usize,
}

/// The components of a surface, and their cells.
pub(super) fn components(mesh: &Mesh, surface: &LimitSurface) -> Vec<Component> {
    let mut seen: FxHashSet<FaceId> = FxHashSet::default();
    let mut found = Vec::new();
    for start in surface.faces() {
        if !seen.insert(start) {
            continue;
        }
        let mut faces = vec![start];
        let mut next = 0;
        while let Some(&face) = faces.get(next) {
            next += 1;
            for h in mesh.face_half_edges(face) {
                let beyond = mesh.face(h.mate());
                if surface.patch_count(beyond) > 0 && seen.insert(beyond) {
                    faces.push(beyond);
                }
            }
        }
        faces.sort_unstable();
        found.push(component(mesh, surface, &faces));
    }
    found
}

fn component(mesh: &Mesh, surface: &LimitSurface, faces: &[FaceId]) -> Component {
    let whole = faces.iter().all(|&face| surface.patch_count(face) == 1);
    let mut cells = Vec::new();
    let mut at: FxHashMap<HalfEdgeId, Side> = FxHashMap::default();
    for &face in faces {
        let first = surface.faces.patches(face).start as usize;
        let quad = surface.patch_count(face) == 1;
        for (corner, h) in mesh.face_half_edges(face).enumerate() {
            if whole {
                at.insert(h, Side::new(cells.len(), corner));
                continue;
            }
            at.insert(h, Side::new(cells.len(), 0));
            let (patch, quarter) = if quad { (first, Some(corner)) } else { (first + corner, None) };
            cells.push(Cell::new(face, patch, quarter));
        }
        if whole {
            cells.push(Cell::new(face, first, None));
        }
    }
    for (&h, &here) in &at {
        let sharp = is_infinite(mesh.edge_sharpness(h));
        let cell = &mut cells[here.cell];
        if whole {
            cell.sharp[here.side] = sharp;
            cell.beyond[here.side] = at.get(&h.mate()).copied();
            continue;
        }
        // The cell at the source of `h`: along `h`, the two sides inside the face, and along the half-edge before.
        let previous = mesh.prev(h);
        let child = |h: HalfEdgeId, side: usize| at.get(&h).map(|place| Side::new(place.cell, side));
        cell.sharp = [sharp, false, false, is_infinite(mesh.edge_sharpness(previous))];
        cell.beyond = [
            child(mesh.next(h.mate()), 3),
            child(mesh.next(h), 2),
            child(previous, 1),
            child(previous.mate(), 0),
        ];
    }
    cells.iter_mut().for_each(|cell| cell.examine(surface));
    Component { cells, per_side: if whole { 1 } else { 2 } }
}
