//! What a file holds, before it becomes a mesh: polygons, and the line each vertex and face came from.

use super::error::{ImportError, LocatedDefect};
use super::report::{IgnoredKind, ImportReport};
use super::{Import, ImportOptions, repair};
use crate::memory::OutOfMemory;
use crate::mesh::{Defect, Defects, Mesh, Polygons};

/// The polygons of a file with what is needed to speak about them: name, lines, report.
#[derive(Clone, PartialEq, Debug)]
pub struct Source {
    /// Name of the file, for messages.
    pub name: String,
    /// The polygons, after the repairs that were asked for.
    pub polygons: Polygons,
    /// What was left out and what was changed.
    pub report: ImportReport,
    pub(super) lines: Lines,
    /// The number in the file of each vertex and face; empty while they are numbered as in the file.
    pub(super) file_vertices: Vec<u32>,
    pub(super) file_faces: Vec<u32>,
}

/// Lines of the statements of a text file, 1-based; empty for a binary file.
#[derive(Clone, PartialEq, Eq, Default, Debug)]
pub(super) struct Lines {
    pub(super) vertices: Vec<u32>,
    pub(super) faces: Vec<u32>,
    pub(super) creases: Vec<u32>,
}

impl From<&Mesh> for Source {
    /// The polygons of a mesh, as if they had been read from a file without a name.
    fn from(mesh: &Mesh) -> Self {
        Self::new("mesh", mesh.to_polygons(), ImportReport::default(), Lines::default())
    }
}

impl Source {
    pub(super) fn new(name: &str, polygons: Polygons, report: ImportReport, lines: Lines) -> Self {
        let name = name.to_string();
        Self { name, polygons, report, lines, file_vertices: Vec::new(), file_faces: Vec::new() }
    }

    /// The number that `vertex` has in the file. Vertices made by a repair have that of the vertex they come from.
    pub fn file_vertex(&self, vertex: u32) -> u32 {
        self.file_vertices.get(vertex as usize).copied().unwrap_or(vertex)
    }

    /// The number that `face` has in the file.
    pub fn file_face(&self, face: u32) -> u32 {
        self.file_faces.get(face as usize).copied().unwrap_or(face)
    }

    /// Welds and repairs as `options` ask.
    pub(super) fn mend(&mut self, options: &ImportOptions) -> Result<(), ImportError> {
        if let Some(distance) = options.weld {
            repair::weld(self, distance)?;
        }
        if options.repair {
            repair::repair(self);
        }
        Ok(())
    }

    /// Builds the mesh.
    ///
    /// # Errors
    /// [`ImportError::Defects`] with everything that keeps the polygons from being a mesh.
    pub fn build(mut self) -> Result<Import, ImportError> {
        match Mesh::from_polygons(&self.polygons) {
            Ok(mesh) => {
                self.report_lost_creases(&mesh);
                Ok(Import { mesh, report: self.report })
            }
            Err(defects) => Err(match defects.0[..] {
                [Defect::NoMemory { bytes }] => {
                    ImportError::Memory { source: OutOfMemory { bytes }, file: self.name }
                }
                _ => ImportError::Defects { defects: self.locate(defects), file: self.name },
            }),
        }
    }

    fn report_lost_creases(&mut self, mesh: &Mesh) {
        let ends: Vec<(u32, u32)> = self.polygons.creases.iter().map(|&(a, b, _)| (a, b)).collect();
        for (i, edge) in mesh.find_edges(&ends).into_iter().enumerate() {
            if edge.is_none() {
                let (a, b) = ends[i];
                let line = self.lines.creases.get(i).copied().unwrap_or(0);
                self.report.ignore(IgnoredKind::CreasesWithoutEdge, line, || format!("{a} {b}"));
            }
        }
    }

    /// The defects in the numbers and lines of the file.
    pub fn locate(&self, defects: Defects) -> Vec<LocatedDefect> {
        defects.0.into_iter().map(|defect| self.locate_one(defect)).collect()
    }

    fn locate_one(&self, defect: Defect) -> LocatedDefect {
        let mut faces = Vec::new();
        let mut lines = Vec::new();
        let defect = defect.renumbered(
            |v| self.file_vertex(v),
            |f| {
                faces.push(self.file_face(f));
                self.file_face(f)
            },
        );
        lines.extend(faces.iter().filter_map(|&face| self.lines.faces.get(face as usize)));
        if let Defect::NotFinite { vertex } | Defect::SeparateFans { vertex, .. } = &defect {
            lines.extend(self.lines.vertices.get(*vertex as usize));
        }
        LocatedDefect { defect, lines }
    }
}
