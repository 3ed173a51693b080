//! Why a call failed, before it becomes an error handle.

use super::status::*;
use crate::feature::{FeatureError, LeftoverMark, ProfileError, RequestError, WidthError};
use crate::gml::Diagnostic;
use crate::grammar::{RulesError, RunError};
use crate::io::{Excess, ExportError, ImportError};
use crate::job::Cancelled;
use crate::mark::{MarkError, SelectorError};
use crate::memory::OutOfMemory;
use crate::mesh::{Defect, Defects};
use crate::subdivision::RefineError;
use crate::surface::FreezeError;

/// What an error handle is made of.
#[derive(Debug)]
pub(super) struct Failure {
    pub(super) code: i32,
    pub(super) message: String,
    pub(super) places: Vec<Place>,
}

/// One place that an error speaks of, and what is wrong there.
#[derive(Debug)]
pub(super) struct Place {
    pub(super) location: Location,
    pub(super) message: String,
    /// Where the text of a file, if it comes from one, speaks of it.
    pub(super) text: Option<TextPlace>,
}

/// A place in a text. Line and column are 1-based, the column in bytes; 0 where there is none.
#[derive(Clone, Debug)]
pub(super) struct TextPlace {
    pub(super) file: String,
    pub(super) line: u32,
    pub(super) column: u32,
}

/// Where a place is. Numbers of elements are 0-based.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Location {
    Whole,
    Vertex(u32),
    /// An edge by its two vertices.
    Edge(u32, u32),
    Face(u32),
}

impl Failure {
    pub(super) fn new(code: i32, message: impl Into<String>) -> Self {
        Self { code, message: message.into(), places: Vec::new() }
    }

    pub(super) fn argument(message: impl Into<String>) -> Self {
        Self::new(WELT_ERROR_ARGUMENT, message)
    }
}

impl Place {
    pub(super) fn vertex(vertex: u32, message: impl Into<String>) -> Self {
        Self { location: Location::Vertex(vertex), message: message.into(), text: None }
    }

    /// An edge, by its vertices.
    pub(super) fn edge(edge: (u32, u32), message: impl Into<String>) -> Self {
        Self { location: Location::Edge(edge.0, edge.1), message: message.into(), text: None }
    }
}

impl From<&Defect> for Place {
    fn from(defect: &Defect) -> Self {
        let location = match *defect {
            Defect::SizeMismatch { .. } | Defect::TooLarge { .. } | Defect::NoMemory { .. } => {
                Location::Whole
            }
            Defect::TooFewVertices { face, .. }
            | Defect::VertexOutOfRange { face, .. }
            | Defect::RepeatedVertex { face, .. } => Location::Face(face),
            Defect::NotFinite { vertex } | Defect::SeparateFans { vertex, .. } => Location::Vertex(vertex),
            Defect::EdgeWithManyFaces { edge, .. } | Defect::InconsistentOrientation { edge, .. } => {
                Location::Edge(edge.0, edge.1)
            }
        };
        Self { location, message: defect.to_string(), text: None }
    }
}

impl From<Defects> for Failure {
    fn from(defects: Defects) -> Self {
        let code = match defects.0.as_slice() {
            [Defect::TooLarge { .. }] => WELT_ERROR_TOO_LARGE,
            [Defect::NoMemory { .. }] => WELT_ERROR_MEMORY,
            [Defect::SizeMismatch { .. }] => WELT_ERROR_ARGUMENT,
            _ => WELT_ERROR_MESH,
        };
        Self { code, message: defects.to_string(), places: defects.0.iter().map(Place::from).collect() }
    }
}

impl From<Excess> for Failure {
    fn from(excess: Excess) -> Self {
        let message = excess.to_string();
        let location = match excess {
            Excess::Memory(error) => return error.into(),
            Excess::Whole { .. } => Location::Whole,
            Excess::Arity { face, .. } => Location::Face(face),
            Excess::Valence { vertex, .. } => Location::Vertex(vertex),
        };
        let places = vec![Place { location, message: message.clone(), text: None }];
        Self { code: WELT_ERROR_TOO_LARGE, message, places }
    }
}

impl From<ImportError> for Failure {
    fn from(error: ImportError) -> Self {
        let message = error.to_string();
        match error {
            ImportError::Unreadable { .. } | ImportError::UnknownFormat { .. } => {
                Self::new(WELT_ERROR_FILE, message)
            }
            ImportError::Memory { .. } => Self::new(WELT_ERROR_MEMORY, message),
            ImportError::WeldDistance { .. } => Self::argument(message),
            ImportError::Text { file, line, column, message: what, .. } => {
                let text = Some(TextPlace { file, line, column });
                let places = vec![Place { location: Location::Whole, message: what, text }];
                Self { code: WELT_ERROR_SYNTAX, message, places }
            }
            ImportError::Binary { file, message: what, .. } => {
                let text = Some(TextPlace { file, line: 0, column: 0 });
                let places = vec![Place { location: Location::Whole, message: what, text }];
                Self { code: WELT_ERROR_SYNTAX, message, places }
            }
            ImportError::Excess { excess, .. } => Self { message, ..Self::from(excess) },
            ImportError::Defects { file, defects } => {
                let place = |located: &crate::io::LocatedDefect| {
                    let line = located.lines.first().copied().unwrap_or(0);
                    let text = Some(TextPlace { file: file.clone(), line, column: 0 });
                    Place { text, ..Place::from(&located.defect) }
                };
                Self { code: WELT_ERROR_MESH, message, places: defects.iter().map(place).collect() }
            }
        }
    }
}

