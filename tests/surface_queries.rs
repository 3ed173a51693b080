//! Closest points and line hits of a frozen limit surface against dense sampling, parity and closed forms.

use crate::common;

use glam::{DVec2, DVec3};
use std::f64::consts::TAU;
use std::path::Path;
use welt::io::{ImportOptions, import};
use welt::job::Job;
use welt::mesh::{BoundaryRule, FaceId, Mesh, Polygons};
use welt::subdivision::evaluate;
use welt::surface::{ClosestOptions, Deviation, Facing, LimitSurface, Sampling, compare, deviation_samples};

const SHAPES: [&str; 8] = [
    "osd/catmark_cube.obj",
    "osd/catmark_torus.obj",
    "osd/catmark_pole8.obj",
    "osd/catmark_val2_interior.obj",
    "osd/catmark_nonquads.obj",
    "product/sc_jar_cage.obj",
    "product/kl_coffee-mug_cage.obj",
    "upholstery/bs0_chair_cage.obj",
];

fn load(data: &Path, file: &str) -> Mesh {
    import(&data.join(file), &ImportOptions::default()).expect("a clean mesh").mesh
}

/// Numbers in [0, 1), the same in every run (xorshift64*).
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        (self.0.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 11) as f64 / (1u64 << 53) as f64
    }

    fn direction(&mut self) -> DVec3 {
        loop {
            let d = DVec3::new(self.next(), self.next(), self.next()) * 2.0 - 1.0;
            if (0.01..1.0).contains(&d.length_squared()) {
                return d.normalize();
            }
        }
    }

    /// A patch of the surface and parameters on it: inside, on edges, at vertices, and very close to vertices.
    fn place(&mut self, surface: &LimitSurface) -> (FaceId, usize, f64, f64) {
        let faces: Vec<FaceId> = surface.faces().collect();
        let face = faces[(self.next() * faces.len() as f64) as usize];
        let corner = (self.next() * surface.patch_count(face) as f64) as usize;
        let (a, b) = (self.next(), self.next());
        let end = |x: f64| if x < 0.5 { 0.0 } else { 1.0 };
        let (u, v) = match (self.next() * 5.0) as u32 {
            0 => (a, end(b)),
            1 => (end(a), b),
            2 => (end(a), end(b)),
            3 => (a * 1e-6, b * 1e-6),
            _ => (a, b),
        };
        (face, corner, u, v)
    }
}

/// Points of the surface on a grid in every patch.
fn samples(surface: &LimitSurface, per_side: usize) -> Vec<(FaceId, usize, DVec2, DVec3)> {
    let mut points = Vec::new();
    for face in surface.faces() {
        for corner in 0..surface.patch_count(face) {
            for k in 0..per_side * per_side {
                let at = DVec2::new((k % per_side) as f64, (k / per_side) as f64) / (per_side - 1) as f64;
                let point = surface.evaluate(face, corner, at.x, at.y).expect("a point");
                points.push((face, corner, at, point.position));
            }
        }
    }
    points
}

/// The distance found by going downhill in ever smaller steps from the best samples.
fn brute_distance(
    surface: &LimitSurface,
    samples: &[(FaceId, usize, DVec2, DVec3)],
    per_side: usize,
    point: DVec3,
) -> f64 {
    let mut order: Vec<usize> = (0..samples.len()).collect();
    order.sort_by(|&a, &b| {
        samples[a].3.distance_squared(point).total_cmp(&samples[b].3.distance_squared(point))
    });
    let mut best = f64::INFINITY;
    for &i in order.iter().take(6) {
        let (face, corner, mut at, start) = samples[i];
        let mut distance = start.distance(point);
        let mut step = 1.0 / per_side as f64;
        while step > 1e-9 {
            let before = distance;
            for (x, y) in [(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0), (1.0, 1.0), (-1.0, -1.0)] {
                let next = (at + step * DVec2::new(x, y)).clamp(DVec2::ZERO, DVec2::ONE);
                let there = surface.evaluate(face, corner, next.x, next.y).expect("a point");
                if there.position.distance(point) < distance {
                    distance = there.position.distance(point);
                    at = next;
                }
            }
            if distance == before {
                step *= 0.5;
            }
        }
        best = best.min(distance);
    }
    best
}

