//! Evaluation of the limit surface against an independent naive subdivision, closed forms and finite differences.

use crate::common;

use glam::DVec3;
use std::collections::HashMap;
use std::path::Path;
use welt::io::{ImportOptions, import};
use welt::mesh::{FaceId, Mesh};
use welt::subdivision::evaluate;
use welt::surface::{Derivatives, LimitSurface, Parameter};

fn load(data: &Path, file: &str) -> Mesh {
    import(&data.join(file), &ImportOptions::default()).expect("a clean mesh").mesh
}

/// A refined face: its vertices, the face and corner of the control mesh it lies in, and the parameters there.
struct Fine {
    vertices: Vec<usize>,
    face: u32,
    corner: usize,
    parameters: Vec<(f64, f64)>,
}

/// One step of Catmull-Clark straight from its definition (1978), with the boundary curve as a cubic B-spline.
fn naive_step(points: &[DVec3], faces: &[Fine], first: bool) -> (Vec<DVec3>, Vec<Fine>) {
    let mut edges: HashMap<(usize, usize), Vec<usize>> = HashMap::new();
    for (f, face) in faces.iter().enumerate() {
        for (i, &a) in face.vertices.iter().enumerate() {
            let b = face.vertices[(i + 1) % face.vertices.len()];
            edges.entry((a.min(b), a.max(b))).or_default().push(f);
        }
    }
    let face_points: Vec<DVec3> = faces
        .iter()
        .map(|f| f.vertices.iter().map(|&v| points[v]).sum::<DVec3>() / f.vertices.len() as f64)
        .collect();
    let mut face_sum = vec![DVec3::ZERO; points.len()];
    let mut mid_sum = vec![DVec3::ZERO; points.len()];
    let mut valence = vec![0usize; points.len()];
    let mut rim_sum = vec![DVec3::ZERO; points.len()];
    let mut rim = vec![0usize; points.len()];
    for (f, face) in faces.iter().enumerate() {
        for &v in &face.vertices {
            face_sum[v] += face_points[f];
        }
    }
    for (&(a, b), beside) in &edges {
        for (v, w) in [(a, b), (b, a)] {
            mid_sum[v] += (points[a] + points[b]) / 2.0;
            valence[v] += 1;
            if beside.len() == 1 {
                rim_sum[v] += points[w];
                rim[v] += 1;
            }
        }
    }
    let mut fine: Vec<DVec3> = (0..points.len())
        .map(|v| {
            let n = valence[v] as f64;
            match (valence[v], rim[v]) {
                (0, _) => points[v],
                (_, 0) => (face_sum[v] / n + 2.0 * mid_sum[v] / n + (n - 3.0) * points[v]) / n,
                _ => 0.75 * points[v] + rim_sum[v] / 8.0,
            }
        })
        .collect();
    let offset = fine.len();
    fine.extend(&face_points);
    let mut keys: Vec<_> = edges.keys().copied().collect();
    keys.sort_unstable();
    let mut edge_vertex = HashMap::new();
    for key @ (a, b) in keys {
        edge_vertex.insert(key, fine.len());
        let beside = &edges[&key];
        fine.push(match beside[..] {
            [f, g] => (points[a] + points[b] + face_points[f] + face_points[g]) / 4.0,
            _ => (points[a] + points[b]) / 2.0,
        });
    }
    let mut children = Vec::new();
    for (f, face) in faces.iter().enumerate() {
        let k = face.vertices.len();
        for i in 0..k {
            let (v, next, prev) =
                (face.vertices[i], face.vertices[(i + 1) % k], face.vertices[(i + k - 1) % k]);
            let vertices = vec![
                v,
                edge_vertex[&(v.min(next), v.max(next))],
                offset + f,
                edge_vertex[&(v.min(prev), v.max(prev))],
            ];
            let middle = |a: (f64, f64), b: (f64, f64)| ((a.0 + b.0) / 2.0, (a.1 + b.1) / 2.0);
            let (corner, parameters) = if first && k != 4 {
                (i, vec![(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)])
            } else {
                let p = &face.parameters;
                let centre = middle(p[0], p[2]);
                (face.corner, vec![p[i], middle(p[i], p[(i + 1) % 4]), centre, middle(p[i], p[(i + 3) % 4])])
            };
            children.push(Fine { vertices, face: face.face, corner, parameters });
        }
    }
    (fine, children)
}

