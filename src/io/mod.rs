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
use crate::memory::{self, OutOfMemory};
use crate::mesh::{Mesh, Polygons};
use std::io::Read;
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

/// Sizes beyond which polygons are refused. The defaults are far above control meshes.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Limits {
    /// Most vertices (and most texture coordinates); default 2^28.
    pub max_vertices: u64,
    /// Most faces; default 2^28.
    pub max_faces: u64,
    /// Most vertices of one face; default 1024.
    pub max_arity: u64,
    /// Most faces at one vertex; default 1024. Work and memory at a vertex grow with the square of this number.
    pub max_valence: u64,
}

impl Default for Limits {
    fn default() -> Self {
        Self { max_vertices: 1 << 28, max_faces: 1 << 28, max_arity: 1 << 10, max_valence: 1 << 10 }
    }
}

impl Limits {
    /// What of the polygons is beyond the limits, if anything. What was read from a file has been compared while it was
    /// read, but for the valence.
    ///
    /// # Errors
    /// The first excess.
    pub fn check(&self, polygons: &Polygons) -> Result<(), Excess> {
        let whole = [
            (polygons.positions.len() as u64, self.max_vertices, "vertices"),
            (polygons.face_sizes.len() as u64, self.max_faces, "faces"),
        ];
        for (count, limit, what) in whole {
            if count > limit {
                return Err(Excess::Whole { count, limit, what });
            }
        }
        for (face, &count) in (0..).zip(&polygons.face_sizes) {
            if u64::from(count) > self.max_arity {
                return Err(Excess::Arity { face, count, limit: self.max_arity });
            }
        }
        let mut valences = memory::filled(polygons.positions.len(), 0u32)?;
        for &vertex in &polygons.face_vertices {
            if let Some(valence) = valences.get_mut(vertex as usize) {
                *valence += 1;
            }
        }
        match (0..).zip(valences).find(|&(_, count)| u64::from(count) > self.max_valence) {
            Some((vertex, count)) => Err(Excess::Valence { vertex, count, limit: self.max_valence }),
            None => Ok(()),
        }
    }
}

/// Polygons that are larger than [`Limits`] allow. Numbers of elements are 0-based.
#[derive(Clone, PartialEq, Eq, Debug, thiserror::Error)]
pub enum Excess {
    /// Too many elements.
    #[error(
        "{count} {what} are more than the limit of {limit}; raise the limit if the mesh is meant to be this large"
    )]
    Whole {
        /// How many there are.
        count: u64,
        /// How many there may be.
        limit: u64,
        /// Of what.
        what: &'static str,
    },
    /// A face with too many vertices.
    #[error(
        "face {face} has {count} vertices, more than the limit of {limit}; split the face, or raise the limit"
    )]
    Arity {
        /// The face.
        face: u32,
        /// How many it has.
        count: u32,
        /// How many it may have.
        limit: u64,
    },
    /// There is no memory to count the faces at the vertices.
    #[error(transparent)]
    Memory(#[from] OutOfMemory),
    /// A vertex with too many faces.
    #[error(
        "{count} faces meet at vertex {vertex}, more than the limit of {limit}; use fewer, or raise the limit"
    )]
    Valence {
        /// The vertex.
        vertex: u32,
        /// How many meet.
        count: u32,
        /// How many may.
        limit: u64,
    },
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

/// Texts that people write are smaller; a device or a wrong file may have no end.
const MOST_TEXT: u64 = 64 << 20;

/// The text of a rule file, a profile, a case or a file of marks.
///
/// # Errors
/// The file cannot be read, is no UTF-8, or is larger than 64 MiB.
pub(crate) fn read_text(path: &Path) -> std::io::Result<String> {
    let mut text = String::new();
    std::fs::File::open(path)?.take(MOST_TEXT + 1).read_to_string(&mut text)?;
    if text.len() as u64 > MOST_TEXT {
        let problem = format!("it is larger than {} MiB", MOST_TEXT >> 20);
        return Err(std::io::Error::new(std::io::ErrorKind::FileTooLarge, problem));
    }
    Ok(text)
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
        Err(error) if error.kind() == std::io::ErrorKind::OutOfMemory => {
            let bytes = std::fs::metadata(path).map_or(0, |metadata| metadata.len());
            Err(ImportError::Memory { file, source: OutOfMemory { bytes } })
        }
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
    match options.limits.check(&source.polygons) {
        Ok(()) => Ok(source),
        Err(Excess::Memory(source)) => Err(ImportError::Memory { file: name.to_owned(), source }),
        Err(excess) => Err(ImportError::Excess { file: name.to_owned(), excess }),
    }
}

/// Writes `mesh` to `path`, in the format its extension names (PLY: binary, without further data).
///
/// # Errors
/// See [`ExportError`].
pub fn export(path: &Path, mesh: &Mesh) -> Result<(), ExportError> {
    let Some(format) = Format::of(path) else {
        return Err(ExportError::UnknownFormat { file: path.display().to_string() });
    };
    let polygons = mesh
        .try_to_polygons()
        .map_err(|source| ExportError::Memory { file: path.display().to_string(), source })?;
    save(path, |out| match format {
        Format::Obj => obj::write(&polygons, out),
        Format::Ply => ply::write(&polygons, &ply::Options::default(), out),
    })
}
