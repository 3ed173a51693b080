//! `welt deviation`.

use super::args;
use super::error::Failure;
use super::files;
use super::output::print;
use super::progress::watch;
use serde::Serialize;
use std::io::{self, Write};
use std::process::ExitCode;
use welt::surface::{Comparison, Sampling, compare};

#[derive(Serialize)]
struct Output {
    /// Bounding box diagonal of the first.
    size: f64,
    #[serde(flatten)]
    comparison: Comparison,
}

pub fn run(arguments: &args::Deviation) -> Result<ExitCode, Failure> {
    let load = |path| files::import(path, &arguments.import);
    let (first, second) = (load(&arguments.first)?, load(&arguments.second)?);
    let size = first.size();
    let sampling = Sampling { per_side: arguments.samples.into(), threads: arguments.threads };
    let comparison = watch(|job| compare(&first, &second, sampling, job))?;
    if arguments.json {
        let text = files::json(&Output { size, comparison })?;
        print(|out| writeln!(out, "{text}"))?;
    } else {
        print(|out| write_table(out, size, &comparison))?;
    }
    Ok(ExitCode::SUCCESS)
}

fn write_table(out: &mut impl Write, size: f64, comparison: &Comparison) -> io::Result<()> {
    let Comparison { both, first_to_second, second_to_first } = comparison;
    writeln!(out, "size (bounding box diagonal of the first): {size}")?;
    writeln!(out, "{:<18}{:>14}{:>14}{:>14}{:>10}", "distance", "max", "rms", "95 %", "samples")?;
    let rows =
        [("both ways", both), ("first to second", first_to_second), ("second to first", second_to_first)];
    for (name, d) in rows {
        writeln!(out, "{name:<18}{:>14.6e}{:>14.6e}{:>14.6e}{:>10}", d.max, d.rms, d.p95, d.samples)?;
    }
    writeln!(out, "{:<18}{:>14}{:>14}{:>14}", "change of", "normal, deg", "mean curv. max", "rms")?;
    for (name, d) in rows {
        writeln!(out, "{name:<18}{:>14.6}{:>14.6e}{:>14.6e}", d.normal, d.curvature_max, d.curvature_rms)?;
    }
    if size > 0.0 {
        writeln!(out, "relative to the size: max {:.3e}, rms {:.3e}", both.max / size, both.rms / size)?;
    }
    Ok(())
}
