//! Loop subdivision of triangle meshes.

use super::arguments::{Buffer, Output};
use super::boundary::boundary;
use super::error::WeltError;
use super::failure::{Failure, Location, Place};
use super::mesh::{WeltMesh, mesh_of};
use super::status::WELT_ERROR_MESH;
use crate::mesh::Mesh;
use crate::subdivision::{LimitPoint, LoopSurface, NotTriangles};

impl From<NotTriangles> for Failure {
    fn from(error: NotTriangles) -> Self {
        let message = error.to_string();
        let place = Place { location: Location::Face(error.face), message: message.clone(), text: None };
        Self { code: WELT_ERROR_MESH, message, places: vec![place] }
    }
}

/// Refines a triangle mesh by Loop's rules, with its sharpness and options.
///
/// mesh: must not be NULL.
/// levels: how often; each time one triangle becomes four.
/// refined: receives the last level, another control mesh of the same surface: it has the sharpness that is left, and holes
/// where the mesh has no surface. Free it with welt_mesh_free.
///
/// At each step the vertices are those of the vertices, then those of the edges in the order of welt_mesh_edges; faces 4 f to
/// 4 f + 2 lie at the corners of face f, and 4 f + 3 is the one in its middle. Fails with WELT_ERROR_MESH where a face is
/// no triangle and with WELT_ERROR_TOO_LARGE. Since: 0.1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welt_mesh_refine_loop(
    mesh: *const WeltMesh,
    levels: u32,
    refined: *mut *mut WeltMesh,
    error: *mut *mut WeltError,
) -> i32 {
    let body = || {
        // SAFETY: the header asks for a living mesh and a place for the handle.
        let (mesh, output) = unsafe { (mesh_of(mesh)?, Output::new(refined, "refined")?) };
        let polygons = LoopSurface::new(mesh)?.refine_levels(levels as usize)?;
        output.handle(WeltMesh::new(Mesh::from_polygons(&polygons)?));
        Ok(())
    };
    // SAFETY: the header asks for NULL or a place for an error.
    unsafe { boundary(error, body) }
}

/// Writes the point and the unit normal of the Loop limit surface at each vertex of a triangle mesh.
///
/// mesh: must not be NULL.
/// positions: receives x, y and z of each point.
/// normals: receives x, y and z of each normal, outwards; (0, 0, 0) where there is none. NULL where they are not wanted.
/// capacity: room in each of both, at least 3 * welt_mesh_vertex_count(mesh) doubles.
///
/// Fails with WELT_ERROR_MESH where a face is no triangle. Since: 0.1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welt_mesh_loop_limit(
    mesh: *const WeltMesh,
    positions: *mut f64,
    normals: *mut f64,
    capacity: usize,
    error: *mut *mut WeltError,
) -> i32 {
    let body = || {
        // SAFETY: the header asks for a living mesh.
        let mesh = unsafe { mesh_of(mesh) }?;
        let surface = LoopSurface::new(mesh)?;
        let needed = 3 * mesh.vertex_bound();
        // SAFETY: the header asks for buffers of this capacity.
        let buffer = unsafe { Buffer::new(positions, capacity, needed, "positions") }?;
        let normal_buffer = if normals.is_null() {
            None
        } else {
            // SAFETY: as above.
            Some(unsafe { Buffer::new(normals, capacity, needed, "normals") }?)
        };
        let points: Vec<LimitPoint> = mesh.vertices().map(|v| surface.limit_point(v)).collect();
        buffer.fill(points.iter().flat_map(|point| point.position.to_array()));
        if let Some(buffer) = normal_buffer {
            buffer.fill(points.iter().flat_map(|point| point.normal().unwrap_or_default().to_array()));
        }
        Ok(())
    };
    // SAFETY: the header asks for NULL or a place for an error.
    unsafe { boundary(error, body) }
}