#[test]
fn frozen_evaluation_equals_evaluation_on_the_mesh() {
    let Some(data) = common::shared_data() else { return };
    let mut random = Random(7);
    for file in SHAPES {
        let mesh = load(&data, file);
        let surface = LimitSurface::new(&mesh);
        for _ in 0..200 {
            let (face, corner, u, v) = random.place(&surface);
            let frozen = surface.evaluate(face, corner, u, v).expect("a point");
            let fresh = evaluate(&mesh, face, corner, u, v).expect("a point");
            assert!(frozen.position.distance(fresh.position) < 1e-14 * mesh.size(), "{file}");
            assert!(frozen.du.distance(fresh.du) < 1e-11 * mesh.size(), "{file}");
        }
    }
}

#[test]
fn closest_points_are_never_farther_than_sampling_finds() {
    let Some(data) = common::shared_data() else { return };
    let mut random = Random(1);
    for file in SHAPES {
        let mesh = load(&data, file);
        let surface = LimitSurface::new(&mesh);
        let size = mesh.size();
        let per_side = if mesh.face_bound() > 400 { 6 } else { 9 };
        let samples = samples(&surface, per_side);
        for query in 0..60 {
            let (face, corner, u, v) = random.place(&surface);
            let near = surface.evaluate(face, corner, u, v).expect("a point").position;
            let reach = [0.02, 0.2, 2.0][query % 3] * size;
            let point = near + random.direction() * (reach * random.next());
            let foot = surface.closest(point, &ClosestOptions::default()).expect("a foot");
            let brute = brute_distance(&surface, &samples, per_side, point);
            assert!(foot.distance <= brute + 1e-12 * size, "{file}: {} > {brute}", foot.distance);
            let there = surface.evaluate(foot.face, foot.corner, foot.u, foot.v).expect("a point");
            assert!(there.position.distance(foot.position) < 1e-12 * size, "{file}");
            assert!((foot.position.distance(point) - foot.distance).abs() < 1e-13 * size, "{file}");
        }
    }
}

#[test]
fn points_lifted_along_the_normal_come_back() {
    let Some(data) = common::shared_data() else { return };
    let mut random = Random(2);
    for file in ["osd/catmark_cube.obj", "osd/catmark_torus.obj", "product/sc_jar_cage.obj"] {
        let mesh = load(&data, file);
        let surface = LimitSurface::new(&mesh);
        let size = mesh.size();
        let mut worst = 0.0f64;
        for _ in 0..300 {
            let (face, corner, u, v) = random.place(&surface);
            let origin = surface.evaluate(face, corner, u, v).expect("a point");
            if origin.normal == DVec3::ZERO {
                continue;
            }
            let lift = 1e-4 * size * (random.next() - 0.5);
            let point = origin.position + origin.normal * lift;
            let options = ClosestOptions {
                radius: 1e-3 * size,
                facing: Some(Facing { normal: origin.normal, min_cosine: 0.0 }),
            };
            let foot = surface.closest(point, &options).expect("a foot");
            worst = worst.max(foot.position.distance(origin.position) / size);
            let signed = surface.signed_distance(point, origin.normal).expect("a distance");
            assert!((signed - lift).abs() < 1e-12 * size, "{file}: {signed} {lift}");
        }
        println!("{file}: {worst:.1e}");
        assert!(worst < 1e-11, "{file}: {worst:e}");
    }
}

