//! Evaluation of the limit surface against an independent naive subdivision, closed forms and finite differences.

mod common;

use glam::DVec3;
use std::collections::HashMap;
use std::path::Path;
use welt::io::{ImportOptions, import};
use welt::mesh::{FaceId, Mesh};
use welt::subdivision::evaluate;

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
            let (v, next, prev) = (face.vertices[i], face.vertices[(i + 1) % k], face.vertices[(i + k - 1) % k]);
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
        let mesh = load(&data, file);
        let error = compare_with_naive(&mesh, levels);
        println!("{file}: {error:.1e}");
        assert!(error < 1e-14, "{file}: {error:e}");
    }
}
