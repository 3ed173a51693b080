//! Grooves of depth 0 on real cages: how far each method leaves the limit surface from what it was. Prints the tables of
//! docs/optimisation.md.
//!
//!     cargo run --release --example insertion -- [rings|crossings|tees|widths]... [every=N] [faces=N] [cages=FOLDER,...]
//!         [methods=NAME,...] [samples=N] [list]
//!
//! reads `../shared/data` (or `data=FOLDER`); `every=N` takes every Nth case, `faces=N` cages of at most N faces, `methods` are
//! compared with `none`, surfaces at `samples` x `samples` places per face (8, as reports do), and `list` prints every case too.

#[allow(dead_code, reason = "shared with the tests")]
#[path = "../tests/common/mod.rs"]
mod common;
use common::rings;

use rings::{Marked, crossing, crossing_pairs, rings as rings_of, tees};
use std::path::PathBuf;
use welt::feature::{self, Options, Report, Request};
use welt::job::Job;
use welt::mesh::Mesh;
use welt::optimise::Method;

const FOLDERS: &str = "upholstery,product,organic,classic,mechanical";
/// Where an insertion moves the surface by less than this part of an edge in rms, nothing is to be gained.
const FLAT: f64 = 1e-3;

fn groove(mesh: &Mesh, marked: &Marked, depth: &str, method: Method, samples: usize) -> Option<Report> {
    let request = Request::features(&["groove"], &["width=30%", &format!("depth={depth}")]).ok()?;
    let options = Options { method, samples, ..Options::default() };
    feature::apply(&mut mesh.clone(), &marked.selection, &request, &options, &Job::new()).ok()
}

/// What one method did in one case: lengths in edges.
#[derive(Clone, Copy)]
struct Figures {
    max: f64,
    rms: f64,
    p95: f64,
    degrees: f64,
    bend_max: f64,
    bend: f64,
    milliseconds: f64,
    held: f64,
}

impl Figures {
    fn of(report: &Report, edge: f64) -> Option<Self> {
        let d = report.fitted.as_ref()?.total;
        Some(Self {
            max: d.max / edge,
            rms: d.rms / edge,
            p95: d.p95 / edge,
            degrees: d.normal,
            bend_max: d.curvature_max * edge,
            bend: d.curvature_rms * edge,
            milliseconds: report.times.iter().filter(|lap| lap.0 == "fit").map(|lap| lap.1).sum(),
            held: report.fit.held as f64 / report.fit.active.max(1) as f64,
        })
    }
}

fn quantile(mut values: Vec<f64>, q: f64) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(((values.len().max(1) - 1) as f64 * q).round() as usize).copied().unwrap_or(f64::NAN)
}

/// One row per method: medians, in brackets the tenth that is worst.
fn table(title: &str, methods: &[Method], cases: &[Vec<Figures>]) {
    println!("\n{title}: {} cases\n", cases.len());
    println!(
        "| method | max | rms | 95 % | closer in max | closer in rms | degrees | curvature, rms | curvature, max | curvature worse | held | ms | least |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|---|---|---|");
    for (k, method) in methods.iter().enumerate() {
        let all = |figure: &dyn Fn(&Figures, &Figures) -> f64| -> Vec<f64> {
            cases.iter().map(|case| figure(&case[k], &case[0])).collect()
        };
        let percent =
            |figure: fn(&Figures) -> f64| format!("{:.3}", 100.0 * quantile(all(&|own, _| figure(own)), 0.5));
        let pair = |values: Vec<f64>, worst: f64| {
            format!("{:.2} ({:.2})", quantile(values.clone(), 0.5), quantile(values, worst))
        };
        let bends = all(&|own, none| own.bend / none.bend);
        let worse = bends.iter().filter(|&&ratio| ratio > 1.0).count() as f64 / bends.len().max(1) as f64;
        println!(
            "| {} | {} | {} | {} | {} | {} | {} | {} | {} | {:.1} % (up to {:.2}) | {:.1} % | {} | {:.2} |",
            method.name(),
            percent(|f| f.max),
            percent(|f| f.rms),
            percent(|f| f.p95),
            pair(all(&|own, none| none.max / own.max), 0.1),
            pair(all(&|own, none| none.rms / own.rms), 0.1),
            pair(all(&|own, _| own.degrees), 0.9),
            pair(bends.clone(), 0.9),
            pair(all(&|own, none| own.bend_max / none.bend_max), 0.9),
            100.0 * worse,
            quantile(bends, 1.0),
            100.0 * all(&|own, _| own.held).iter().sum::<f64>() / cases.len().max(1) as f64,
            pair(all(&|own, _| own.milliseconds), 0.9),
            quantile(all(&|own, none| none.rms / own.rms), 0.0),
        );
    }
}

