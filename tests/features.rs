//! The features that ship and profiles of one's own, on a flat sheet where the right answer is known.
//!
//! The limit surface is looked at through five levels of refinement with every vertex moved to its limit, so that
//! nothing here depends on how the library measures.

use crate::common;

use glam::DVec3;
use std::path::PathBuf;
use welt::feature::{self, FeatureError, Options, Profile, Report, Request};
use welt::job::Job;
use welt::mark::{Selection, Selector};
use welt::mesh::Mesh;
use welt::subdivision::{limit_positions, refine};

const SIDE: u32 = 9;

/// A flat sheet of 9 x 9 unit cells; vertex (i, j) is number 10 j + i.
fn sheet() -> Mesh {
    common::flat_sheet(SIDE)
}

fn try_apply(
    mesh: &mut Mesh,
    marks: &[&str],
    features: &[&str],
    set: &[&str],
) -> Result<Report, FeatureError> {
    let selectors: Vec<Selector> = marks.iter().map(|m| Selector::parse(m).expect("a selector")).collect();
    let selection = Selection::resolve(mesh, &selectors).expect("marks");
    let request = Request::features(features, set).expect("a request");
    feature::apply(mesh, &selection, &request, &Options::default(), &Job::new())
}

fn apply(mesh: &mut Mesh, marks: &[&str], features: &[&str], set: &[&str]) -> Report {
    let report = try_apply(mesh, marks, features, set).expect("applied");
    mesh.validate_control_mesh().expect("valid");
    assert!(report.leftovers.is_empty(), "{report}");
    report
}

/// Points of the limit surface.
fn limit(mesh: &Mesh) -> Vec<DVec3> {
    let refined = Mesh::from_polygons(&refine(mesh, 5).expect("fits").into_polygons()).expect("refined");
    limit_positions(&refined)
}

/// The cross-section at y = 4.5 as (x, height), by x; the band runs along y.
fn section(mesh: &Mesh) -> Vec<(f64, f64)> {
    let mut points: Vec<(f64, f64)> =
        limit(mesh).into_iter().filter(|p| (p.y - 4.5).abs() < 1e-6).map(|p| (p.x, p.z)).collect();
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    points
}

/// Where the section passes a height, from left to right.
fn passes(section: &[(f64, f64)], level: f64) -> Vec<f64> {
    section
        .windows(2)
        .filter(|w| (w[0].1 - level) * (w[1].1 - level) < 0.0)
        .map(|w| w[0].0 + (w[1].0 - w[0].0) * (level - w[0].1) / (w[1].1 - w[0].1))
        .collect()
}

fn extremes(section: &[(f64, f64)]) -> (f64, f64) {
    section.iter().fold((0.0, 0.0), |(low, high): (f64, f64), p| (low.min(p.1), high.max(p.1)))
}

fn close(reached: f64, asked: f64) {
    assert!((reached / asked - 1.0).abs() < 0.01, "asked {asked}, reached {reached}");
}

/// The column of cells between x = 4 and x = 5, marked from its left side.
const COLUMN: &str = "ring:44,45";

#[test]
fn piping_is_a_crest_between_two_grooves() {
    let mut mesh = sheet();
    let set = ["width=0.5", "height=0.08", "depth=0.04"];
    let report = apply(&mut mesh, &[COLUMN], &["piping"], &set);
    assert_eq!(report.after.vertices, 100 + 5 * 10);
    let section = section(&mesh);
    let (low, high) = extremes(&section);
    close(high, 0.08);
    close(low, -0.04);
    let flanks = passes(&section, -0.02);
    assert_eq!(flanks.len(), 4, "{flanks:?}");
    close(flanks[3] - flanks[0], 0.5);
    let crest = section.iter().max_by(|a, b| a.1.total_cmp(&b.1)).expect("points");
    assert!((crest.0 - 4.5).abs() < 0.01, "the crest lies at {}", crest.0);
}

#[test]
fn a_bead_is_broader_than_a_ridge() {
    let mut widths = Vec::new();
    for feature in ["ridge", "bead"] {
        let mut mesh = sheet();
        apply(&mut mesh, &[COLUMN], &[feature], &["width=0.5", "height=0.1"]);
        let section = section(&mesh);
        close(extremes(&section).1, 0.1);
        let half = passes(&section, 0.05);
        close(half[1] - half[0], 0.5);
        let top = passes(&section, 0.08);
        widths.push(top[1] - top[0]);
    }
    assert!(widths[1] > 1.15 * widths[0], "{widths:?}");
}

/// Which flank is steep follows the first vertex of the mark.
#[test]
fn a_step_is_steep_on_the_side_of_the_first_vertex() {
    for (mark, steep_left) in [("ring:44,45", true), ("ring:45,44", false)] {
        let mut mesh = sheet();
        apply(&mut mesh, &[mark], &["step"], &["width=0.5", "height=0.1"]);
        let section = section(&mesh);
        close(extremes(&section).1, 0.1);
        let (half, low) = (passes(&section, 0.08), passes(&section, 0.02));
        let (left, right) = (half[0] - low[0], low[1] - half[1]);
        assert_eq!(left < right, steep_left, "{mark}: {left} {right}");
        close(passes(&section, 0.05)[1] - passes(&section, 0.05)[0], 0.5);
    }
}

