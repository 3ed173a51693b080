//! The junctions that are measured: marks, bands and centre lines on a flat sheet of 7 x 7 cells, the junction in the
//! middle face.

#![allow(dead_code, reason = "not every program that shares this module uses all of it")]

use super::sheet::{Band, Line, Marked, SIDE, line, sideways, upwards};
use glam::{DVec2, DVec3};

pub const CENTRE: DVec2 = DVec2::new(3.5, 3.5);
pub const DEPTH: f64 = 0.1;

pub fn flat(x: f64, y: f64) -> DVec3 {
    DVec3::new(x, y, 0.0)
}

#[derive(Clone)]
pub struct Case {
    pub name: &'static str,
    pub bands: Vec<Band>,
    pub marks: Vec<Marked>,
    pub lines: Vec<Line>,
    /// Parameters of the rules.
    pub set: &'static [(&'static str, f64)],
}

pub fn cases(w: f64) -> Vec<Case> {
    let g = || vec![Band::groove(w, DEPTH), Band::parity()];
    let end = f64::from(SIDE) + 1.0;
    let bar = || line([-1.0, 3.5], [end, 3.5], 0);
    let stem = |band| line([3.5, -1.0], [3.5, 3.5], band);
    let t = [upwards(3, 0..=3, 0), sideways(3, 0..=7, 0)].concat();
    vec![
        Case { name: "straight", bands: g(), marks: sideways(3, 0..=7, 0), lines: vec![bar()], set: &[] },
        Case {
            name: "corner",
            bands: g(),
            marks: [upwards(3, 0..=3, 0), sideways(3, 4..=7, 0)].concat(),
            lines: vec![stem(0), line([3.5, 3.5], [end, 3.5], 0)],
            set: &[],
        },
        Case {
            name: "crossing",
            bands: g(),
            marks: [upwards(3, 0..=7, 0), sideways(3, 0..=7, 0)].concat(),
            lines: vec![bar(), line([3.5, -1.0], [3.5, end], 0)],
            set: &[],
        },
        Case { name: "T-DE", bands: g(), marks: t.clone(), lines: vec![bar(), stem(0)], set: &[] },
        Case {
            name: "T-D",
            bands: g(),
            marks: [t.clone(), upwards(3, 4..=7, 1)].concat(),
            lines: vec![bar(), stem(0)],
            set: &[],
        },
        Case {
            name: "T-B",
            bands: g(),
            marks: [t.clone(), upwards(3, 4..=7, 1)].concat(),
            lines: vec![bar(), stem(0)],
            set: &[("paper_tees", 1.0)],
        },
        Case {
            name: "T-6",
            bands: g(),
            marks: t.clone(),
            lines: vec![bar(), stem(0)],
            set: &[("paper_tees", 1.0)],
        },
        Case {
            name: "T, stem of four lines",
            bands: vec![Band::groove(w, DEPTH), Band::channel(w, DEPTH)],
            marks: [upwards(3, 0..=3, 1), sideways(3, 0..=7, 0)].concat(),
            lines: vec![bar(), stem(1)],
            set: &[],
        },
        Case {
            name: "DE3W",
            bands: g(),
            marks: upwards(3, 0..=3, 0),
            lines: vec![line([3.5, -1.0], [3.5, 3.5 - w - 0.08], 0)],
            set: &[],
        },
        Case {
            name: "DE3V",
            bands: g(),
            marks: [upwards(3, 0..=3, 0), upwards(3, 4..=7, 1)].concat(),
            lines: vec![line([3.5, -1.0], [3.5, 3.5 - w - 0.08], 0)],
            set: &[],
        },
        Case {
            name: "DE4",
            bands: vec![Band::channel(w, DEPTH)],
            marks: upwards(3, 0..=3, 0),
            lines: vec![line([3.5, -1.0], [3.5, 3.5 - w - 0.04], 0)],
            set: &[],
        },
    ]
}

/// A piping with something across or into it, all 0.05 deep or high.
pub fn piped_cases() -> Vec<Case> {
    const D: f64 = 0.05;
    let end = f64::from(SIDE) + 1.0;
    let bands = || {
        let stem = Band { kind: "second", ..Band::piping(0.24, D) };
        vec![Band::piping(0.24, D), Band::groove(0.15, D), Band::parity(), stem]
    };
    let bar = || line([-1.0, 3.5], [end, 3.5], 0);
    // What meets a piping ends at its rim.
    let stem = |band| line([3.5, -1.0], [3.5, 3.5 - 0.24], band);
    let whole = |band| vec![stem(band), line([3.5, 3.5 + 0.24], [3.5, end], band)];
    let along = sideways(3, 0..=7, 0);
    let case = |name, across: Vec<Marked>, lines: Vec<Line>| Case {
        name,
        bands: bands(),
        marks: [along.clone(), across].concat(),
        lines: [vec![bar()], lines].concat(),
        set: &[],
    };
    vec![
        case("piping alone", vec![], vec![]),
        case("seam across piping", upwards(3, 0..=7, 1), whole(1)),
        case("seam into piping", upwards(3, 0..=3, 1), vec![stem(1)]),
        case(
            "seam into piping, all quads",
            [upwards(3, 0..=3, 1), upwards(3, 4..=7, 2)].concat(),
            vec![stem(1)],
        ),
        case("piping across piping", upwards(3, 0..=7, 3), whole(3)),
        case("piping into piping", upwards(3, 0..=3, 3), vec![stem(3)]),
        Case {
            name: "piping into seam",
            bands: bands(),
            marks: [sideways(3, 0..=7, 1), upwards(3, 0..=3, 0)].concat(),
            lines: vec![line([-1.0, 3.5], [end, 3.5], 1), stem(0)],
            set: &[],
        },
        Case {
            name: "piping ends",
            bands: bands(),
            marks: upwards(3, 0..=3, 0),
            lines: vec![stem(0)],
            set: &[],
        },
        Case {
            name: "piping corner",
            bands: bands(),
            marks: [upwards(3, 0..=3, 0), sideways(3, 4..=7, 0)].concat(),
            lines: vec![stem(0), line([3.5, 3.5], [end, 3.5], 0)],
            set: &[],
        },
    ]
}
