//! Grooves round every ring of the real cages: valid, sparse, deterministic, true to size; and at depth 0, how much
//! closer the fit brings the surface to what it was.

use crate::common;
use crate::common::rings;

use rings::{Marked, crossing, crossing_pairs, rings, tees};
use welt::feature::{self, Options, Report, Request};
use welt::job::Job;
use welt::mark::{Mark, Selection};
use welt::mesh::{HalfEdgeId, Mesh, Polygons, VertexId};
use welt::optimise::Method;

fn request(depth: &str) -> Request {
    Request::features(&["groove"], &["width=30%", &format!("depth={depth}")]).expect("a request")
}

fn groove(mesh: &mut Mesh, ring: &Marked, request: &Request, method: Method, deviation: bool) -> Report {
    let options = Options { method, samples: if deviation { 3 } else { 0 }, ..Options::default() };
    feature::apply(mesh, &ring.selection, request, &options, &Job::new()).expect("a ring takes a groove")
}

/// Chairs whose edges change their lengths slowly: the width holds to 3 % at all but 3 % of the places. On the others
/// some edges are too short for 30 % of their control length on the limit surface; the report lists them.
const EVEN_CHAIRS: [&str; 4] =
    ["bs0_chair_cage.obj", "bs0_couch2.obj", "bsby_leaf_chair_cage.obj", "kl_mid-century-chair_cage.obj"];

fn non_quads(mesh: &Mesh) -> usize {
    mesh.faces().filter(|&f| mesh.arity(f) != 4).count()
}

fn quantile(sorted: &[f64], q: f64) -> f64 {
    sorted[((sorted.len() - 1) as f64 * q).round() as usize]
}

/// Every how many rings are taken: as the environment says.
fn ring_step(otherwise: usize) -> usize {
    let wanted = std::env::var("WELT_RING_STEP").ok().and_then(|step| step.parse().ok());
    wanted.filter(|step| *step > 0).unwrap_or(otherwise)
}

#[test]
fn every_ring_takes_a_groove() {
    let Some(data) = common::shared_data() else { return };
    // All 1,735 rings with WELT_RING_STEP=1.
    let thinned = ring_step(4);
    let request = request("10%");
    let (mut count, mut narrow, mut shallow) = (0, Vec::new(), Vec::new());
    let (mut places, mut off) = (0, 0);
    for folder in ["upholstery", "product"] {
        for (name, mesh) in common::clean_cages(&data, folder) {
            let (places_before, off_before) = (places, off);
            let is_even = EVEN_CHAIRS.contains(&name.as_str());
            for ring in rings(&mesh).into_iter().step_by(if is_even { 1 } else { thinned }) {
                let mut result = mesh.clone();
                let report = groove(&mut result, &ring, &request, Method::Solve, false);
                let marks = ring.selection.marks.len();
                result.validate_control_mesh().unwrap_or_else(|e| panic!("{name}: {e}"));
                assert!(report.leftovers.is_empty(), "{name}: {report}");
                assert_eq!(result.vertex_bound(), mesh.vertex_bound() + 3 * marks, "{name}");
                assert_eq!(non_quads(&result), non_quads(&mesh), "{name}");
                let mut again = mesh.clone();
                groove(&mut again, &ring, &request, Method::Solve, false);
                assert_eq!(again.to_polygons(), result.to_polygons(), "{name}: two runs differ");
                narrow.extend(report.dimension("width").iter().flat_map(|d| [d.worst_low, d.worst_high]));
                shallow.extend(report.dimension("depth").iter().flat_map(|d| [d.worst_low, d.worst_high]));
                count += 1;
                places += report.dimension("width").map_or(0, |d| d.stations);
                off += report.dimension("width").map_or(0, |d| d.off.len());
            }
            let (off_here, places_here) = (off - off_before, places - places_before);
            println!("{name}: width off by more than 3 % at {off_here} of {places_here} places");
            if is_even {
                assert!(33 * off_here < places_here, "{name}: {off_here} of {places_here} places are off");
            }
        }
    }
    println!("width off by more than 3 % at {off} of {places} places");
    for (name, mut ratios) in [("width", narrow), ("depth", shallow)] {
        ratios.sort_by(f64::total_cmp);
        println!(
            "{name} reached over asked, worst places of {count} rings: least {:.3}, 1 % {:.3}, 10 % {:.4}, median {:.4}, 90 % {:.4}, 99 % {:.3}, greatest {:.3}",
            ratios[0],
            quantile(&ratios, 0.01),
            quantile(&ratios, 0.1),
            quantile(&ratios, 0.5),
            quantile(&ratios, 0.9),
            quantile(&ratios, 0.99),
            ratios[ratios.len() - 1]
        );
        assert!((quantile(&ratios, 0.5) - 1.0).abs() < 0.03);
    }
    assert!(10 * off < places, "{off} of {places} places are off");
    assert!(count > 100, "only {count} rings");
}