/// Depth 0 with every method.
fn insertions(
    title: &str,
    methods: &[Method],
    cases: impl Iterator<Item = (String, Mesh, Marked)>,
    samples: usize,
    list: bool,
) {
    let mut figures = Vec::new();
    for (name, mesh, marked) in cases {
        let insert = |method| Figures::of(&groove(&mesh, &marked, "0", method, samples)?, marked.edge);
        let Some(none) = insert(Method::None).filter(|none| none.rms > FLAT) else { continue };
        let others = methods.iter().filter(|&&method| method != Method::None).map(|&method| insert(method));
        let Some(of_case) = std::iter::once(Some(none)).chain(others).collect::<Option<Vec<Figures>>>()
        else {
            continue;
        };
        if list {
            let mark = &marked.selection.marks[0];
            print!("{name} {title} {} {:?}", marked.selection.marks.len(), mark.half_edge);
            for own in &of_case {
                print!(" | {:.6} {:.6} {:.5} {:.3}", own.max, own.rms, own.bend, own.held);
            }
            println!();
        }
        figures.push(of_case);
    }
    table(title, methods, &figures);
}

/// Grooves of a tenth of an edge: widths and depths reached over asked, and time.
fn widths(methods: &[Method], cases: impl Iterator<Item = (String, Mesh, Marked)>) {
    let cases: Vec<_> = cases.collect();
    println!(
        "\nwidth 30 %, depth 10 %: reached over asked in the mean of the worst places, places off by more than 3 %\n"
    );
    println!("| method | width, 1 % | 10 % | 50 % | 90 % | 99 % | off | depth off | corrections | fit, ms |");
    println!("|---|---|---|---|---|---|---|---|---|---|");
    for &method in methods {
        let (mut worst, mut times, mut corrections) = (Vec::new(), Vec::new(), 0);
        let (mut places, mut off, mut depth_off) = (0, 0, 0);
        for (_, mesh, marked) in &cases {
            let Some(report) = groove(mesh, marked, "10%", method, 0) else { continue };
            corrections += report.corrections;
            times.push(report.times.iter().filter(|lap| lap.0 == "fit").map(|lap| lap.1).sum());
            if let Some(width) = report.dimension("width") {
                worst.extend(
                    [width.worst_low, width.worst_high].into_iter().filter(|ratio| ratio.is_finite()),
                );
                places += width.stations;
                off += width.off.len();
            }
            depth_off += report.dimension("depth").map_or(0, |depth| depth.off.len());
        }
        let of = |count: usize| format!("{:.2} %", 100.0 * count as f64 / places.max(1) as f64);
        let [a, b, c, d, e] = [0.01, 0.1, 0.5, 0.9, 0.99].map(|q| quantile(worst.clone(), q));
        println!(
            "| {} | {a:.3} | {b:.3} | {c:.4} | {d:.3} | {e:.3} | {} | {} | {:.2} | {:.2} |",
            method.name(),
            of(off),
            of(depth_off),
            f64::from(corrections) / cases.len().max(1) as f64,
            quantile(times, 0.5)
        );
    }
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let value = |name: &str| arguments.iter().find_map(|a| a.strip_prefix(name)?.strip_prefix('='));
    let wanted = |name: &str| arguments.iter().any(|a| a == name);
    let kinds = ["rings", "crossings", "tees", "widths"];
    let all = !kinds.iter().any(|kind| wanted(kind));
    let number = |name| value(name).and_then(|n| n.parse().ok()).filter(|n| *n > 0);
    let (step, samples) = (number("every").unwrap_or(1), number("samples").unwrap_or(8));
    let Some(data) = value("data").map(PathBuf::from).or_else(common::shared_data) else { return };
    let faces = number("faces").unwrap_or(usize::MAX);
    let methods: Vec<Method> = match value("methods") {
        Some(names) => std::iter::once("none")
            .chain(names.split(',').filter(|name| *name != "none"))
            .filter_map(Method::from_name)
            .collect(),
        None => Method::ALL.map(|entry| entry.1).to_vec(),
    };
    let cages: Vec<(String, Mesh)> = value("cages")
        .unwrap_or(FOLDERS)
        .split(',')
        .flat_map(|folder| common::clean_cages(&data, folder))
        .filter(|(_, mesh)| mesh.counts()[2] <= faces)
        .collect();
    for kind in kinds.into_iter().filter(|kind| all || wanted(kind)) {
        let of_cage = |(name, mesh): &(String, Mesh)| {
            let rings = rings_of(mesh);
            let pairs = crossing_pairs(mesh, &rings);
            let pair = |[a, b]: [usize; 2]| [&rings[a], &rings[b]];
            let marks: Vec<Marked> = match kind {
                "crossings" => pairs.into_iter().map(|p| crossing(mesh, pair(p))).collect(),
                "tees" => pairs.into_iter().filter_map(|p| tees(mesh, pair(p))).collect(),
                _ => rings,
            };
            let with_mesh = |marked| (name.clone(), mesh.clone(), marked);
            marks.into_iter().map(with_mesh).collect::<Vec<_>>()
        };
        let cases = cages.iter().flat_map(of_cage).step_by(step);
        match kind {
            "widths" => widths(&methods, cases),
            _ => insertions(kind, &methods, cases, samples, wanted("list")),
        }
    }
}
