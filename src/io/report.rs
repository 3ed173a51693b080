//! What an import left out and what it changed.

use serde::Serialize;
use std::fmt;

/// A kind of statement or datum that a file holds and a control mesh does not.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum IgnoredKind {
    /// Normals (`vn`): those of the limit surface replace them.
    Normals,
    /// Colours behind the coordinates of a vertex.
    VertexColours,
    /// A weight other than 1 behind the coordinates of a vertex.
    VertexWeights,
    /// Numbers that are neither coordinates, weight nor colour.
    ExtraNumbers,
    /// The third texture coordinate, where it is not 0.
    ThirdTextureCoordinate,
    /// Corners that name a texture coordinate which is not in the file.
    MissingTextureCoordinate,
    /// Faces with a texture coordinate at some of their corners only: they lose it.
    PartialTextureCoordinates,
    /// Texture coordinates in a file in which no face keeps any.
    UnusedTextureCoordinates,
    /// Points (`p`).
    Points,
    /// Lines (`l`).
    Lines,
    /// Curves and free-form surfaces.
    FreeFormGeometry,
    /// Statements about display, levels of detail and merging.
    DisplaySettings,
    /// `t` tags that have no meaning here: hierarchical edits, face-varying rules and others.
    Tags,
    /// Creases between vertices that share no edge.
    CreasesWithoutEdge,
    /// Group, object, material and smoothing statements with no face after them.
    NamesWithoutFaces,
    /// Names that are not UTF-8: read with replacement characters.
    NamesNotUtf8,
    /// Statements whose keyword the OBJ format does not have.
    UnknownKeywords,
    /// Elements of a PLY file other than vertices and faces.
    PlyElements,
    /// Properties of a PLY file other than positions and face vertices.
    PlyProperties,
}

impl IgnoredKind {
    fn words(self) -> &'static str {
        match self {
            Self::Normals => "normals",
            Self::VertexColours => "vertex colours",
            Self::VertexWeights => "vertex weights",
            Self::ExtraNumbers => "vertices with extra numbers",
            Self::ThirdTextureCoordinate => "third texture coordinates",
            Self::MissingTextureCoordinate => "references to missing texture coordinates",
            Self::PartialTextureCoordinates => "faces with texture coordinates at some corners only",
            Self::UnusedTextureCoordinates => "texture coordinates that no face keeps",
            Self::Points => "point statements",
            Self::Lines => "line statements",
            Self::FreeFormGeometry => "curve and surface statements",
            Self::DisplaySettings => "display statements",
            Self::Tags => "tags of kinds that are not used",
            Self::CreasesWithoutEdge => "creases between vertices without an edge",
            Self::NamesWithoutFaces => "group, object, material or smoothing statements without faces",
            Self::NamesNotUtf8 => "names that are not UTF-8 (replaced in part)",
            Self::UnknownKeywords => "statements with an unknown keyword",
            Self::PlyElements => "PLY elements",
            Self::PlyProperties => "PLY properties",
        }
    }
}

/// How often a kind of datum was ignored, and where first.
#[derive(Clone, PartialEq, Eq, Debug, Serialize)]
pub struct Ignored {
    /// What.
    pub kind: IgnoredKind,
    /// How often.
    pub count: u64,
    /// Line of the first one, 1-based.
    pub first_line: u32,
    /// The first one's keyword or name.
    pub example: String,
}

/// A change that made the mesh fit for the kernel. Numbers of faces, and of vertices unless said otherwise, are
/// those of the file, 0-based.
#[derive(Clone, PartialEq, Eq, Debug, Serialize)]
#[serde(rename_all = "kebab-case", tag = "kind")]
pub enum Repair {
    /// A vertex was merged into another one at the same place.
    VertexWelded {
        /// The vertex that is gone.
        vertex: u32,
        /// The vertex that stands for it.
        into: u32,
    },
    /// A face named a vertex several times in a row and keeps it once.
    RepetitionRemoved {
        /// The face.
        face: u32,
        /// The vertex.
        vertex: u32,
    },
    /// A face with fewer than three different vertices, or one that meets a vertex twice, is gone.
    FaceRemoved {
        /// The face.
        face: u32,
    },
    /// The vertex order of a face was reversed, so that it agrees with its neighbours.
    FaceFlipped {
        /// The face.
        face: u32,
    },
    /// The faces of an edge were taken apart because there were more than two.
    EdgeCut {
        /// The edge's vertices.
        edge: (u32, u32),
        /// Its faces.
        faces: Vec<u32>,
    },
    /// Two faces were taken apart at their edge because the surface has only one side there (a Moebius strip).
    OneSidedEdgeCut {
        /// The edge's vertices.
        edge: (u32, u32),
        /// Its faces.
        faces: (u32, u32),
    },
    /// Fans of faces that met in a vertex got a vertex each.
    VertexSplit {
        /// The vertex, which the first fan keeps.
        vertex: u32,
        /// The new vertices of the other fans, in the numbers of the result.
        copies: Vec<u32>,
    },
}

impl fmt::Display for Repair {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::VertexWelded { vertex, into } => write!(f, "vertex {vertex} was welded into vertex {into}"),
            Self::RepetitionRemoved { face, vertex } => {
                write!(f, "face {face} named vertex {vertex} several times in a row; once is kept")
            }
            Self::FaceRemoved { face } => write!(f, "face {face} was removed: it encloses no area"),
            Self::FaceFlipped { face } => write!(f, "face {face} was turned round"),
            Self::EdgeCut { edge, faces } => {
                write!(f, "the {} faces of edge {}-{} were taken apart", faces.len(), edge.0, edge.1)
            }
            Self::OneSidedEdgeCut { edge, faces } => write!(
                f,
                "the surface has one side only; it was cut between faces {} and {} at edge {}-{}",
                faces.0, faces.1, edge.0, edge.1
            ),
            Self::VertexSplit { vertex, copies } => {
                let copies: Vec<String> = copies.iter().map(u32::to_string).collect();
                write!(f, "vertex {vertex} was split; new vertices {}", copies.join(", "))
            }
        }
    }
}

/// What an import left out and what it changed; empty for a file that was taken over whole.
#[derive(Clone, PartialEq, Eq, Default, Debug, Serialize)]
pub struct ImportReport {
    /// What the file holds and the mesh does not, one entry per kind.
    pub ignored: Vec<Ignored>,
    /// What was changed on request.
    pub repairs: Vec<Repair>,
}

impl ImportReport {
    /// Counts one more datum of `kind`.
    pub(super) fn ignore(&mut self, kind: IgnoredKind, line: u32, example: impl FnOnce() -> String) {
        match self.ignored.iter_mut().find(|entry| entry.kind == kind) {
            Some(entry) => entry.count += 1,
            None => self.ignored.push(Ignored { kind, count: 1, first_line: line, example: example() }),
        }
    }

    /// Notes a kind that is counted as a whole.
    pub(super) fn ignore_all(&mut self, ignored: Ignored) {
        self.ignored.push(ignored);
    }

    /// How often `kind` was ignored.
    pub fn count(&self, kind: IgnoredKind) -> u64 {
        self.ignored.iter().find(|entry| entry.kind == kind).map_or(0, |entry| entry.count)
    }
}

impl fmt::Display for ImportReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for Ignored { kind, count, first_line, example } in &self.ignored {
            writeln!(f, "ignored: {count} {} (first: '{example}' in line {first_line})", kind.words())?;
        }
        for repair in &self.repairs {
            writeln!(f, "repaired: {repair}")?;
        }
        Ok(())
    }
}