/// One method against `none` over rings: by how much it is closer, and what it does to normals and curvature.
struct Row {
    method: Method,
    /// Deviations of `none` over those of the method, max and rms.
    closer: [Vec<f64>; 2],
    /// Of the method, in edge lengths: max, rms, 95 %; degrees.
    deviation: [Vec<f64>; 4],
    /// Change of mean curvature over that of `none`, in rms.
    curvature: Vec<f64>,
    /// Milliseconds of the fit.
    time: Vec<f64>,
}

/// Every `step`-th ring whose surface an insertion without a fit moves by more than a thousandth of an edge in rms.
fn depth_zero(data: &std::path::Path, methods: &[Method], step: usize) -> Vec<Row> {
    let request = request("0");
    let empty = |&method| Row {
        method,
        closer: Default::default(),
        deviation: Default::default(),
        curvature: Vec::new(),
        time: Vec::new(),
    };
    let mut rows: Vec<Row> = methods.iter().map(empty).collect();
    let cages = ["upholstery", "product"].into_iter().flat_map(|folder| common::clean_cages(data, folder));
    let rings = cages.flat_map(|(name, mesh)| {
        rings(&mesh).into_iter().map(|ring| (name.clone(), mesh.clone(), ring)).collect::<Vec<_>>()
    });
    for (name, mesh, ring) in rings.step_by(step) {
        let insert = |method| {
            let report = groove(&mut mesh.clone(), &ring, &request, method, true);
            let time = report.times.iter().filter(|lap| lap.0 == "fit").map(|lap| lap.1).sum::<f64>();
            (report.fitted.unwrap_or_else(|| panic!("{name}: no deviation")).total, time)
        };
        let (none, _) = insert(Method::None);
        if none.rms <= 1e-3 * ring.edge {
            continue;
        }
        for row in &mut rows {
            let (d, time) = insert(row.method);
            row.closer[0].push(none.max / d.max);
            row.closer[1].push(none.rms / d.rms);
            let lengths = [d.max, d.rms, d.p95].map(|length| length / ring.edge);
            row.deviation
                .iter_mut()
                .zip(lengths.into_iter().chain([d.normal]))
                .for_each(|(all, x)| all.push(x));
            row.curvature.push(d.curvature_rms / none.curvature_rms);
            row.time.push(time);
            if d.rms > none.rms {
                println!(
                    "{name}, ring of {:?}: {} is {:.2} times as far off as none",
                    ring.selection.marks[0].half_edge,
                    row.method.name(),
                    d.rms / none.rms
                );
            }
        }
    }
    rows.iter_mut().for_each(Row::finish);
    rows
}

impl Row {
    fn finish(&mut self) {
        let all =
            self.closer.iter_mut().chain(&mut self.deviation).chain([&mut self.curvature, &mut self.time]);
        all.for_each(|values| values.sort_by(f64::total_cmp));
    }

    /// Medians, and the tenth that is worst in brackets.
    fn print(&self) {
        let [max, rms, p95, normal] = &self.deviation;
        let pair = |values: &[f64], worst: f64| {
            format!("{:.2} ({:.2})", quantile(values, 0.5), quantile(values, worst))
        };
        let percent = |values: &[f64]| format!("{:.3}", 100.0 * quantile(values, 0.5));
        println!(
            "| {} | {} | {} | {} | {} | {} | {} | {} | {} | {:.2} |",
            self.method.name(),
            percent(max),
            percent(rms),
            percent(p95),
            pair(&self.closer[0], 0.1),
            pair(&self.closer[1], 0.1),
            pair(normal, 0.9),
            pair(&self.curvature, 0.9),
            pair(&self.time, 0.9),
            self.closer[1][0],
        );
    }
}

/// How much more a surface may be curved than without a fit, in rms: feet of the report and of the fit differ by rounding.
const BENT: f64 = 1e-3;

#[test]
fn depth_zero_leaves_the_surface_where_it_was() {
    let Some(data) = common::shared_data() else { return };
    let rows = depth_zero(&data, &[Method::Solve, Method::Fit, Method::FitSlide], 40);
    rows.iter().for_each(Row::print);
    // Medians over all rings: docs/optimisation.md.
    for (row, [max, rms]) in rows.iter().zip([[2.5, 3.3], [2.5, 3.3], [13.0, 15.0]]) {
        let [found_max, found_rms] = [0, 1].map(|i| quantile(&row.closer[i], 0.5));
        assert!(found_max > max && found_rms > rms, "{}: {found_max} {found_rms}", row.method.name());
        assert!(quantile(&row.curvature, 0.5) < 1.0, "{}", row.method.name());
        assert!(row.closer[1][0] > 0.85, "{}: {}", row.method.name(), row.closer[1][0]);
    }
    let most_bent = rows[2].curvature.iter().copied().fold(0.0, f64::max);
    assert!(most_bent <= 1.0 + BENT, "the default makes ripples: {most_bent}");
}

