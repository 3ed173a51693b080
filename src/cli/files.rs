//! Files, with `-` for standard input and output.

use super::args::Import;
use super::error::Failure;
use super::output;
use serde::Serialize;
use std::io::{ErrorKind, Read, Write};
use std::path::{Path, PathBuf};
use welt::io::{self, ExportError, Format, ImportReport, Source};
use welt::mesh::Mesh;

pub fn is_standard(path: &Path) -> bool {
    path.as_os_str() == "-"
}

/// The polygons of a file, before the mesh is built.
pub fn read(path: &Path, import: &Import) -> Result<Source, Failure> {
    let options = import.options();
    let mut source = if is_standard(path) {
        let mut bytes = Vec::new();
        std::io::stdin().lock().read_to_end(&mut bytes)?;
        io::read_bytes("standard input", Format::Obj, &bytes, &options)?
    } else {
        io::read(path, &options)?
    };
    if let Some(boundary) = import.boundary {
        source.polygons.subdivision.boundary = boundary.into();
    }
    Ok(source)
}

/// The mesh of a file. What was left out or repaired is told on standard error.
pub fn import(path: &Path, import: &Import) -> Result<Mesh, Failure> {
    let imported = read(path, import)?.build()?;
    tell(path, &imported.report);
    Ok(imported.mesh)
}

fn tell(path: &Path, report: &ImportReport) {
    for line in report.to_string().lines() {
        output::tell(format_args!("{}: {line}", path.display()));
    }
}

/// Refuses a mesh file whose format is not known or that has no place, before any work is done.
pub fn check_mesh_output(path: &Path) -> Result<(), Failure> {
    if is_standard(path) {
        return Ok(());
    }
    if Format::of(path).is_none() {
        return Err(ExportError::UnknownFormat { file: path.display().to_string() }.into());
    }
    check_output(path)
}

/// Refuses a file that is a folder or whose folder is missing.
pub fn check_output(path: &Path) -> Result<(), Failure> {
    let file = path.display().to_string();
    if path.is_dir() {
        let source = ErrorKind::IsADirectory.into();
        return Err(ExportError::Unwritable { file, source }.into());
    }
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() && !folder.is_dir() => {
            Err(ExportError::FolderMissing { file, folder: folder.display().to_string() }.into())
        }
        _ => Ok(()),
    }
}

/// Refuses a picture that cannot be written as such.
pub fn check_picture(path: &Path) -> Result<(), Failure> {
    if path.extension().is_none_or(|e| !e.eq_ignore_ascii_case("png")) {
        let path = path.display();
        return Err(Failure::error(format_args!("{path}: pictures are PNG files; end the name with .png")));
    }
    check_output(path)
}

/// Refuses outputs that would overwrite each other or one of `others`.
pub fn check_apart(outputs: &[&Path], others: &[&Path]) -> Result<(), Failure> {
    for (i, path) in outputs.iter().enumerate() {
        if others.iter().chain(&outputs[..i]).any(|other| are_same(path, other)) {
            let path = path.display();
            return Err(Failure::usage(format!("{path} is named twice; give each output a file of its own")));
        }
    }
    Ok(())
}

/// Whether two names lead to one file.
fn are_same(a: &Path, b: &Path) -> bool {
    !is_standard(a) && !is_standard(b) && place(a).is_some_and(|a| place(b) == Some(a))
}

/// The one name of a file, which need not be there, in a folder that is.
pub fn place(path: &Path) -> Option<PathBuf> {
    let folder = match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    path.canonicalize().ok().or_else(|| Some(folder.canonicalize().ok()?.join(path.file_name()?)))
}

/// Writes the control mesh.
pub fn export(path: &Path, mesh: &Mesh) -> Result<(), Failure> {
    if !is_standard(path) {
        return Ok(io::export(path, mesh)?);
    }
    let polygons = mesh.try_to_polygons()?;
    output::print(|out| io::obj::write(&polygons, out))
}

pub fn save_json(path: &Path, value: &impl Serialize) -> Result<(), Failure> {
    let text = json(value)?;
    Ok(io::save(path, |out| writeln!(out, "{text}"))?)
}

pub fn json(value: &impl Serialize) -> Result<String, Failure> {
    Ok(serde_json::to_string_pretty(value)?)
}