impl From<ExportError> for Failure {
    fn from(error: ExportError) -> Self {
        let code = match error {
            ExportError::Memory { .. } => WELT_ERROR_MEMORY,
            ExportError::FolderMissing { .. }
            | ExportError::UnknownFormat { .. }
            | ExportError::Unwritable { .. } => WELT_ERROR_FILE,
        };
        Self::new(code, error.to_string())
    }
}

impl From<RefineError> for Failure {
    fn from(error: RefineError) -> Self {
        let code = match error {
            RefineError::Memory(_) => WELT_ERROR_MEMORY,
            RefineError::TooLarge { .. } | RefineError::TooDeep { .. } => WELT_ERROR_TOO_LARGE,
        };
        Self::new(code, error.to_string())
    }
}

impl From<OutOfMemory> for Failure {
    fn from(error: OutOfMemory) -> Self {
        Self::new(WELT_ERROR_MEMORY, error.to_string())
    }
}

impl From<FreezeError> for Failure {
    fn from(error: FreezeError) -> Self {
        match error {
            FreezeError::Cancelled(cancelled) => cancelled.into(),
            FreezeError::Memory(error) => error.into(),
        }
    }
}

impl From<Cancelled> for Failure {
    fn from(cancelled: Cancelled) -> Self {
        Self::new(WELT_ERROR_CANCELLED, cancelled.to_string())
    }
}

impl From<ProfileError> for Failure {
    fn from(error: ProfileError) -> Self {
        let code = match error {
            ProfileError::Unknown { .. } => WELT_ERROR_ARGUMENT,
            ProfileError::File { .. } => WELT_ERROR_FILE,
        };
        Self::new(code, error.to_string())
    }
}

impl From<RequestError> for Failure {
    fn from(error: RequestError) -> Self {
        match error {
            RequestError::Profile(error) => error.into(),
            RequestError::Rules(error) => error.into(),
            RequestError::Setting(_) | RequestError::KindTwice { .. } => Self::argument(error.to_string()),
        }
    }
}

impl From<SelectorError> for Failure {
    fn from(error: SelectorError) -> Self {
        Self::argument(error.to_string())
    }
}

impl From<MarkError> for Failure {
    fn from(error: MarkError) -> Self {
        let code =
            if matches!(error, MarkError::File { .. }) { WELT_ERROR_FILE } else { WELT_ERROR_ARGUMENT };
        Self::new(code, error.to_string())
    }
}

impl From<&Diagnostic> for Place {
    fn from(diagnostic: &Diagnostic) -> Self {
        let text = Some(TextPlace {
            file: diagnostic.file.clone(),
            line: u32::try_from(diagnostic.line).unwrap_or(0),
            column: u32::try_from(diagnostic.column).unwrap_or(0),
        });
        Self { location: Location::Whole, message: diagnostic.message.clone(), text }
    }
}

impl From<RulesError> for Failure {
    fn from(error: RulesError) -> Self {
        let places: Vec<Place> = error.diagnostics.iter().map(Place::from).collect();
        let message = match places.as_slice() {
            [only] => only.message.clone(),
            [first, _] => format!("{}; and 1 more mistake", first.message),
            [first, ..] => format!("{}; and {} more mistakes", first.message, places.len() - 1),
            [] => String::new(),
        };
        if error.unreadable {
            return Self::new(WELT_ERROR_FILE, message);
        }
        Self { code: WELT_ERROR_SYNTAX, message, places }
    }
}

impl From<RunError> for Failure {
    fn from(error: RunError) -> Self {
        let message = error.to_string();
        match error {
            RunError::UnknownParameter { .. }
            | RunError::ParameterOutOfRange { .. }
            | RunError::Replay { .. } => Self::argument(message),
            RunError::Cancelled(cancelled) => cancelled.into(),
            RunError::Script { diagnostic, .. }
            | RunError::Runaway { diagnostic, .. }
            | RunError::BrokenFace { diagnostic, .. } => {
                Self { code: WELT_ERROR_RULE, message, places: vec![Place::from(&*diagnostic)] }
            }
        }
    }
}

impl From<FeatureError> for Failure {
    fn from(error: FeatureError) -> Self {
        let message = error.to_string();
        match error {
            FeatureError::Width(WidthError { edge, .. }) | FeatureError::UnknownKind { edge, .. } => {
                Self { places: vec![Place::edge(edge, message.clone())], ..Self::argument(message) }
            }
            FeatureError::OpenLoop { ends, .. } => {
                let places = ends.into_iter().map(|edge| Place::edge(edge, message.clone())).collect();
                Self { places, ..Self::argument(message) }
            }
            FeatureError::Unresolved { leftovers } => {
                let marks = leftovers.iter().flat_map(|leftover| &leftover.marks);
                let place = |mark: &LeftoverMark| {
                    Place::edge(mark.edge, format!("no rule handles the mark #{}", mark.kind))
                };
                Self { code: WELT_ERROR_RULE, message, places: marks.map(place).collect() }
            }
            FeatureError::Rules(error) => error.into(),
            FeatureError::Cancelled(cancelled) => cancelled.into(),
            FeatureError::Memory(error) => error.into(),
            _ => Self::argument(message),
        }
    }
}
