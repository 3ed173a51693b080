//! What a report warns of, on shapes where the limits are known.

use glam::DVec3;
use std::f64::consts::TAU;
use welt::feature::{self, Options, Report, Request, Warning};
use welt::job::Job;
use welt::mark::{Selection, Selector};
use welt::mesh::{Mesh, Polygons};

const AROUND: u32 = 16;
const ROWS: u32 = 8;

/// An open tube round the z axis: vertex (i, j) is number 16 j + i. Its limit radius is a little below 1.
fn tube() -> Mesh {
    let mut polygons = Polygons::default();
    for (i, j) in (0..=ROWS).flat_map(|j| (0..AROUND).map(move |i| (i, j))) {
        let angle = TAU * f64::from(i) / f64::from(AROUND);
        polygons.positions.push(DVec3::new(angle.cos(), angle.sin(), 0.4 * f64::from(j)));
    }
    for (i, j) in (0..ROWS).flat_map(|j| (0..AROUND).map(move |i| (i, j))) {
        let next = (i + 1) % AROUND;
        polygons.face_sizes.push(4);
        polygons.face_vertices.extend([
            AROUND * j + i,
            AROUND * j + next,
            AROUND * (j + 1) + next,
            AROUND * (j + 1) + i,
        ]);
    }
    Mesh::from_polygons(&polygons).expect("a tube")
}

fn groove(mark: &str, depth: f64, samples: usize) -> Report {
    let mut mesh = tube();
    let selection = Selection::resolve(&mesh, &[Selector::parse(mark).expect("a selector")]).expect("marks");
    let request =
        Request::features(&["groove"], &["width=30%", &format!("depth={depth}")]).expect("a request");
    let options = Options { samples, ..Options::default() };
    feature::apply(&mut mesh, &selection, &request, &options, &Job::new()).expect("applied")
}

/// The ring round the tube between rows 4 and 5.
const ROUND: &str = "ring:64,80";
/// One edge along the tube.
const LOCAL: &str = "edge:64,80";

#[test]
fn a_shallow_groove_warns_of_nothing() {
    assert_eq!(groove(ROUND, 0.1, 4).warnings, []);
}

#[test]
fn a_groove_past_the_axis_folds() {
    // The sections turn over once they are pushed through the axis, at a depth of about 1.
    let fold = |report: Report| report.warnings.into_iter().any(|w| matches!(w, Warning::Fold { .. }));
    assert!(!fold(groove(ROUND, 0.5, 0)));
    assert!(fold(groove(ROUND, 1.4, 0)));
}

#[test]
fn a_groove_deeper_than_the_tube_is_wide_meets_the_other_wall() {
    let wall = |report: &Report| {
        report.warnings.iter().find_map(|w| match w {
            Warning::Wall { thickness, depth, .. } => Some((*thickness, *depth)),
            Warning::Fold { .. } => None,
        })
    };
    for mark in [ROUND, LOCAL] {
        let report = groove(mark, 3.0, 4);
        let (thickness, depth) = wall(&report).unwrap_or_else(|| panic!("{mark}: no warning: {report}"));
        // The opposite wall is two limit radii away.
        assert!(thickness > 1.9 && thickness < 2.0, "{mark}: {thickness}");
        assert!((depth - 3.0).abs() < 1e-12, "{mark}: {depth}");
        assert!(report.to_string().contains("exceeds the wall"));
    }
    assert_eq!(wall(&groove(ROUND, 0.5, 4)), None);
}

#[test]
fn what_was_not_measured_is_said() {
    let report = groove(LOCAL, 0.1, 0);
    assert_eq!(report.dimension("width").map(|d| d.stations), Some(0));
    assert!(report.to_string().contains("width: asked 30%, not measured: no straight stretch"), "{report}");
}
