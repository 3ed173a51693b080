//! Expected values are closed forms: uniform cubic B-splines on grids, known limit points, invariants.

use super::*;
use crate::mesh::{Mesh, Polygons, VertexId};
use glam::DVec3;

fn mesh(positions: Vec<DVec3>, faces: &[&[u32]]) -> Mesh {
    Mesh::from_polygons(&Polygons::new(positions, faces)).unwrap()
}

fn cube() -> Mesh {
    let positions =
        (0..8).map(|i| DVec3::new((i & 1) as f64, (i >> 1 & 1) as f64, (i >> 2) as f64)).collect();
    mesh(
        positions,
        &[&[0, 2, 3, 1], &[4, 5, 7, 6], &[0, 1, 5, 4], &[2, 6, 7, 3], &[0, 4, 6, 2], &[1, 3, 7, 5]],
    )
}

/// `columns` x `rows` vertices with integer x and y and the given height.
fn grid(columns: u32, rows: u32, height: impl Fn(f64, f64) -> f64) -> Mesh {
    let mut polygons = Polygons::default();
    for y in 0..rows {
        for x in 0..columns {
            polygons.positions.push(DVec3::new(x.into(), y.into(), height(x.into(), y.into())));
            if x + 1 < columns && y + 1 < rows {
                let v = y * columns + x;
                polygons.face_sizes.push(4);
                polygons.face_vertices.extend([v, v + 1, v + columns + 1, v + columns]);
            }
        }
    }
    Mesh::from_polygons(&polygons).unwrap()
}

/// Faces of 3 to 6 vertices, a boundary, an isolated vertex, vertices with 2 to 6 faces; not plane.
fn mixed() -> Mesh {
    let ring = |radius: f64, count: u32, height: f64| {
        (0..count).map(move |i| {
            let angle = f64::from(i) * std::f64::consts::TAU / f64::from(count);
            DVec3::new(radius * angle.cos(), radius * angle.sin(), height + 0.1 * (3.0 * angle).sin())
        })
    };
    let mut positions = vec![DVec3::Z * 1.2];
    positions.extend(ring(1.0, 6, 1.0));
    positions.extend(ring(2.0, 6, 0.0));
    positions.push(DVec3::splat(9.0));
    let mut faces: Vec<Vec<u32>> = (0..5).map(|i| vec![0, i + 1, i + 2]).collect();
    faces.push(vec![0, 6, 1]);
    faces.extend((0..4).map(|i| vec![i + 1, i + 7, i + 8, i + 2]));
    // One pentagon and a triangle in place of the quad and the open place that would follow.
    faces.push(vec![5, 11, 12, 7, 6]);
    faces.push(vec![6, 7, 1]);
    let faces: Vec<&[u32]> = faces.iter().map(Vec::as_slice).collect();
    mesh(positions, &faces)
}

fn assert_close(found: DVec3, expected: DVec3) {
    assert!(found.distance(expected) < 1e-13, "{found} instead of {expected}");
}

#[test]
fn cube_goes_to_known_points() {
    let mesh = cube();
    // (9 v + 4 e + f) / 24 about the centre: half of the way out.
    assert_close(limit_position(&mesh, VertexId(7)), DVec3::splat(0.75));
    let normal = limit_normal(&mesh, VertexId(7)).unwrap();
    assert_close(normal, DVec3::splat(1.0 / 3f64.sqrt()));
    let refined = refine(&mesh, 1).unwrap();
    assert_eq!((refined.level().vertex_count(), refined.level().face_count()), (26, 24));
    // Vertex point, edge point, face point of a unit cube: 7/9, 1/8 and 0 from the middle of their element.
    assert_close(refined.positions[7], DVec3::splat(0.5 + 5.0 / 18.0));
    let on_edge = refined.positions[8..20].iter().find(|p| p.y > 0.5 && p.z > 0.5 && p.x == 0.5).unwrap();
    assert_close(*on_edge, DVec3::new(0.5, 0.875, 0.875));
    assert_close(refined.positions[20], DVec3::new(0.5, 0.5, 0.0));
}

