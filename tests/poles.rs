//! A pole in which 64 faces meet: large, and allowed. Everything works there.

use glam::DVec3;
use std::f64::consts::TAU;
use std::time::{Duration, Instant};
use welt::feature::{self, FeatureError, Options, Report, Request, raise};
use welt::io::{self, Format, ImportOptions};
use welt::job::Job;
use welt::mark::{Selection, Selector};
use welt::mesh::{FaceId, Mesh, Polygons, VertexId};
use welt::subdivision::{LoopSurface, limit_normal, limit_points, limit_position, refine};
use welt::surface::{ClosestOptions, LimitSurface, PatchOptions, Patches, Quality, Sampling, compare};

/// Faces at the pole of [`pole`].
const VALENCE: u32 = 64;

/// A disk round a pole in which 64 triangles meet, with two rings of quads; flat, unless `height` lifts the pole. Vertex 0 is
/// the pole, 1 to 64 the first ring.
fn pole(height: f64) -> Mesh {
    let at = |ring: u32, i: u32| {
        let angle = TAU * f64::from(i) / f64::from(VALENCE);
        DVec3::new(angle.cos(), angle.sin(), 0.0) * f64::from(ring)
    };
    let mut positions = vec![DVec3::Z * height];
    positions.extend((1..=3).flat_map(|ring| (0..VALENCE).map(move |i| at(ring, i))));
    let mut polygons = Polygons { positions, ..Polygons::default() };
    for i in 0..VALENCE {
        let next = (i + 1) % VALENCE;
        polygons.face_sizes.extend([3, 4, 4]);
        polygons.face_vertices.extend([0, 1 + i, 1 + next]);
        for ring in 0..2 {
            let (inner, outer) = (1 + ring * VALENCE, 1 + (ring + 1) * VALENCE);
            polygons.face_vertices.extend([inner + i, outer + i, outer + next, inner + next]);
        }
    }
    Mesh::from_polygons(&polygons).expect("a disk")
}

fn apply(mesh: &mut Mesh, marks: &[&str], features: &[&str], set: &[&str]) -> Result<Report, FeatureError> {
    let selectors: Vec<Selector> = marks.iter().map(|m| Selector::parse(m).expect("a selector")).collect();
    let selection = Selection::resolve(mesh, &selectors).expect("marks");
    let request = Request::features(features, set).expect("a request");
    feature::apply(mesh, &selection, &request, &Options::default(), &Job::new())
}

#[track_caller]
fn finite(points: impl IntoIterator<Item = DVec3>) {
    assert!(points.into_iter().all(DVec3::is_finite));
}

/// By symmetry the pole of the flat disk is its own limit, and normals point upwards.
#[test]
fn a_pole_of_64_faces_can_be_refined_evaluated_and_queried() {
    let mesh = pole(0.0);
    assert_eq!(mesh.valence(VertexId(0)), VALENCE as usize);
    assert!(limit_position(&mesh, VertexId(0)).length() < 1e-12);
    assert!(limit_normal(&mesh, VertexId(0)).expect("a normal").distance(DVec3::Z) < 1e-12);
    let refined = refine(&mesh, 4).expect("fits");
    assert!(refined.positions[0].length() < 1e-12);
    assert!(refined.positions.iter().all(|p| p.is_finite() && p.z == 0.0 && p.length() <= 3.0 + 1e-12));
    finite(limit_points(&mesh).iter().map(|point| point.position));

    let surface = LimitSurface::new(&mesh);
    for face in mesh.faces() {
        for corner in 0..surface.patch_count(face) {
            for (u, v) in [(0.0, 0.0), (1e-9, 1e-9), (0.5, 0.5), (1.0, 1.0)] {
                let point = surface.evaluate(face, corner, u, v).expect("a point");
                assert!(point.position.is_finite() && point.position.z.abs() < 1e-12);
            }
        }
    }
    let foot = surface.closest(DVec3::new(0.001, 0.002, 5.0), &ClosestOptions::default()).expect("a foot");
    assert!((foot.distance - 5.0).abs() < 1e-9, "{}", foot.distance);
    let hits = surface.line_hits(DVec3::new(1e-4, 2e-4, 1.0), DVec3::NEG_Z);
    assert!(!hits.is_empty() && hits.iter().all(|hit| (hit.s - 1.0).abs() < 1e-9));
    let deviation =
        compare(&mesh, &pole(0.0), Sampling { per_side: 2, threads: 1 }, &Job::new()).expect("not cancelled");
    assert!(deviation.both.max < 1e-9);
    let faces: Vec<FaceId> = mesh.faces().collect();
    let patches = Patches::new(&mesh, &faces, &PatchOptions::default(), &Job::new()).expect("patches");
    assert!(patches.patches.iter().all(|patch| patch.poles.iter().all(|pole| pole.is_finite())));
    // Out and in again.
    let mut text = Vec::new();
    io::obj::write(&mesh.to_polygons(), &mut text).expect("written");
    let again = io::import_bytes("a.obj", Format::Obj, &text, &ImportOptions::default()).expect("read").mesh;
    assert_eq!(again.to_polygons(), mesh.to_polygons());
}