/// Limit positions of an all-quad mesh: Halstead et al. (1993); on the boundary that of the B-spline curve.
fn naive_limits(points: &[DVec3], faces: &[Fine]) -> Vec<DVec3> {
    let mut neighbours: Vec<HashMap<usize, usize>> = vec![HashMap::new(); points.len()];
    let mut opposite = vec![DVec3::ZERO; points.len()];
    for face in faces {
        for i in 0..4 {
            let v = face.vertices[i];
            *neighbours[v].entry(face.vertices[(i + 1) % 4]).or_default() += 1;
            *neighbours[v].entry(face.vertices[(i + 3) % 4]).or_default() += 1;
            opposite[v] += points[face.vertices[(i + 2) % 4]];
        }
    }
    (0..points.len())
        .map(|v| {
            let n = neighbours[v].len() as f64;
            let rim: Vec<usize> = neighbours[v].iter().filter(|x| *x.1 == 1).map(|x| *x.0).collect();
            if neighbours[v].is_empty() {
                points[v]
            } else if rim.is_empty() {
                let mut ring: Vec<usize> = neighbours[v].keys().copied().collect();
                ring.sort_unstable();
                let sum: DVec3 = ring.iter().map(|&w| points[w]).sum();
                (n * n * points[v] + 4.0 * sum + opposite[v]) / (n * (n + 5.0))
            } else {
                rim.iter().fold(4.0 * points[v], |sum, &w| sum + points[w]) / 6.0
            }
        })
        .collect()
}

fn control(mesh: &Mesh) -> (Vec<DVec3>, Vec<Fine>) {
    let faces = mesh.faces().map(|f| {
        let vertices: Vec<usize> = mesh.face_vertices(f).map(|v| v.index()).collect();
        let parameters = vec![(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)];
        Fine { vertices, face: f.0, corner: 0, parameters }
    });
    (mesh.positions().to_vec(), faces.collect())
}

/// Largest distance between evaluation and the naive limit, relative to the size, over `levels` levels.
fn compare_with_naive(mesh: &Mesh, levels: usize) -> f64 {
    let (mut points, mut faces) = control(mesh);
    let mut worst = 0.0f64;
    for level in 1..=levels {
        (points, faces) = naive_step(&points, &faces, level == 1);
        let limits = naive_limits(&points, &faces);
        for fine in &faces {
            for (&v, &(u, w)) in fine.vertices.iter().zip(&fine.parameters) {
                let point = evaluate(mesh, FaceId(fine.face), fine.corner, u, w).expect("a point");
                worst = worst.max(point.position.distance(limits[v]));
            }
        }
    }
    worst / mesh.size()
}

/// The mesh with nothing but its boundary sharp, which is what naive refinement knows.
fn smooth(mesh: &Mesh) -> Mesh {
    let mut polygons = mesh.to_polygons();
    polygons.creases.clear();
    polygons.corners.clear();
    polygons.subdivision = Default::default();
    Mesh::from_polygons(&polygons).expect("a mesh")
}

#[test]
fn positions_equal_naive_refinement() {
    let Some(data) = common::shared_data() else { return };
    let cases = [
        ("osd/catmark_cube.obj", 5),
        ("osd/catmark_torus.obj", 3),
        ("osd/catmark_nonquads.obj", 4),
        ("osd/catmark_gregory_test3.obj", 4),
        ("osd/catmark_val2_interior.obj", 5),
        ("osd/catmark_xord_interior.obj", 4),
        ("osd/catmark_edgecorner.obj", 6),
        ("osd/catmark_tent.obj", 5),
        ("osd/catmark_pole8.obj", 3),
        ("osd/catmark_pole360.obj", 2),
        ("product/sc_jar_cage.obj", 3),
        ("upholstery/bs0_chair_cage.obj", 2),
        ("upholstery/kl_mid-century-chair_cage.obj", 2),
        ("product/kl_coffee-mug_cage.obj", 2),
    ];
    for (file, levels) in cases {
        let mesh = smooth(&load(&data, file));
        let error = compare_with_naive(&mesh, levels);
        println!("{file}: {error:.1e}");
        assert!(error < 1e-14, "{file}: {error:e}");
    }
}