#[test]
fn lines_through_points_of_the_surface_hit_them() {
    let Some(data) = common::shared_data() else { return };
    let mut random = Random(3);
    for file in SHAPES {
        let mesh = load(&data, file);
        let surface = LimitSurface::new(&mesh);
        let size = mesh.size();
        let mut worst = 0.0f64;
        for _ in 0..300 {
            let (face, corner, u, v) = random.place(&surface);
            let target = surface.evaluate(face, corner, u, v).expect("a point");
            let mut direction = random.direction();
            if target.normal.dot(direction).abs() < 0.1 {
                direction = target.normal;
            }
            if direction == DVec3::ZERO {
                continue;
            }
            let back = size * (random.next() - 0.5);
            let hits = surface.line_hits(target.position - direction * back, 2.0 * direction);
            let error = hits
                .iter()
                .map(|hit| (2.0 * hit.s - back).abs().max(hit.position.distance(target.position)))
                .fold(f64::INFINITY, f64::min);
            worst = worst.max(error / size);
            assert!(error < 1e-11 * size, "{file}: face {} corner {corner} u {u} v {v}: {error:e}", face.0);
            assert!(hits.windows(2).all(|pair| pair[0].s < pair[1].s), "{file}");
            let nearest = surface.nearest_line_hit(target.position, direction, 1e-3 * size, target.normal);
            if target.normal != DVec3::ZERO {
                let nearest = nearest.expect("a nearest hit");
                assert!(nearest.s.abs() < 1e-11 * size, "{file}: {}", nearest.s);
            }
        }
        println!("{file}: {worst:.1e}");
    }
}

#[test]
fn lines_cross_closed_surfaces_an_even_number_of_times() {
    let Some(data) = common::shared_data() else { return };
    let mut random = Random(4);
    for file in ["osd/catmark_cube.obj", "osd/catmark_torus.obj", "product/sc_jar_cage.obj"] {
        let mesh = load(&data, file);
        let surface = LimitSurface::new(&mesh);
        for _ in 0..2000 {
            let (face, corner, u, v) = random.place(&surface);
            let target = surface.evaluate(face, corner, u, v).expect("a point");
            let direction = random.direction();
            let hits = surface.line_hits(target.position, direction);
            let tangent = hits.iter().any(|hit| hit.normal.dot(direction).abs() < 1e-4);
            assert!(tangent || hits.len().is_multiple_of(2), "{file}: {} hits", hits.len());
        }
    }
}

/// An n x n grid of quads with z given by `height` at integer (x, y).
fn sheet(n: u32, height: impl Fn(f64, f64) -> f64) -> Mesh {
    let positions = (0..(n + 1) * (n + 1))
        .map(|k| {
            let (x, y) = (f64::from(k % (n + 1)), f64::from(k / (n + 1)));
            DVec3::new(x, y, height(x, y))
        })
        .collect();
    let faces: Vec<Vec<u32>> = (0..n * n)
        .map(|k| {
            let a = k / n * (n + 1) + k % n;
            vec![a, a + 1, a + n + 2, a + n + 1]
        })
        .collect();
    let faces: Vec<&[u32]> = faces.iter().map(Vec::as_slice).collect();
    Mesh::from_polygons(&Polygons::new(positions, &faces)).expect("a sheet")
}

#[test]
fn height_fields_of_a_quadratic_are_that_quadratic() {
    // A uniform cubic B-spline whose control heights are x^2 has the heights x^2 + 1/3.
    let mesh = sheet(10, |x, y| 0.1 * (x * x - 2.0 * y * y + x * y));
    let inner: Vec<FaceId> =
        mesh.faces().filter(|&f| mesh.face_vertices(f).all(|v| !mesh.is_boundary_vertex(v))).collect();
    let surface = LimitSurface::around(&mesh, &inner);
    assert_eq!(surface.faces().count(), 64);
    let height = |x: f64, y: f64| 0.1 * (x * x - 2.0 * y * y + x * y - 1.0 / 3.0);
    let mut random = Random(5);
    for _ in 0..500 {
        let (x, y) = (1.0 + 8.0 * random.next(), 1.0 + 8.0 * random.next());
        let hits = surface.line_hits(DVec3::new(x, y, 5.0), DVec3::NEG_Z);
        assert_eq!(hits.len(), 1);
        assert!((hits[0].position - DVec3::new(x, y, height(x, y))).length() < 1e-12);
        assert!((hits[0].s - (5.0 - height(x, y))).abs() < 1e-12);
        let normal = DVec3::new(-0.1 * (2.0 * x + y), -0.1 * (x - 4.0 * y), 1.0).normalize();
        assert!(hits[0].normal.distance(normal) < 1e-12);
        let foot =
            surface.closest(hits[0].position + 0.1 * normal, &ClosestOptions::default()).expect("a foot");
        assert!(
            foot.position.distance(hits[0].position) < 1e-12,
            "{}",
            foot.position.distance(hits[0].position)
        );
    }
}

