//! Where the lines of a profile cross each marked edge.

use super::length::significant;
use super::section::Section;
use crate::mark::Mark;
use crate::mesh::{HalfEdgeId, Mesh};
use glam::DVec3;
use rustc_hash::FxHashMap;

/// Least distance, as a fraction of the edge, that the lines keep from each other and from the edge's ends.
const CLEARANCE: f64 = 0.01;
/// Sines of the crossing angle below this are treated as this: the feature runs nearly along the edge.
const LEAST_SINE: f64 = 0.1;

/// A width that an edge cannot take. All lengths in model units.
#[derive(Clone, PartialEq, Debug, thiserror::Error)]
#[error("{}", self.message())]
pub struct WidthError {
    /// The edge.
    pub edge: (u32, u32),
    /// Its length.
    pub length: f64,
    /// The width asked for.
    pub asked: f64,
    /// Least width.
    pub low: f64,
    /// Greatest width; below `low` where the mark is too near an end of the edge for any width.
    pub high: f64,
}

impl WidthError {
    fn message(&self) -> String {
        let Self { edge: (a, b), length, asked, low, high } = self;
        let [length, asked, low, high] = [length, asked, low, high].map(|x| significant(*x));
        if self.length <= 0.0 {
            return format!("edge {a},{b} has no length; merge its vertices (--weld 0) or do not mark it");
        }
        if self.high < self.low {
            return format!(
                "the mark on edge {a},{b} is too near to one of its ends for any width; move it inwards"
            );
        }
        format!(
            "a width of {asked} does not fit edge {a},{b} (length {length}); it takes widths from {low} to {high}"
        )
    }
}

/// The direction in which a feature crosses the marked edge: along the sides of the faces beside it.
///
/// In each face the direction is between those of the two edges that leave the marked edge's ends, so that in a quad
/// crossed straight it points to the opposite mark (docs/linear-features.md, section 1, takes the angle from it).
pub(super) fn band_direction(mesh: &Mesh, h: HalfEdgeId, t: f64) -> DVec3 {
    let into_face = |h: HalfEdgeId, t: f64| {
        if mesh.face(h).is_boundary() {
            return DVec3::ZERO;
        }
        let at_source = mesh.position(mesh.source(mesh.prev(h))) - mesh.position(mesh.source(h));
        let at_target = mesh.position(mesh.target(mesh.next(h))) - mesh.position(mesh.target(h));
        at_source.lerp(at_target, t).normalize_or_zero()
    };
    (into_face(h, t) - into_face(h.mate(), 1.0 - t)).normalize_or_zero()
}

/// Sine of the angle between the feature and the marked edge.
pub(super) fn crossing_sine(mesh: &Mesh, mark: &Mark) -> f64 {
    let edge = mesh.position(mesh.target(mark.half_edge)) - mesh.position(mesh.source(mark.half_edge));
    let direction = band_direction(mesh, mark.half_edge, mark.t);
    if direction == DVec3::ZERO {
        return 1.0;
    }
    edge.normalize_or_zero().cross(direction).length().clamp(LEAST_SINE, 1.0)
}

/// A vertex moves by at most this fraction of its shortest edge; `rules/room.rules` keeps to the same.
const LONGEST_MOVE: f64 = 0.3;
/// Room that rules 7 and 8 leave between a vertex and the nearest line, in half widths of the control band.
const ROOM: f64 = 1.0 / 3.0;

/// How far the ends of a marked edge may make room for its lines, model units: 0 for those nearer to the middle of the
/// edge than the mark, on a boundary, on a crease, or where more of `marks` are near than rules 7 and 8 know about.
pub(super) fn freedom(mesh: &Mesh, mark: &Mark, marks: &FxHashMap<u32, &Mark>) -> [f64; 2] {
    let near = |h: HalfEdgeId| {
        marks.get(&h.edge()).is_some_and(|mark| if mark.half_edge == h { mark.t < 0.5 } else { mark.t > 0.5 })
    };
    [mark.half_edge, mark.half_edge.mate()].map(|h| {
        let v = mesh.source(h);
        if mark.breadth.is_some() || !near(h) || mesh.is_boundary_vertex(v) || mesh.vertex_sharpness(v) > 0.0
        {
            return 0.0;
        }
        let mut shortest = f64::INFINITY;
        for out in mesh.outgoing(v) {
            let beside = out == mesh.next(h.mate()) || h == mesh.next(out.mate());
            if mesh.edge_sharpness(out) > 0.0 || (out != h && near(out) && !beside) {
                return 0.0;
            }
            shortest = shortest.min(mesh.edge_length(out));
        }
        let others = mesh.outgoing(v).filter(|&out| out != h && near(out)).count();
        if others > 1 { 0.0 } else { LONGEST_MOVE * shortest }
    })
}

/// Places along the marked edge, increasing, for a limit surface `width` wide across the feature; without a
/// width the lines are spread over the edge, a single one lies at the mark. They lie in (0, 1) unless the ends of the edge
/// have the `freedom` to make room.
///
/// # Errors
/// [`WidthError`] when the lines would come closer than 1 % of the edge to each other or to an end that cannot make room.
pub(super) fn cuts(
    mesh: &Mesh,
    mark: &Mark,
    section: &Section,
    width: Option<f64>,
    freedom: [f64; 2],
) -> Result<Vec<f64>, WidthError> {
    let h = mark.half_edge;
    let length = mesh.edge_length(h);
    let Some(width) = width else {
        return Ok(match section.lines.as_slice() {
            [_] => vec![mark.t],
            lines => lines.iter().map(|line| (1.0 + line.across) / 2.0).collect(),
        });
    };
    // Along the edge, or across the feature where that is known: the lines divide both in the same ratios.
    let (length, sine) = match mark.breadth {
        Some(breadth) => (breadth, 1.0),
        None => (length, crossing_sine(mesh, mark)),
    };
    let lowest = CLEARANCE * length / section.least_gap();
    let most = |t: f64, freedom: f64| {
        let unmoved = (t - CLEARANCE) * length;
        if freedom > 0.0 { unmoved.max((t * length + freedom) / (1.0 + ROOM)) } else { unmoved }
    };
    let highest = most(mark.t, freedom[0]).min(most(1.0 - mark.t, freedom[1]));
    let half = section.half_width(width / sine, length, mark.t);
    if !(length > 0.0 && half >= lowest && half <= highest) {
        return Err(WidthError {
            edge: (mesh.source(h).0, mesh.target(h).0),
            length,
            asked: width,
            low: sine * section.full_width(lowest, length, mark.t),
            high: sine * section.full_width(highest.max(0.0), length, mark.t),
        });
    }
    Ok(section.lines.iter().map(|line| mark.t + line.across * half / length).collect())
}
