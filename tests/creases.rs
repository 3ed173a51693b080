//! Sharp edges and vertices, boundary rules and holes: closed forms, and one way of computing against another.
//! (tests/cpp compares with OpenSubdiv.)

use crate::common;

use glam::DVec3;
use proptest::prelude::*;
use std::path::Path;
use welt::io::{Format, ImportOptions, import_bytes};
use welt::mesh::{BoundaryRule, Creasing, FaceId, Mesh, Polygons, SubdivisionOptions, VertexId};
use welt::subdivision::{
    Refinement, evaluate, has_limit, limit_mask, limit_normal, limit_point, limit_position,
    limit_tangent_masks, refine,
};
use welt::surface::{ClosestOptions, Facing, LimitSurface};

/// The shapes of OpenSubdiv that are surfaces, with their tags.
fn shapes() -> Vec<(String, Mesh)> {
    let Some(data) = common::shared_data() else { return Vec::new() };
    let mut paths: Vec<_> = std::fs::read_dir(data.join("osd"))
        .expect("a folder")
        .map(|entry| entry.expect("a file").path())
        .collect();
    paths.sort();
    let meshes =
        paths.iter().filter(|path| path.extension().is_some_and(|e| e == "obj")).filter_map(|path| {
            let name = path.file_name()?.to_string_lossy().into_owned();
            let import = import_bytes(
                &name,
                Format::Obj,
                &common::content(Path::new(path)),
                &ImportOptions::default(),
            );
            Some((name, import.ok()?.mesh))
        });
    let meshes: Vec<_> = meshes.filter(|(name, _)| !name.contains("pole360")).collect();
    assert!(meshes.len() > 40);
    meshes
}

const CUBE: [&[u32]; 6] =
    [&[0, 2, 3, 1], &[4, 5, 7, 6], &[0, 1, 5, 4], &[2, 6, 7, 3], &[0, 4, 6, 2], &[1, 3, 7, 5]];

fn cube_polygons() -> Polygons {
    let corner = |i: u32| DVec3::new((i & 1) as f64, (i >> 1 & 1) as f64, (i >> 2) as f64);
    Polygons::new((0..8).map(corner).collect(), &CUBE)
}

/// A cube all of whose edges have the sharpness.
fn cube(sharpness: f32) -> Mesh {
    let mut mesh = Mesh::from_polygons(&cube_polygons()).expect("a cube");
    let edges: Vec<_> = mesh.edges().collect();
    edges.into_iter().for_each(|h| mesh.set_edge_sharpness(h, sharpness));
    mesh
}

fn assert_close(found: DVec3, expected: DVec3, what: &str) {
    assert!(found.distance(expected) < 1e-13, "{what}: {found} instead of {expected}");
}

#[test]
fn a_cube_with_infinite_creases_is_the_cube() {
    let mesh = cube(10.0);
    let surface = LimitSurface::new(&mesh);
    for face in mesh.faces() {
        let corners: Vec<DVec3> = mesh.face_vertices(face).map(|v| mesh.position(v)).collect();
        for (u, v) in [(0.0, 0.0), (0.5, 0.5), (1.0, 0.25), (0.3, 0.9)] {
            let point = surface.evaluate(face, 0, u, v).expect("a point");
            // The rows of control points are straight, but not evenly spaced: u moves by the spline of 0, 0, 1, 1.
            let plane = (corners[1] - corners[0]).cross(corners[3] - corners[0]);
            assert!((point.position - corners[0]).dot(plane).abs() < 1e-15);
            assert_close(point.normal, plane.normalize(), "normal");
            assert!(point.second.is_some(), "a corner of one face is regular");
        }
    }
    for v in mesh.vertices() {
        assert_eq!(limit_position(&mesh, v), mesh.position(v));
    }
    // The nearest point of an edge, seen from outside along the diagonal, and with the normal of one side.
    let outside = DVec3::new(0.5, 2.0, 2.0);
    let foot = surface.closest(outside, &ClosestOptions::default()).expect("a foot");
    assert_close(foot.position, DVec3::new(0.5, 1.0, 1.0), "foot on the edge");
    let facing = Some(Facing { normal: DVec3::Y, min_cosine: 0.5 });
    let foot = surface.closest(outside, &ClosestOptions { facing, ..Default::default() }).expect("a foot");
    assert_close(foot.position, DVec3::new(0.5, 1.0, 1.0), "foot on the edge");
    assert_close(foot.normal, DVec3::Y, "normal of the side");
    let hits = surface.line_hits(DVec3::new(0.3, 0.4, -1.0), DVec3::Z);
    assert_eq!(hits.len(), 2);
    assert_close(hits[0].position, DVec3::new(0.3, 0.4, 0.0), "entry");
}

