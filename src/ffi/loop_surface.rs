//! Loop subdivision of triangle meshes.

use super::arguments::{Buffer, Output, RowBuffer};
use super::boundary::boundary;
use super::error::WeltError;
use super::evaluate::{Points, WeltBatchOptions, order};
use super::failure::{Failure, Location, Place};
use super::mesh::{WeltMesh, mesh_of};
use super::options;
use super::status::WELT_ERROR_MESH;
use crate::fault;
use crate::mesh::Mesh;
use crate::subdivision::{LimitPoint, LoopSurface, NotTriangles, SurfacePoint};
use crate::surface::Parameter;
use crate::threads::in_ranges;
use glam::DVec3;

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

/// Evaluates the Loop limit surface of a triangle mesh at parameters of faces.
///
/// mesh: must not be NULL.
/// faces: the face of each point.
/// parameters: u and v of each point, the weights of the second and the third corner: u >= 0, v >= 0, u + v <= 1; what lies
/// outside is moved inside.
/// count: number of points.
/// derivatives: up to which order, 0 to 2.
/// options: threads and strides; NULL for the defaults.
/// values: receives per point what welt_surface_evaluate writes.
/// capacity: room in values, in doubles up to the end of the last point.
///
/// Fails with WELT_ERROR_MESH where a face of the mesh is no triangle, and with WELT_ERROR_ARGUMENT where a face does not
/// exist or a parameter is NaN. Since: 0.1.
#[unsafe(no_mangle)]
#[allow(clippy::too_many_arguments)]
pub unsafe extern "C" fn welt_mesh_loop_evaluate(
    mesh: *const WeltMesh,
    faces: *const u32,
    parameters: *const f64,
    count: usize,
    derivatives: u32,
    options: *const WeltBatchOptions,
    values: *mut f64,
    capacity: usize,
    error: *mut *mut WeltError,
) -> i32 {
    let body = || {
        let width = order(derivatives)?.values();
        // SAFETY: the header asks for a living mesh, initialised options or NULL, and arrays and a buffer of these sizes.
        let (mesh, options, points, buffer) = unsafe {
            let mesh = mesh_of(mesh)?;
            let options = options::complete(options)?;
            let points = Points::new(faces, std::ptr::null(), parameters, count, options.input_stride)?;
            let rows = [count, width, options.output_stride];
            (mesh, options, points, RowBuffer::new(values, capacity, rows, "values")?)
        };
        let surface = LoopSurface::new(mesh)?;
        points.check(|face, _| {
            let missing = face.is_boundary() || !mesh.has_face(face);
            missing.then(|| format!("face {} does not exist", face.0))
        })?;
        in_ranges(count, options.threads as usize, 64, |range| {
            for i in range {
                fault::point("evaluate");
                let Parameter { face, u, v, .. } = points.get(i);
                // SAFETY: ranges have no row in common.
                unsafe { buffer.write(i, &numbers(surface.evaluate(face, u, v))[..width]) };
            }
        });
        Ok(())
    };
    // SAFETY: the header asks for NULL or a place for an error.
    unsafe { boundary(error, body) }
}

/// Position, first and second derivatives; NaN for what is not defined.
fn numbers(point: Option<SurfacePoint>) -> [f64; 18] {
    let mut numbers = [f64::NAN; 18];
    if let Some(SurfacePoint { position, du, dv, second, .. }) = point {
        let [uu, uv, vv] = second.map_or([DVec3::NAN; 3], |second| [second.uu, second.uv, second.vv]);
        let vectors = [position, du, dv, uu, uv, vv];
        numbers.iter_mut().zip(vectors.iter().flat_map(|v| v.to_array())).for_each(|(slot, x)| *slot = x);
    }
    numbers
}