/// Marks named one by one, in directions that disagree, are one chain all the same.
#[test]
fn single_marks_of_a_chain_agree() {
    let mut column = sheet();
    apply(&mut column, &[COLUMN], &["step"], &["width=0.5", "height=0.1"]);
    let mut mixed = sheet();
    let marks: Vec<String> = (0..10)
        .map(|j| (10 * j + 4, 10 * j + 5))
        .map(|(a, b)| if a % 20 == 4 { format!("edge:{a},{b}") } else { format!("edge:{b},{a}") })
        .collect();
    let marks: Vec<&str> = marks.iter().map(String::as_str).collect();
    apply(&mut mixed, &marks, &["step"], &["width=0.5", "height=0.1"]);
    let (a, b) = (section(&column), section(&mixed));
    assert!(a.iter().zip(&b).all(|(p, q)| (p.0 - q.0).abs() < 1e-9 && (p.1 - q.1).abs() < 1e-9));
}

#[test]
fn a_dent_has_a_flat_floor_and_leaves_the_rest() {
    // Around the vertices (3..=5, 3..=5).
    let inside: Vec<String> = (3..=5).flat_map(|j| (3..=5).map(move |i| (10 * j + i).to_string())).collect();
    let mut mesh = sheet();
    let report =
        apply(&mut mesh, &[&format!("cut:{}", inside.join(","))], &["dent"], &["width=0.2", "depth=0.2"]);
    let points = limit(&mesh);
    let floor = points.iter().filter(|p| (p.x - 4.0).abs() < 0.9 && (p.y - 4.0).abs() < 0.9);
    for p in floor {
        close(p.z, -0.2);
    }
    let outside = points.iter().filter(|p| (p.x - 4.0).abs() > 2.2 || (p.y - 4.0).abs() > 2.2);
    assert!(outside.map(|p| p.z.abs()).fold(0.0, f64::max) < 1e-12);
    assert!(points.iter().all(|p| p.z > -0.2 * 1.001), "nothing lies deeper than asked");
    // The flank from a quarter to three quarters, along y = 4 through the middle.
    let mut row: Vec<(f64, f64)> =
        points.iter().filter(|p| (p.y - 4.0).abs() < 1e-6).map(|p| (p.x, p.z)).collect();
    row.sort_by(|a, b| a.0.total_cmp(&b.0));
    close(passes(&row, -0.15)[0] - passes(&row, -0.05)[0], 0.2);
    assert!(report.green.len() >= 9);
}

#[test]
fn an_open_loop_is_refused_with_its_ends() {
    let mut mesh = sheet();
    let before = mesh.to_polygons();
    let error = try_apply(&mut mesh, &["path:14,15:54,55"], &["dent"], &[]).expect_err("open");
    assert_eq!(
        error.to_string(),
        "dent needs a closed loop of marks; this one ends at the edges 14,15 and 54,55"
    );
    // From border to border it ends nowhere, and separates the sheet in two halves.
    assert!(try_apply(&mut mesh, &[COLUMN], &["dent"], &["depth=0.1"]).is_ok());
    assert_ne!(mesh.to_polygons(), before);
}

#[test]
fn loops_leave_a_flat_sheet_flat() {
    let mut mesh = sheet();
    let report = apply(&mut mesh, &[COLUMN], &["loop"], &["count=3"]);
    assert_eq!(report.after.vertices, 100 + 3 * 10);
    assert!(limit(&mesh).iter().all(|p| p.z.abs() < 1e-12));
    let spacing: Vec<f64> = mesh.positions()[100..103].iter().map(|p| p.x - 4.0).collect();
    for x in [0.25, 0.5, 0.75] {
        assert!(spacing.iter().any(|s| (s - x).abs() < 1e-9), "{spacing:?}");
    }
    let mut mesh = sheet();
    let marks: Vec<String> = (0..10).map(|j| format!("edge:{},{}@0.3", 10 * j + 4, 10 * j + 5)).collect();
    apply(&mut mesh, &marks.iter().map(String::as_str).collect::<Vec<_>>(), &["loop"], &[]);
    assert!((mesh.positions()[100].x - 4.3).abs() < 1e-9);
}