#[test]
fn regular_grid_is_a_cubic_b_spline() {
    let mesh = grid(5, 5, |x, y| x * x + 2.0 * x * y);
    let v = VertexId(2 * 5 + 1);
    let point = limit_point(&mesh, v);
    // A uniform cubic B-spline adds 1/3 to squares.
    assert_close(point.position, DVec3::new(1.0, 2.0, 1.0 + 4.0 + 1.0 / 3.0));
    let (dx, dy) = (DVec3::new(1.0, 0.0, 2.0 + 4.0), DVec3::new(0.0, 1.0, 2.0));
    assert_close(point.normal().unwrap(), dx.cross(dy).normalize());
    let lengths = point.tangents.map(|t| t.truncate().length());
    assert!(lengths.iter().all(|l| (l - 1.0).abs() < 1e-14), "{lengths:?}");
}

#[test]
fn boundary_is_a_cubic_b_spline_curve() {
    let mesh = grid(4, 3, |x, _| x * x);
    let point = limit_point(&mesh, VertexId(1));
    assert_close(point.position, DVec3::new(1.0, 0.0, 4.0 / 3.0));
    assert_close(point.tangents[0], DVec3::new(1.0, 0.0, 2.0));
    assert_close(point.tangents[1], DVec3::new(0.0, 1.0, 0.0));
    // The corner of one face is rounded.
    let corner = limit_position(&mesh, VertexId(0));
    assert_close(corner, DVec3::new(1.0 / 6.0, 1.0 / 6.0, 1.0 / 6.0));
}

#[test]
fn masks_are_the_limit_points_as_rows() {
    for mesh in [cube(), grid(4, 4, |x, y| (x * 1.3).sin() * y), mixed()] {
        for v in mesh.vertices() {
            let total = |mask: &LimitMask| mask.iter().map(|&(_, w)| w).sum::<f64>();
            let point = |mask: &LimitMask| mask.iter().map(|&(u, w)| w * mesh.position(u)).sum::<DVec3>();
            let mask = limit_mask(&mesh, v);
            assert!((total(&mask) - 1.0).abs() < 1e-14);
            assert!(mask.is_sorted_by(|a, b| a.0 < b.0));
            assert_close(point(&mask), limit_position(&mesh, v));
            let Some(tangents) = limit_tangent_masks(&mesh, v) else {
                assert_eq!(mesh.valence(v), 0);
                continue;
            };
            for (mask, tangent) in tangents.iter().zip(limit_point(&mesh, v).tangents) {
                assert!(total(mask).abs() < 1e-13, "vertex {v:?}: {}", total(mask));
                assert_close(point(mask), tangent);
            }
        }
    }
}

#[test]
fn limit_is_the_same_on_every_level() {
    for mesh in [cube(), grid(4, 4, |x, y| (x * 1.3).sin() * y), mixed()] {
        let refined = refine(&mesh, 2).unwrap();
        let flat = refined.refinement.limit_positions(2, &refined.positions).unwrap().unwrap();
        let finer = Mesh::from_polygons(&refined.into_polygons()).unwrap();
        for v in mesh.vertices() {
            assert_close(limit_position(&finer, v), limit_position(&mesh, v));
            assert_close(flat[v.index()], limit_position(&mesh, v));
            match (limit_normal(&finer, v), limit_normal(&mesh, v)) {
                (Some(fine), Some(coarse)) => assert!(fine.distance(coarse) < 1e-12, "{v:?} {fine} {coarse}"),
                (fine, coarse) => assert_eq!(fine, coarse),
            }
        }
    }
}

