//! Grooves round every ring of the real cages: valid, sparse, deterministic, true to size; and at depth 0, how much
//! closer the fit brings the surface to what it was.

mod common;

use rustc_hash::FxHashSet;
use welt::feature::{self, Options, Report, Request};
use welt::job::Job;
use welt::mark::{Selection, Selector, Shape};
use welt::mesh::{FaceId, Mesh};
use welt::optimise::Method;

/// A closed ring of quads that crosses no face twice.
struct Ring {
    selection: Selection,
    /// Mean length of its edges.
    edge: f64,
}

/// The rings of a mesh of 6 edges or more whose longest edge is under 8 times its shortest.
fn rings(mesh: &Mesh) -> Vec<Ring> {
    let mut seen: FxHashSet<u32> = FxHashSet::default();
    let mut rings = Vec::new();
    for h in mesh.edges() {
        if seen.contains(&h.edge()) {
            continue;
        }
        let edge = (mesh.source(h).0, mesh.target(h).0);
        let selector = Selector { shape: Shape::Ring { edge }, kind: "red".into() };
        let selection = Selection::resolve(mesh, &[selector]).expect("an edge of the mesh");
        seen.extend(selection.marks.iter().map(|mark| mark.half_edge.edge()));
        let lengths: Vec<f64> = selection.marks.iter().map(|mark| mesh.edge_length(mark.half_edge)).collect();
        let (low, high) = lengths.iter().fold((f64::INFINITY, 0.0_f64), |(l, h), &x| (l.min(x), h.max(x)));
        let faces: FxHashSet<FaceId> = selection.marks.iter().map(|mark| mesh.face(mark.half_edge)).collect();
        if selection.ends.is_empty()
            && selection.marks.len() >= 6
            && faces.len() == selection.marks.len()
            && high < 8.0 * low
        {
            let edge = lengths.iter().sum::<f64>() / lengths.len() as f64;
            rings.push(Ring { selection, edge });
        }
    }
    rings
}

fn groove(mesh: &mut Mesh, ring: &Ring, depth: &str, method: Method, deviation: bool) -> Report {
    let request =
        Request::features(&["groove"], &["width=30%", &format!("depth={depth}")]).expect("a request");
    let options = Options { method, samples: if deviation { 3 } else { 0 }, ..Options::default() };
    feature::apply(mesh, &ring.selection, &request, &options, &Job::new()).expect("a ring takes a groove")
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

#[test]
fn every_ring_takes_a_groove() {
    let Some(data) = common::shared_data() else { return };
    let (mut count, mut narrow, mut shallow) = (0, Vec::new(), Vec::new());
    let (mut places, mut off) = (0, 0);
    for folder in ["upholstery", "product"] {
        for (name, mesh) in common::clean_cages(&data, folder) {
            let (places_before, off_before) = (places, off);
            for ring in rings(&mesh) {
                let mut result = mesh.clone();
                let report = groove(&mut result, &ring, "10%", Method::Solve, false);
                let marks = ring.selection.marks.len();
                result.validate_control_mesh().unwrap_or_else(|e| panic!("{name}: {e}"));
                assert!(report.leftovers.is_empty(), "{name}: {report}");
                assert_eq!(result.vertex_bound(), mesh.vertex_bound() + 3 * marks, "{name}");
                assert_eq!(non_quads(&result), non_quads(&mesh), "{name}");
                let mut again = mesh.clone();
                groove(&mut again, &ring, "10%", Method::Solve, false);
                assert_eq!(again.to_polygons(), result.to_polygons(), "{name}: two runs differ");
                narrow.extend(report.dimension("width").iter().flat_map(|d| [d.worst_low, d.worst_high]));
                shallow.extend(report.dimension("depth").iter().flat_map(|d| [d.worst_low, d.worst_high]));
                count += 1;
                places += report.dimension("width").map_or(0, |d| d.stations);
                off += report.dimension("width").map_or(0, |d| d.off.len());
            }
            let (off_here, places_here) = (off - off_before, places - places_before);
            println!("{name}: width off by more than 3 % at {off_here} of {places_here} places");
            if EVEN_CHAIRS.contains(&name.as_str()) {
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

#[test]
fn depth_zero_leaves_the_surface_where_it_was() {
    let Some(data) = common::shared_data() else { return };
    let (mut rms, mut max) = (Vec::new(), Vec::new());
    for folder in ["upholstery", "product"] {
        for (name, mesh) in common::clean_cages(&data, folder) {
            for ring in rings(&mesh) {
                let deviation = |method| {
                    let mut result = mesh.clone();
                    let report = groove(&mut result, &ring, "0", method, true);
                    report.fitted.unwrap_or_else(|| panic!("{name}: no deviation")).total
                };
                let none = deviation(Method::None);
                if none.rms <= 1e-3 * ring.edge {
                    continue;
                }
                let solve = deviation(Method::Solve);
                rms.push(none.rms / solve.rms);
                max.push(none.max / solve.max);
            }
        }
    }
    for (name, mut ratios, aim) in [("rms", rms, 3.5), ("max", max, 2.5)] {
        ratios.sort_by(f64::total_cmp);
        let [least, low, median, high, most] = [0.0, 0.1, 0.5, 0.9, 1.0].map(|q| quantile(&ratios, q));
        println!(
            "{name}: solve is closer than none by a factor of {median:.2} (median of {} rings; least {least:.2}, 10 % {low:.2}, 90 % {high:.2}, most {most:.2})",
            ratios.len()
        );
        assert!(median >= aim, "{name}: the median factor {median} is below {aim}");
    }
}
