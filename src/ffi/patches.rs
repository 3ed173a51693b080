//! `welt_patches`.

use super::arguments::{self, Output};
use super::boundary::{boundary, boundary_value};
use super::error::{WELT_NONE, WeltError};
use super::failure::Failure;
use super::job::WeltJob;
use super::mesh::{WeltMesh, mesh_of};
use super::options::{self, Options};
use super::report::WeltReport;
use super::surface::faces_of;
use crate::job::Job;
use crate::surface::{PatchOptions, Patches, SplinePatch};

/// How patches are made.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct WeltPatchOptions {
    /// Set by welt_patch_options_init; leave it.
    pub struct_size: u32,
    /// Faces along a side of a patch at most, 1 or more. Default 10.
    pub most_faces: u32,
    /// Aim for the deviation beside extraordinary vertices, in parts of the mean length of the edges of the control face
    /// there; greater than 0. Default 1e-4.
    pub tolerance: f64,
}

// SAFETY: `repr(C)`, 4 + 4 + 8 bytes without padding, of integers and a double.
unsafe impl Options for WeltPatchOptions {
    fn first_size() -> usize {
        16
    }

    fn defaults(struct_size: u32) -> Self {
        let PatchOptions { most_faces, tolerance } = PatchOptions::default();
        Self { struct_size, most_faces: most_faces as u32, tolerance }
    }
}

/// A bicubic B-spline patch of the limit surface. The arrays belong to the patches and are valid until they are freed.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct WeltPatch {
    /// x, y and z of each pole, row by row, u running fastest: pole (i, j) is number j * pole_count_u + i.
    pub poles: *const f64,
    /// Knots along u, ascending, pole_count_u + degree_u + 1 of them: the first and the last one stand degree_u + 1 times, those
    /// between once.
    pub knots_u: *const f64,
    /// Knots along v, likewise.
    pub knots_v: *const f64,
    /// The control faces whose surface it is, row by row, u running fastest, each once.
    pub faces: *const u32,
    /// Number of faces.
    pub face_count: usize,
    /// 3.
    pub degree_u: u32,
    /// 3.
    pub degree_v: u32,
    /// Poles along u.
    pub pole_count_u: u32,
    /// Poles along v.
    pub pole_count_v: u32,
    /// Per side the patch beyond it, or WELT_NONE at the border of the surface. Sides: 0 at the first v in the direction of u,
    /// 1 at the last u, 2 at the last v against u, 3 at the first u. The two patches have the same poles along the side, in
    /// opposite order, equal to the last bit, and the same spans of knots.
    pub neighbours: [u32; 4],
    /// Which side of that patch; WELT_NONE at the border.
    pub neighbour_sides: [u32; 4],
    /// Per corner, at which side of the same number begins, not 0 where an extraordinary vertex lies there: in the last
    /// three spans beside it the patch is an approximation. Everywhere else it is the limit surface itself.
    pub irregular: [u32; 4],
    /// Greatest distance to the limit surface that was found; 0 where the patch is exact.
    pub deviation: f64,
    /// The same in parts of the mean length of the edges of the control face.
    pub relative_deviation: f64,
}

/// The limit surface as bicubic B-spline patches. Never changes.
pub struct WeltPatches {
    patches: Patches,
    /// The faces of each.
    faces: Vec<Vec<u32>>,
}

/// Sets options to their defaults. options: must not be NULL. size: sizeof *options. Fails with WELT_ERROR_ARGUMENT where the
/// size is none that the library knows. Since: 0.1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welt_patch_options_init(options: *mut WeltPatchOptions, size: usize) -> i32 {
    // SAFETY: the header asks for NULL or a struct of this size; no error is wanted.
    unsafe { boundary(std::ptr::null_mut(), || options::initialise(options, size)) }
}