/// Parameters well inside a patch, on the low side of every quarter and near each corner.
const INSIDE: [(f64, f64); 8] = [
    (0.3, 0.4),
    (0.7, 0.2),
    (0.81, 0.93),
    (0.11, 0.77),
    (0.02, 0.03),
    (0.97, 0.01),
    (0.985, 0.99),
    (0.004, 0.9),
];

#[test]
fn derivatives_equal_finite_differences() {
    let Some(data) = common::shared_data() else { return };
    for file in ["osd/catmark_cube.obj", "osd/catmark_nonquads.obj", "osd/catmark_edgecorner.obj"] {
        let mesh = load(&data, file);
        for face in mesh.faces() {
            let arity = mesh.arity(face);
            for corner in 0..if arity == 4 { 1 } else { arity } {
                for (u, v) in INSIDE {
                    let at = |u: f64, v: f64| evaluate(&mesh, face, corner, u, v).expect("a point");
                    let here = at(u, v);
                    let h = 1e-5;
                    let (east, west, north, south) = (at(u + h, v), at(u - h, v), at(u, v + h), at(u, v - h));
                    let second = here.second.expect("second derivatives");
                    let slope = |a: DVec3, b: DVec3| (a - b) / (2.0 * h);
                    let checks = [
                        (here.du, slope(east.position, west.position), 1e-7),
                        (here.dv, slope(north.position, south.position), 1e-7),
                        (second.uu, slope(east.du, west.du), 1e-2),
                        (second.uv, slope(north.du, south.du), 1e-2),
                        (second.uv, slope(east.dv, west.dv), 1e-2),
                        (second.vv, slope(north.dv, south.dv), 1e-2),
                    ];
                    for (i, (exact, difference, bound)) in checks.into_iter().enumerate() {
                        let error = exact.distance(difference);
                        assert!(error < bound, "{file} {} {corner} ({u}, {v}) {i}: {error:e}", face.0);
                    }
                    assert!((here.normal.length() - 1.0).abs() < 1e-12);
                    assert!(here.normal.dot(here.du).abs() < 1e-12 && here.normal.dot(here.dv).abs() < 1e-12);
                }
            }
        }
    }
}

#[test]
fn tangents_turn_continuously_into_those_of_the_vertex() {
    let Some(data) = common::shared_data() else { return };
    for file in ["osd/catmark_cube.obj", "osd/catmark_pole8.obj", "product/sc_jar_cage.obj"] {
        let mesh = load(&data, file);
        for face in mesh.faces() {
            let vertex = evaluate(&mesh, face, 0, 0.0, 0.0).expect("a point");
            let beside = evaluate(&mesh, face, 0, 1e-9, 1e-9).expect("a point");
            assert!(vertex.normal.distance(beside.normal) < 1e-4, "{file} {}", face.0);
            let along = evaluate(&mesh, face, 0, 1e-12, 0.0).expect("a point");
            assert!(along.du.normalize().distance(vertex.du.normalize()) < 1e-4, "{file} {}", face.0);
        }
    }
}

#[test]
fn deep_parameters_keep_their_precision() {
    // Once the other eigenvectors are gone, the surface beside a vertex shrinks by the subdominant eigenvalue with every halving.
    let Some(data) = common::shared_data() else { return };
    let mesh = load(&data, "osd/catmark_cube.obj");
    let c = (2.0 * std::f64::consts::PI / 3.0).cos();
    let half = (std::f64::consts::PI / 3.0).cos();
    let lambda = (5.0 + c + half * (2.0 * (9.0 + c)).sqrt()) / 16.0;
    for depth in [60, 80, 100, 120] {
        let at = |d: i32| evaluate(&mesh, FaceId(0), 0, 0.7f64 * 0.5f64.powi(d), 0.0).expect("a point").du;
        let ratio = at(depth + 1).length() / at(depth).length();
        assert!((ratio - 2.0 * lambda).abs() < 1e-10, "{depth}: {ratio}");
    }
}