/// A flat disc of k quads round the origin and 2k quads round these, at height z. The origin has valence k.
fn disc(k: u32, z: f64) -> Mesh {
    let ring = |radius: f64, j: u32| {
        let angle = std::f64::consts::PI * f64::from(j) / f64::from(k);
        DVec3::new(radius * angle.cos(), radius * angle.sin(), z)
    };
    let mut positions = vec![DVec3::new(0.0, 0.0, z)];
    positions.extend((0..2 * k).map(|j| ring(1.0, j)));
    positions.extend((0..2 * k).map(|j| ring(2.0, j)));
    let at = |circle: u32, j: u32| 1 + 2 * k * circle + j % (2 * k);
    let mut faces: Vec<[u32; 4]> =
        (0..k).map(|j| [0, at(0, 2 * j), at(0, 2 * j + 1), at(0, 2 * j + 2)]).collect();
    faces.extend((0..2 * k).map(|j| [at(0, j), at(1, j), at(1, j + 1), at(0, j + 1)]));
    let faces: Vec<&[u32]> = faces.iter().map(|face| face.as_slice()).collect();
    Mesh::from_polygons(&Polygons::new(positions, &faces)).expect("a disc")
}

#[test]
fn plane_with_extraordinary_points_is_the_plane() {
    for k in [3, 5, 7, 64] {
        let surface = LimitSurface::new(&disc(k, 0.25));
        let mut random = Random(6);
        for _ in 0..300 {
            let (face, corner, u, v) = random.place(&surface);
            let on = surface.evaluate(face, corner, u, v).expect("a point");
            assert!((on.position.z - 0.25).abs() < 1e-15);
            let point = on.position + DVec3::Z * (random.next() - 0.5);
            let foot = surface.closest(point, &ClosestOptions::default()).expect("a foot");
            assert!((foot.distance - (point.z - 0.25).abs()).abs() < 1e-14);
            let error = foot.position.distance(on.position);
            assert!(error < 1e-12, "{k} {u} {v}: {error:e}");
            let hits = surface.line_hits(point, DVec3::Z);
            assert_eq!(hits.len(), 1, "{k} {u} {v}");
            assert!(hits[0].position.distance(on.position) < 1e-12);
        }
        // Off the surface nothing is hit.
        assert!(surface.line_hits(DVec3::new(2.1, 0.0, 0.0), DVec3::Z).is_empty());
    }
}

#[test]
fn deviation_of_a_shifted_plane_is_the_shift() {
    let (low_mesh, high_mesh) = (sheet(6, |_, _| 0.0), sheet(6, |_, _| 0.5));
    let (low, high) = (LimitSurface::new(&low_mesh), LimitSurface::new(&high_mesh));
    let samples =
        |sampling| deviation_samples(&high, |_| true, &low, sampling, &Job::new()).expect("not cancelled");
    let one_thread = samples(Sampling::default());
    assert_eq!(one_thread, samples(Sampling { threads: 3, ..Sampling::default() }));
    let up = Deviation::of(&one_thread).expect("memory");
    assert_eq!(up.samples, 36 * 64);
    for value in [up.max, up.rms, up.p95] {
        assert!((value - 0.5).abs() < 1e-12);
    }
    assert!(up.at.expect("a place").signed > 0.0);
    let compared = compare(&low_mesh, &high_mesh, Sampling { per_side: 4, threads: 1 }, &Job::new())
        .expect("not cancelled");
    assert_eq!(compared.both.samples, 2 * 36 * 16);
    assert!((compared.both.rms - 0.5).abs() < 1e-12);
    assert!(compared.first_to_second.at.expect("a place").signed < 0.0);
}

