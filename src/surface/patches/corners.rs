//! Extraordinary vertices: all patches at one share its tangent plane.

use super::cells::Cell;
use super::pieces::corner_of;
use super::regions::Region;
use super::spline::SplinePatch;
use crate::surface::LimitSurface;
use glam::DVec3;

/// The normals of the limit surface at the corners that are extraordinary vertices; `None` elsewhere and where it has none.
pub(super) fn normals(surface: &LimitSurface, cells: &[Cell], region: &Region) -> [Option<DVec3>; 4] {
    std::array::from_fn(|corner| {
        let (patch, at) = region.irregular[corner].then(|| corner_of(cells, region, corner))?;
        let point = surface.evaluate_patch(patch, at.x, at.y);
        point.du.cross(point.dv).try_normalize()
    })
}

/// Moves the poles beside extraordinary corners along the sides into the tangent plane there.
pub(super) fn flatten(patch: &mut SplinePatch, normals: [Option<DVec3>; 4]) {
    for (corner, normal) in normals.into_iter().enumerate() {
        let Some(normal) = normal else { continue };
        let (ends, begins) = (patch.side_poles(corner + 3), patch.side_poles(corner));
        let ([.., before, origin], [_, next, ..]) = (&ends[..], &begins[..]) else { continue };
        let origin = *origin;
        for &pole in [next, before] {
            let height = (patch.poles[pole] - patch.poles[origin]).dot(normal);
            patch.poles[pole] -= height * normal;
        }
    }
}
