//! Depth-0 insertion on curved sheets: the study of docs/optimisation.md. The bounds are a prototype's figures (written
//! independently, with its own evaluator), which the library is to stay below.

use crate::common::curved_sheet;

use curved_sheet::{Base, Case, Pattern, WIDTH, measure};
use welt::optimise::Method;

fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0.0), |(sum, count), x| (sum + x, count + 1.0));
    sum / count
}

/// Mean factors over the patterns by which a method is closer than `none` in max and rms, and its part of the rms
/// curvature error of `none`.
fn factors(base: Base, radius: f64, method: Method) -> [f64; 3] {
    let rows: Vec<[f64; 3]> = Pattern::ALL
        .into_iter()
        .map(|pattern| {
            let case = Case::new(base, radius, pattern, WIDTH);
            let ((none, _), (d, _)) = (measure(&case, Method::None), measure(&case, method));
            [none.max / d.max, none.rms / d.rms, d.curvature_rms / none.curvature_rms]
        })
        .collect();
    [0, 1, 2].map(|k| mean(rows.iter().map(|row| row[k])))
}

#[test]
fn methods_are_closer_than_the_prototype() {
    // Base; the prototype's factors in max and rms: solve, distance and slope, the same sliding.
    let table = [
        (Base::Cylinder, [(4.1, 4.0), (4.2, 5.0), (5.4, 7.3)]),
        (Base::Sphere, [(5.0, 5.6), (6.4, 7.6), (10.8, 13.3)]),
        (Base::Saddle, [(2.8, 3.2), (3.0, 3.6), (4.3, 5.6)]),
    ];
    for (base, [solve, fit, slide]) in table {
        for (method, (max, rms), share) in
            // Its window is smaller and it has eight patterns, so the first two are held to three quarters of it.
            [(Method::Solve, solve, 0.75), (Method::Fit, fit, 0.6), (Method::FitSlide, slide, 1.8)]
        {
            let [found_max, found_rms, curvature] = factors(base, 3.0, method);
            println!("{base:?} {}: x{found_max:.1} x{found_rms:.1}, curvature {curvature:.2}", method.name());
            assert!(found_max > share * max && found_rms > share * rms, "{base:?} {method:?}");
            assert!(curvature < 1.0, "{base:?} {method:?}: curvature error {curvature}");
        }
    }
}

/// The prototype reached 0.26 % of an edge.
#[test]
fn a_tee_on_a_sphere_of_six_edges_is_closer_than_a_thousandth_of_an_edge() {
    let (d, _) = measure(&Case::new(Base::Sphere, 6.0, Pattern::Tee, WIDTH), Method::FitSlide);
    println!("T-DE on a sphere, radius 6 edges: max {:.5}, rms {:.6}", d.max, d.rms);
    assert!(d.max < 1e-3, "{}", d.max);
}