/// A unit square below two sheets that no normal of it meets within a tenth of their size: what is closest comes from the
/// whole surface. Height 1 where the lower sheet, which begins at x = 0.95 and height 0.5, is further away.
#[test]
fn deviations_without_a_hit_go_to_the_closest_point() {
    let flat = |sheets: &[[f64; 5]]| {
        let mut polygons = Polygons::default();
        for (&[x0, x1, y0, y1, z], first) in sheets.iter().zip((0..).step_by(4)) {
            let corners = [(x0, y0), (x1, y0), (x1, y1), (x0, y1)];
            polygons.positions.extend(corners.map(|(x, y)| DVec3::new(x, y, z)));
            polygons.face_sizes.push(4);
            polygons.face_vertices.extend([first, first + 1, first + 2, first + 3]);
        }
        polygons.subdivision.boundary = BoundaryRule::EdgeAndCorner;
        Mesh::from_polygons(&polygons).expect("sheets")
    };
    let below = flat(&[[0.0, 1.0, 0.0, 1.0, 0.0]]);
    let above = flat(&[[-0.2, 1.2, -0.2, 1.2, 1.0], [0.95, 1.6, -0.2, 1.2, 0.5]]);
    let compared = compare(&below, &above, Sampling { per_side: 64, threads: 1 }, &Job::new());
    let found = compared.expect("not cancelled").first_to_second.rms;
    // The distances are equal where (0.95 - x)^2 + 0.5^2 = 1.
    let reach = 0.75f64.sqrt();
    let square = (0.95 - reach) + (reach.powi(3) / 3.0 + 0.25 * reach) + 0.05 * 0.25;
    assert!((found - square.sqrt()).abs() < 1e-3, "{found} {}", square.sqrt());
}

/// Beside faces with many corners queries hold more of the surface than elsewhere: against dense sampling.
#[test]
fn closest_points_of_a_prism_over_a_polygon_of_forty_sides() {
    const SIDES: u32 = 40;
    let mut polygons = Polygons::default();
    for level in 0..3 {
        polygons.positions.extend((0..SIDES).map(|i| {
            let (sin, cos) = (TAU * f64::from(i) / f64::from(SIDES)).sin_cos();
            DVec3::new(2.0 * cos, 2.0 * sin, f64::from(level))
        }));
    }
    for (level, i) in (0..2).flat_map(|level| (0..SIDES).map(move |i| (level, i))) {
        let (a, b) = (SIDES * level + i, SIDES * level + (i + 1) % SIDES);
        polygons.face_sizes.push(4);
        polygons.face_vertices.extend([a, b, b + SIDES, a + SIDES]);
    }
    polygons.face_sizes.extend([SIDES; 2]);
    polygons.face_vertices.extend((0..SIDES).map(|i| 2 * SIDES + i).chain((0..SIDES).rev()));
    let mesh = Mesh::from_polygons(&polygons).expect("a prism");
    let surface = LimitSurface::new(&mesh);
    const STEPS: u32 = 24;
    let mut points = Vec::new();
    for face in mesh.faces() {
        for corner in 0..surface.patch_count(face) {
            for k in 0..=STEPS * (STEPS + 2) {
                let [u, v] = [k % (STEPS + 1), k / (STEPS + 1)].map(|k| f64::from(k) / f64::from(STEPS));
                points.extend(evaluate(&mesh, face, corner, u, v).map(|at| at.position));
            }
        }
    }
    let mut random = Random(0x5eed_f041);
    for _ in 0..300 {
        let point = random.direction() * 2.5 * random.next() + DVec3::Z;
        let sampled = points.iter().map(|p| p.distance(point)).fold(f64::INFINITY, f64::min);
        let foot = surface.closest(point, &ClosestOptions::default()).expect("a foot").distance;
        assert!(foot <= sampled + 1e-12 && foot >= sampled - 0.05, "{point}: {foot} {sampled}");
    }
}

