//! `welt_surface`.

use super::arguments::{self, Output, RowBuffer};
use super::boundary::boundary;
use super::error::WeltError;
use super::evaluate::{Points, missing_patch};
use super::failure::Failure;
use super::feature::method;
use super::job::WeltJob;
use super::mesh::{WeltMesh, mesh_of};
use super::report::{WeltReport, hand_over};
use crate::fault;
use crate::job::Job;
use crate::mesh::{FaceId, Mesh, VertexId};
use crate::optimise::{self, Target};
use crate::subdivision::SurfacePoint;
use crate::surface::Parameter;

/// A limit surface, frozen: it stays as it is when its mesh changes. Never changes.
pub struct WeltSurface {
    pub(super) target: Target,
}

/// Freezes the limit surface of a mesh.
///
/// mesh: must not be NULL.
/// faces: the faces whose surface is frozen, 0-based; NULL for all. Cost follows their number.
/// count: number of faces; 0 where faces is NULL.
/// job: may be NULL.
/// surface: receives the handle; free it with welt_surface_free.
///
/// Fails with WELT_ERROR_ARGUMENT where a face does not exist, and with WELT_ERROR_CANCELLED. Since: 0.1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welt_surface_create(
    mesh: *const WeltMesh,
    faces: *const u32,
    count: usize,
    job: *const WeltJob,
    surface: *mut *mut WeltSurface,
    error: *mut *mut WeltError,
) -> i32 {
    let body = || {
        // SAFETY: the header asks for a living mesh, an array of this count, a job or NULL and a place for the handle.
        let (mesh, job, output) =
            unsafe { (mesh_of(mesh)?, arguments::optional(job, "job")?, Output::new(surface, "surface")?) };
        // SAFETY: as above.
        let faces = unsafe { faces_of(mesh, faces, count) }?;
        let idle = Job::new();
        let job = job.map_or(&idle, |job| &job.job);
        output.handle(WeltSurface { target: Target::freeze(mesh, &faces, job)? });
        Ok(())
    };
    // SAFETY: the header asks for NULL or a place for an error.
    unsafe { boundary(error, body) }
}

/// The faces that a caller names; all where `faces` is NULL.
///
/// # Safety
/// `faces` is NULL or the start of `count` elements.
pub(super) unsafe fn faces_of(mesh: &Mesh, faces: *const u32, count: usize) -> Result<Vec<FaceId>, Failure> {
    if faces.is_null() {
        return Ok(mesh.faces().collect());
    }
    // SAFETY: as for this function.
    let faces: Vec<FaceId> =
        unsafe { arguments::array(faces, count, "faces") }?.iter().map(|&f| FaceId(f)).collect();
    match faces.iter().find(|f| f.is_boundary() || !mesh.has_face(**f)) {
        Some(missing) => Err(Failure::argument(format!("face {} does not exist", missing.0))),
        None => Ok(faces),
    }
}

/// Frees a surface. NULL is allowed. Since: 0.1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welt_surface_free(surface: *mut WeltSurface) {
    // SAFETY: the header asks for NULL or a surface that was not freed.
    unsafe { arguments::free(surface) };
}

