//! Curvature of the limit surface against closed forms, and the quality report.

use glam::DVec3;
use welt::mesh::{FaceId, Mesh, Polygons};
use welt::subdivision::evaluate;
use welt::surface::Quality;

/// A sheet of 4 x 4 cells with control points (x, y, f(x, y)), x and y from -2 to 2.
fn sheet(f: impl Fn(f64, f64) -> f64) -> Mesh {
    let place = |k: u32| f64::from(k) - 2.0;
    let positions =
        (0..25).map(|k| (place(k % 5), place(k / 5))).map(|(x, y)| DVec3::new(x, y, f(x, y))).collect();
    let faces: Vec<[u32; 4]> = (0..16)
        .map(|k| k % 4 + 5 * (k / 4))
        .map(|corner| [corner, corner + 1, corner + 6, corner + 5])
        .collect();
    let faces: Vec<&[u32]> = faces.iter().map(<[u32; 4]>::as_slice).collect();
    Mesh::from_polygons(&Polygons::new(positions, &faces)).expect("a sheet")
}

fn cuboid(height: f64) -> Mesh {
    let positions =
        (0..8).map(|i| DVec3::new((i & 1).into(), (i >> 1 & 1).into(), height * f64::from(i >> 2))).collect();
    let faces: [&[u32]; 6] =
        [&[0, 2, 3, 1], &[4, 5, 7, 6], &[0, 1, 5, 4], &[2, 6, 7, 3], &[0, 4, 6, 2], &[1, 3, 7, 5]];
    Mesh::from_polygons(&Polygons::new(positions, &faces)).expect("a cuboid")
}

/// Uniform cubic B-splines reproduce quadratic polynomials up to a constant, so the surface is the graph of
/// z = (a x^2 + 2 b x y + c y^2)/2 + const, whose curvature is in every book (do Carmo 1976, section 3.3).
#[test]
fn curvature_of_a_paraboloid() {
    let (a, b, c) = (0.7, 0.3, -0.4);
    let mesh = sheet(|x, y| 0.5 * (a * x * x + 2.0 * b * x * y + c * y * y));
    // Face 5 has its first corner at (-1, -1).
    for (u, v) in [(1.0, 1.0), (0.2, 0.7), (0.5, 0.0)] {
        let (x, y) = (u - 1.0, v - 1.0);
        let point = evaluate(&mesh, FaceId(5), 0, u, v).expect("a face");
        let found = point.curvature().expect("regular");
        let (p, q) = (a * x + b * y, b * x + c * y);
        let w = 1.0 + p * p + q * q;
        let gaussian = (a * c - b * b) / (w * w);
        let mean = ((1.0 + q * q) * a - 2.0 * p * q * b + (1.0 + p * p) * c) / (2.0 * w.powf(1.5));
        let root = (mean * mean - gaussian).sqrt();
        assert!((found.gaussian - gaussian).abs() < 1e-12, "{} {gaussian}", found.gaussian);
        assert!((found.mean - mean).abs() < 1e-12, "{} {mean}", found.mean);
        assert!(
            (found.principal[0] - mean - root).abs() < 1e-12
                && (found.principal[1] - mean + root).abs() < 1e-12
        );
        let [first, second] = found.directions;
        assert!((first.length() - 1.0).abs() < 1e-12 && first.cross(second).distance(point.normal) < 1e-12);
        // Euler: the normal curvature along a principal direction, from the second differences of the graph.
        let along = |d: DVec3| (a * d.x * d.x + 2.0 * b * d.x * d.y + c * d.y * d.y) / w.sqrt();
        assert!(
            (along(first) - found.principal[0]).abs() < 1e-12
                && (along(second) - found.principal[1]).abs() < 1e-12
        );
    }
}

#[test]
fn flat_and_extraordinary_places() {
    let flat =
        evaluate(&sheet(|_, _| 0.0), FaceId(5), 0, 0.3, 0.4).expect("a face").curvature().expect("regular");
    assert_eq!((flat.principal, flat.mean, flat.gaussian), ([0.0; 2], 0.0, 0.0));
    let cube = cuboid(1.0);
    assert!(evaluate(&cube, FaceId(0), 0, 0.0, 0.0).expect("a face").curvature().is_none());
    // Outward normals: a convex surface bends away from them.
    let convex = evaluate(&cube, FaceId(0), 0, 0.3, 0.4).expect("a face").curvature().expect("regular");
    assert!(convex.principal[0] < 0.0);
}

#[test]
fn quality_of_cuboids() {
    let cube = Quality::of(&cuboid(1.0), 3);
    assert_eq!((cube.extraordinary.len(), cube.aspect.len()), (8, 3));
    let first = &cube.extraordinary[0];
    for vertex in &cube.extraordinary {
        assert_eq!((vertex.valence, vertex.on_boundary), (3, false));
        // By symmetry.
        assert!((vertex.variation - first.variation).abs() < 1e-9 && vertex.variation > 0.0);
    }
    assert!(cube.aspect.iter().all(|face| face.aspect == 1.0 && face.warp == 0.0));
    let tall = Quality::of(&cuboid(3.0), 6);
    assert_eq!((tall.aspect[0].aspect, tall.median_aspect), (3.0, 3.0));
    // A sheet has no extraordinary vertices but its corners; a saddle warps its faces: each corner is a quarter of the
    // diagonals' distance off the plane of a unit cell.
    let saddle = Quality::of(&sheet(|x, y| 0.2 * x * y), 1);
    assert!(saddle.extraordinary.iter().all(|vertex| vertex.on_boundary && vertex.valence == 2));
    assert_eq!(saddle.extraordinary.len(), 4);
    assert!(saddle.median_warp > 0.03 && saddle.median_warp < 0.05, "{}", saddle.median_warp);
}
