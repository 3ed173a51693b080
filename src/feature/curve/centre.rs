//! The centre solve: sections of the band move within the surface until the middle line's limit lies on the curve.

use super::track::Track;
use crate::feature::displace::LineVertex;
use crate::mesh::{FaceId, HalfEdgeId, Mesh, VertexId};
use crate::optimise::{LeastSquares, Row};
use crate::subdivision::{evaluate, limit_mask, limit_position};
use glam::DVec3;
use rustc_hash::FxHashMap;

/// Repetitions of the linear solve (docs/linear-features.md, section 6).
const STEPS: usize = 4;
/// A section moves by at most this fraction of its own breadth in one step.
const LONGEST_SHIFT: f64 = 0.5;
/// Sine of the angle by which a corner of a face may turn to the wrong side. Where a band cuts a corner, faces beside it
/// have straight angles to begin with; the limit surface does not fold for a little more.
const LARGEST_TURN: f64 = 0.5;
/// Times that a shift is halved to keep faces upright.
const HALVINGS: usize = 4;
/// Samples per edge of the middle line when the distance to the curve is measured.
const SAMPLES: usize = 8;

/// Vertices across the band that move together.
struct Section {
    members: Vec<VertexId>,
    /// The vertex of the middle line.
    middle: VertexId,
    track: usize,
}

impl Section {
    /// Distance between the outer vertices; infinite for a single line.
    fn breadth(&self, mesh: &Mesh) -> f64 {
        match [self.members.first(), self.members.last()] {
            [Some(&a), Some(&b)] if a != b => mesh.position(a).distance(mesh.position(b)),
            _ => f64::INFINITY,
        }
    }
}

/// Shifts the sections of bands along curves. `track_of` gives the track of a mark, `middle` the middle line of a
/// feature.
pub(in super::super) fn centre(
    mesh: &mut Mesh,
    lines: &[LineVertex],
    tracks: &[Track],
    track_of: impl Fn(usize) -> Option<usize>,
    middle: impl Fn(usize) -> Option<usize>,
) {
    if tracks.is_empty() {
        return;
    }
    let sections = sections(mesh, lines, track_of, middle);
    let section_of: FxHashMap<VertexId, usize> = sections
        .iter()
        .enumerate()
        .flat_map(|(i, section)| section.members.iter().map(move |&v| (v, i)))
        .collect();
    for _ in 0..STEPS {
        let places: Vec<Option<(DVec3, f64)>> = sections
            .iter()
            .map(|section| {
                let beside = tracks[section.track].beside(limit_position(mesh, section.middle))?;
                Some((beside.left, beside.distance))
            })
            .collect();
        let left = |i: usize| places[i].map_or(DVec3::ZERO, |place| place.0);
        let mut rows = Vec::with_capacity(sections.len());
        let mut targets = Vec::with_capacity(sections.len());
        for (i, section) in sections.iter().enumerate() {
            let mut weights: FxHashMap<u32, f64> = FxHashMap::default();
            for (v, weight) in limit_mask(mesh, section.middle) {
                if let Some(&j) = section_of.get(&v) {
                    *weights.entry(j as u32).or_default() += weight * left(j).dot(left(i));
                }
            }
            let mut row: Row = weights.into_iter().collect();
            row.sort_unstable_by_key(|entry| entry.0);
            rows.push(row);
            targets.push(-places[i].map_or(0.0, |place| place.1));
        }
        let Some(system) = LeastSquares::new(rows, sections.len()) else { return };
        let shifts = system.solve(targets.into_iter());
        let shifts: Vec<DVec3> = (0..sections.len())
            .map(|i| {
                let most = LONGEST_SHIFT * sections[i].breadth(mesh);
                left(i) * shifts[i].clamp(-most, most)
            })
            .collect();
        shift(mesh, &sections, &section_of, shifts);
    }
}

/// Moves all sections; those beside a face that would turn over half as far, and half again.
fn shift(
    mesh: &mut Mesh,
    sections: &[Section],
    section_of: &FxHashMap<VertexId, usize>,
    mut shifts: Vec<DVec3>,
) {
    let mut faces: Vec<FaceId> = section_of
        .keys()
        .flat_map(|&v| mesh.outgoing(v))
        .map(|h| mesh.face(h))
        .filter(|f| !f.is_boundary())
        .collect();
    faces.sort_unstable();
    faces.dedup();
    faces.retain(|&f| is_upright(mesh, f));
    let old: Vec<Vec<DVec3>> =
        sections.iter().map(|section| section.members.iter().map(|&v| mesh.position(v)).collect()).collect();
    for _ in 0..=HALVINGS {
        for (i, section) in sections.iter().enumerate() {
            for (&v, &position) in section.members.iter().zip(&old[i]) {
                mesh.set_position(v, position + shifts[i]);
            }
        }
        let mut turned: Vec<usize> = faces
            .iter()
            .filter(|&&f| !is_upright(mesh, f))
            .flat_map(|&f| mesh.face_vertices(f))
            .filter_map(|v| section_of.get(&v).copied())
            .collect();
        if turned.is_empty() {
            return;
        }
        turned.sort_unstable();
        turned.dedup();
        turned.into_iter().for_each(|i| shifts[i] /= 2.0);
    }
}

