//! The report as a person reads it.

use super::length::significant;
use super::report::{Counts, Report};
use crate::optimise::Stop;
use std::fmt;

impl fmt::Display for Report {
    /// The report as a person reads it.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Counts { vertices, faces, .. } = self.after;
        writeln!(
            f,
            "{}: {} marked edges; {} vertices ({:+}), {} faces ({:+})",
            self.feature,
            self.marks,
            vertices,
            vertices as i64 - self.before.vertices as i64,
            faces,
            faces as i64 - self.before.faces as i64
        )?;
        let rules: Vec<String> =
            self.rules.iter().filter(|r| r.1 > 0).map(|(name, count)| format!("{name} {count}")).collect();
        writeln!(f, "rules: {}", if rules.is_empty() { "none applied".into() } else { rules.join(", ") })?;
        let several = self.features.len() > 1;
        for (feature, d) in self.features.iter().flat_map(|f| f.dimensions.iter().map(move |d| (f, d))) {
            let of = if several { format!("{}.", feature.kind) } else { String::new() };
            if d.stations == 0 {
                writeln!(f, "{of}{}: asked {}, not measured: no straight stretch", d.name, d.asked)?;
                continue;
            }
            writeln!(
                f,
                "{of}{}: asked {}, reached {} of {} in the mean ({:+.2} % to {:+.2} %; {} of {} places off by more than 3 %)",
                d.name,
                d.asked,
                significant(d.reached_mean),
                significant(d.asked_mean),
                100.0 * (d.worst_low - 1.0),
                100.0 * (d.worst_high - 1.0),
                d.off.len(),
                d.stations
            )?;
        }
        for feature in &self.features {
            if let Some(off) = feature.off_curve {
                let (max, rms) = (significant(off.max), significant(off.rms));
                writeln!(f, "{}: off its curve by {max} at most, {rms} rms", feature.kind)?;
            }
            if !feature.off_ends.is_empty() {
                let list: Vec<String> = feature.off_ends.iter().map(|&x| significant(x)).collect();
                writeln!(f, "{}: ends {} from the ends of its curve", feature.kind, list.join(", "))?;
            }
        }
        writeln!(
            f,
            "fit: {}, {} active vertices, {} steps, {}, residual {:.1e}",
            self.fit.method.name(),
            self.fit.active,
            self.fit.steps,
            match self.fit.stop {
                Stop::Nothing if self.fit.held > 0 => "nothing to gain",
                Stop::Nothing => "nothing to do",
                Stop::TooCoarse =>
                    "not done so far from the origin, where numbers are coarser than the edges",
                Stop::Converged => "converged",
                Stop::StepLimit => "step limit reached",
            },
            self.fit.residual
        )?;
        if self.fit.held > 0 {
            writeln!(
                f,
                "fit: {} vertices held, where the fit would have made the surface worse",
                self.fit.held
            )?;
        }
        if !self.fit.missed.is_empty() {
            writeln!(f, "fit: {} vertices found no surface to fit to", self.fit.missed.len())?;
        }
        let measured = [
            ("before the fit", &self.inserted),
            ("before displacement", &self.fitted),
            ("result", &self.displaced),
        ];
        for (name, difference) in measured {
            if let Some(d) = difference {
                writeln!(
                    f,
                    "deviation, {name}: max {:.3e}, rms {:.3e}; outside of the footprint max {:.3e}, rms {:.3e}",
                    d.total.max, d.total.rms, d.outside.max, d.outside.rms
                )?;
                writeln!(
                    f,
                    "  outside of the footprint 95 % within {:.3e}; normals turn by at most {:.2} degrees, mean curvature changes by at most {:.2e}, rms {:.2e}",
                    d.outside.p95, d.outside.normal, d.outside.curvature_max, d.outside.curvature_rms
                )?;
            }
        }
        if self.without_texcoords > 0 {
            writeln!(f, "note: {} changed faces lost their texture coordinates", self.without_texcoords)?;
        }
        for end in &self.ends {
            writeln!(f, "note: {end}")?;
        }
        if let Some(parity) = &self.parity {
            write!(f, "{parity}")?;
        }
        for leftover in &self.leftovers {
            let marks: Vec<String> = leftover
                .marks
                .iter()
                .map(|mark| format!("{},{}#{}", mark.edge.0, mark.edge.1, mark.kind))
                .collect();
            writeln!(
                f,
                "unresolved: face {} with {} edges, marked at {}; no rule handles it",
                leftover.face,
                leftover.vertices.len(),
                marks.join(" ")
            )?;
        }
        for warning in &self.warnings {
            writeln!(f, "warning: {warning}")?;
        }
        Ok(())
    }
}
