//! Features along curves that do not follow the edges, on flat sheets: the figures of a study
//! (docs/linear-features.md, section 6) are the bar.

use crate::common;

use glam::DVec3;
use std::fmt::Write;
use welt::feature::{self, Options, Report, Request};
use welt::job::Job;
use welt::mark::{Selection, Selector};
use welt::mesh::Mesh;
use welt::subdivision::{limit_positions, refine};

const SIDE: u32 = 12;
const DEPTH: f64 = 0.1;
/// Full width at half depth of a band whose control rims are 0.1 from its middle: W = 1.1934 w + 0.06285 e.
const WIDTH: f64 = 1.1934 * 0.1 + 0.062_85;

/// A flat sheet of 12 x 12 unit cells.
fn sheet() -> Mesh {
    common::flat_sheet(SIDE)
}

fn text(course: &str, points: &[DVec3], closed: bool) -> String {
    let mut text = format!("{course}:");
    for (i, p) in points.iter().enumerate() {
        let separator = if i == 0 { "" } else { ";" };
        write!(text, "{separator}{},{},{}", p.x, p.y, p.z).expect("a string takes it");
    }
    text + if closed { ";closed" } else { "" }
}

fn groove(mesh: &mut Mesh, marks: &[String]) -> Report {
    let selectors: Vec<Selector> = marks.iter().map(|m| Selector::parse(m).expect("a selector")).collect();
    let selection = Selection::resolve(mesh, &selectors).expect("marks");
    let set = [format!("width={WIDTH}"), format!("depth={DEPTH}")];
    let request = Request::features(&["groove"], &set).expect("a request");
    let report =
        feature::apply(mesh, &selection, &request, &Options::default(), &Job::new()).expect("applied");
    mesh.validate_control_mesh().expect("valid");
    report
}

/// The limit surface: points, and the least z of the normals of its facets.
fn limit(mesh: &Mesh) -> (Vec<DVec3>, f64) {
    let refined = Mesh::from_polygons(&refine(mesh, 4).expect("fits").into_polygons()).expect("refined");
    let points = limit_positions(&refined);
    let least = refined
        .faces()
        .map(|f| {
            let [a, b, c, d] =
                [0, 1, 2, 3].map(|i| points[refined.face_vertices(f).nth(i).expect("a quad").index()]);
            (c - a).cross(d - b).normalize_or_zero().z
        })
        .fold(1.0, f64::min);
    (points, least)
}

/// Looks at the valley of a groove along a curve given by `at` for x in `range`: greatest and root mean square
/// distance of the deepest points from the curve, and the least and greatest depth there, in units of the asked one.
fn valley(points: &[DVec3], at: impl Fn(f64) -> DVec3, range: [f64; 2]) -> [f64; 4] {
    const STATIONS: usize = 60;
    let (mut most, mut sum, mut low, mut high) = (0.0_f64, 0.0, f64::INFINITY, 0.0_f64);
    for station in 0..STATIONS {
        let x = range[0] + (range[1] - range[0]) * station as f64 / (STATIONS - 1) as f64;
        let (here, ahead) = (at(x), at(x + 1e-4));
        let along = (ahead - here).normalize();
        let across = DVec3::Z.cross(along);
        // A slice across the band, its deepest point found by a parabola through the lowest samples.
        let mut slice: Vec<(f64, f64)> = points
            .iter()
            .filter(|p| ((**p - here).dot(along)).abs() < 0.04 && ((**p - here).dot(across)).abs() < 0.3)
            .map(|p| ((*p - here).dot(across), -p.z))
            .collect();
        slice.sort_by(|a, b| b.1.total_cmp(&a.1));
        let deepest = slice.first().expect("points in the slice").1;
        let near: Vec<&(f64, f64)> = slice.iter().filter(|p| p.1 > 0.9 * deepest).collect();
        let weight = |p: &(f64, f64)| p.1 - 0.9 * deepest + 1e-12;
        let offset =
            near.iter().map(|p| p.0 * weight(p)).sum::<f64>() / near.iter().map(|p| weight(p)).sum::<f64>();
        most = most.max(offset.abs());
        sum += offset * offset;
        (low, high) = (low.min(deepest), high.max(deepest));
    }
    [most, (sum / STATIONS as f64).sqrt(), low / DEPTH, high / DEPTH]
}

#[test]
fn a_straight_line_of_slope_a_half() {
    let mut mesh = sheet();
    let at = |x: f64| DVec3::new(x, 3.3 + 0.5 * x, 0.0);
    let report = groove(&mut mesh, &[text("polyline", &[at(-0.5), at(12.5)], false)]);
    let (points, least_z) = limit(&mesh);
    let found = valley(&points, at, [1.0, 11.0]);
    println!("line: {found:?}, {least_z}, {} vertices\n{report}", mesh.vertex_bound());
    assert!(report.leftovers.is_empty());
    assert!(least_z > 0.0, "a fold");
    // The study: off by at most .008, depth .95 to 1.00.
    assert!(found[0] < 0.008 && found[2] > 0.95 && found[3] < 1.01, "{found:?}");
}

