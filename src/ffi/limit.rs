//! The limit surface at the vertices of a mesh.

use super::arguments::RowBuffer;
use super::boundary::boundary;
use super::error::WeltError;
use super::mesh::{WeltMesh, mesh_of};
use crate::subdivision::{each_limit_point, each_limit_position};

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
        // SAFETY: the header asks for a buffer of this capacity.
        let buffer =
            unsafe { RowBuffer::new(positions, capacity, [mesh.vertex_bound(), 3, 0], "positions") }?;
        for (i, position) in each_limit_position(mesh).enumerate() {
            // SAFETY: there is one thread.
            unsafe { buffer.write(i, &position.to_array()) };
        }
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
        // SAFETY: the header asks for a buffer of this capacity.
        let buffer = unsafe { RowBuffer::new(normals, capacity, [mesh.vertex_bound(), 3, 0], "normals") }?;
        for (i, point) in each_limit_point(mesh).enumerate() {
            // SAFETY: there is one thread.
            unsafe { buffer.write(i, &point.normal().unwrap_or_default().to_array()) };
        }
        Ok(())
    };
    // SAFETY: the header asks for NULL or a place for an error.
    unsafe { boundary(error, body) }
}