#[test]
fn senseless_queries_have_defined_results() {
    let mesh = sheet(3, |x, y| x * y);
    let surface = LimitSurface::new(&mesh);
    let plain = ClosestOptions::default();
    let nan = DVec3::new(f64::NAN, 0.0, 0.0);
    assert!(surface.closest(nan, &plain).is_none());
    assert!(surface.closest(DVec3::INFINITY, &plain).is_none());
    assert!(surface.closest(DVec3::splat(1e200), &plain).is_none());
    assert!(surface.closest(DVec3::ZERO, &ClosestOptions { radius: 0.0, ..plain }).is_none());
    assert!(surface.closest(DVec3::splat(1e50), &plain).is_some_and(|foot| foot.distance > 1e50));
    assert!(surface.line_hits(DVec3::ZERO, DVec3::ZERO).is_empty());
    assert!(surface.line_hits(nan, DVec3::Z).is_empty());
    assert!(surface.line_hits(DVec3::ZERO, nan).is_empty());
    assert_eq!(surface.line_hits(DVec3::new(1.5, 1.5, 1e9), DVec3::NEG_Z).len(), 1);
    assert!(surface.nearest_line_hit(DVec3::ZERO, DVec3::Z, f64::NAN, DVec3::Z).is_none());
    assert!(surface.evaluate(FaceId(0), 1, 0.5, 0.5).is_none());
    assert!(surface.evaluate(FaceId(0), 0, f64::NAN, 0.5).is_none());
    assert!(surface.evaluate(FaceId(99), 0, 0.5, 0.5).is_none());
    let empty = LimitSurface::around(&mesh, &[]);
    assert!(empty.closest(DVec3::ZERO, &plain).is_none());
    assert!(empty.line_hits(DVec3::ZERO, DVec3::Z).is_empty());
    assert!(empty.signed_distance(DVec3::ZERO, DVec3::Z).is_none());
}

#[test]
fn degenerate_shapes_have_defined_results() {
    let plain = ClosestOptions::default();
    // A line that lies in a flat sheet: some points of it, all on the line.
    let flat = LimitSurface::new(&sheet(6, |_, _| 0.0));
    let hits = flat.line_hits(DVec3::new(-1.0, 2.3, 0.0), DVec3::new(1.0, 0.1, 0.0));
    assert!(hits.iter().all(|hit| hit.position.z.abs() < 1e-12), "{hits:?}");
    assert!(hits.windows(2).all(|pair| pair[0].s < pair[1].s));

    // A mesh in one point, one on a line, and one of the largest numbers.
    let point = LimitSurface::new(&map(&sheet(3, |_, _| 0.0), |_| DVec3::ONE));
    assert_eq!(point.size(), 0.0);
    assert!((point.closest(DVec3::ZERO, &plain).expect("a foot").distance - 3f64.sqrt()).abs() < 1e-12);
    point.line_hits(DVec3::ZERO, DVec3::ONE);
    let line = LimitSurface::new(&map(&sheet(3, |_, _| 0.0), |p| DVec3::X * p.x));
    let foot = line.closest(DVec3::new(1.3, 0.7, 0.0), &plain).expect("a foot");
    assert!((foot.distance - 0.7).abs() < 1e-9, "{}", foot.distance);
    line.line_hits(DVec3::ZERO, DVec3::X);
    let huge = LimitSurface::new(&map(&sheet(3, |x, y| x * y), |p| p * 1e300));
    huge.closest(DVec3::ZERO, &plain);
    huge.line_hits(DVec3::ZERO, DVec3::Z);
}

fn map(mesh: &Mesh, f: impl Fn(DVec3) -> DVec3) -> Mesh {
    let mut mapped = mesh.clone();
    for v in mesh.vertices() {
        mapped.set_position(v, f(mesh.position(v)));
    }
    mapped
}

#[test]
fn centre_of_a_symmetric_shape_has_a_closest_point() {
    let Some(data) = common::shared_data() else { return };
    let mesh = load(&data, "osd/catmark_cube.obj");
    let surface = LimitSurface::new(&mesh);
    let foot = surface.closest(DVec3::ZERO, &ClosestOptions::default()).expect("a foot");
    let sampled = samples(&surface, 33);
    let nearest = sampled.iter().map(|sample| sample.3.length()).fold(f64::INFINITY, f64::min);
    assert!(foot.distance <= nearest + 1e-12, "{} {nearest}", foot.distance);
    assert!(foot.distance > nearest - 1e-3, "{} {nearest}", foot.distance);
}