/// Features round the pole, beside it, and through it: done, or refused in words, and then nothing has changed.
#[test]
fn features_meet_a_pole_of_64_faces() {
    let all: Vec<String> = (1..=VALENCE).map(|v| format!("edge:0,{v}")).collect();
    let all: Vec<&str> = all.iter().map(String::as_str).collect();
    let cases: [(&str, Vec<&str>); 5] = [
        ("all edges round it", vec!["cut:0"]),
        ("each of them", all),
        ("one", vec!["edge:0,1"]),
        ("two opposite ones", vec!["edge:0,1", "edge:0,33"]),
        ("a ring beside it", vec!["ring:1,65"]),
    ];
    let mut done = 0;
    for (name, marks) in cases {
        for feature in ["groove", "ridge", "dent", "loop"] {
            let mut mesh = pole(0.3);
            let before = mesh.to_polygons();
            let start = Instant::now();
            match apply(&mut mesh, &marks, &[feature], &[]) {
                Ok(report) => {
                    mesh.validate_control_mesh().expect(name);
                    finite(mesh.vertices().map(|v| mesh.position(v)));
                    assert!(report.leftovers.is_empty(), "{name}: {report}");
                    done += 1;
                }
                Err(error) => {
                    assert!(error.to_string().contains(' '), "{name}: {error}");
                    assert_eq!(mesh.to_polygons(), before, "{name}");
                }
            }
            assert!(start.elapsed() < Duration::from_secs(5), "{name}, {feature}: {:?}", start.elapsed());
        }
    }
    assert!(done >= 12, "{done} of 20 were applied");
}

/// The pole alone, and with all of its first ring: their limits rise by what is asked, and no other marked one does.
#[test]
fn a_pole_of_64_faces_can_be_displaced() {
    for ring in [false, true] {
        let mut mesh = pole(0.0);
        let mut heights = vec![(VertexId(0), 0.25)];
        if ring {
            heights.extend((1..=VALENCE).map(|v| (VertexId(v), -0.1)));
        }
        assert!(raise(&mut mesh, &heights).is_empty(), "all have a normal");
        for &(v, height) in &heights {
            let limit = limit_position(&mesh, v);
            assert!((limit.z - height).abs() < 1e-9, "{v:?}: {limit}");
        }
        assert!(limit_position(&mesh, VertexId(0)).truncate().length() < 1e-9);
        // By symmetry.
        let heights: Vec<f64> = (1..=VALENCE).map(|v| limit_position(&mesh, VertexId(v)).z).collect();
        assert!(heights.iter().all(|z| (z - heights[0]).abs() < 1e-9), "{heights:?}");
    }
}