#[test]
fn creases_are_cubic_b_splines_and_corners_stay() {
    // One ring of four creases round a face: a closed B-spline through (a + 4 v + b) / 6.
    let mut polygons = cube_polygons();
    polygons.creases = vec![(4, 5, 10.0), (5, 7, 12.5), (7, 6, 10.0), (6, 4, f32::INFINITY)];
    let mut mesh = Mesh::from_polygons(&polygons).expect("a cube");
    assert_close(limit_position(&mesh, VertexId(4)), DVec3::new(1.0 / 6.0, 1.0 / 6.0, 1.0), "crease");
    mesh.set_vertex_sharpness(VertexId(4), 10.0);
    assert_close(limit_position(&mesh, VertexId(4)), DVec3::new(0.0, 0.0, 1.0), "corner");
    // A vertex of sharpness 1/2: half of it and half of the smooth rule on the first level. The smooth vertex point of
    // a unit cube is 5/18 from the middle, and 9/4 of what is left after one step remains in the limit.
    let mut mesh = cube(0.0);
    mesh.set_vertex_sharpness(VertexId(7), 0.5);
    let refined = refine(&mesh, 1).expect("a level");
    assert_close(refined.positions[7], DVec3::splat(0.5 * 1.0 + 0.5 * (0.5 + 5.0 / 18.0)), "half sharp");
    // Edges of sharpness 1/4: a quarter of the middle.
    let refined = refine(&cube(0.25), 1).expect("a level");
    let edge =
        refined.positions[8..20].iter().find(|p| p.y > 0.5 && p.z > 0.5 && p.x == 0.5).expect("an edge");
    assert_close(
        *edge,
        DVec3::new(0.5, 0.875, 0.875) * 0.75 + DVec3::new(0.5, 1.0, 1.0) * 0.25,
        "edge point",
    );
}

#[test]
fn chaikin_averages_along_the_crease() {
    // At the vertex between edges of sharpness 1.2 and 3.2 the halves get 3/4 of their own and 1/4 of the other, less 1.
    let mut polygons = cube_polygons();
    polygons.creases = vec![(4, 5, 1.2), (5, 7, 3.2)];
    polygons.subdivision.creasing = Creasing::Chaikin;
    let chaikin = Mesh::from_polygons(&polygons).expect("a cube");
    polygons.subdivision.creasing = Creasing::Uniform;
    let uniform = Mesh::from_polygons(&polygons).expect("a cube");
    let one = |mesh: &Mesh| refine(mesh, 1).expect("a level").positions;
    assert_eq!(one(&chaikin), one(&uniform), "the first level differs in sharpness only");
    let by_hand = {
        let refined = refine(&chaikin, 1).expect("a level");
        let middle = |a: u32, b: u32| {
            let ends = [chaikin.position(VertexId(a)), chaikin.position(VertexId(b))];
            let at = (ends[0] + ends[1]) * 0.5;
            (8..20).find(|&v| refined.positions[v as usize].distance(at) < 1e-12).expect("a sharp edge point")
        };
        let (e, f) = (middle(4, 5), middle(5, 7));
        let mut polygons = refined.into_polygons();
        let (near, far) = (0.75 * 1.2 + 0.25 * 3.2 - 1.0, 0.75 * 3.2 + 0.25 * 1.2 - 1.0);
        polygons.creases = vec![(4, e, 0.2), (e, 5, near as f32), (5, f, far as f32), (f, 7, 2.2)];
        polygons.subdivision.creasing = Creasing::Chaikin;
        Mesh::from_polygons(&polygons).expect("the refined cube")
    };
    for v in chaikin.vertices() {
        let distance = limit_position(&chaikin, v).distance(limit_position(&by_hand, v));
        assert!(distance < 1e-6, "{v:?} {distance:e}");
    }
}

