//! Marks: mark files and selectors, resolved and used.

use super::models::sheet;
use welt::feature::{self, Options, Request};
use welt::job::Job;
use welt::mark::{Selection, Selector};

/// A mark file on a small sheet.
pub fn marks(bytes: &[u8]) -> bool {
    let mesh = sheet();
    Selection::from_json(&mesh, "marks.json", bytes).is_ok_and(|selection| groove(&selection))
}

/// Selectors, one per line, on a small sheet. None reads a file here.
pub fn selectors(bytes: &[u8]) -> bool {
    let Ok(text) = std::str::from_utf8(bytes) else { return false };
    if text.contains("select:") || text.lines().count() > 20 {
        return false;
    }
    let mesh = sheet();
    let selectors: Result<Vec<Selector>, _> = text.lines().map(Selector::parse).collect();
    let Ok(selectors) = selectors else { return false };
    Selection::resolve(&mesh, &selectors).is_ok_and(|selection| groove(&selection))
}

/// Applies a groove; the mesh must be valid after it, and as before where it fails.
fn groove(selection: &Selection) -> bool {
    if selection.marks.len() > 40
        || selection.curves.iter().map(|curve| curve.points.len()).sum::<usize>() > 40
    {
        return false;
    }
    let mut mesh = sheet();
    let before = mesh.to_polygons();
    let request = Request::features(&["groove"], &["width=20%", "depth=10%"]).expect("a feature that ships");
    match feature::apply(&mut mesh, selection, &request, &Options::default(), &Job::new()) {
        Ok(_) => {
            mesh.validate_control_mesh().expect("a valid mesh");
            true
        }
        Err(error) => {
            assert!(!error.to_string().is_empty());
            assert!(mesh.to_polygons() == before, "{error}: the mesh was changed");
            false
        }
    }
}