/// Curvature of the limit surface at parameters of faces.
///
/// surface, faces, corners, parameters, count: as for welt_surface_evaluate.
/// values: receives per point 10 doubles: the principal curvatures, the greater first; the unit tangents along which the normal
/// curvature takes these values; mean and Gaussian curvature. Curvature is positive where the surface bends towards its
/// normal: a sphere of radius r whose normals point outwards has -1/r, in units of the model. All are NaN at an extraordinary vertex, where curvature is
/// not defined, where the tangents span no plane, and where the surface has no part of the face.
/// capacity: room in values, at least 10 * count doubles.
///
/// Fails with WELT_ERROR_ARGUMENT where a face has no such patch, or a parameter is NaN. Since: 0.1.
#[unsafe(no_mangle)]
#[allow(clippy::too_many_arguments)]
pub unsafe extern "C" fn welt_surface_curvature(
    surface: *const WeltSurface,
    faces: *const u32,
    corners: *const u32,
    parameters: *const f64,
    count: usize,
    values: *mut f64,
    capacity: usize,
    error: *mut *mut WeltError,
) -> i32 {
    let body = || {
        // SAFETY: the header asks for a living surface, and arrays and a buffer of these sizes.
        let (surface, points, buffer) = unsafe {
            let surface = &arguments::handle(surface, "surface")?.target.surface;
            let points = Points::new(faces, corners, parameters, count, 0)?;
            (surface, points, RowBuffer::new(values, capacity, [count, 10, 0], "values")?)
        };
        points.check(|face, corner| missing_patch(surface, face, corner))?;
        for i in 0..count {
            fault::point("evaluate");
            let Parameter { face, corner, u, v } = points.get(i);
            // SAFETY: there is one thread.
            unsafe { buffer.write(i, &curvature(surface.evaluate(face, corner as usize, u, v))) };
        }
        Ok(())
    };
    // SAFETY: the header asks for NULL or a place for an error.
    unsafe { boundary(error, body) }
}

/// Principal curvatures and directions, mean and Gaussian curvature; NaN where they are not defined.
fn curvature(point: Option<SurfacePoint>) -> [f64; 10] {
    point.and_then(|point| point.curvature()).map_or([f64::NAN; 10], |found| {
        let [[a, b, c], [d, e, f]] = found.directions.map(|direction| direction.to_array());
        let [first, second] = found.principal;
        [first, second, a, b, c, d, e, f, found.mean, found.gaussian]
    })
}

/// Moves vertices so that their limit points lie on a frozen surface.
///
/// mesh: must not be NULL; is changed.
/// vertices: the vertices that may move, 0-based; NULL for all.
/// count: number of vertices; 0 where vertices is NULL.
/// surface: must not be NULL.
/// fit: one of WELT_FIT_*.
/// job: may be NULL.
/// report: may be NULL; else receives method, steps, stop reason, residual and the vertices that found no surface. Free it
/// with welt_report_free.
///
/// Fails with WELT_ERROR_ARGUMENT and WELT_ERROR_CANCELLED; the mesh is as it was before then. Since: 0.1.
#[unsafe(no_mangle)]
#[allow(clippy::too_many_arguments)]
pub unsafe extern "C" fn welt_mesh_fit(
    mesh: *mut WeltMesh,
    vertices: *const u32,
    count: usize,
    surface: *const WeltSurface,
    fit: u32,
    job: *const WeltJob,
    report: *mut *mut WeltReport,
    error: *mut *mut WeltError,
) -> i32 {
    let body = || {
        // SAFETY: the header asks for these handles, a place for a report or NULL, and an array of this count.
        let (mesh, surface, job, report, named) = unsafe {
            (
                arguments::handle_mut(mesh, "mesh")?,
                arguments::handle(surface, "surface")?,
                arguments::optional(job, "job")?,
                Output::optional(report, "report")?,
                if vertices.is_null() { None } else { Some(arguments::array(vertices, count, "vertices")?) },
            )
        };
        let method = method(fit)?;
        let checked = mesh.read()?;
        let mut active: Vec<VertexId> = match named {
            Some(vertices) => vertices.iter().map(|&v| VertexId(v)).collect(),
            None => checked.vertices().collect(),
        };
        active.sort_unstable();
        active.dedup();
        if let Some(missing) = active.iter().find(|&&v| !checked.has_vertex(v)) {
            return Err(Failure::argument(format!("vertex {} does not exist", missing.0)));
        }
        let idle = Job::new();
        let job = job.map_or(&idle, |job| &job.job);
        let done = mesh.transact(|mesh| {
            let done = optimise::fit(mesh, &active, &surface.target, method, job)?;
            report.is_some().then(|| WeltReport::new(&done)).transpose()
        })?;
        hand_over(report, done);
        Ok(())
    };
    // SAFETY: the header asks for NULL or a place for an error.
    unsafe { boundary(error, body) }
}
