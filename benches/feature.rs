//! A whole groove: round a ring of 200 quads in meshes of 10 thousand to a million, on a chair, and 1,000 marks at once.
//!
//! `cargo bench --bench feature`. Medians over freshly built meshes; building and reading are not counted.

use glam::DVec3;
use std::f64::consts::TAU;
use std::path::Path;
use std::time::Instant;
use welt::feature::{self, Options, Report, Request};
use welt::job::Job;
use welt::mark::{Selection, Selector};
use welt::mesh::{Mesh, Polygons};
use welt::optimise::Method;

const RUNS: usize = 9;

/// A torus of `n` quads round the tube times `m` round the axis.
fn torus(n: u32, m: u32) -> Polygons {
    let point = |i: u32, j: u32| {
        let (u, v) = (TAU * f64::from(i) / f64::from(n), TAU * f64::from(j) / f64::from(m));
        let r = 4.0 + u.cos();
        DVec3::new(r * v.cos(), r * v.sin(), u.sin())
    };
    let at = |i: u32, j: u32| (j % m) * n + i % n;
    let mut polygons = Polygons::default();
    for (i, j) in (0..m).flat_map(|j| (0..n).map(move |i| (i, j))) {
        polygons.positions.push(point(i, j));
        polygons.face_sizes.push(4);
        polygons.face_vertices.extend([at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)]);
    }
    polygons
}

fn measure(name: &str, method: Method, polygons: &Polygons, marks: &[String]) {
    let request = Request::features(&["groove"], &["width=30%", "depth=10%"]).expect("a request");
    let options = Options { method, ..Options::default() };
    let mut runs: Vec<(f64, Report)> = (0..RUNS)
        .map(|_| {
            let mut mesh = Mesh::from_polygons(polygons).expect("a mesh");
            let start = Instant::now();
            let selectors: Vec<Selector> =
                marks.iter().map(|mark| Selector::parse(mark).expect("a selector")).collect();
            let selection = Selection::resolve(&mesh, &selectors).expect("marks");
            let report =
                feature::apply(&mut mesh, &selection, &request, &options, &Job::new()).expect("applied");
            (start.elapsed().as_secs_f64() * 1e3, report)
        })
        .collect();
    runs.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (milliseconds, report) = &runs[RUNS / 2];
    let stages: Vec<String> = report.times.iter().map(|(stage, ms)| format!("{stage} {ms:.2}")).collect();
    println!(
        "{name:<30}{:<10}{:>6} marks {milliseconds:>9.2} ms   ({})",
        method.name(),
        report.marks,
        stages.join(", ")
    );
}

fn main() {
    let models = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/models");
    let methods = [Method::None, Method::Solve, Method::FitSlide];
    for (name, ring) in [("mid_century_chair", "ring:240,262"), ("leaf_chair", "ring:3,331")] {
        let file = models.join(name).with_extension("obj");
        let chair = welt::io::import(&file, &welt::io::ImportOptions::default()).expect("the chair").mesh;
        let name = format!("chair of {} faces", chair.face_bound());
        for method in methods {
            measure(&name, method, &chair.to_polygons(), &[ring.into()]);
        }
    }
    for m in [50, 500, 5000] {
        let name = format!("torus of {} faces", 200 * m);
        for method in methods {
            measure(&name, method, &torus(200, m), &["ring:0,200".into()]);
        }
    }
    // 1,000 marks: five rings; then a hundred bands of ten that end in the open, so that 200 faces are odd.
    let rings: Vec<String> = (0..5).map(|j| format!("ring:{},{}", 2000 * j, 2000 * j + 200)).collect();
    let bands: Vec<String> = (0..1000)
        .map(|i| (i % 10 + 20 * (i / 10 % 10), 5 * (i / 100)))
        .map(|(i, j)| format!("edge:{},{}", 200 * j + i, 200 * (j + 1) + i))
        .collect();
    for m in [50, 5000] {
        let polygons = torus(200, m);
        measure(&format!("five rings in {} faces", 200 * m), Method::FitSlide, &polygons, &rings);
        measure(&format!("100 bands in {} faces", 200 * m), Method::FitSlide, &polygons, &bands);
    }
}
