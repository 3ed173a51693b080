//! The fit to a frozen surface, on meshes whose control points were pushed off it.

use crate::common;

use glam::DVec3;
use std::path::Path;
use welt::job::Job;
use welt::mesh::{FaceId, Mesh, Polygons, VertexId};
use welt::optimise::{Method, Stop, Target, active_set, fit};
use welt::subdivision::{limit_position, vertex_normal};
use welt::surface::{Deviation, LimitSurface, Sampling, deviation_samples};

fn model(name: &str) -> Mesh {
    common::load(&Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/models").join(name))
}

fn cube() -> Mesh {
    let positions =
        (0..8).map(|i| DVec3::new((i & 1).into(), (i >> 1 & 1).into(), (i >> 2).into())).collect();
    let faces: [&[u32]; 6] =
        [&[0, 2, 3, 1], &[4, 5, 7, 6], &[0, 1, 5, 4], &[2, 6, 7, 3], &[0, 4, 6, 2], &[1, 3, 7, 5]];
    Mesh::from_polygons(&Polygons::new(positions, &faces)).expect("a cube")
}

/// Pushes vertices along their normals by up to `amount`, each differently.
fn push(mesh: &mut Mesh, vertices: &[VertexId], amount: f64) {
    for &v in vertices {
        let wobble = f64::from((v.0 * 7919) % 101) / 50.0 - 1.0;
        let normal = vertex_normal(mesh, v).unwrap_or(DVec3::Z);
        mesh.set_position(v, mesh.position(v) + normal * amount * wobble);
    }
}

/// Largest distance of the limit points of `vertices` to `surface`.
fn off(mesh: &Mesh, vertices: &[VertexId], surface: &LimitSurface) -> f64 {
    vertices
        .iter()
        .filter_map(|&v| surface.closest(limit_position(mesh, v), &Default::default()))
        .fold(0.0, |worst, foot| worst.max(foot.distance))
}

#[test]
fn limit_points_come_back_to_the_surface() {
    let mesh = model("leaf_chair.obj");
    let faces: Vec<FaceId> = mesh.grow_faces(&mesh.grow_faces(&[FaceId(200), FaceId(300), FaceId(500)]));
    let everything = mesh.grow_faces(&mesh.grow_faces(&faces));
    let target = Target::freeze(&mesh, &everything, &Job::new()).unwrap();
    let active = active_set(&mesh, &faces, Method::Solve);
    for method in [Method::Solve, Method::Loop] {
        let mut pushed = mesh.clone();
        push(&mut pushed, &active, 0.05 * target.reach);
        let before = off(&pushed, &active, &target.surface);
        let report = fit(&mut pushed, &active, &target, method, &Job::new()).expect("not cancelled");
        let after = off(&pushed, &active, &target.surface);
        println!("{method:?}: {before:.2e} -> {after:.2e} of reach {:.2}, {report:?}", target.reach);
        assert!(before > 1e-2 * target.reach);
        assert!(after < 1e-6 * target.reach, "{method:?}: {after}");
        assert!(report.missed.is_empty());
        // Vertices that are not active stay.
        for v in pushed.vertices().filter(|v| active.binary_search(v).is_err()) {
            assert_eq!(pushed.position(v), mesh.position(v));
        }
    }
}

/// Pushed vertices have no better place than their old one; whatever the fit finds is at least as close as solving.
#[test]
fn surface_fits_come_back_to_the_surface() {
    let mesh = model("leaf_chair.obj");
    let faces: Vec<FaceId> = mesh.grow_faces(&[FaceId(300)]);
    let everything: Vec<FaceId> = mesh.faces().collect();
    let target = Target::freeze(&mesh, &everything, &Job::new()).unwrap();
    let active = active_set(&mesh, &faces, Method::Solve);
    let distance = |mesh: &Mesh| {
        let samples = deviation_samples(
            &LimitSurface::new(mesh),
            |_| true,
            &target.surface,
            Sampling { per_side: 4, threads: 1 },
            &Job::new(),
        );
        Deviation::of(&samples.expect("not cancelled")).expect("memory").max / target.reach
    };
    for method in [Method::Fit, Method::FitSlide] {
        let mut pushed = mesh.clone();
        push(&mut pushed, &active, 0.02 * target.reach);
        let before = distance(&pushed);
        let report = fit(&mut pushed, &active, &target, method, &Job::new()).expect("not cancelled");
        let after = distance(&pushed);
        println!("{method:?}: {before:.2e} -> {after:.2e} of reach, {report:?}");
        assert!(before > 5e-3 && after < 1e-4, "{method:?}: {before} -> {after}");
        for v in pushed.vertices().filter(|v| active.binary_search(v).is_err()) {
            assert_eq!(pushed.position(v), mesh.position(v));
        }
    }
}

/// An edge loop of a cube refined once is a crease; its vertices are pushed off it and come back to its limit curve.
#[test]
fn crease_vertices_stay_on_the_crease() {
    let refined = welt::subdivision::refine(&cube(), 2).expect("fits").into_polygons();
    let mut mesh = Mesh::from_polygons(&refined).expect("refined");
    // The equator: vertices whose height is one half, by symmetry of the cube.
    let on_equator = |mesh: &Mesh, v: VertexId| (mesh.position(v).z - 0.5).abs() < 1e-9;
    let crease: Vec<_> = mesh
        .edges()
        .filter(|&h| on_equator(&mesh, mesh.source(h)) && on_equator(&mesh, mesh.target(h)))
        .collect();
    assert_eq!(crease.len(), 16);
    crease.iter().for_each(|&h| mesh.set_edge_sharpness(h, f32::INFINITY));
    let faces: Vec<FaceId> = mesh.faces().collect();
    let target = Target::freeze(&mesh, &faces, &Job::new()).unwrap();
    let vertices: Vec<VertexId> = mesh.vertices().filter(|&v| on_equator(&mesh, v)).collect();
    let all: Vec<VertexId> = mesh.vertices().collect();
    for method in [Method::Solve, Method::FitSlide] {
        let mut pushed = mesh.clone();
        push(&mut pushed, &vertices, 0.02 * target.reach);
        fit(&mut pushed, &all, &target, method, &Job::new()).expect("not cancelled");
        for &v in &vertices {
            let limit = limit_position(&pushed, v);
            // The crease of a plane of symmetry stays in it.
            assert!((limit.z - 0.5).abs() < 1e-6, "{method:?}: {limit}");
            let foot = target.curves.closest(limit).expect("a crease");
            assert!(foot.distance(limit) < 1e-5 * target.reach, "{method:?} {}", v.0);
        }
    }
}

#[test]
fn boundary_vertices_stay_on_the_boundary_curve() {
    let mesh = model("mid_century_chair.obj");
    let rim: Vec<VertexId> = mesh.vertices().filter(|&v| mesh.is_boundary_vertex(v)).collect();
    assert!(!rim.is_empty());
    let faces: Vec<FaceId> = mesh.faces().collect();
    let target = Target::freeze(&mesh, &faces, &Job::new()).unwrap();
    let mut pushed = mesh.clone();
    push(&mut pushed, &rim, 0.02 * target.reach);
    let all: Vec<VertexId> = pushed.vertices().collect();
    fit(&mut pushed, &all, &target, Method::Solve, &Job::new()).expect("not cancelled");
    for &v in &rim {
        let limit = limit_position(&pushed, v);
        let foot = target.curves.closest(limit).expect("a boundary");
        assert!(foot.distance(limit) < 1e-5 * target.reach, "vertex {}: {}", v.0, foot.distance(limit));
    }
}

/// The limit matrix of a cube is singular (docs/linear-features.md, section 3): its alternating mode has no limit at all.
#[test]
fn a_cube_is_fitted_although_its_system_is_singular() {
    let mesh = cube();
    let faces: Vec<FaceId> = mesh.faces().collect();
    let target = Target::freeze(&mesh, &faces, &Job::new()).unwrap();
    let all: Vec<VertexId> = mesh.vertices().collect();
    let mut pushed = mesh.clone();
    for v in &all {
        pushed.set_position(*v, pushed.position(*v) * 1.1 - DVec3::splat(0.05));
    }
    let report = fit(&mut pushed, &all, &target, Method::Solve, &Job::new()).expect("not cancelled");
    assert!(off(&pushed, &all, &target.surface) < 1e-6, "{report:?}");
    assert!(pushed.positions().iter().all(|p| p.length() < 2.0), "{:?}", pushed.positions());
}

#[test]
fn nothing_to_do_and_cancelling() {
    let mesh = cube();
    let faces: Vec<FaceId> = mesh.faces().collect();
    let target = Target::freeze(&mesh, &faces, &Job::new()).unwrap();
    let mut same = mesh.clone();
    let report = fit(&mut same, &[], &target, Method::Solve, &Job::new()).expect("not cancelled");
    assert_eq!((report.stop, report.steps), (Stop::Nothing, 0));
    let all: Vec<VertexId> = mesh.vertices().collect();
    let report = fit(&mut same, &all, &target, Method::Solve, &Job::new()).expect("not cancelled");
    assert_eq!((report.stop, report.steps), (Stop::Converged, 0));
    assert_eq!(same.positions(), mesh.positions());
    let job = Job::new();
    job.cancel();
    assert!(fit(&mut same, &all, &target, Method::Solve, &job).is_err());
}
