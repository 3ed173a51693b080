//! Grooves on flat sheets, where the right answer is known: figures of a prototype (docs/linear-features.md) and closed forms.
//!
//! The limit surface is looked at through five levels of refinement with every vertex moved to its limit, so that
//! nothing here depends on how the library measures.

use glam::DVec3;
use welt::feature::{self, Options, Report, Request};
use welt::job::Job;
use welt::mark::{Selection, Selector};
use welt::mesh::{Mesh, Polygons};
use welt::subdivision::{limit_positions, refine};

const SIDE: u32 = 7;

/// A sheet of 7 x 7 cells with edges `u` and `v`; vertex (i, j) is number 8 j + i and lies at i u + j v.
fn sheet(u: DVec3, v: DVec3) -> Mesh {
    let positions =
        (0..=SIDE).flat_map(|j| (0..=SIDE).map(move |i| u * f64::from(i) + v * f64::from(j))).collect();
    let at = |i: u32, j: u32| j * (SIDE + 1) + i;
    let mut polygons = Polygons { positions, ..Polygons::default() };
    for (i, j) in (0..SIDE).flat_map(|j| (0..SIDE).map(move |i| (i, j))) {
        polygons.face_sizes.push(4);
        polygons.face_vertices.extend([at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]);
    }
    Mesh::from_polygons(&polygons).expect("a sheet")
}

fn square() -> Mesh {
    sheet(DVec3::X, DVec3::Y)
}

fn apply(mesh: &mut Mesh, marks: &[String], feature: &str, set: &[(&str, f64)]) -> Report {
    let selectors: Vec<Selector> = marks.iter().map(|m| Selector::parse(m).expect("a selector")).collect();
    let selection = Selection::resolve(mesh, &selectors).expect("marks");
    let settings: Vec<String> = set.iter().map(|(name, x)| format!("{name}={x}")).collect();
    let request = Request::features(&[feature], &settings).expect("a request");
    let report =
        feature::apply(mesh, &selection, &request, &Options::default(), &Job::new()).expect("applied");
    mesh.validate_control_mesh().expect("valid");
    report
}

/// Edge marks for the edges (i, j)-(i + 1, j) in `columns` x `rows`: crossed by lines of constant x.
fn crossed_upwards(i: u32, rows: std::ops::RangeInclusive<u32>) -> Vec<String> {
    rows.map(|j| format!("edge:{},{}", 8 * j + i, 8 * j + i + 1)).collect()
}

/// Edge marks for the edges (i, j)-(i, j + 1): crossed by lines of constant y.
fn crossed_sideways(j: u32, columns: std::ops::RangeInclusive<u32>) -> Vec<String> {
    columns.map(|i| format!("edge:{},{}", 8 * j + i, 8 * j + 8 + i)).collect()
}

/// Points of the limit surface, dense.
fn limit(mesh: &Mesh) -> Vec<DVec3> {
    let refined = Mesh::from_polygons(&refine(mesh, 5).expect("fits").into_polygons()).expect("refined");
    limit_positions(&refined)
}

/// Depth of the valley that crosses the strip `low <= along < high`: the lowest point there.
fn depth_where(points: &[DVec3], inside: impl Fn(DVec3) -> bool) -> f64 {
    points.iter().filter(|p| inside(**p)).fold(0.0, |deepest: f64, p| deepest.max(-p.z))
}

/// Valley depths along `count` slices of `coordinate` over [from, to], in units of the asked depth.
fn valley(
    points: &[DVec3],
    from: f64,
    to: f64,
    coordinate: impl Fn(DVec3) -> f64,
    near: impl Fn(DVec3) -> bool,
) -> (f64, f64) {
    const SLICES: usize = 24;
    let (mut low, mut high) = (f64::INFINITY, 0.0_f64);
    for slice in 0..SLICES {
        let a = from + (to - from) * slice as f64 / SLICES as f64;
        let b = from + (to - from) * (slice + 1) as f64 / SLICES as f64;
        let depth = depth_where(points, |p| near(p) && coordinate(p) >= a && coordinate(p) <= b);
        (low, high) = (low.min(depth), high.max(depth));
    }
    (low, high)
}

const DEPTH: f64 = 0.1;
/// The band whose control rims are at 0.15 (the half width of the measured figures): W = 1.1934 w + 0.06285.
const WIDTH: f64 = 1.1934 * 0.15 + 0.062_85;