#[test]
fn parents_are_numbered_as_documented() {
    let mesh = mixed();
    let refinement = Refinement::new(&mesh, 2).unwrap();
    let control = refinement.level(0);
    let [v, e] = [control.vertex_count() as u32, control.edge_count() as u32];
    assert_eq!(refinement.vertex_parent(1, v - 1), Some(VertexParent::Vertex(v - 1)));
    assert_eq!(refinement.vertex_parent(1, v), Some(VertexParent::Edge(0)));
    assert_eq!(refinement.vertex_parent(1, v + e), Some(VertexParent::Face(0)));
    assert_eq!(refinement.vertex_parent(0, 0), None);
    assert_eq!(refinement.vertex_parent(1, refinement.level(1).vertex_count() as u32), None);
    let mut corner = 0;
    for (face, vertices) in control.faces().enumerate() {
        for (i, &vertex) in vertices.iter().enumerate() {
            assert_eq!(refinement.face_parent(1, corner), Some((face as u32, i as u32)));
            let quad = refinement.level(1).quads().unwrap()[corner as usize];
            assert_eq!((quad[0], quad[2]), (vertex, v + e + face as u32));
            let edge = refinement.control_ids().edges[(quad[1] - v) as usize];
            let ends = [mesh.source(edge).0, mesh.target(edge).0];
            assert!(ends.contains(&vertex) && ends.contains(&vertices[(i + 1) % vertices.len()]));
            corner += 1;
        }
    }
    assert_eq!(refinement.face_parent(1, corner), None);
}

#[test]
fn refined_levels_are_valid_meshes() {
    let mesh = mixed();
    for depth in 0..4 {
        let refined = refine(&mesh, depth).unwrap();
        let boundary = mesh.half_edges().filter(|&h| mesh.face(h).is_boundary()).count();
        let finer = Mesh::from_polygons(&refined.into_polygons()).unwrap();
        finer.validate_control_mesh().unwrap();
        assert_eq!(finer.half_edges().filter(|&h| finer.face(h).is_boundary()).count(), boundary << depth);
    }
}

#[test]
fn a_level_that_cannot_be_numbered_is_refused() {
    let error = Refinement::new(&grid(400, 400, |_, _| 0.0), 12).unwrap_err();
    assert!(error.to_string().contains("ask for a lower level"), "{error}");
}

#[test]
fn small_and_degenerate_meshes() {
    let empty = Mesh::default();
    assert!(refine(&empty, 3).unwrap().positions.is_empty());
    assert!(refine(&empty, usize::MAX).is_err());
    let triangle = mesh(vec![DVec3::ZERO, DVec3::X, DVec3::Y], &[&[0, 1, 2]]);
    assert_close(limit_normal(&triangle, VertexId(0)).unwrap(), DVec3::Z);
    let flat = mesh(vec![DVec3::ZERO; 4], &[&[0, 1, 2, 3]]);
    assert_eq!(limit_normal(&flat, VertexId(0)), None);
    assert_eq!(vertex_normal(&flat, VertexId(0)), None);
    let tiny = mesh([DVec3::ZERO, DVec3::X, DVec3::Y].map(|p| p * 1e-200).to_vec(), &[&[0, 1, 2]]);
    assert_close(limit_normal(&tiny, VertexId(0)).unwrap(), DVec3::Z);
}

#[test]
fn a_face_with_many_vertices_takes_linear_time() {
    const COUNT: u32 = 200_000;
    let vertices: Vec<u32> = (0..COUNT).collect();
    let circle = |i: &u32| DVec3::new((f64::from(*i) / 1e4).sin(), f64::from(*i), 0.0);
    let mesh = mesh(vertices.iter().map(circle).collect(), &[&vertices]);
    // Squared, this would take minutes.
    let points = limit_points(&mesh);
    assert_eq!(points[9].position, limit_position(&mesh, VertexId(9)));
    assert_eq!(refine(&mesh, 1).unwrap().level().face_count(), COUNT as usize);
}

/// A sharp vertex without faces has no ring.
#[test]
fn isolated_sharp_vertices_stay() {
    let mut polygons = Polygons::new(vec![DVec3::ONE, DVec3::ZERO, DVec3::X, DVec3::Y], &[&[1, 2, 3]]);
    polygons.corners.push((0, 3.5));
    let mesh = Mesh::from_polygons(&polygons).unwrap();
    assert_eq!(limit_position(&mesh, VertexId(0)), DVec3::ONE);
    let refined = refine(&mesh, 2).unwrap();
    assert_eq!(refined.positions[0], DVec3::ONE);
    let limits = refined.refinement.limit_positions(2, &refined.positions).unwrap().unwrap();
    assert_eq!(limits[0], DVec3::ONE);
}
