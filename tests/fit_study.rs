//! Depth-0 insertion on curved sheets: the optimisation study of docs/optimisation.md.

#[path = "common/sheet.rs"]
mod sheet;

use sheet::{Base, Case, Pattern};
use std::time::Instant;
use welt::job::Job;
use welt::mesh::FaceId;
use welt::optimise::{Method, Target, active_set, fit};
use welt::surface::{Deviation, LimitSurface, Sampling, deviation_samples};

/// Deviation over the cells within `within` of the junction, and the time of the fit in milliseconds.
fn measure(case: &Case, method: Method, within: usize) -> (Deviation, f64) {
    let faces: Vec<FaceId> = case.before.faces().collect();
    let target = Target::freeze(&case.before, &faces);
    let mut after = case.after.clone();
    let active = active_set(&after, &case.changed(), method);
    let start = Instant::now();
    fit(&mut after, &active, &target, method, &Job::new()).expect("not cancelled");
    let time = start.elapsed().as_secs_f64() * 1e3;
    let now = LimitSurface::new(&after);
    let near = |f: FaceId| case.away[f.index()] <= within;
    let samples = {
        if std::env::var("SHOW").is_ok() { let mut m=0.0f64; for v in after.vertices().filter(|v| v.index() >= case.before.vertex_bound()) { let n=welt::subdivision::limit_normal(&after,v).unwrap(); let d=after.position(v)-case.after.position(v); m=m.max(d.reject_from(n).length()); } print!("inserted {m:.4} "); }
        deviation_samples(&now, near, &target.surface, Sampling::default(), &Job::new()).expect("samples") };
    (Deviation::of(&samples), time)
}

#[test]
fn study() {
    let radii = std::env::var("RADII").unwrap_or("3".into());
    let methods = std::env::var("METHODS").unwrap_or("none,solve,fit,fit+slide".into());
    for radius in radii.split(',').map(|r| r.parse::<f64>().unwrap()) {
        for base in Base::ALL {
            for pattern in Pattern::ALL {
                let case = Case::new(base, radius, pattern, 0.15);
                let none = measure(&case, Method::None, 4).0;
                print!("{radius:>3} {:<9}{:<9}", format!("{base:?}"), format!("{pattern:?}"));
                for method in methods.split(',').map(|m| Method::from_name(m).unwrap()) {
                    let (d, time) = measure(&case, method, 4);
                    print!(
                        "| {:<5} {:.5} {:.6} x{:5.1} {:5.1} dH {:.4} {:.3} n {:.2} {:4.0}ms ",
                        &method.name()[..method.name().len().min(5)], d.max, d.rms, none.max / d.max, none.rms / d.rms, d.curvature_rms, d.curvature_max, d.normal, time
                    );
                }
                println!();
            }
        }
    }
}