#[test]
fn limits_are_the_same_on_every_level_and_at_patch_corners() {
    let mut sharp = 0;
    for (name, mesh) in shapes() {
        let size = mesh.size();
        let refined = Refinement::new(&mesh, 2).expect("two levels");
        let control = refined.control_positions(&mesh);
        for level in 1..=2 {
            let positions = refined.positions(level, &control).expect("memory");
            let limits = refined.limit_positions(level, &positions).expect("memory").expect("quads");
            for (v, limit) in mesh.vertices().zip(&limits) {
                let expected = limit_position(&mesh, v);
                assert!(limit.distance(expected) < 1e-13 * size, "{name} level {level} vertex {}", v.0);
                sharp += usize::from(mesh.has_sharpness());
            }
        }
        let finer = Mesh::from_polygons(
            &refined.polygons(1, refined.positions(1, &control).expect("memory")).expect("memory"),
        )
        .expect("a level");
        for v in mesh.vertices() {
            let off = limit_position(&finer, v).distance(limit_position(&mesh, v)) / size;
            assert!(off < 1e-13, "{name} vertex {}: {off:e}", v.0);
        }
        let parts = |mesh: &Mesh| {
            mesh.faces().filter(|&face| has_limit(mesh, face)).map(|f| mesh.arity(f)).sum::<usize>()
        };
        assert_eq!(4 * parts(&mesh), parts(&finer), "{name}");
        for face in mesh.faces().filter(|&face| has_limit(&mesh, face)) {
            let arity = mesh.arity(face);
            for (i, v) in mesh.face_vertices(face).enumerate() {
                let (corner, (x, y)) = if arity == 4 {
                    (0, [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)][i])
                } else {
                    (i, (0.0, 0.0))
                };
                let point = evaluate(&mesh, face, corner, x, y).expect("a point");
                let off = point.position.distance(limit_position(&mesh, v)) / size;
                assert!(off < 1e-13, "{name} face {} corner {i}: {off:e}", face.0);
            }
        }
    }
    assert!(sharp > 100 || common::shared_data().is_none());
}

#[test]
fn frozen_surfaces_are_the_surface() {
    for (name, mesh) in shapes() {
        let surface = LimitSurface::new(&mesh);
        let size = mesh.size();
        for face in mesh.faces() {
            let patches = if mesh.arity(face) == 4 { 1 } else { mesh.arity(face) };
            for (i, corner) in (0..patches).cycle().take(12).enumerate() {
                // Well spread, and in every quarter.
                let (u, v) = ((0.618034 * i as f64).fract(), (0.754878 * i as f64).fract());
                let (here, there) =
                    (surface.evaluate(face, corner, u, v), evaluate(&mesh, face, corner, u, v));
                assert_eq!(here.is_some(), has_limit(&mesh, face), "{name}");
                let (Some(here), Some(there)) = (here, there) else { continue };
                let off = here.position.distance(there.position) + here.du.distance(there.du);
                assert!(off < 1e-11 * size, "{name} face {} ({u}, {v}): {off:e}", face.0);
                assert_eq!(here.second.is_some(), there.second.is_some());
            }
        }
    }
}

