//! Marks from a JSON file.

use super::resolve::half_edge;
use super::{Mark, MarkError};
use crate::mesh::Mesh;
use serde::Deserialize;
use std::path::Path;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    marks: Vec<Entry>,
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

/// Reads the marks of `path`; entries without a kind get `kind`.
pub(super) fn read(mesh: &Mesh, path: &Path, kind: &str) -> Result<Vec<Mark>, MarkError> {
    let error = |problem: String| MarkError::File { path: path.display().to_string(), problem };
    let text = std::fs::read_to_string(path).map_err(|e| error(e.to_string()))?;
    let file: File = serde_json::from_str(&text).map_err(|e| {
        error(format!(
            "{e}; a mark file is {{\"marks\": [{{\"edge\": [0, 1], \"t\": 0.5, \"kind\": \"red\"}}]}}"
        ))
    })?;
    file.marks
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
            Ok(Mark { half_edge, t: entry.t, kind: entry.kind.unwrap_or_else(|| kind.to_owned()) })
        })
        .collect()
}
