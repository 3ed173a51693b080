//! The width and depth that a feature reached, measured on its limit surface.
//!
//! Where a band runs straight over a marked edge, the limit surface above the edge is a uniform cubic B-spline across
//! the band whose control points are (previous + 4 here + next)/6 of the stations along it. The section is taken there
//! before and after displacement, at the same parameters.

use super::displace::LineVertex;
use super::profile::Profile;
use super::section::flanks;
use crate::mesh::{FaceId, HalfEdgeId, Mesh, VertexId};
use crate::optimise::evaluate_b_spline;
use glam::DVec3;

/// A marked edge where the band runs straight: the rows of vertices across it, at the edge and at its neighbours.
/// Each row holds the edge's source, the vertices of the lines, and its target.
#[derive(Clone, Debug)]
pub(super) struct Station {
    /// Index of the mark.
    pub(super) mark: usize,
    rows: [Vec<VertexId>; 3],
    /// The marks of the neighbouring rows.
    pub(super) neighbours: [usize; 2],
}

/// The stations of the marks in `lines` (all vertices of the mesh that lie on lines, by id); `line_count` per mark.
pub(super) fn stations(mesh: &Mesh, lines: &[LineVertex], line_counts: &[usize]) -> Vec<Station> {
    let mut on_mark: Vec<Vec<Option<VertexId>>> =
        line_counts.iter().map(|&count| vec![None; count]).collect();
    for v in lines {
        if let Some(slot) = v.mark.and_then(|m| on_mark.get_mut(m)?.get_mut(v.line)) {
            *slot = Some(v.vertex);
        }
    }
    let mark_of =
        |v: VertexId| lines.binary_search_by_key(&v, |entry| entry.vertex).ok().and_then(|i| lines[i].mark);
    (0..line_counts.len())
        .filter_map(|mark| {
            let inner: Vec<VertexId> = on_mark[mark].iter().copied().collect::<Option<_>>()?;
            let station = station(mesh, mark, &inner, mark_of)?;
            let alike = |&neighbour: &usize| line_counts.get(neighbour) == Some(&inner.len());
            station.neighbours.iter().all(alike).then_some(station)
        })
        .collect()
}

/// Samples across the band for the greatest height.
const SAMPLES: usize = 64;

fn station(
    mesh: &Mesh,
    mark: usize,
    inner: &[VertexId],
    mark_of: impl Fn(VertexId) -> Option<usize>,
) -> Option<Station> {
    // The pieces of the edge, from its source to its target.
    let first = *inner.first()?;
    let second = *inner.get(1)?;
    let along = mesh.find_half_edge(first, second)?;
    let start = mesh.outgoing(first).map(HalfEdgeId::mate).find(|&h| straight_on(mesh, h) == Some(along))?;
    let mut pieces = vec![start];
    for _ in inner {
        pieces.push(straight_on(mesh, *pieces.last()?)?);
    }
    let here: Vec<VertexId> =
        pieces.iter().map(|&h| mesh.source(h)).chain(pieces.last().map(|&h| mesh.target(h))).collect();
    if here[1..here.len() - 1] != *inner {
        return None;
    }
    let side = |left: bool| -> Option<(Vec<VertexId>, usize)> {
        let mut row = Vec::with_capacity(here.len());
        for &piece in &pieces {
            let h = if left { piece } else { piece.mate() };
            if !is_quad(mesh, mesh.face(h)) {
                return None;
            }
            let (at_source, at_target) = (mesh.source(mesh.prev(h)), mesh.target(mesh.next(h)));
            row.push(if left { at_source } else { at_target });
            if row.len() == pieces.len() {
                row.push(if left { at_target } else { at_source });
            }
        }
        let mark = mark_of(row[1])?;
        let same = row[1..row.len() - 1].iter().all(|&v| mark_of(v) == Some(mark));
        same.then_some((row, mark))
    };
    let (left, left_mark) = side(true)?;
    let (right, right_mark) = side(false)?;
    Some(Station { mark, rows: [right, here, left], neighbours: [right_mark, left_mark] })
}

fn is_quad(mesh: &Mesh, f: FaceId) -> bool {
    !f.is_boundary() && mesh.face_half_edges(f).take(5).count() == 4
}

/// The half-edge that goes on straight through the target of `h`, a vertex of valence 4.
fn straight_on(mesh: &Mesh, h: HalfEdgeId) -> Option<HalfEdgeId> {
    let v = mesh.target(h);
    (mesh.outgoing(v).take(5).count() == 4).then(|| mesh.vertex_cw(mesh.next(h)))
}

impl Station {
    /// Control points across the band, and along it, of the limit surface above the marked edge.
    fn section(&self, position: &impl Fn(VertexId) -> DVec3) -> (Vec<DVec3>, Vec<DVec3>) {
        let [before, here, after] = &self.rows;
        (0..here.len())
            .map(|i| {
                let (b, h, a) = (position(before[i]), position(here[i]), position(after[i]));
                ((b + h * 4.0 + a) / 6.0, (a - b) / 2.0)
            })
            .unzip()
    }

    /// Compares the limit surface of `displaced` with that of `base`, vertex positions of one connectivity: what was
    /// reached of each parameter of the profile, in model units. `None` for parameters that cannot be measured here.
    pub(super) fn measure(
        &self,
        profile: &Profile,
        base: impl Fn(VertexId) -> DVec3,
        displaced: impl Fn(VertexId) -> DVec3,
    ) -> Vec<Option<f64>> {
        let (base, along) = self.section(&base);
        let (moved, _) = self.section(&displaced);
        // The section covers parameters 1 to n - 2 of its n control points.
        let last = base.len() as f64 - 2.0;
        let at = |points: &[DVec3], x: f64| {
            let i = (x.floor() as usize).clamp(1, points.len() - 3);
            evaluate_b_spline(&[points[i - 1], points[i], points[i + 1], points[i + 2]], x - i as f64)
        };
        let height = |x: f64| {
            let [p, across, _] = at(&base, x);
            let normal = across.cross(at(&along, x)[0]).normalize_or_zero();
            (at(&moved, x)[0] - p).dot(normal)
        };
        let mut reached = vec![None; profile.parameters.len()];
        let heights: Vec<f64> =
            (0..=SAMPLES).map(|i| height(1.0 + (last - 1.0) * i as f64 / SAMPLES as f64)).collect();
        for extent in profile.extents() {
            let top = heights.iter().map(|h| h * extent.times.signum()).fold(0.0, f64::max);
            reached[extent.parameter] = (top > 0.0 && top.is_finite()).then_some(top / extent.times.abs());
        }
        if let (Some(width), Some([low, high])) =
            (profile.width(), flanks(height, [1.0, last], profile.inside.is_some()))
        {
            let chord = at(&base, high)[0] - at(&base, low)[0];
            let direction = at(&along, (low + high) / 2.0)[0].normalize_or_zero();
            reached[width] = Some((chord - direction * chord.dot(direction)).length());
        }
        reached
    }
}
