//! The result does not depend on the numbers of vertices and faces, nor on where a face begins.

use super::case::Case;
use super::checks::ensure;
use super::random::Random;
use glam::DVec3;
use rustc_hash::FxHashMap;
use std::collections::BTreeSet;
use welt::mark::Mark;
use welt::mesh::{Mesh, Polygons, VertexId};
use welt::optimise::Stop;

/// Distance of vertices that count as the same, as a fraction of the size: sums are taken in another order.
const NEAR: f64 = 1e-7;

/// The mesh with every vertex moved a little, so that no two ways cost the same.
fn shaken(mesh: &Mesh, random: &mut Random) -> Polygons {
    let mut polygons = mesh.to_polygons();
    let edge = mesh.edges().map(|h| mesh.edge_length(h)).sum::<f64>() / mesh.edges().count().max(1) as f64;
    let mut shift = || random.between(-1e-3, 1e-3) * edge;
    for p in &mut polygons.positions {
        *p += DVec3::new(shift(), shift(), shift());
    }
    polygons
}

/// The same surface under other numbers: vertex `v` becomes `vertices[v]`.
fn renumbered(polygons: &Polygons, vertices: &[u32], random: &mut Random) -> Polygons {
    let mut positions = vec![DVec3::ZERO; polygons.positions.len()];
    for (&to, &p) in vertices.iter().zip(&polygons.positions) {
        positions[to as usize] = p;
    }
    let faces: Vec<&[u32]> = polygons.faces().collect();
    let mut face_sizes = Vec::new();
    let mut face_vertices = Vec::new();
    for f in random.permutation(faces.len()) {
        let mut face: Vec<u32> = faces[f as usize].iter().map(|&v| vertices[v as usize]).collect();
        face.rotate_left(random.below(faces[f as usize].len()));
        face_sizes.push(face.len() as u32);
        face_vertices.extend(face);
    }
    let creases = polygons.creases.iter().map(|&(a, b, s)| (vertices[a as usize], vertices[b as usize], s));
    let corners = polygons.corners.iter().map(|&(v, s)| (vertices[v as usize], s));
    Polygons {
        positions,
        face_sizes,
        face_vertices,
        creases: creases.collect(),
        corners: corners.collect(),
        subdivision: polygons.subdivision,
        ..Polygons::default()
    }
}

pub fn result_is_the_same(case: &Case) -> Result<(), String> {
    let mut random = Random::new(case.seed);
    let mut polygons = shaken(&case.model.mesh, &mut random);
    polygons.holes.clear();
    let to = random.permutation(polygons.positions.len());
    let mut first = Mesh::from_polygons(&polygons).map_err(|e| e.to_string())?;
    let mut second =
        Mesh::from_polygons(&renumbered(&polygons, &to, &mut random)).map_err(|e| e.to_string())?;
    let moved = |mesh: &Mesh, vertex: &dyn Fn(u32) -> u32| -> Option<Vec<Mark>> {
        let original = &case.model.mesh;
        case.marks
            .iter()
            .map(|mark| {
                let [a, b] =
                    [original.source(mark.half_edge), original.target(mark.half_edge)].map(|v| vertex(v.0));
                let half_edge = mesh.find_half_edge(VertexId(a), VertexId(b))?;
                Some(Mark { half_edge, ..mark.clone() })
            })
            .collect()
    };
    let marks = moved(&first, &|v| v).ok_or("an edge is lost")?;
    let renumbered_marks = moved(&second, &|v| to[v as usize]).ok_or("an edge is lost")?;
    let size = first.size();
    match (case.apply_to(&mut first, &marks), case.apply_to(&mut second, &renumbered_marks)) {
        (Err(_), Err(_)) => Ok(()),
        (Ok(one), Ok(two)) => {
            ensure!(one.after == two.after, "{:?} and {:?} elements", one.after, two.after);
            ensure!(one.rules == two.rules, "rules: {:?} and {:?}", one.rules, two.rules);
            // A fit that has not converged after its steps may end elsewhere, and one that made the surface worse first was
            // such: their positions are not compared.
            if [&one, &two].iter().any(|report| report.fit.stop == Stop::StepLimit || report.fit.held > 0) {
                return Ok(());
            }
            same_surface(&first.to_polygons(), &second.to_polygons(), size)
        }
        (one, two) => Err(format!("one numbering fails: {:?} {:?}", one.err(), two.err())),
    }
}

/// Both have the same faces between the same points.
fn same_surface(first: &Polygons, second: &Polygons, size: f64) -> Result<(), String> {
    let cell = |p: DVec3| (p / (16.0 * NEAR * size)).round().as_i64vec3();
    let mut cells: FxHashMap<glam::I64Vec3, Vec<u32>> = FxHashMap::default();
    for (v, &p) in first.positions.iter().enumerate() {
        cells.entry(cell(p)).or_default().push(v as u32);
    }
    let mut to = Vec::with_capacity(second.positions.len());
    for &p in &second.positions {
        let around = (0..27).map(|i| cell(p) + glam::I64Vec3::new(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1));
        let candidates = around.filter_map(|c| cells.get(&c)).flatten().copied();
        let nearest = candidates.min_by(|&a, &b| {
            let distance = |v: u32| first.positions[v as usize].distance(p);
            distance(a).total_cmp(&distance(b))
        });
        let found = nearest.filter(|&v| first.positions[v as usize].distance(p) < NEAR * size);
        to.push(found.ok_or_else(|| {
            let distances = first.positions.iter().map(|q| q.distance(p) / size);
            format!(
                "no vertex at {p}; the nearest is {:.1e} of the size away",
                distances.fold(f64::MAX, f64::min)
            )
        })?);
    }
    let from_least = |face: Vec<u32>| {
        let mut face = face;
        let least = (0..face.len()).min_by_key(|&i| face[i]).unwrap_or(0);
        face.rotate_left(least);
        face
    };
    let faces: BTreeSet<Vec<u32>> = first.faces().map(|face| from_least(face.to_vec())).collect();
    for face in second.faces() {
        let face = from_least(face.iter().map(|&v| to[v as usize]).collect());
        ensure!(faces.contains(&face), "no face {face:?} in the other result");
    }
    ensure!(faces.len() == second.face_sizes.len(), "faces on top of each other");
    Ok(())
}