/// Makes bicubic B-spline patches of the limit surface (Catmull-Clark), for CAD.
///
/// mesh: must not be NULL.
/// faces: the faces whose surface is wanted, 0-based; NULL for all. Cost follows their number.
/// count: number of faces; 0 where faces is NULL.
/// options: NULL for the defaults.
/// job: may be NULL.
/// patches: receives the handle; free it with welt_patches_free.
///
/// The patches meet side to side: no corner of one lies within a side of another. Extraordinary vertices and
/// creases lie at corners and along sides only. Fails with WELT_ERROR_ARGUMENT where a face does not exist or an option is out of
/// its range, and with WELT_ERROR_CANCELLED. Since: 0.1.
#[unsafe(no_mangle)]
#[allow(clippy::too_many_arguments)]
pub unsafe extern "C" fn welt_patches_create(
    mesh: *const WeltMesh,
    faces: *const u32,
    count: usize,
    options: *const WeltPatchOptions,
    job: *const WeltJob,
    patches: *mut *mut WeltPatches,
    error: *mut *mut WeltError,
) -> i32 {
    let body = || {
        // SAFETY: the header asks for a living mesh, an array of this count or NULL, options that were initialised or NULL, a job
        // or NULL, and a place for the handle.
        let (mesh, options, job, output) = unsafe {
            (
                mesh_of(mesh)?,
                options::complete(options)?,
                arguments::optional(job, "job")?,
                Output::new(patches, "patches")?,
            )
        };
        // SAFETY: as above.
        let faces = unsafe { faces_of(mesh, faces, count) }?;
        let WeltPatchOptions { most_faces, tolerance, .. } = options;
        if most_faces == 0 {
            return Err(Failure::argument("most_faces is 0; it must be at least 1"));
        }
        if !(tolerance > 0.0 && tolerance.is_finite()) {
            return Err(Failure::argument(format!("tolerance is {tolerance}; it must be greater than 0")));
        }
        let options = PatchOptions { most_faces: most_faces as usize, tolerance };
        let idle = Job::new();
        let job = job.map_or(&idle, |job| &job.job);
        let patches = Patches::new(mesh, &faces, &options, job)?;
        let numbers = |patch: &SplinePatch| patch.faces.iter().map(|face| face.0).collect();
        let faces = patches.patches.iter().map(numbers).collect();
        output.handle(WeltPatches { patches, faces });
        Ok(())
    };
    // SAFETY: the header asks for NULL or a place for an error.
    unsafe { boundary(error, body) }
}

/// Frees patches. NULL is allowed. Since: 0.1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welt_patches_free(patches: *mut WeltPatches) {
    // SAFETY: the header asks for NULL or patches that were not freed.
    unsafe { arguments::free(patches) };
}

/// Number of patches; 0 where patches is NULL. Since: 0.1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welt_patches_count(patches: *const WeltPatches) -> usize {
    boundary_value(0, || {
        // SAFETY: the header asks for NULL or living patches.
        let patches = unsafe { arguments::optional(patches, "patches") };
        patches.ok().flatten().map_or(0, |patches| patches.patches.patches.len())
    })
}

/// One of the patches.
///
/// patches: must not be NULL.
/// index: below welt_patches_count(patches).
/// patch: receives it; its arrays belong to patches and are valid until that is freed.
///
/// Fails with WELT_ERROR_ARGUMENT where there is no such patch. Since: 0.1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welt_patches_get(
    patches: *const WeltPatches,
    index: usize,
    patch: *mut WeltPatch,
    error: *mut *mut WeltError,
) -> i32 {
    let body = || {
        // SAFETY: the header asks for living patches and a place for one.
        let (patches, output) =
            unsafe { (arguments::handle(patches, "patches")?, Output::new(patch, "patch")?) };
        let missing = || Failure::argument(format!("patch {index} does not exist"));
        let patch = patches.patches.patches.get(index).ok_or_else(missing)?;
        let faces = patches.faces.get(index).ok_or_else(missing)?;
        let [pole_count_u, pole_count_v] = patch.pole_counts().map(|count| count as u32);
        output.set(WeltPatch {
            // Three doubles one after the other: `DVec3` is `repr(C)`.
            poles: patch.poles.as_ptr().cast(),
            knots_u: patch.knots_u.as_ptr(),
            knots_v: patch.knots_v.as_ptr(),
            faces: faces.as_ptr(),
            face_count: faces.len(),
            degree_u: 3,
            degree_v: 3,
            pole_count_u,
            pole_count_v,
            neighbours: patch.neighbours.map(|beyond| beyond.map_or(WELT_NONE, |(number, _)| number as u32)),
            neighbour_sides: patch.neighbours.map(|beyond| beyond.map_or(WELT_NONE, |(_, side)| side as u32)),
            irregular: patch.irregular.map(u32::from),
            deviation: patch.deviation,
            relative_deviation: patch.relative_deviation,
        });
        Ok(())
    };
    // SAFETY: the header asks for NULL or a place for an error.
    unsafe { boundary(error, body) }
}

/// What was made.
///
/// patches: must not be NULL.
/// report: receives a report whose JSON has patches, exact, approximate and faces (numbers), rings (of exact pieces round
/// extraordinary vertices), max_deviation (in units of the model), max_relative_deviation (in parts of the mean length of
/// the edges of the control face), rms_relative_deviation (root mean square of what was measured in the spans beside
/// extraordinary vertices) and max_normal_jump (greatest angle in degrees between the normals of two patches along
/// a side that is no crease). Free it with welt_report_free.
///
/// Since: 0.1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welt_patches_report(
    patches: *const WeltPatches,
    report: *mut *mut WeltReport,
    error: *mut *mut WeltError,
) -> i32 {
    let body = || {
        // SAFETY: the header asks for living patches and a place for the handle.
        let (patches, output) =
            unsafe { (arguments::handle(patches, "patches")?, Output::new(report, "report")?) };
        output.handle(WeltReport::new(&patches.patches.report)?);
        Ok(())
    };
    // SAFETY: the header asks for NULL or a place for an error.
    unsafe { boundary(error, body) }
}
