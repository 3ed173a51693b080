//! Marks from a JSON file.

use super::resolve::half_edge;
use super::{Mark, MarkError};
use crate::mesh::Mesh;
use serde::Deserialize;
use std::io::Read;
use std::path::Path;

/// Size that a mark file can have, in bytes.
const MAX_BYTES: u64 = 64 << 20;

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
    let mut text = Vec::new();
    let read = std::fs::File::open(path).and_then(|file| file.take(MAX_BYTES + 1).read_to_end(&mut text));
    let length = read.map_err(|e| error(e.to_string()))?;
    if length as u64 > MAX_BYTES {
        return Err(error(format!("the file is larger than {} MiB; is it a mark file?", MAX_BYTES >> 20)));
    }
    let file: File = serde_json::from_slice(&text).map_err(|e| {
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