/// Width at half depth and depth of a groove along `v`, measured in the middle of the sheet across the band.
fn section(mesh: &Mesh, u: DVec3, v: DVec3) -> (f64, f64) {
    let points = limit(mesh);
    let along = v.normalize();
    let across = (u - along * u.dot(along)).normalize();
    let middle = (u + v) * 3.5;
    // Near one station: a thin slice across the band through a row of limit vertices.
    let mut profile: Vec<(f64, f64)> = points
        .iter()
        .filter(|p| ((**p - middle).dot(along)).abs() < 0.02 * v.length() + 0.6 * u.dot(along).abs() / 32.0)
        .map(|p| ((*p - middle).dot(across), p.z.abs()))
        .filter(|(x, _)| x.abs() < 0.5 * u.dot(across))
        .collect();
    profile.sort_by(|a, b| a.0.total_cmp(&b.0));
    let depth = profile.iter().fold(0.0_f64, |d, p| d.max(p.1));
    let half = depth / 2.0;
    let crossing = |pair: &[(f64, f64)]| {
        let (a, b) = (pair[0], pair[1]);
        ((a.1 - half) * (b.1 - half) < 0.0).then(|| a.0 + (b.0 - a.0) * (half - a.1) / (b.1 - a.1))
    };
    let crossings: Vec<f64> = profile.windows(2).filter_map(crossing).collect();
    assert!(crossings.len() >= 2, "no section: {profile:?}");
    (crossings[crossings.len() - 1] - crossings[0], depth)
}

#[test]
fn width_and_depth_are_reached_within_a_percent() {
    let cases = [
        ("square", DVec3::X, DVec3::Y),
        ("sheared", DVec3::X, DVec3::new(0.5, 0.75_f64.sqrt(), 0.0)),
        ("stretched across", DVec3::X * 2.0, DVec3::Y),
        ("stretched along", DVec3::X, DVec3::Y * 2.0),
    ];
    for (name, u, v) in cases {
        for (feature, extent, width) in [("groove", "depth", 0.3), ("ridge", "height", 0.45)] {
            let width = width * u.length() * (1.0 - (u.dot(v) / u.length() / v.length()).powi(2)).sqrt();
            let mut mesh = sheet(u, v);
            let report =
                apply(&mut mesh, &["ring:27,28".into()], feature, &[("width", width), (extent, DEPTH)]);
            assert_eq!(report.marks, 8, "{name}");
            assert_eq!(report.after.vertices, 64 + 3 * 8, "{name}");
            let (reached, depth) = section(&mesh, u, v);
            println!(
                "{name} {}: width {width:.4} reached {reached:.4}, depth {DEPTH} reached {depth:.5}",
                feature
            );
            assert!((reached / width - 1.0).abs() < 0.01, "{name}: width {width} reached {reached}");
            assert!((depth / DEPTH - 1.0).abs() < 0.01, "{name}: depth {depth}");
            let said = report.dimension("width").expect("measured");
            assert!(
                (said.reached_mean / reached - 1.0).abs() < 0.01,
                "{name}: the report says {}",
                said.reached_mean
            );
        }
    }
}

#[test]
fn straight_valley() {
    let mut mesh = square();
    apply(&mut mesh, &["ring:27,28".into()], "groove", &[("width", WIDTH), ("depth", DEPTH)]);
    let points = limit(&mesh);
    let (low, high) = valley(&points, 0.1, 6.9, |p| p.y, |_| true);
    // docs/linear-features.md, section 2: 1.00.
    assert!((low / DEPTH - 1.0).abs() < 1e-3 && (high / DEPTH - 1.0).abs() < 1e-3, "{low} {high}");
    // Section 2, reach: exactly flat beyond w + (5g + G)/6 from the centre line.
    let reach = 0.15 + (5.0 * 0.35 + 1.0) / 6.0;
    assert!(depth_where(&points, |p| (p.x - 3.5).abs() > reach + 1e-9) < 1e-14);
    assert!(depth_where(&points, |p| (p.x - 3.5).abs() > reach - 0.05) > 0.0);
}

