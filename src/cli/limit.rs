//! `welt limit`.

use super::args::Limit;
use super::error::Failure;
use super::files;
use super::output::print;
use std::process::ExitCode;
use welt::io::{self, Format};
use welt::mesh::{Mesh, Polygons};
use welt::subdivision::{Refinement, limit_points, limit_positions};

pub fn run(arguments: &Limit) -> Result<ExitCode, Failure> {
    files::check_mesh_output(&arguments.output)?;
    let mesh = files::import(&arguments.input, &arguments.import)?;
    let level = usize::from(arguments.level);
    if files::is_standard(&arguments.output) {
        let polygons = limit_mesh(&mesh, level)?;
        print(|out| io::obj::write(&polygons, out))?;
        return Ok(ExitCode::SUCCESS);
    }
    let polygons = limit_mesh(&mesh, level)?;
    match Format::of(&arguments.output) {
        Some(Format::Ply) => {
            let refined = Mesh::from_polygons(&polygons)?;
            // Normals of the refined control mesh at its own vertices are those of the surface itself.
            let control = Mesh::from_polygons(&refined_control(&mesh, level)?)?;
            let normals: Vec<_> =
                limit_points(&control).iter().map(|point| point.normal().unwrap_or_default()).collect();
            let options = io::ply::Options { normals: Some(&normals), ..Default::default() };
            io::save(&arguments.output, |out| io::ply::write(&refined.to_polygons(), &options, out))?;
        }
        _ => io::save(&arguments.output, |out| io::obj::write(&polygons, out))?,
    }
    Ok(ExitCode::SUCCESS)
}

/// The control mesh refined `level` times.
pub fn refined_control(mesh: &Mesh, level: usize) -> Result<Polygons, Failure> {
    let refinement = Refinement::new(mesh, level)?;
    let positions = refinement.positions(level, &refinement.control_positions(mesh));
    Ok(refinement.polygons(level, positions))
}

/// The control mesh refined `level` times, every vertex moved to its limit.
pub fn limit_mesh(mesh: &Mesh, level: usize) -> Result<Polygons, Failure> {
    if level == 0 {
        let mut polygons = mesh.to_polygons();
        polygons.positions = limit_positions(mesh);
        return Ok(polygons);
    }
    let control = refined_control(mesh, level)?;
    let positions = limit_positions(&Mesh::from_polygons(&control)?);
    Ok(Polygons { positions, ..control })
}
