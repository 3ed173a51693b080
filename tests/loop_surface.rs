//! Loop subdivision: closed forms, and limits against those of finer levels. (tests/cpp compares with OpenSubdiv and
//! OpenMesh.)

use glam::DVec3;
use welt::mesh::{FaceId, Mesh, Polygons, VertexId};
use welt::subdivision::{LoopSurface, RefineError};

/// A lattice of equilateral triangles with heights.
fn lattice(height: impl Fn(f64, f64) -> f64) -> Polygons {
    const SIDE: u32 = 7;
    let point = |i: u32| {
        let (x, y) = (f64::from(i % SIDE), f64::from(i / SIDE));
        let (x, y) = (x + 0.5 * y, y * 0.75f64.sqrt());
        DVec3::new(x, y, height(x, y))
    };
    let mut polygons = Polygons::new((0..SIDE * SIDE).map(point).collect(), &[]);
    for y in 0..SIDE - 1 {
        for x in 0..SIDE - 1 {
            let v = y * SIDE + x;
            polygons.face_sizes.extend([3, 3]);
            polygons.face_vertices.extend([v, v + 1, v + SIDE, v + 1, v + SIDE + 1, v + SIDE]);
        }
    }
    polygons
}

fn assert_close(found: DVec3, expected: DVec3, tolerance: f64, what: &str) {
    assert!(found.distance(expected) < tolerance, "{what}: {found} instead of {expected}");
}

#[test]
fn quadratics_on_a_lattice_are_box_splines() {
    // The box spline adds to a quadratic half of its Laplacian times the variance along an axis, which at a vertex is
    // 1/12 of the six neighbours at distance 1: 6/12 cos^2 averages to 1/4.
    let mesh = Mesh::from_polygons(&lattice(|x, y| x * x + 0.5 * x * y - 3.0 * y * y)).expect("a lattice");
    let surface = LoopSurface::new(&mesh).expect("triangles");
    let v = VertexId(3 * 7 + 3);
    let p = mesh.position(v);
    let point = surface.limit_point(v);
    assert_close(point.position, p + DVec3::Z * 0.25 * (2.0 - 6.0) / 2.0, 1e-13, "limit");
    let slope = DVec3::new(2.0 * p.x + 0.5 * p.y, 0.5 * p.x - 6.0 * p.y, -1.0);
    assert_close(point.normal().expect("a normal"), -slope.normalize(), 1e-13, "normal");
}

/// A lattice with creases, darts, corners of all kinds, and the six vertices of a hole.
fn tagged() -> Mesh {
    let mut polygons = lattice(|x, y| (1.3 * x).sin() * (0.8 * y + 0.3).cos());
    polygons.creases = vec![
        (8, 9, 10.0),
        (9, 10, 10.0),
        (10, 17, 2.3),
        (17, 24, 0.7),
        (24, 31, 10.0),
        (31, 38, 1.0),
        (22, 23, 3.5),
        (22, 29, 10.0),
        (22, 15, 10.0),
    ];
    polygons.corners = vec![(40, 1.5), (12, 10.0), (3, 10.0)];
    polygons.holes = vec![5];
    Mesh::from_polygons(&polygons).expect("a lattice")
}

#[test]
fn limits_are_the_same_on_every_level() {
    let mesh = tagged();
    let coarse = LoopSurface::new(&mesh).expect("triangles");
    for levels in 1..=3 {
        let polygons = coarse.refine_levels(levels).expect("a level");
        let finer = Mesh::from_polygons(&polygons).expect("a level");
        finer.validate_control_mesh().expect("valid");
        assert_eq!(polygons.holes.len(), 4usize.pow(levels as u32));
        let fine = LoopSurface::new(&finer).expect("triangles");
        for v in mesh.vertices() {
            let (here, there) = (coarse.limit_point(v), fine.limit_point(v));
            assert_close(
                there.position,
                here.position,
                1e-6 * 1e-6,
                &format!("level {levels} vertex {}", v.0),
            );
            let mask: DVec3 = coarse.limit_mask(v).iter().map(|&(w, weight)| weight * mesh.position(w)).sum();
            assert_close(mask, here.position, 1e-13, "mask");
            let edges = mesh.outgoing(v).filter(|&h| mesh.edge_sharpness(h) >= 10.0).count();
            if edges == 0
                && mesh.vertex_sharpness(v) < 10.0
                && let (Some(a), Some(b)) = (here.normal(), there.normal())
            {
                assert_close(b, a, 1e-10, &format!("normal on level {levels} at vertex {}", v.0));
            }
        }
    }
    // What one level leaves to the next: the vertices go to their limits.
    let deep = coarse.refine_levels(6).expect("a level");
    for v in mesh.vertices() {
        let off = deep.positions[v.index()].distance(coarse.limit_point(v).position);
        assert!(off < 2e-3, "{v:?} {off:e}");
    }
}

#[test]
fn other_faces_are_refused() {
    let mut polygons = lattice(|_, _| 0.0);
    polygons.face_sizes.push(4);
    polygons.positions.extend([DVec3::X; 4]);
    polygons.face_vertices.extend([49, 50, 51, 52]);
    let mesh = Mesh::from_polygons(&polygons).expect("a lattice and a quad");
    let error = LoopSurface::new(&mesh).expect_err("a quad");
    assert_eq!((error.face, error.arity), (72, 4));
    assert_eq!(mesh.arity(FaceId(72)), 4);
    assert!(error.to_string().contains("triangulate"), "{error}");
    let empty = Mesh::default();
    let surface = LoopSurface::new(&empty).expect("nothing");
    assert!(surface.refine_levels(3).expect("nothing").positions.is_empty());
}

#[test]
fn a_level_that_cannot_be_numbered_is_refused() {
    let mesh = Mesh::from_polygons(&lattice(|_, _| 0.0)).expect("a lattice");
    let surface = LoopSurface::new(&mesh).expect("triangles");
    assert!(matches!(
        surface.refine_levels(usize::MAX),
        Err(RefineError::TooLarge { .. } | RefineError::TooDeep { .. })
    ));
}