/// True when no corner turns further to the wrong side than [`LARGEST_TURN`].
fn is_upright(mesh: &Mesh, f: FaceId) -> bool {
    let corner = |h: HalfEdgeId| {
        let [a, b, c] = [mesh.source(h), mesh.target(h), mesh.target(mesh.next(h))].map(|v| mesh.position(v));
        [b - a, c - b]
    };
    let turns = || mesh.face_half_edges(f).map(corner);
    let normal = turns().map(|[a, b]| a.cross(b)).sum::<DVec3>().normalize_or_zero();
    turns().all(|[a, b]| a.cross(b).dot(normal) >= -LARGEST_TURN * a.length() * b.length())
}

fn sections(
    mesh: &Mesh,
    lines: &[LineVertex],
    track_of: impl Fn(usize) -> Option<usize>,
    middle: impl Fn(usize) -> Option<usize>,
) -> Vec<Section> {
    let find = |v: VertexId| lines.binary_search_by_key(&v, |entry| entry.vertex).ok().map(|i| &lines[i]);
    // Sections on marked edges, then those inside of faces: rows of vertices joined across the lines.
    let mut groups: Vec<(usize, Vec<&LineVertex>)> = Vec::new();
    let mut by_mark: FxHashMap<usize, usize> = FxHashMap::default();
    let mut inner: FxHashMap<VertexId, usize> = FxHashMap::default();
    for v in lines {
        if let Some((mark, track)) = v.mark.and_then(|mark| Some((mark, track_of(mark)?))) {
            let group = *by_mark.entry(mark).or_insert_with(|| {
                groups.push((track, Vec::new()));
                groups.len() - 1
            });
            groups[group].1.push(v);
        }
    }
    for v in lines.iter().filter(|v| v.mark.is_none()) {
        let around = || mesh.outgoing(v.vertex).filter_map(|h| find(mesh.target(h)));
        let track = around()
            .filter(|other| other.feature == v.feature && other.line == v.line)
            .find_map(|other| track_of(other.mark?));
        let Some(track) = track else { continue };
        let joined = around()
            .filter(|other| other.feature == v.feature && other.line.abs_diff(v.line) == 1)
            .find_map(|other| inner.get(&other.vertex).copied());
        let group = joined.unwrap_or_else(|| {
            groups.push((track, Vec::new()));
            groups.len() - 1
        });
        groups[group].1.push(v);
        inner.insert(v.vertex, group);
    }
    groups
        .into_iter()
        .filter_map(|(track, mut members)| {
            members.sort_by_key(|v| v.line);
            let line = middle(members.first()?.feature)?;
            let centre = members.iter().find(|v| v.line == line)?.vertex;
            Some(Section { middle: centre, members: members.iter().map(|v| v.vertex).collect(), track })
        })
        .collect()
}

/// Greatest and root mean square distance, in the surface, between the limit of the middle lines and the tracks.
pub(in super::super) fn off_curve(
    mesh: &Mesh,
    lines: &[LineVertex],
    tracks: &[Track],
    track_of: impl Fn(usize) -> Option<usize>,
    middle: impl Fn(usize) -> Option<usize>,
) -> Option<[f64; 2]> {
    let find = |v: VertexId| lines.binary_search_by_key(&v, |entry| entry.vertex).ok().map(|i| &lines[i]);
    let (mut most, mut sum, mut count) = (0.0_f64, 0.0, 0.0);
    for v in lines.iter().filter(|v| middle(v.feature) == Some(v.line)) {
        let Some(track) = v.mark.and_then(&track_of) else { continue };
        for h in mesh.outgoing(v.vertex).filter(|&h| !mesh.face(h).is_boundary()) {
            if !find(mesh.target(h)).is_some_and(|other| v.shares_line(other)) {
                continue;
            }
            for i in 0..=SAMPLES {
                let Some(point) = point_on_edge(mesh, h, i as f64 / SAMPLES as f64) else { continue };
                let Some(beside) = tracks[track].beside(point) else { continue };
                most = most.max(beside.distance.abs());
                sum += beside.distance * beside.distance;
                count += 1.0;
            }
        }
    }
    (count > 0.0).then(|| [most, f64::sqrt(sum / count)])
}

/// The limit surface above an edge of a face.
fn point_on_edge(mesh: &Mesh, h: HalfEdgeId, t: f64) -> Option<DVec3> {
    let face = mesh.face(h);
    let corner = mesh.face_half_edges(face).position(|other| other == h)?;
    let last = mesh.arity(face) - 1;
    // A quad has one patch: u along its first edge, v against its last one.
    let (corner, u, v) = match (last, corner) {
        (3, 0) => (0, t, 0.0),
        (3, 1) => (0, 1.0, t),
        (3, 2) => (0, 1.0 - t, 1.0),
        (3, _) => (0, 0.0, 1.0 - t),
        (_, corner) if t <= 0.5 => (corner, 2.0 * t, 0.0),
        (last, corner) => (if corner == last { 0 } else { corner + 1 }, 0.0, 2.0 * (1.0 - t)),
    };
    Some(evaluate(mesh, face, corner, u, v)?.position)
}
