//! `welt patches`.

use super::args;
use super::error::Failure;
use super::files;
use super::output::{print, tell};
use super::progress::watch;
use serde_json::{Value, json};
use std::io::Write;
use std::process::ExitCode;
use welt::mesh::FaceId;
use welt::surface::{PatchOptions, Patches, SplinePatch};

pub fn run(arguments: &args::Patches) -> Result<ExitCode, Failure> {
    let tolerance = arguments.tolerance;
    if !(tolerance > 0.0 && tolerance.is_finite()) {
        return Err(Failure::usage(format_args!("--tolerance {tolerance}: it must be greater than 0")));
    }
    if !files::is_standard(&arguments.output) {
        files::check_output(&arguments.output)?;
        files::check_apart(&[&arguments.output], &[&arguments.input])?;
    }
    let mesh = files::import(&arguments.input, &arguments.import)?;
    let faces: Vec<FaceId> = mesh.faces().collect();
    let options = PatchOptions { most_faces: arguments.most_faces as usize, tolerance };
    let made = watch(|job| Patches::new(&mesh, &faces, &options, job))?;
    let content = json!({
        "report": made.report,
        "patches": made.patches.iter().map(describe).collect::<Vec<Value>>(),
    });
    if files::is_standard(&arguments.output) {
        let text = files::json(&content)?;
        print(|out| writeln!(out, "{text}"))?;
        return Ok(ExitCode::SUCCESS);
    }
    files::save_json(&arguments.output, &content)?;
    let report = &made.report;
    tell(format_args!(
        "{} patches of {} faces, {} exact; deviation {:.2e} (of an edge {:.2e}), normals {:.3} degrees apart",
        report.patches,
        report.faces,
        report.exact,
        report.max_deviation,
        report.max_relative_deviation,
        report.max_normal_jump
    ));
    Ok(ExitCode::SUCCESS)
}

fn describe(patch: &SplinePatch) -> Value {
    let beyond = |beyond: Option<(usize, usize)>| beyond.map(|(patch, side)| [patch, side]);
    json!({
        "degree": [3, 3],
        "pole_counts": patch.pole_counts(),
        "knots_u": patch.knots_u,
        "knots_v": patch.knots_v,
        "poles": patch.poles.iter().map(|pole| pole.to_array()).collect::<Vec<_>>(),
        "faces": patch.faces.iter().map(|face| face.0).collect::<Vec<_>>(),
        "neighbours": patch.neighbours.map(beyond),
        "irregular": patch.irregular,
        "deviation": patch.deviation,
        "relative_deviation": patch.relative_deviation,
    })
}