#[test]
fn masks_give_limits_and_move_with_the_mesh() {
    for (name, mesh) in shapes() {
        for v in mesh.vertices() {
            let mask = limit_mask(&mesh, v);
            assert!((mask.iter().map(|entry| entry.1).sum::<f64>() - 1.0).abs() < 1e-13, "{name} {v:?}");
            let point: DVec3 = mask.iter().map(|&(w, weight)| weight * mesh.position(w)).sum();
            assert!(point.distance(limit_position(&mesh, v)) < 1e-13 * mesh.size());
            if let Some(tangents) = limit_tangent_masks(&mesh, v) {
                for (mask, tangent) in tangents.iter().zip(limit_point(&mesh, v).tangents) {
                    let found: DVec3 = mask.iter().map(|&(w, weight)| weight * mesh.position(w)).sum();
                    assert!(found.distance(tangent) < 1e-12 * mesh.size(), "{name} {v:?}");
                }
            }
        }
    }
}

/// A double pyramid over `count` vertices, not plane, with an infinite crease from its pole to one of them: a dart of
/// valence `count` and one of valence 4.
fn pyramid_with_dart(count: u32) -> Mesh {
    let ring = (0..count).map(|i| {
        let angle = f64::from(i) * std::f64::consts::TAU / f64::from(count);
        DVec3::new(angle.cos(), 1.3 * angle.sin(), 0.1 * (3.0 * angle + 0.4).cos())
    });
    let mut polygons = Polygons::new(ring.chain([DVec3::Z, -0.7 * DVec3::Z]).collect(), &[]);
    for i in 0..count {
        let next = (i + 1) % count;
        polygons.face_sizes.extend([3, 3]);
        polygons.face_vertices.extend([count, i, next, count + 1, next, i]);
    }
    polygons.creases = vec![(count, 0, 10.0)];
    Mesh::from_polygons(&polygons).expect("a pyramid")
}

/// The surface beside a dart tends to the normal at the dart.
#[test]
fn normals_at_darts_continue_those_beside() {
    for count in [3, 4, 5, 6, 8] {
        let mesh = pyramid_with_dart(count);
        for v in [VertexId(count), VertexId(0)] {
            let normal = limit_normal(&mesh, v).expect("a normal");
            for h in mesh.outgoing(v) {
                let face = mesh.face(h);
                let corner = mesh.face_vertices(face).position(|w| w == v).expect("a corner");
                let at = |x: f64| evaluate(&mesh, face, corner, x, x).expect("a point");
                let off = |x: f64| at(x).normal.distance(normal);
                assert!(
                    off(1e-12) < 0.02 && off(1e-12) < 0.8 * off(1e-4) + 1e-6,
                    "{count} {v:?} {} {}",
                    off(1e-4),
                    off(1e-12)
                );
                assert_close(at(0.0).normal, normal, "normal at the dart");
                assert_eq!(at(0.0).second, None);
            }
        }
    }
}

#[test]
fn boundary_rules_and_holes() {
    let square = [DVec3::ZERO, DVec3::X, DVec3::X + DVec3::Y, DVec3::Y];
    let mut mesh = Mesh::from_polygons(&Polygons::new(square.to_vec(), &[&[0, 1, 2, 3]])).expect("a quad");
    let face = FaceId(0);
    let corner = |mesh: &Mesh| evaluate(mesh, face, 0, 0.0, 0.0).map(|point| point.position);
    assert_close(corner(&mesh).expect("a point"), DVec3::new(1.0 / 6.0, 1.0 / 6.0, 0.0), "rounded");
    let with = |boundary| SubdivisionOptions { boundary, ..Default::default() };
    mesh.set_subdivision(with(BoundaryRule::EdgeAndCorner));
    assert_eq!(corner(&mesh), Some(DVec3::ZERO));
    let middle = evaluate(&mesh, face, 0, 0.25, 0.75).expect("a point");
    assert_close(middle.position, DVec3::new(0.25, 0.75, 0.0), "a bilinear square");
    mesh.set_subdivision(with(BoundaryRule::None));
    assert!(
        !has_limit(&mesh, face) && corner(&mesh).is_none() && LimitSurface::new(&mesh).faces().count() == 0
    );
    let edges: Vec<_> = mesh.edges().collect();
    edges.into_iter().for_each(|h| mesh.set_edge_sharpness(h, 10.0));
    assert!(has_limit(&mesh, face));
    mesh.set_hole(face, true);
    assert!(mesh.is_hole(face) && !has_limit(&mesh, face));
    assert_eq!(mesh.to_polygons().holes, [0]);
    // What is done in a transaction is taken back.
    let before = mesh.to_polygons();
    let checkpoint = mesh.begin();
    mesh.set_hole(face, false);
    mesh.set_subdivision(Default::default());
    assert_ne!(mesh.to_polygons(), before);
    mesh.rollback(checkpoint);
    assert_eq!(mesh.to_polygons(), before);
}