/// Where rings cross and where bands end in T-junctions, `fit+slide` ends no further from the surface than an
/// insertion without a fit.
#[test]
fn junctions_of_depth_zero_are_no_worse_than_without_a_fit() {
    let Some(data) = common::shared_data() else { return };
    let request = request("0");
    let mut closer = Vec::new();
    for (name, mesh) in common::clean_cages(&data, "product").into_iter().step_by(4) {
        let rings = rings(&mesh);
        for pair in crossing_pairs(&mesh, &rings).into_iter().step_by(24) {
            let pair = pair.map(|number| &rings[number]);
            for marked in [Some(crossing(&mesh, pair)), tees(&mesh, pair)].into_iter().flatten() {
                let insert = |method| {
                    let report = groove(&mut mesh.clone(), &marked, &request, method, true);
                    report.fitted.unwrap_or_else(|| panic!("{name}: no deviation")).total
                };
                let (none, fitted) = (insert(Method::None), insert(Method::FitSlide));
                if none.rms > 1e-3 * marked.edge {
                    println!("{name}: {:.3e} {:.3e}", none.rms, fitted.rms);
                    assert!(fitted.rms < 1.05 * none.rms, "{name}: {} {}", fitted.rms, none.rms);
                    let bent = fitted.curvature_rms / none.curvature_rms;
                    assert!(bent <= 1.0 + BENT, "{name}: ripples, {bent}");
                    closer.push(none.rms / fitted.rms);
                }
            }
        }
    }
    closer.sort_by(f64::total_cmp);
    assert!(quantile(&closer, 0.5) > 3.0, "{closer:?}");
}

/// Where the samples of a fit miss what it bends: without the last word (src/optimise/judge.rs) the ring is 11 % more curved
/// than without a fit, and the crossing 25 %.
#[test]
fn the_last_word_takes_back_what_bends() {
    let Some(data) = common::shared_data() else { return };
    let mesh = common::load(&data.join("product/bs0_slippers_cage.obj"));
    let rings = rings(&mesh);
    let first = |marked: &Marked| marked.selection.marks[0].half_edge;
    let ring = rings.iter().position(|ring| first(ring) == HalfEdgeId(794)).expect("the ring");
    let crossing = crossing_pairs(&mesh, &rings)
        .into_iter()
        .map(|pair| crossing(&mesh, pair.map(|number| &rings[number])))
        .find(|marked| first(marked) == HalfEdgeId(778))
        .expect("the crossing");
    let request = request("0");
    for marked in [&rings[ring], &crossing] {
        let bend = |method| {
            let options = Options { method, samples: 8, ..Options::default() };
            let mut mesh = mesh.clone();
            let report = feature::apply(&mut mesh, &marked.selection, &request, &options, &Job::new());
            report.expect("a groove").fitted.expect("a deviation").total.curvature_rms
        };
        let (none, fitted) = (bend(Method::None), bend(Method::FitSlide));
        assert!(fitted <= none, "{fitted} {none}");
    }
}

/// The same mesh with vertices, faces and corners in the opposite order (but the same orientation).
fn renumbered(mesh: &Mesh) -> Mesh {
    let polygons = mesh.to_polygons();
    let last = polygons.positions.len() as u32 - 1;
    let mut rest = polygons.face_vertices.as_slice();
    let mut faces: Vec<Vec<u32>> = Vec::new();
    for &size in &polygons.face_sizes {
        let (face, others) = rest.split_at(size as usize);
        faces.push(face.iter().cycle().skip(1).take(face.len()).map(|&v| last - v).collect());
        rest = others;
    }
    let faces: Vec<&[u32]> = faces.iter().rev().map(Vec::as_slice).collect();
    let positions = polygons.positions.iter().rev().copied().collect();
    Mesh::from_polygons(&Polygons::new(positions, &faces)).expect("the same mesh")
}

/// Also beside folds, where vertices are held.
#[test]
fn fits_do_not_depend_on_the_numbering() {
    let Some(data) = common::shared_data() else { return };
    let request = request("0");
    let mesh = common::load(&data.join("upholstery/bs0_chair2.obj"));
    let other = renumbered(&mesh);
    let last = mesh.vertex_bound() as u32 - 1;
    let mut held = 0;
    for ring in rings(&mesh).into_iter().step_by(11) {
        let edge = |h| (last - mesh.source(h).0, last - mesh.target(h).0);
        let marks = ring.selection.marks.iter().map(|mark| {
            let (a, b) = edge(mark.half_edge);
            let half_edge = other.find_half_edge(VertexId(a), VertexId(b)).expect("the same edge");
            Mark { half_edge, ..mark.clone() }
        });
        let selection = Selection { marks: marks.collect(), ..Selection::default() };
        let other_ring = Marked { selection, edge: ring.edge };
        for method in [Method::Solve, Method::FitSlide] {
            let (mut first, mut second) = (mesh.clone(), other.clone());
            held += groove(&mut first, &ring, &request, method, false).fit.held;
            groove(&mut second, &other_ring, &request, method, false);
            for v in mesh.vertices() {
                let apart = first.position(v).distance(second.position(VertexId(last - v.0)));
                assert!(apart < 1e-6 * ring.edge, "{method:?}, vertex {}: {}", v.0, apart / ring.edge);
            }
        }
    }
    println!("{held} vertices were held");
    assert!(held > 0);
}
