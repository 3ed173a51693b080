//! How far two limit surfaces are apart.

use super::arguments::{self, Buffer};
use super::boundary::boundary;
use super::error::WeltError;
use super::failure::Failure;
use super::job::WeltJob;
use super::mesh::WeltMesh;
use crate::job::Job;
use crate::surface::{Deviation, Sampling, compare};

/// # Safety
/// `first` and `second` are NULL or living meshes that nobody changes during the call, `job` is NULL or a living one.
unsafe fn measure(
    first: *const WeltMesh,
    second: *const WeltMesh,
    [samples, threads]: [u32; 2],
    job: *const WeltJob,
) -> Result<Deviation, Failure> {
    // SAFETY: as for this function.
    let (first, second, job) = unsafe {
        (
            arguments::handle(first, "first")?.read()?,
            arguments::handle(second, "second")?.read()?,
            arguments::optional(job, "job")?,
        )
    };
    if !(1..=64).contains(&samples) {
        return Err(Failure::argument(format!("samples is {samples}; it lies between 1 and 64")));
    }
    let idle = Job::new();
    let job = job.map_or(&idle, |job| &job.job);
    let sampling = Sampling { per_side: samples as usize, threads: threads as usize };
    Ok(compare(first, second, sampling, job)?.both)
}

/// Measures how far the limit surfaces of two control meshes are apart, both ways.
///
/// first, second: must not be NULL.
/// samples: samples per side of each face, 1 to 64; 8 is usual.
/// values: receives the largest distance, the root mean square and the distance that 95 % of the area do not exceed, in
/// model units: 3 doubles.
/// job: may be NULL.
///
/// Fails with WELT_ERROR_ARGUMENT, WELT_ERROR_CANCELLED and WELT_ERROR_MEMORY. Since: 0.1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welt_mesh_deviation(
    first: *const WeltMesh,
    second: *const WeltMesh,
    samples: u32,
    values: *mut f64,
    job: *const WeltJob,
    error: *mut *mut WeltError,
) -> i32 {
    let body = || {
        // SAFETY: the header asks for living meshes, a job or NULL, and room for three doubles.
        let (values, found) = unsafe {
            (Buffer::new(values, 3, 3, "values")?, measure(first, second, [samples, 1], job)?)
        };
        values.fill([found.max, found.rms, found.p95]);
        Ok(())
    };
    // SAFETY: the header asks for NULL or a place for an error.
    unsafe { boundary(error, body) }
}

/// Measures how far the limit surfaces of two control meshes are apart, both ways, and how their normals and curvatures differ.
///
/// first, second: must not be NULL.
/// samples: samples per side of each face, 1 to 64; 8 is usual.
/// threads: 0 for as many as the machine has; the result does not depend on it.
/// values: receives 6 doubles: the three of welt_mesh_deviation; the largest angle between the normals of a point and of its
/// closest point, in degrees; the root mean square and the largest difference of the mean curvatures there, per model unit.
/// Beside extraordinary vertices curvature is not bounded, so that the last figure grows with samples.
/// job: may be NULL.
///
/// Fails with WELT_ERROR_ARGUMENT, WELT_ERROR_CANCELLED and WELT_ERROR_MEMORY. Since: 0.1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welt_mesh_compare(
    first: *const WeltMesh,
    second: *const WeltMesh,
    samples: u32,
    threads: u32,
    values: *mut f64,
    job: *const WeltJob,
    error: *mut *mut WeltError,
) -> i32 {
    let body = || {
        // SAFETY: the header asks for living meshes, a job or NULL, and room for six doubles.
        let (values, found) = unsafe {
            (Buffer::new(values, 6, 6, "values")?, measure(first, second, [samples, threads], job)?)
        };
        let Deviation { max, rms, p95, normal, curvature_rms, curvature_max, .. } = found;
        values.fill([max, rms, p95, normal, curvature_rms, curvature_max]);
        Ok(())
    };
    // SAFETY: the header asks for NULL or a place for an error.
    unsafe { boundary(error, body) }
}