fn any_sharpness() -> impl Strategy<Value = f32> {
    prop_oneof![
        Just(0.0f32),
        0.0f32..1.0,
        0.0f32..10.0,
        Just(10.0f32),
        Just(f32::INFINITY),
        Just(f32::NAN),
        Just(-3.0f32)
    ]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 60, failure_persistence: None, ..Default::default() })]

    /// Any sharpness whatever: results are finite, and evaluation agrees with refinement.
    #[test]
    fn any_sharpness_of_a_strip(
        edges in proptest::collection::vec(any_sharpness(), 24),
        vertices in proptest::collection::vec(any_sharpness(), 12),
        options in (0..3usize, proptest::bool::ANY),
    ) {
        // A pentagon and a triangle among quads, with a boundary.
        let point = |i: u32| DVec3::new(f64::from(i % 4), f64::from(i / 4), f64::from(i * i % 5) * 0.3);
        let faces: [&[u32]; 6] = [&[0, 1, 5, 4], &[1, 2, 6, 5], &[2, 3, 7], &[2, 7, 6], &[4, 5, 6, 9, 8], &[6, 7, 11, 10, 9]];
        let mut mesh = Mesh::from_polygons(&Polygons::new((0..12).map(point).collect(), &faces)).expect("a strip");
        let all: Vec<_> = mesh.edges().collect();
        for (h, sharpness) in all.into_iter().zip(edges) {
            mesh.set_edge_sharpness(h, sharpness);
        }
        for (v, sharpness) in vertices.into_iter().enumerate() {
            mesh.set_vertex_sharpness(VertexId(v as u32), sharpness);
        }
        let boundary = [BoundaryRule::EdgeOnly, BoundaryRule::EdgeAndCorner, BoundaryRule::None][options.0];
        let creasing = if options.1 { Creasing::Chaikin } else { Creasing::Uniform };
        mesh.set_subdivision(SubdivisionOptions { boundary, creasing });
        let refined = Refinement::new(&mesh, 3).expect("levels");
        let positions = refined.positions(3, &refined.control_positions(&mesh)).expect("memory");
        let limits = refined.limit_positions(3, &positions).expect("memory").expect("quads");
        for (v, limit) in mesh.vertices().zip(&limits) {
            prop_assert!(limit.distance(limit_position(&mesh, v)) < 1e-6, "{v:?} {limit} {}", limit_position(&mesh, v));
        }
        let surface = LimitSurface::new(&mesh);
        for face in mesh.faces().filter(|&face| has_limit(&mesh, face)) {
            let v = mesh.face_vertices(face).next().expect("a vertex");
            let point = surface.evaluate(face, 0, 0.0, 0.0).expect("a point");
            prop_assert!(point.position.distance(limit_position(&mesh, v)) < 1e-12);
            let point = surface.evaluate(face, 0, 0.3, 0.7).expect("a point");
            prop_assert!(point.position.is_finite() && point.du.is_finite() && point.dv.is_finite());
        }
    }
}
