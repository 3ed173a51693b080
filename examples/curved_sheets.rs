//! Bands of depth 0 on curved sheets: how far each method leaves the limit surface from what it was. Prints the table of
//! docs/optimisation.md, section 2: radius, sheet, pattern; per method max, rms (in edges), rms curvature change, normals
//! (degrees), milliseconds.
//!
//!     cargo run --release --example curved_sheets

#[allow(dead_code, reason = "shared with the tests")]
#[path = "../tests/common/curved_sheet.rs"]
mod curved_sheet;

use curved_sheet::{Base, Case, Pattern, WIDTH, measure};
use welt::optimise::Method;

fn main() {
    for radius in [3.0, 6.0, 12.0] {
        for (base, pattern) in [Base::Cylinder, Base::Sphere, Base::Saddle]
            .into_iter()
            .flat_map(|base| Pattern::ALL.map(|pattern| (base, pattern)))
        {
            let case = Case::new(base, radius, pattern, WIDTH);
            print!("| {radius} | {base:?} | {pattern:?} |");
            for method in [Method::None, Method::Solve, Method::Fit, Method::FitSlide] {
                let (d, time) = measure(&case, method);
                print!(
                    " {:.5} / {:.5} / {:.3} / {:.1} / {time:.1} |",
                    d.max, d.rms, d.curvature_rms, d.normal
                );
            }
            println!();
        }
    }
}
