//! Files of polygons.

use welt::io::{self, Format, ImportOptions, Limits};
use welt::mesh::Mesh;
use welt::subdivision::limit_points;
use welt::surface::{ClosestOptions, LimitSurface};

/// A Wavefront OBJ file.
pub fn obj(bytes: &[u8]) -> bool {
    read(Format::Obj, bytes)
}

/// A PLY file.
pub fn ply(bytes: &[u8]) -> bool {
    read(Format::Ply, bytes)
}

/// The last byte says how the rest is read: repaired or not, welded or not.
fn read(format: Format, bytes: &[u8]) -> bool {
    let Some((how, content)) = bytes.split_last() else { return false };
    let weld = [None, Some(0.0), Some(0.3), Some(f64::NAN)][usize::from(how >> 1 & 3)];
    let options = ImportOptions { repair: how & 1 == 1, weld, limits: Limits::default() };
    let Ok(source) = io::read_bytes("soup", format, content, &options) else { return false };
    let inspection = io::inspect(&source);
    let report = source.report.to_string();
    match source.build() {
        Ok(import) => {
            import.mesh.validate_control_mesh().expect("an accepted mesh is valid");
            assert!(inspection.is_clean(), "{inspection}");
            limit(&import.mesh);
            true
        }
        Err(error) => {
            assert!(!inspection.is_clean());
            assert!(!options.repair, "repair left {error}\n{report}");
            false
        }
    }
}

/// What becomes of any coordinates on the way to the limit surface: no panic, no endless search.
fn limit(mesh: &Mesh) {
    if mesh.vertex_bound() > 100 {
        return;
    }
    let points = limit_points(mesh);
    let surface = LimitSurface::new(mesh);
    if let Some(point) = points.first() {
        let _ = surface.closest(point.position, &ClosestOptions::default());
        let _ = surface.line_hits(point.position, glam::DVec3::new(0.1, 0.2, 1.0));
    }
}
