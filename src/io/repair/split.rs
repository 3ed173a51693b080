//! Orients faces consistently and takes apart what a manifold cannot have.
//!
//! Faces hang together only across edges that have exactly two faces and on which they agree (after flipping) which
//! side is outside. The fans that this leaves at a vertex get a vertex each: that separates the faces of an edge with
//! three or more of them, fans that met in a vertex only, and the two sides of a cut through a one-sided surface.
//! (The rule of Gueziec et al. 2001, "Cutting and stitching: converting sets of polygons to manifold surfaces".)

use super::faces::rewrite;
use crate::io::report::Repair;
use crate::io::source::Source;
use crate::io::topology::{NONE, Topology};
use rustc_hash::FxHashMap;

pub(super) fn orient_and_split(source: &mut Source) {
    let topology = Topology::new(&source.polygons);
    let orientation = topology.orientation();
    let fans = topology.fans(&orientation.conflicts);
    let mut repairs = Vec::new();
    for (face, _) in orientation.flip.iter().enumerate().filter(|&(_, &flip)| flip) {
        repairs.push(Repair::FaceFlipped { face: source.file_face(face as u32) });
    }
    for edge in topology.edges().filter(|edge| edge.len() > 2) {
        let edge_vertices = (source.file_vertex(edge[0].low), source.file_vertex(edge[0].high));
        let faces = edge.iter().map(|side| source.file_face(topology.face(side.corner))).collect();
        repairs.push(Repair::EdgeCut { edge: edge_vertices, faces });
    }
    for &(a, b) in &orientation.conflicts {
        let ends = [a, topology.next(a)].map(|corner| source.file_vertex(topology.vertex(corner)));
        let faces = [a, b].map(|corner| source.file_face(topology.face(corner)));
        repairs.push(Repair::OneSidedEdgeCut { edge: ends.into(), faces: faces.into() });
    }

    let (corner_vertices, copies) = assign_vertices(&topology, &fans, source.polygons.positions.len());
    let face_start = topology.face_start;
    add_copies(source, &copies, &mut repairs);
    if !copies.is_empty() {
        copy_creases(source, &corner_vertices, &face_start);
    }
    rewrite(source, |face, corners| {
        let start = face_start[face as usize] as usize;
        for (i, corner) in corners.iter_mut().enumerate() {
            corner.0 = corner_vertices[start + i];
        }
        if orientation.flip[face as usize] {
            // The first vertex stays the first.
            corners[1..].reverse();
        }
        true
    });
    source.report.repairs.extend(repairs);
}

/// The vertex of each corner once every fan has its own, and the (old vertex, new vertex) pairs. The fan with the
/// lowest corner keeps the vertex; new ones are numbered by their fans' lowest corners.
fn assign_vertices(topology: &Topology, fans: &[u32], vertex_count: usize) -> (Vec<u32>, Vec<(u32, u32)>) {
    let mut keeper = vec![NONE; vertex_count];
    let mut corner_vertices = Vec::with_capacity(fans.len());
    let mut copies = Vec::new();
    for (corner, &fan) in fans.iter().enumerate() {
        let vertex = topology.vertex(corner as u32);
        let assigned = match keeper.get_mut(vertex as usize) {
            _ if (fan as usize) < corner => corner_vertices[fan as usize],
            Some(keeper) if *keeper != NONE => {
                let new = (vertex_count + copies.len()) as u32;
                copies.push((vertex, new));
                new
            }
            Some(keeper) => {
                *keeper = fan;
                vertex
            }
            None => vertex,
        };
        corner_vertices.push(assigned);
    }
    (corner_vertices, copies)
}

/// Appends the new vertices, with position and sharpness of those they come from.
fn add_copies(source: &mut Source, copies: &[(u32, u32)], repairs: &mut Vec<Repair>) {
    if copies.is_empty() {
        return;
    }
    let count = source.polygons.positions.len() as u32;
    if source.file_vertices.is_empty() {
        source.file_vertices = (0..count).collect();
    }
    for &(old, _) in copies {
        source.polygons.positions.push(source.polygons.positions[old as usize]);
        source.file_vertices.push(source.file_vertices[old as usize]);
    }
    let sharpness: FxHashMap<u32, f32> = source.polygons.corners.iter().copied().collect();
    let sharp = copies.iter().filter_map(|&(old, new)| Some((new, *sharpness.get(&old)?)));
    source.polygons.corners.extend(sharp);
    let mut by_vertex = copies.to_vec();
    by_vertex.sort_unstable();
    for group in by_vertex.chunk_by(|a, b| a.0 == b.0) {
        let copies = group.iter().map(|copy| copy.1).collect();
        repairs.push(Repair::VertexSplit { vertex: source.file_vertices[group[0].0 as usize], copies });
    }
}

/// Gives the edges at new vertices the creases of the edges they come from.
fn copy_creases(source: &mut Source, corner_vertices: &[u32], face_start: &[u32]) {
    let polygons = &mut source.polygons;
    let key = |a: u32, b: u32| (a.min(b), a.max(b));
    let known: FxHashMap<(u32, u32), (usize, f32)> =
        polygons.creases.iter().enumerate().map(|(i, &(a, b, s))| (key(a, b), (i, s))).collect();
    if known.is_empty() {
        return;
    }
    let mut added = Vec::new();
    for corners in face_start.windows(2) {
        for corner in corners[0]..corners[1] {
            let next = if corner + 1 == corners[1] { corners[0] } else { corner + 1 };
            let ends = |vertices: &[u32]| key(vertices[corner as usize], vertices[next as usize]);
            let (old, new) = (ends(&polygons.face_vertices), ends(corner_vertices));
            if old != new
                && let Some(&(crease, sharpness)) = known.get(&old)
            {
                added.push((new, crease, sharpness));
            }
        }
    }
    added.sort_unstable_by_key(|&(edge, crease, _)| (edge, crease));
    added.dedup_by_key(|crease| crease.0);
    for ((a, b), crease, sharpness) in added {
        polygons.creases.push((a, b, sharpness));
        source.lines.creases.extend(source.lines.creases.get(crease).copied());
    }
}
