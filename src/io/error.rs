//! What can go wrong while a file is read or written.

use super::Excess;
use crate::memory::OutOfMemory;
use crate::mesh::Defect;
use serde::Serialize;
use std::io;

/// Why a file did not become a mesh. Every message names the file, the place and what to do.
#[derive(Debug, thiserror::Error)]
pub enum ImportError {
    /// The file could not be read.
    #[error("{file}: cannot be read: {source}; check the path and the permissions")]
    Unreadable {
        /// The file.
        file: String,
        /// What the system said.
        source: io::Error,
    },
    /// The extension names no format that is known.
    #[error("{file}: the format of this file is not known; files end with .obj or .ply")]
    UnknownFormat {
        /// The file.
        file: String,
    },
    /// A place in a text file that cannot be understood.
    #[error("{file}:{line}:{column}: {message}; {remedy}")]
    Text {
        /// The file.
        file: String,
        /// The line, 1-based.
        line: u32,
        /// The column in bytes, 1-based.
        column: u32,
        /// What is wrong.
        message: String,
        /// What to do.
        remedy: &'static str,
    },
    /// An element of a binary file that cannot be understood.
    #[error("{file}: {element}: {message}; {remedy}")]
    Binary {
        /// The file.
        file: String,
        /// The element, for instance `vertex 12` (0-based).
        element: String,
        /// What is wrong.
        message: String,
        /// What to do.
        remedy: &'static str,
    },
    /// There is no memory for what the file holds.
    #[error("{file}: {source}")]
    Memory {
        /// The file.
        file: String,
        /// How much was asked for.
        source: OutOfMemory,
    },
    /// The distance for welding is not a number that can be used.
    #[error("the welding distance {distance} is not usable; give a finite number that is 0 or larger")]
    WeldDistance {
        /// The distance.
        distance: f64,
    },
    /// The file was understood, but is larger than the limits allow.
    #[error("{file}: {excess}")]
    Excess {
        /// The file.
        file: String,
        /// What is larger; numbers of elements are those after the repairs.
        excess: Excess,
    },
    /// The file was understood, but the kernel cannot hold what it describes.
    #[error("{file}: {}", summary(.defects))]
    Defects {
        /// The file.
        file: String,
        /// All that was found, in a fixed order.
        defects: Vec<LocatedDefect>,
    },
}

/// A defect and the lines of the file that cause it.
#[derive(Clone, PartialEq, Eq, Debug, Serialize)]
pub struct LocatedDefect {
    /// The defect. Its numbers are those of the file, 0-based.
    #[serde(flatten)]
    pub defect: Defect,
    /// Lines of the faces (or of the vertex) it concerns, 1-based; empty for a binary file.
    pub lines: Vec<u32>,
}

impl std::fmt::Display for LocatedDefect {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        const SHOWN: usize = 4;
        match self.lines.as_slice() {
            [] => {}
            [line] => write!(f, "line {line}: ")?,
            lines => {
                let shown: Vec<String> = lines.iter().take(SHOWN).map(u32::to_string).collect();
                let more = if lines.len() > SHOWN { ", ..." } else { "" };
                write!(f, "lines {}{more}: ", shown.join(", "))?;
            }
        }
        self.defect.fmt(f)
    }
}

/// The first few defects in one line, and the remedy; the whole list stays available to the caller.
fn summary(defects: &[LocatedDefect]) -> String {
    const SHOWN: usize = 3;
    let mut text = defects.iter().take(SHOWN).map(LocatedDefect::to_string).collect::<Vec<_>>().join("; ");
    if defects.len() > SHOWN {
        text += &format!("; and {} more", defects.len() - SHOWN);
    }
    text + "; mend these in the modeller, or import with repair"
}

/// Why a file could not be written.
#[derive(Debug, thiserror::Error)]
pub enum ExportError {
    /// The folder does not exist.
    #[error("{file}: the folder {folder} does not exist; create it first")]
    FolderMissing {
        /// The file.
        file: String,
        /// Its folder.
        folder: String,
    },
    /// The extension names no format that is known.
    #[error("{file}: the format of this file is not known; files end with .obj or .ply")]
    UnknownFormat {
        /// The file.
        file: String,
    },
    /// Writing failed; a file that was there before is as it was.
    #[error("{file}: cannot be written: {source}; check the permissions and the space on the disk")]
    Unwritable {
        /// The file.
        file: String,
        /// What the system said.
        source: io::Error,
    },
    /// There is no memory to put the mesh in order for the file.
    #[error("{file}: {source}")]
    Memory {
        /// The file.
        file: String,
        /// How much was asked for.
        source: OutOfMemory,
    },
}