#[test]
fn evaluation_commutes_with_affine_maps() {
    let Some(data) = common::shared_data() else { return };
    let matrix = glam::DMat3::from_cols_array(&[1.2, 0.3, -0.4, 0.1, 0.8, 0.5, -0.7, 0.2, 1.1]);
    let map = |p: DVec3| matrix * p + DVec3::new(3.0, -2.0, 1.0);
    for file in ["osd/catmark_nonquads.obj", "osd/catmark_edgecorner.obj", "osd/catmark_pole8.obj"] {
        let mesh = load(&data, file);
        let mut mapped = mesh.clone();
        for v in mesh.vertices() {
            mapped.set_position(v, map(mesh.position(v)));
        }
        for face in mesh.faces() {
            for (u, v) in INSIDE {
                let point = evaluate(&mesh, face, 0, u, v).expect("a point");
                let image = evaluate(&mapped, face, 0, u, v).expect("a point");
                assert!(image.position.distance(map(point.position)) < 1e-14 * mapped.size());
                assert!(image.du.distance(matrix * point.du) < 1e-12 * mapped.size());
            }
        }
    }
}

#[test]
fn missing_patches_and_nan_give_nothing() {
    let Some(data) = common::shared_data() else { return };
    let mesh = load(&data, "osd/catmark_cube.obj");
    assert!(evaluate(&mesh, FaceId(0), 1, 0.5, 0.5).is_none());
    assert!(evaluate(&mesh, FaceId(6), 0, 0.5, 0.5).is_none());
    assert!(evaluate(&mesh, FaceId(0), 0, f64::NAN, 0.5).is_none());
    let clamped = evaluate(&mesh, FaceId(0), 0, 7.0, -1.0).expect("a point");
    assert_eq!(Some(clamped), evaluate(&mesh, FaceId(0), 0, 1.0, 0.0));
}

/// A batch is done by the widest instructions of the machine, single points by those that all machines have.
#[test]
fn batches_are_the_same_to_the_last_bit() {
    let Some(data) = common::shared_data() else { return };
    let mut extraordinary = 0;
    for file in ["osd/catmark_car.obj", "upholstery/q_chair_cushioned.obj", "product/sc_jar_cage.obj"] {
        let mesh = load(&data, file);
        let surface = LimitSurface::new(&mesh);
        let mut at = Vec::new();
        for face in surface.faces() {
            for corner in 0..surface.patch_count(face) as u32 {
                let inner = (0..6).map(|i| ((0.618034 * i as f64).fract(), (0.754878 * i as f64).fract()));
                at.extend(inner.map(|(u, v)| Parameter { face, corner, u, v }));
            }
        }
        at.push(Parameter { face: FaceId(u32::MAX), corner: 0, u: 0.5, v: 0.5 });
        for (order, width) in [(Derivatives::None, 3), (Derivatives::First, 9), (Derivatives::Second, 18)] {
            let mut compared = 0;
            surface.evaluate_all(
                0..at.len(),
                order,
                |i| at[i],
                |i, values| {
                    assert_eq!((i, values.len()), (compared, width));
                    compared += 1;
                    let Parameter { face, corner, u, v } = at[i];
                    let Some(point) = surface.evaluate(face, corner as usize, u, v) else {
                        return assert!(values.iter().all(|x| x.is_nan()));
                    };
                    extraordinary += u32::from(point.second.is_none());
                    let second =
                        point.second.map_or([DVec3::NAN; 3], |second| [second.uu, second.uv, second.vv]);
                    let expected = [point.position, point.du, point.dv].into_iter().chain(second);
                    let expected = expected.flat_map(|vector| vector.to_array());
                    assert!(
                        values.iter().zip(expected).all(|(a, b)| a.to_bits() == b.to_bits()),
                        "{file} {i}"
                    );
                },
            );
            assert_eq!(compared, at.len());
        }
    }
    assert!(extraordinary > 10);
}