#[test]
fn marks_name_their_feature() {
    let mut mesh = sheet();
    let marks = ["ring:41,42", "ring:44,45#ridge", "ring:47,48#wide"];
    let set = ["width=0.3", "depth=0.1", "wide.width=0.5", "ridge.height=0.05"];
    let report = apply(&mut mesh, &marks, &["groove", "wide=groove"], &set);
    let section = section(&mesh);
    let part = |from: f64, to: f64| -> Vec<(f64, f64)> {
        section.iter().filter(|p| p.0 > from && p.0 < to).copied().collect()
    };
    for (from, to, level, width) in [(0.5, 3.0, -0.05, 0.3), (3.2, 5.8, 0.025, 0.3), (6.2, 8.8, -0.05, 0.5)] {
        let half = passes(&part(from, to), level);
        assert_eq!(half.len(), 2, "{half:?}");
        close(half[1] - half[0], width);
        let (low, high) = extremes(&part(from, to));
        close(if level < 0.0 { low } else { high }, 2.0 * level);
    }
    let kinds: Vec<&str> = report.features.iter().map(|f| f.kind.as_str()).collect();
    assert_eq!(kinds, ["groove", "wide", "ridge"]);

    let error = try_apply(&mut sheet(), &["ring:44,45#blue"], &["groove"], &[]).expect_err("no such kind");
    assert_eq!(error.to_string(), "edge 4,5 is marked #blue, and no feature has that name; there are groove");
}

#[test]
fn settings_that_make_no_sense_are_refused() {
    let cases = [
        (
            &["groove"][..],
            "height=1",
            "groove has no parameter 'height'; it has width, depth, paper_tees, taper",
        ),
        (&["groove"], "depth=-1", "it must not be less than 0"),
        (&["loop"], "count=1.5", "it is a whole number"),
        (&["loop"], "count=17", "it lies between 1 and 16"),
        (&["groove"], "blue.width=1", "there is no feature of kind 'blue'; there are groove"),
        (&["groove"], "piping.count=1", "piping has no parameter 'count'; it has width, height, depth"),
    ];
    for (features, setting, message) in cases {
        let error = Request::features(features, &[setting]).expect_err(setting).to_string();
        assert!(error.starts_with(&format!("setting '{setting}': ")) && error.ends_with(message), "{error}");
    }
    let twice = Request::features::<_, &str>(&["groove", "groove"], &[]).expect_err("twice").to_string();
    assert!(twice.contains("'groove' is given twice"), "{twice}");
    let none = Request::features::<_, &str>(&["grove"], &[]).expect_err("none").to_string();
    assert!(none.starts_with("there is no feature 'grove'; there are groove, ridge, piping"), "{none}");
}

const TWIN: &str = r#"
name = "twin"
help = "two crests"

[[parameter]]
name = "width"
default = "50%"
help = "full width at half height"

[[parameter]]
name = "height"
default = 0.1
help = "height of the crests"

[[line]]
across = -1.0

[[line]]
across = -0.5
height = { height = 1.0 }

[[line]]
across = 0.0
height = { height = 0.25 }

[[line]]
across = 0.5
height = { height = 1.0 }

[[line]]
across = 1.0
"#;

#[test]
fn a_profile_of_ones_own() {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("profiles");
    std::fs::create_dir_all(&folder).expect("a folder");
    let path = folder.join("twin.toml");
    std::fs::write(&path, TWIN).expect("written");
    let mut mesh = sheet();
    apply(&mut mesh, &[COLUMN], &[path.to_str().expect("UTF-8")], &["width=0.5"]);
    let section = section(&mesh);
    close(extremes(&section).1, 0.1);
    let half = passes(&section, 0.05);
    assert_eq!(half.len(), 4, "two crests: {half:?}");
    close(half[3] - half[0], 0.5);
}

#[test]
fn mistakes_in_profiles_name_file_and_line() {
    let cases = [
        ("across = 0.0", "across = -0.9", 21, "across is -0.9; lines are listed from one rim to the other"),
        ("across = 1.0", "across = 2.0", 32, "across is 2; it lies between -1"),
        ("{ height = 0.25 }", "{ heigth = 0.25 }", 24, "'heigth' is no parameter that can be a height"),
        ("{ height = 0.25 }", "{ height = 0.0 }", 24, "the factor of height is 0"),
        ("default = 0.1", "default = -0.1", 10, "default of height: it must not be less than 0"),
        ("default = \"50%\"", "default = \"half\"", 5, "'half' is not a length"),
        ("name = \"width\"", "name = \"wide\"", 2, "a profile with several lines declares a parameter width"),
        ("help = \"two crests\"", "hlep = \"two crests\"", 3, "unknown field"),
        ("across = 0.5", "across = ", 29, ""),
    ];
    assert!(Profile::parse("twin.toml", TWIN).is_ok());
    let absent = Profile::named("absent.toml").expect_err("no file").to_string();
    assert!(absent.starts_with("cannot read the profile file absent.toml: "), "{absent}");
    assert!(absent.contains("the folder profiles") && absent.contains("groove, ridge"), "{absent}");
    for (from, to, line, message) in cases {
        let error = Profile::parse("twin.toml", &TWIN.replacen(from, to, 1)).expect_err(to).to_string();
        println!("{error}");
        let (place, said) = error.split_at(error.find(": ").expect("a place"));
        let found: u32 = place.trim_start_matches("twin.toml:").parse().expect("a line");
        assert!(said.contains(message), "{error}");
        assert!(found.abs_diff(line) <= 2, "{error}: line {line} is meant");
    }
}