/// Flat where the disk is flat. Beside a lifted pole curvature is not bounded, and each figure is a number.
#[test]
fn curvature_at_a_pole_of_64_faces_is_a_number() {
    for height in [0.0, 0.3] {
        let mesh = pole(height);
        let surface = LimitSurface::new(&mesh);
        let mut found = 0;
        for face in mesh.faces().take(6) {
            for corner in 0..surface.patch_count(face) {
                for t in [0.0, 1e-300, 1e-12, 1e-6, 1e-3, 0.1, 0.5, 1.0] {
                    for (u, v) in [(t, t), (t, 0.0), (0.0, t), (t, 0.5)] {
                        let point = surface.evaluate(face, corner, u, v).expect("a point");
                        let Some(curvature) = point.curvature() else { continue };
                        found += 1;
                        assert!(curvature.mean.is_finite() && curvature.gaussian.is_finite());
                        assert!(curvature.principal.iter().all(|k| k.is_finite()), "{curvature:?}");
                        if height == 0.0 {
                            assert!(curvature.mean.abs() < 1e-9, "{face:?} {u} {v}: {curvature:?}");
                        }
                    }
                }
            }
        }
        assert!(found > 100, "{found}");
        let quality = Quality::of(&mesh, 10);
        assert!(!quality.extraordinary.is_empty());
        assert!(quality.extraordinary.iter().all(|vertex| vertex.variation.is_finite()), "{quality:?}");
    }
}

/// A disk of triangles round a pole, with a second ring.
fn pole_of_triangles(height: f64) -> Mesh {
    let at = |ring: u32, i: u32| {
        let angle = TAU * (f64::from(i) + 0.5 * f64::from(ring)) / f64::from(VALENCE);
        DVec3::new(angle.cos(), angle.sin(), 0.0) * f64::from(ring)
    };
    let mut positions = vec![DVec3::Z * height];
    positions.extend((1..=2).flat_map(|ring| (0..VALENCE).map(move |i| at(ring, i))));
    let mut polygons = Polygons { positions, ..Polygons::default() };
    for i in 0..VALENCE {
        let next = (i + 1) % VALENCE;
        polygons.face_sizes.extend([3; 3]);
        polygons.face_vertices.extend([0, 1 + i, 1 + next]);
        polygons.face_vertices.extend([1 + i, 1 + VALENCE + i, 1 + next]);
        polygons.face_vertices.extend([1 + next, 1 + VALENCE + i, 1 + VALENCE + next]);
    }
    Mesh::from_polygons(&polygons).expect("a disk")
}

/// Loop's rules at the pole, after Hoppe et al., *Piecewise smooth surface reconstruction* (1994), appendix: with
/// a(n) = 5/8 - (3 + 2 cos(2 pi/n))^2 / 64 the limit is (w p + sum of neighbours) / (w + n), w = 3 n / (8 a).
#[test]
fn a_pole_of_64_triangles_can_be_refined_and_evaluated() {
    let n = f64::from(VALENCE);
    let a = 0.625 - (3.0 + 2.0 * (TAU / n).cos()).powi(2) / 64.0;
    let weight = 3.0 * n / (8.0 * a);
    for height in [0.0, 0.3] {
        let mesh = pole_of_triangles(height);
        let surface = LoopSurface::new(&mesh).expect("triangles");
        let expected = DVec3::Z * (height * weight / (weight + n));
        let point = surface.limit_point(VertexId(0));
        assert!(point.position.distance(expected) < 1e-13, "{} instead of {expected}", point.position);
        assert!(point.normal().expect("a normal").distance(DVec3::Z) < 1e-12);
        for levels in 1..=3 {
            let refined = surface.refine_levels(levels).expect("fits");
            finite(refined.positions.iter().copied());
            let refined = Mesh::from_polygons(&refined).expect("a mesh");
            assert_eq!(refined.valence(VertexId(0)), VALENCE as usize);
            let there = LoopSurface::new(&refined).expect("triangles").limit_point(VertexId(0)).position;
            assert!(there.distance(expected) < 1e-12, "level {levels}: {there}");
        }
        for face in mesh.faces() {
            for (v, w) in [(0.0, 0.0), (1e-300, 0.0), (1e-12, 1e-12), (1e-3, 0.2), (0.3, 0.3), (1.0, 0.0)] {
                let point = surface.evaluate(face, v, w).expect("a point");
                finite([point.position, point.du, point.dv, point.normal]);
                assert!(height != 0.0 || point.position.z.abs() < 1e-12);
            }
        }
    }
}
