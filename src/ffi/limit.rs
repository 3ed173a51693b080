//! The limit surface at the vertices of a mesh and at parameters of its faces.

use super::arguments::{self, Buffer};
use super::boundary::boundary;
use super::error::WeltError;
use super::failure::Failure;
use super::mesh::{WeltMesh, mesh_of};
use crate::mesh::FaceId;
use crate::subdivision::{self, SurfacePoint};
use crate::surface::LimitSurface;
use glam::DVec3;

/// Writes the point of the limit surface that belongs to each vertex. A vertex without a face stays where it is.
///
/// mesh: must not be NULL.
/// positions: receives x, y and z of each point.
/// capacity: room in positions, at least 3 * welt_mesh_vertex_count(mesh) doubles.
///
/// Since: 0.1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welt_mesh_limit_positions(
    mesh: *const WeltMesh,
    positions: *mut f64,
    capacity: usize,
    error: *mut *mut WeltError,
) -> i32 {
    let body = || {
        // SAFETY: the header asks for a living mesh.
        let mesh = unsafe { mesh_of(mesh) }?;
        let needed = 3 * mesh.vertex_bound();
        // SAFETY: the header asks for a buffer of this capacity.
        let buffer = unsafe { Buffer::new(positions, capacity, needed, "positions") }?;
        buffer.fill(subdivision::limit_positions(mesh).iter().flat_map(|p| p.to_array()));
        Ok(())
    };
    // SAFETY: the header asks for NULL or a place for an error.
    unsafe { boundary(error, body) }
}

/// Writes the unit normal of the limit surface at each vertex, outwards; (0, 0, 0) where there is none: at a vertex without
/// a face, and where the surface has no tangent plane.
///
/// mesh: must not be NULL.
/// normals: receives x, y and z of each normal.
/// capacity: room in normals, at least 3 * welt_mesh_vertex_count(mesh) doubles.
///
/// Since: 0.1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welt_mesh_limit_normals(
    mesh: *const WeltMesh,
    normals: *mut f64,
    capacity: usize,
    error: *mut *mut WeltError,
) -> i32 {
    let body = || {
        // SAFETY: the header asks for a living mesh.
        let mesh = unsafe { mesh_of(mesh) }?;
        let needed = 3 * mesh.vertex_bound();
        // SAFETY: the header asks for a buffer of this capacity.
        let buffer = unsafe { Buffer::new(normals, capacity, needed, "normals") }?;
        let points = subdivision::limit_points(mesh);
        buffer.fill(points.iter().flat_map(|point| point.normal().unwrap_or_default().to_array()));
        Ok(())
    };
    // SAFETY: the header asks for NULL or a place for an error.
    unsafe { boundary(error, body) }
}

/// Evaluates the limit surface at parameters of faces.
///
/// mesh: must not be NULL.
/// faces: the face of each point.
/// corners: the patch of each point; NULL for 0 everywhere. A quad has patch 0 only, another face one per corner.
/// parameters: u and v of each point, in [0, 1]; what lies outside is moved to the nearest inside. On a quad (0, 0) is its
/// first corner, u runs along the first edge and v against the last one. On patch c of another face (0, 0) is corner c,
/// (1, 0) the middle of the edge that leaves it, (0, 1) that of the edge that arrives, (1, 1) the face point.
/// count: number of points.
/// values: receives per point the position, the derivatives by u and by v, and those by u twice, by u and v, by v twice: 18
/// doubles. At an extraordinary vertex the first derivatives are tangents of conventional length, and the second ones,
/// which are not defined, are NaN. Where the face is no part of the limit surface (a hole, or by the boundary rule) all
/// are NaN.
/// capacity: room in values, at least 18 * count doubles.
///
/// Fails with WELT_ERROR_ARGUMENT where there is no such face or patch, or a parameter is NaN. Since: 0.1.
#[unsafe(no_mangle)]
#[allow(clippy::too_many_arguments)]
pub unsafe extern "C" fn welt_mesh_evaluate(
    mesh: *const WeltMesh,
    faces: *const u32,
    corners: *const u32,
    parameters: *const f64,
    count: usize,
    values: *mut f64,
    capacity: usize,
    error: *mut *mut WeltError,
) -> i32 {
    let body = || {
        let too_large = || Failure::argument(format!("count is {count}, which is too large"));
        let needed = count.checked_mul(18).ok_or_else(too_large)?;
        // SAFETY: the header asks for a living mesh, arrays of this count and a buffer of this capacity.
        let (mesh, faces, parameters, buffer) = unsafe {
            (
                mesh_of(mesh)?,
                arguments::array(faces, count, "faces")?,
                arguments::array(parameters, 2 * count, "parameters")?,
                Buffer::new(values, capacity, needed, "values")?,
            )
        };
        let corners = if corners.is_null() {
            &[]
        } else {
            // SAFETY: not NULL; the header asks for an array of this count.
            unsafe { arguments::array(corners, count, "corners") }?
        };
        let ids: Vec<FaceId> = faces.iter().map(|&face| FaceId(face)).collect();
        let surface = LimitSurface::around(mesh, &ids);
        let mut found = Vec::with_capacity(count);
        for (i, (&face, uv)) in ids.iter().zip(parameters.chunks_exact(2)).enumerate() {
            let corner = corners.get(i).copied().unwrap_or(0) as usize;
            if !mesh.has_face(face) || face.is_boundary() {
                return Err(Failure::argument(format!("there is no face {}", face.0)));
            }
            let arity = mesh.arity(face);
            if corner >= if arity == 4 { 1 } else { arity } {
                return Err(Failure::argument(format!("face {} has no patch {corner}", face.0)));
            }
            if uv.iter().any(|parameter| parameter.is_nan()) {
                return Err(Failure::argument(format!("a parameter of point {i} is NaN")));
            }
            found.push(jet(surface.evaluate(face, corner, uv[0], uv[1])));
        }
        buffer.fill(found.iter().flatten().flat_map(|vector| vector.to_array()));
        Ok(())
    };
    // SAFETY: the header asks for NULL or a place for an error.
    unsafe { boundary(error, body) }
}

/// Position, first and second derivatives; NaN for what is not defined.
fn jet(point: Option<SurfacePoint>) -> [DVec3; 6] {
    let nowhere = DVec3::NAN;
    point.map_or([nowhere; 6], |point| {
        let [uu, uv, vv] = point.second.map_or([nowhere; 3], |second| [second.uu, second.uv, second.vv]);
        [point.position, point.du, point.dv, uu, uv, vv]
    })
}