#[test]
fn corner_valley() {
    let mut mesh = square();
    let mut marks = crossed_upwards(3, 0..=3);
    marks.extend(crossed_sideways(3, 4..=7));
    let report = apply(&mut mesh, &marks, "groove", &[("width", WIDTH), ("depth", DEPTH)]);
    assert!(report.leftovers.is_empty() && report.non_quads.is_empty(), "{report}");
    // 3 per mark and 3 on the diagonal (docs/linear-features.md: 91 vertices on the 7 x 7 sheet).
    assert_eq!(report.after.vertices, 91);
    let points = limit(&mesh);
    // The bend is at the lower right of the middle face: the valley comes from below and leaves to the right.
    let (low, high) = valley(&points, 0.5, 3.2, |p| p.y, |p| p.x < 4.0);
    assert!(low / DEPTH > 0.995 && high / DEPTH < 1.005, "{low} {high}");
    let (low, high) = valley(&points, 3.8, 6.5, |p| p.x, |p| p.y > 3.0);
    assert!(low / DEPTH > 0.995 && high / DEPTH < 1.005, "{low} {high}");
    // Along the bend, measured across the diagonal: the prototype had 1.00.
    let (low, high) =
        valley(&points, -0.25, 0.25, |p| (p.x - 3.5) + (p.y - 3.5), |p| (p.x - p.y - 0.0).abs() < 0.9);
    assert!(low / DEPTH > 0.99 && high / DEPTH < 1.01, "{low} {high}");
}

#[test]
fn crossing_valley() {
    let mut mesh = square();
    let report = apply(
        &mut mesh,
        &["ring:27,28".into(), "ring:27,35".into()],
        "groove",
        &[("width", WIDTH), ("depth", DEPTH)],
    );
    assert!(report.leftovers.is_empty() && report.non_quads.is_empty(), "{report}");
    // docs/linear-features.md, section 2: 121 vertices, valley 1.00 to 1.00 with the centre at half height (1.33 without).
    assert_eq!(report.after.vertices, 121);
    let points = limit(&mesh);
    for coordinate in [0, 1] {
        let (low, high) =
            valley(&points, 0.5, 6.5, |p| p[coordinate], |p| (p[1 - coordinate] - 3.5).abs() < 0.02);
        assert!(low / DEPTH > 0.995 && high / DEPTH < 1.005, "{low} {high}");
    }
}

#[test]
fn dead_end_valley() {
    let mut mesh = square();
    let marks = crossed_upwards(3, 0..=3);
    let report = apply(&mut mesh, &marks, "groove", &[("width", WIDTH), ("depth", DEPTH)]);
    assert!(report.leftovers.is_empty(), "{report}");
    // DE3W: five inner vertices, one triangle (docs/linear-features.md: 81 vertices; 64 + 3 x 4 + 5).
    assert_eq!(report.after.vertices, 81);
    assert_eq!(report.non_quads.iter().map(|n| n.1).collect::<Vec<_>>(), [3]);
    let points = limit(&mesh);
    let middle = |p: DVec3| (p.x - 3.5).abs() < 0.02;
    let depth_at = |y: f64| depth_where(&points, |p| middle(p) && (p.y - 3.0 - y).abs() < 0.016) / DEPTH;
    // docs/linear-features.md, section 2, for the tip at y = 0.5: 98 % until 0.12, half depth at 0.907 y - 0.096 = 0.36.
    assert!(depth_at(0.05) > 0.97, "{}", depth_at(0.05));
    assert!(depth_at(0.12) > 0.98, "{}", depth_at(0.12));
    assert!(depth_at(0.32) > 0.5 && depth_at(0.40) < 0.5, "{} {}", depth_at(0.32), depth_at(0.40));
    assert!(depth_at(0.9) < 0.02, "{}", depth_at(0.9));
}

#[test]
fn t_valley() {
    let mut mesh = square();
    let mut marks = crossed_upwards(3, 0..=3);
    marks.push("ring:27,35".into());
    let report = apply(&mut mesh, &marks, "groove", &[("width", WIDTH), ("depth", DEPTH)]);
    // T-DE: 104 vertices, one pentagon behind the far rim; valleys .96 to 1.01 (docs/junctions.md, section 1).
    assert!(report.leftovers.is_empty(), "{report}");
    assert_eq!(report.after.vertices, 104);
    assert_eq!(report.non_quads.iter().map(|n| n.1).collect::<Vec<_>>(), [5]);
    let points = limit(&mesh);
    let (low, high) = valley(&points, 0.5, 6.5, |p| p.x, |p| (p.y - 3.5).abs() < 0.15);
    assert!(low / DEPTH > 0.96 && high / DEPTH < 1.01, "{low} {high}");
    let (low, high) = valley(&points, 0.5, 3.4, |p| p.y, |p| (p.x - 3.5).abs() < 0.02);
    assert!(low / DEPTH > 0.96 && high / DEPTH < 1.01, "{low} {high}");
}
