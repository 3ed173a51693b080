//! OBJ and PLY in and out, with an import report.
//!
//! [`import`] reads a file and builds the mesh; [`read`] stops at the polygons, for callers that look at what cannot
//! be built ([`inspect`]). Nothing is dropped in silence: the [`ImportReport`] counts what the file holds and the mesh
//! does not, and lists what was repaired. [`export`] writes a mesh; [`save`] is the way every file is written.

mod error;
mod inspect;
mod number;
pub mod obj;
pub mod ply;
mod repair;
mod report;
mod save;
mod source;
mod text;
mod topology;

pub use error::{ExportError, ImportError, LocatedDefect};
pub use inspect::{Boundary, Component, Inspection, inspect};
pub use report::{Ignored, IgnoredKind, ImportReport, Repair};
pub use save::save;
pub use source::Source;

use crate::fault;
use crate::mesh::Mesh;
use std::path::Path;

/// A file format.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Format {
    /// Wavefront OBJ.
    Obj,
    /// PLY (Stanford), ascii or binary.
    Ply,
}

impl Format {
    /// The format that the extension of `path` names, in upper or lower case.
    pub fn of(path: &Path) -> Option<Self> {
        let extension = path.extension()?.to_str()?;
        if extension.eq_ignore_ascii_case("obj") {
            Some(Self::Obj)
        } else if extension.eq_ignore_ascii_case("ply") {
            Some(Self::Ply)
        } else {
            None
        }
    }
}

/// Sizes beyond which a file is refused while it is read. The defaults are far above control meshes.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Limits {
    /// Most vertices (and most texture coordinates); default 2^28.
    pub max_vertices: u64,
    /// Most faces; default 2^28.
    pub max_faces: u64,
    /// Most vertices of one face; default 2^20.
    pub max_arity: u64,
}

impl Default for Limits {
    fn default() -> Self {
        Self { max_vertices: 1 << 28, max_faces: 1 << 28, max_arity: 1 << 20 }
    }
}

/// How a file is taken over.
#[derive(Clone, PartialEq, Default, Debug)]
pub struct ImportOptions {
    /// Split apart, turn round or remove what the kernel cannot hold, instead of refusing the file.
    pub repair: bool,
    /// Merge vertices that are no further apart than this distance, in the unit of the file; 0 merges equal ones.
    pub weld: Option<f64>,
    /// Sizes beyond which a file is refused.
    pub limits: Limits,
}

/// A mesh from a file, and what became of the file's content.
#[derive(Clone, Debug)]
pub struct Import {
    /// The mesh.
    pub mesh: Mesh,
    /// What was left out and what was changed.
    pub report: ImportReport,
}

/// Reads the file at `path`, in the format its extension names, and builds the mesh.
///
/// # Errors
/// See [`ImportError`].
pub fn import(path: &Path, options: &ImportOptions) -> Result<Import, ImportError> {
    read(path, options)?.build()
}

/// Builds the mesh from the content of a file. `name` stands for the file in messages.
///
/// # Errors
/// See [`ImportError`].
pub fn import_bytes(
    name: &str,
    format: Format,
    bytes: &[u8],
    options: &ImportOptions,
) -> Result<Import, ImportError> {
    read_bytes(name, format, bytes, options)?.build()
}

/// Reads the file at `path`, welded and repaired as asked, without building the mesh.
///
/// # Errors
/// All of [`ImportError`] but [`ImportError::Defects`].
pub fn read(path: &Path, options: &ImportOptions) -> Result<Source, ImportError> {
    let file = path.display().to_string();
    let Some(format) = Format::of(path) else { return Err(ImportError::UnknownFormat { file }) };
    match std::fs::read(path) {
        Ok(bytes) => read_bytes(&file, format, &bytes, options),
        Err(source) => Err(ImportError::Unreadable { file, source }),
    }
}

/// [`read`] for the content of a file. `name` stands for the file in messages.
///
/// # Errors
/// All of [`ImportError`] but [`ImportError::Defects`] and [`ImportError::Unreadable`].
pub fn read_bytes(
    name: &str,
    format: Format,
    bytes: &[u8],
    options: &ImportOptions,
) -> Result<Source, ImportError> {
    fault::point("read");
    let mut source = match format {
        Format::Obj => obj::read(name, bytes, &options.limits)?,
        Format::Ply => ply::read(name, bytes, &options.limits)?,
    };
    source.mend(options)?;
    Ok(source)
}

/// Writes `mesh` to `path`, in the format its extension names (PLY: binary, without further data).
///
/// # Errors
/// See [`ExportError`].
pub fn export(path: &Path, mesh: &Mesh) -> Result<(), ExportError> {
    let Some(format) = Format::of(path) else {
        return Err(ExportError::UnknownFormat { file: path.display().to_string() });
    };
    let polygons = mesh.to_polygons();
    save(path, |out| match format {
        Format::Obj => obj::write(&polygons, out),
        Format::Ply => ply::write(&polygons, &ply::Options::default(), out),
    })
}
