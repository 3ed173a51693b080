//! `welt limit`.

use super::args::Limit;
use super::curvature;
use super::error::Failure;
use super::figure;
use super::files;
use super::output::print;
use glam::DVec3;
use std::process::ExitCode;
use welt::io::{self, Format};
use welt::memory::OutOfMemory;
use welt::mesh::{Mesh, Polygons};
use welt::subdivision::{Refinement, limit_points, limit_positions};

pub fn run(arguments: &Limit) -> Result<ExitCode, Failure> {
    files::check_mesh_output(&arguments.output)?;
    if let Some(file) = &arguments.zebra {
        files::check_picture(file)?;
        files::check_apart(&[file], &[&arguments.output, &arguments.input])?;
    }
    if arguments.curvature.is_some() && Format::of(&arguments.output) != Some(Format::Ply) {
        return Err(Failure::usage(
            "--curvature needs a .ply file as the output: only there vertices have values",
        ));
    }
    let mesh = files::import(&arguments.input, &arguments.import)?;
    let level = usize::from(arguments.level);
    if let Some(file) = &arguments.zebra {
        let image = figure::reflection_lines(&mesh)?;
        welt::io::save(file, |out| image.write_png(out))?;
    }
    if files::is_standard(&arguments.output) {
        let polygons = limit_mesh(&mesh, level)?;
        print(|out| io::obj::write(&polygons, out))?;
        return Ok(ExitCode::SUCCESS);
    }
    if Format::of(&arguments.output) == Some(Format::Ply) {
        let refinement = Refinement::new(&mesh, level)?;
        let (polygons, normals) = limit_mesh_with_normals(&refinement, &mesh, level)?;
        let values = match arguments.curvature {
            Some(kind) => Some(curvature::at_vertices(&refinement, &mesh, level, curvature::value(kind))?),
            None => None,
        };
        let options =
            io::ply::Options { normals: Some(&normals), quality: values.as_deref(), ..Default::default() };
        io::save(&arguments.output, |out| io::ply::write(&polygons, &options, out))?;
    } else {
        let polygons = limit_mesh(&mesh, level)?;
        io::save(&arguments.output, |out| io::obj::write(&polygons, out))?;
    }
    Ok(ExitCode::SUCCESS)
}

/// The control mesh refined `level` times, every vertex moved to its limit.
fn limit_mesh(mesh: &Mesh, level: usize) -> Result<Polygons, Failure> {
    if level == 0 {
        // Groups, materials and texture coordinates stay.
        return Ok(Polygons { positions: limit_positions(mesh), ..mesh.to_polygons() });
    }
    let control = refined_control(&Refinement::new(mesh, level)?, mesh, level)?;
    let positions = limit_positions(&Mesh::from_polygons(&control)?);
    Ok(Polygons { positions, ..control })
}

/// Level `level` of `mesh`, every vertex moved to its limit, and the normal of the surface at each vertex; zero where
/// there is none.
pub fn limit_mesh_with_normals(
    refinement: &Refinement,
    mesh: &Mesh,
    level: usize,
) -> Result<(Polygons, Vec<DVec3>), Failure> {
    let control = refined_control(refinement, mesh, level)?;
    let points = limit_points(&Mesh::from_polygons(&control)?);
    let normals = points.iter().map(|point| point.normal().unwrap_or_default()).collect();
    let positions = points.iter().map(|point| point.position).collect();
    Ok((Polygons { positions, ..control }, normals))
}

/// Level `level` of `mesh`: another control mesh of the same surface.
pub fn refined_control(refinement: &Refinement, mesh: &Mesh, level: usize) -> Result<Polygons, OutOfMemory> {
    let positions = refinement.positions(level, &refinement.control_positions(mesh))?;
    refinement.polygons(level, positions)
}