#[test]
fn a_sine() {
    let mut mesh = sheet();
    let at = |x: f64| DVec3::new(x, 6.03 + 1.5 * (std::f64::consts::TAU * x / 10.0).sin(), 0.0);
    let points: Vec<DVec3> = (-2..=50).map(|i| at(f64::from(i) * 0.25)).collect();
    let report = groove(&mut mesh, &[text("spline", &points, false)]);
    let (points, least_z) = limit(&mesh);
    let found = valley(&points, at, [1.0, 11.0]);
    println!("sine: {found:?}, {least_z}, {} vertices\n{report}", mesh.vertex_bound());
    assert!(report.leftovers.is_empty());
    assert!(least_z > 0.0, "a fold");
    // The study: off by at most .022, .007 in the mean; depth .93 to 1.00.
    assert!(found[0] < 0.023 && found[1] < 0.008 && found[2] > 0.93 && found[3] < 1.01, "{found:?}");
}

#[test]
fn a_circle_closes() {
    let mut mesh = sheet();
    let at = |x: f64| DVec3::new(6.1 + 3.0 * x.cos(), 5.9 + 3.0 * x.sin(), 0.0);
    let points: Vec<DVec3> = (0..24).map(|i| at(std::f64::consts::TAU * f64::from(i) / 24.0)).collect();
    let report = groove(&mut mesh, &[text("spline", &points, true)]);
    let (points, least_z) = limit(&mesh);
    let found = valley(&points, at, [0.0, std::f64::consts::TAU]);
    println!("circle: {found:?}, {least_z}, {} vertices\n{report}", mesh.vertex_bound());
    assert!(report.leftovers.is_empty());
    assert!(least_z > 0.0, "a fold");
    assert!(found[0] < 0.025 && found[1] < 0.01 && found[2] > 0.95 && found[3] < 1.01, "{found:?}");
}

/// Figure 8 of the paper: a feature along a curve crosses one that follows the edges.
#[test]
fn a_line_crosses_a_ring() {
    let mut mesh = sheet();
    let at = |x: f64| DVec3::new(x, 3.3 + 0.5 * x, 0.0);
    let report = groove(&mut mesh, &[text("polyline", &[at(-0.5), at(12.5)], false), "ring:6,7".into()]);
    let (points, least_z) = limit(&mesh);
    println!("crossing: {least_z}, {} vertices\n{report}", mesh.vertex_bound());
    assert!(report.leftovers.is_empty() && least_z > 0.0);
    // They cross at (6.5, 6.55); beside that each keeps to its own course.
    for range in [[1.0, 5.9], [7.1, 11.0]] {
        let found = valley(&points, at, range);
        assert!(found[0] < 0.01 && found[2] > 0.95 && found[3] < 1.05, "{found:?}");
        let ring = valley(&points, |y| DVec3::new(6.5, y, 0.0), range);
        assert!(ring[0] < 0.03 && ring[2] > 0.95 && ring[3] < 1.05, "{ring:?}");
    }
}

#[test]
fn curves_that_cannot_be_followed_are_refused() {
    let error = |marks: &[&str]| {
        let mut mesh = sheet();
        let before = mesh.to_polygons();
        let selectors: Vec<Selector> =
            marks.iter().map(|m| Selector::parse(m).expect("a selector")).collect();
        let selection = Selection::resolve(&mesh, &selectors).expect("marks");
        let request = Request::features::<_, &str>(&["groove"], &[]).expect("a request");
        let error = feature::apply(&mut mesh, &selection, &request, &Options::default(), &Job::new())
            .expect_err("refused");
        assert_eq!(mesh.to_polygons(), before);
        error.to_string()
    };
    assert!(error(&["polyline:100,100,0;101,100,0"]).contains("curve 0: it is far from the surface"));
    assert!(error(&["polyline:5.2,5.2,0;5.3,5.2,0"]).contains("it crosses no edge"));
    assert!(error(&["polyline:1,5.4,0;9,5.4,0#blue"]).contains("#blue"));
    let twice = error(&["polyline:1,5.4,0;9,5.4,0", "ring:67,80"]);
    assert!(
        twice.starts_with("curve 0 crosses edge ") && twice.contains("--rules rules/patches.rules"),
        "{twice}"
    );
    // Rules alone would pass over the curve: that is said, and the marks beside it are left alone.
    let mut mesh = sheet();
    let selectors = ["polyline:1,5.4,0;9,5.4,0", "ring:6,7"].map(|m| Selector::parse(m).expect("a selector"));
    let selection = Selection::resolve(&mesh, &selectors).expect("marks");
    let rules = feature::linear_rules().expect("rules");
    let request = Request::rules::<&str>(rules, &[]).expect("a request");
    let refused = feature::apply(&mut mesh, &selection, &request, &Options::default(), &Job::new());
    assert_eq!(
        refused.expect_err("refused").to_string(),
        "curve 0: rules alone follow no curve; ask for a feature"
    );
    for bad in ["polyline:0,0,0", "spline:0,0,0;0,0,0", "polyline:0,0,0;1,nan,0"] {
        assert!(Selector::parse(bad).is_err(), "{bad}");
    }
}
