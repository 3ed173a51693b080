//! Marks from a JSON file.

use super::resolve::half_edge;
use super::{Course, Curve, Mark, MarkError};
use crate::mesh::Mesh;
use glam::DVec3;
use serde::Deserialize;
use std::path::Path;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    #[serde(default)]
    marks: Vec<Entry>,
    #[serde(default)]
    curves: Vec<CurveEntry>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct CurveEntry {
    points: Vec<[f64; 3]>,
    #[serde(default = "polyline")]
    course: Course,
    #[serde(default)]
    closed: bool,
    kind: Option<String>,
}

fn polyline() -> Course {
    Course::Polyline
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Entry {
    edge: (u32, u32),
    #[serde(default = "middle")]
    t: f64,
    kind: Option<String>,
}

fn middle() -> f64 {
    0.5
}

/// Reads the marks and curves of `path`; entries without a kind get `kind`.
pub(super) fn read(mesh: &Mesh, path: &Path, kind: &str) -> Result<(Vec<Mark>, Vec<Curve>), MarkError> {
    let name = path.display().to_string();
    let text = crate::io::read_text(path)
        .map_err(|error| MarkError::File { path: name.clone(), problem: error.to_string() })?;
    parse(mesh, &name, text.as_bytes(), kind)
}

/// [`read`] for the content of a file. `name` stands for the file in messages.
pub(super) fn parse(
    mesh: &Mesh,
    name: &str,
    text: &[u8],
    kind: &str,
) -> Result<(Vec<Mark>, Vec<Curve>), MarkError> {
    let error = |problem: String| MarkError::File { path: name.to_owned(), problem };
    let file: File = serde_json::from_slice(text).map_err(|e| {
        error(format!(
            "{e}; a mark file is {{\"marks\": [{{\"edge\": [0, 1], \"t\": 0.5, \"kind\": \"red\"}}]}}"
        ))
    })?;
    let curves = file.curves.into_iter().enumerate().map(|(i, entry)| {
        let curve = Curve {
            points: entry.points.into_iter().map(DVec3::from).collect(),
            course: entry.course,
            closed: entry.closed,
            kind: entry.kind.unwrap_or_else(|| kind.to_owned()),
        };
        match curve.problem() {
            Some(problem) => Err(error(format!("curve {i}: {problem}"))),
            None => Ok(curve),
        }
    });
    let curves = curves.collect::<Result<Vec<_>, _>>()?;
    let marks = file
        .marks
        .into_iter()
        .enumerate()
        .map(|(i, entry)| {
            if !(entry.t > 0.0 && entry.t < 1.0) {
                return Err(error(format!(
                    "mark {i}: t is {} but lies between 0 and 1, ends excluded",
                    entry.t
                )));
            }
            let half_edge = half_edge(mesh, entry.edge).map_err(|e| error(format!("mark {i}: {e}")))?;
            let kind = entry.kind.unwrap_or_else(|| kind.to_owned());
            Ok(Mark { half_edge, t: entry.t, kind, breadth: None })
        })
        .collect::<Result<Vec<_>, _>>()?;
    Ok((marks, curves))
}
