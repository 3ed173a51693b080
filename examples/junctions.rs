//! The tables of docs/junctions.md: `cargo run --example junctions`.

#[path = "../tests/common/junction_cases.rs"]
mod junction_cases;
#[path = "../tests/common/sheet.rs"]
mod sheet;

use glam::DVec2;
use junction_cases::{CENTRE, DEPTH, SIDE, cases, flat, piped_cases};
use sheet::{Ideal, apply};
use welt::feature;
use welt::grammar::RuleSet;
use welt::optimise::Method;

/// Crest of the bar, the groove beside it at the stem's side, the seam, each from least to greatest.
fn piped(rules: &RuleSet) {
    const D: f64 = 0.05;
    for case in piped_cases() {
        let result = apply(rules, sheet::sheet(SIDE, flat), SIDE, &case.bands, &case.marks, Method::None, &[]);
        let samples = sheet::samples(&result, &result.base, CENTRE, 1.5, 16);
        let along = |y: f64, beside: f64, sign: f64| {
            let [a, b] = [DVec2::new(2.1, y), DVec2::new(4.9, y)];
            sheet::valley(&samples, a, b, beside, sign * D)
        };
        let [crest, groove] = [along(3.5, 0.04, -1.0), along(3.5 - 0.15, 0.1, 1.0)];
        let seam = sheet::valley(&samples, DVec2::new(3.5, 2.1), DVec2::new(3.5, 3.3), 0.1, D);
        if std::env::var("WHERE").is_ok() {
            let deepest = samples.iter().max_by(|a, b| (-a.height).total_cmp(&-b.height)).unwrap();
            let highest = samples.iter().max_by(|a, b| a.height.total_cmp(&b.height)).unwrap();
            println!("deepest at {} highest at {}", deepest.at - CENTRE, highest.at - CENTRE);
            for k in 0..15 { let x = -0.7 + 0.1 * k as f64; 
              let near = |y: f64| samples.iter().filter(|s| (s.at.x - CENTRE.x - x).abs() < 0.03 && (s.at.y - CENTRE.y - y).abs() < 0.08).map(|s| s.height / D).fold((9.0_f64, -9.0_f64), |a, h| (a.0.min(h), a.1.max(h)));
              println!("x {x:.1} groove below {:.3} crest {:.3} groove above {:.3}", near(-0.15).0, near(0.0).1, near(0.15).0); }
        }
        let [pit, peak] =
            [1.0, -1.0].map(|sign| samples.iter().map(|s| -s.height * sign / D).fold(0.0, f64::max));
        println!(
            "{:28} crest {:.3}-{:.3} groove {:.3}-{:.3} seam {:.3}-{:.3} deepest {pit:.2} highest {peak:.2} vertices {} non-quads {:?} {:?}",
            case.name, crest[0], crest[1], groove[0], groove[1], seam[0], seam[1],
            result.mesh.vertex_bound(), result.non_quads(), result.fired
        );
    }
}

fn main() {
    let rules = match std::env::var("RULES") {
        Ok(path) => RuleSet::load(path.as_ref()).unwrap_or_else(|e| panic!("{e}")),
        Err(_) => feature::linear_rules().expect("rules"),
    };
    piped(&rules);
    for w in [0.15, 0.08] {
        println!("w = {w}");
        for case in cases(w) {
            let ideal = Ideal::new(&case.bands, case.lines.clone());
            let result =
                apply(&rules, sheet::sheet(SIDE, flat), SIDE, &case.bands, &case.marks, Method::None, &[]);
            let samples = sheet::samples(&result, &result.base, CENTRE, 1.5, 32);
            let [rms, max] = sheet::error(&samples, &ideal, CENTRE, DEPTH);
            let half_depth = 1.1934 * w + 0.06285;
            let h = sheet::curvature_error(&samples, &ideal, half_depth);
            // Dead ends are fitted: the ideal's end moves along the line, over all nine faces.
            if case.name.starts_with("DE") {
                let (fitted, end) = sheet::fitted_end(&samples, &case.bands, case.lines[0], DEPTH);
                println!("{:24} rms {:.4} max {:.3} end at {:.3} {:?}", case.name, fitted[0], fitted[1], end.y - 3.0, result.non_quads());
                continue;
            }
            let across = sheet::valley(&samples, DVec2::new(2.1, 3.5), DVec2::new(4.9, 3.5), w, DEPTH);
            let up = sheet::valley(&samples, DVec2::new(3.5, 2.1), DVec2::new(3.5, 3.5 - w / 2.0), w, DEPTH);
            if std::env::var("DUMP").is_ok_and(|name| name == case.name) {
                for v in 64..result.mesh.vertex_bound() as u32 {
                    let p = result.mesh.position(welt::mesh::VertexId(v));
                    if (p.truncate() - CENTRE).abs().max_element() < 0.51 {
                        println!("{v}: {p:?} valence {}", result.mesh.valence(welt::mesh::VertexId(v)));
                    }
                }
            }
            if std::env::var("MAP").is_ok_and(|name| name == case.name) {
                let mut cells = vec![(0.0_f64, 0.0, DVec2::ZERO); 225];
                for s in &samples {
                    let q = ((s.at - CENTRE + 0.75) * 10.0).floor();
                    if q.min_element() >= 0.0 && q.max_element() < 15.0 {
                        let cell = &mut cells[q.y as usize * 15 + q.x as usize];
                        cell.0 += (s.height - ideal.at(s.at)[0]) / DEPTH * s.area;
                        cell.1 += s.area;
                    }
                }
                for row in cells.chunks(15).rev() {
                    println!("{}", row.iter().map(|c| format!("{:6.2}", c.0 / c.1)).collect::<String>());
                }
            }
            println!(
                "{:24} rms {rms:.4} max {max:.3} bar {:.3}-{:.3} stem {:.3}-{:.3} dH {:.3}/{:.2} vertices {} non-quads {:?} {:?}",
                case.name, across[0], across[1], up[0], up[1], h[0], h[1],
                result.mesh.vertex_bound(), result.non_quads(), result.fired
            );
        }
    }
}
