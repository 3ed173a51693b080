//! `welt quality`.

use super::args;
use super::curvature;
use super::error::Failure;
use super::files;
use super::output::print;
use std::collections::BTreeMap;
use std::io::{self, Write};
use std::process::ExitCode;
use welt::surface::Quality;

pub fn run(arguments: &args::Quality) -> Result<ExitCode, Failure> {
    if let Some(file) = &arguments.picture {
        files::check_picture(file)?;
        files::check_apart(&[file], &[&arguments.input])?;
    }
    let mesh = files::import(&arguments.input, &arguments.import)?;
    let quality = Quality::of(&mesh, arguments.worst);
    if let Some(file) = &arguments.picture {
        let image = curvature::picture(&mesh, &quality)?;
        welt::io::save(file, |out| image.write_png(out))?;
    }
    if arguments.json {
        let text = files::json(&quality)?;
        print(|out| writeln!(out, "{text}"))?;
    } else {
        print(|out| write_table(out, &quality, arguments.worst))?;
    }
    Ok(ExitCode::SUCCESS)
}

fn write_table(out: &mut impl Write, quality: &Quality, worst: usize) -> io::Result<()> {
    let mut valences: BTreeMap<(bool, usize), usize> = BTreeMap::new();
    for vertex in &quality.extraordinary {
        *valences.entry((vertex.on_boundary, vertex.valence)).or_default() += 1;
    }
    writeln!(out, "extraordinary vertices: {}", quality.extraordinary.len())?;
    for ((on_boundary, valence), count) in valences {
        let place = if on_boundary { " on the boundary" } else { "" };
        writeln!(out, "  valence {valence}{place}: {count}")?;
    }
    if !quality.extraordinary.is_empty() {
        writeln!(out, "where mean curvature varies most (least, greatest; variation times edge length):")?;
    }
    for vertex in quality.extraordinary.iter().take(worst) {
        let [x, y, z] = vertex.position;
        let Some([low, high]) = vertex.mean_curvature else { continue };
        writeln!(
            out,
            "  vertex {:<7} valence {}  at ({x:.4} {y:.4} {z:.4})  {low:+.4} {high:+.4}  {:.4}",
            vertex.vertex, vertex.valence, vertex.variation
        )?;
    }
    writeln!(out, "faces, longest edge over shortest: median {:.2}; worst", quality.median_aspect)?;
    for face in &quality.aspect {
        writeln!(out, "  face {:<7} {} edges  {:.2}", face.face, face.edges, face.aspect)?;
    }
    writeln!(out, "faces, corner off their plane in edges: median {:.4}; worst", quality.median_warp)?;
    for face in &quality.warp {
        writeln!(out, "  face {:<7} {} edges  {:.4}", face.face, face.edges, face.warp)?;
    }
    Ok(())
}
