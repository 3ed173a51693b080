//! The limit surface at parameters, many at a time.

use super::arguments::{self, RowBuffer, Rows};
use super::boundary::boundary;
use super::error::WeltError;
use super::failure::Failure;
use super::options::{self, Options};
use super::surface::WeltSurface;
use crate::fault;
use crate::mesh::FaceId;
use crate::surface::{Derivatives, LimitSurface, Parameter};
use crate::threads::in_ranges;

/// How a call does a batch of points or lines. Set it with welt_batch_options_init before use.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct WeltBatchOptions {
    /// sizeof (welt_batch_options).
    pub struct_size: u32,
    /// Threads to use, 1 by default; 0 for as many as the machine has. Results do not depend on it.
    pub threads: u32,
    /// Bytes from one element of the input (a pair of parameters, a point, a line) to the next; 0, the default, where nothing
    /// lies between them.
    pub input_stride: usize,
    /// Bytes from one element of the results to the next; 0, the default, where nothing lies between them.
    pub output_stride: usize,
}

// SAFETY: as the trait asks; both sizes of pointers leave no padding.
unsafe impl Options for WeltBatchOptions {
    fn first_size() -> usize {
        size_of::<Self>()
    }

    fn defaults(struct_size: u32) -> Self {
        Self { struct_size, threads: 1, input_stride: 0, output_stride: 0 }
    }
}

/// Sets options to their defaults. options: must not be NULL. size: sizeof *options. Fails with WELT_ERROR_ARGUMENT where the
/// size is none that the library knows. Since: 0.1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welt_batch_options_init(options: *mut WeltBatchOptions, size: usize) -> i32 {
    // SAFETY: the header asks for NULL or a struct of this size; no error is wanted.
    unsafe { boundary(std::ptr::null_mut(), || options::initialise(options, size)) }
}

/// Evaluates the limit surface at parameters of faces.
///
/// surface: must not be NULL.
/// faces: the face of each point.
/// corners: the patch of each point; NULL for 0 everywhere. A quad has patch 0 only, another face one per corner.
/// parameters: u and v of each point, in [0, 1]; what lies outside is moved to the nearest inside. On a quad (0, 0) is its
/// first corner, u runs along the first edge and v against the last one. On patch c of another face (0, 0) is corner c,
/// (1, 0) the middle of the edge that leaves it, (0, 1) that of the edge that arrives, (1, 1) the face point.
/// count: number of points.
/// derivatives: up to which order, 0 to 2.
/// options: threads and strides; NULL for the defaults.
/// values: receives per point the position, with order 1 also the derivatives by u and by v, with order 2 also those by u
/// twice, by u and v, by v twice: 3, 9 or 18 doubles. At an extraordinary vertex the first derivatives are tangents of
/// conventional length, and the second ones, which are not defined, are NaN. Where the surface has no part of the face, which
/// may not have been frozen or is a hole or left out by the boundary rule, all are NaN.
/// capacity: room in values, in doubles up to the end of the last point.
///
/// Points that are sorted by face cost less on large surfaces. Fails with WELT_ERROR_ARGUMENT where a face has no such patch,
/// or a parameter is NaN. Since: 0.1.
#[unsafe(no_mangle)]
#[allow(clippy::too_many_arguments)]
pub unsafe extern "C" fn welt_surface_evaluate(
    surface: *const WeltSurface,
    faces: *const u32,
    corners: *const u32,
    parameters: *const f64,
    count: usize,
    derivatives: u32,
    options: *const WeltBatchOptions,
    values: *mut f64,
    capacity: usize,
    error: *mut *mut WeltError,
) -> i32 {
    let body = || {
        let order = order(derivatives)?;
        // SAFETY: the header asks for a living surface, initialised options or NULL, and arrays and a buffer of these sizes.
        let (surface, options, points, buffer) = unsafe {
            let surface = &arguments::handle(surface, "surface")?.target.surface;
            let options = options::complete(options)?;
            let points = Points::new(faces, corners, parameters, count, options.input_stride)?;
            let rows = [count, order.values(), options.output_stride];
            (surface, options, points, RowBuffer::new(values, capacity, rows, "values")?)
        };
        points.check(|face, corner| missing_patch(surface, face, corner))?;
        // Fewer points are not worth a thread.
        const LEAST_PER_THREAD: usize = 1024;
        in_ranges(count, options.threads as usize, LEAST_PER_THREAD, |range| {
            let write = |i, row: &[f64]| {
                fault::point("evaluate");
                // SAFETY: ranges have no row in common.
                unsafe { buffer.write(i, row) };
            };
            surface.evaluate_all(range, order, |i| points.get(i), write);
        });
        Ok(())
    };
    // SAFETY: the header asks for NULL or a place for an error.
    unsafe { boundary(error, body) }
}

/// Points of a surface, as the caller names them.
pub(super) struct Points<'a> {
    faces: &'a [u32],
    corners: Option<&'a [u32]>,
    parameters: Rows<'a>,
}

impl<'a> Points<'a> {
    /// # Safety
    /// Each pointer is NULL or the start of an array of `count` elements that nobody changes during the call.
    pub(super) unsafe fn new(
        faces: *const u32,
        corners: *const u32,
        parameters: *const f64,
        count: usize,
        stride: usize,
    ) -> Result<Self, Failure> {
        // SAFETY: as for this function.
        unsafe {
            let corners =
                if corners.is_null() { None } else { Some(arguments::array(corners, count, "corners")?) };
            Ok(Self {
                faces: arguments::array(faces, count, "faces")?,
                corners,
                parameters: Rows::new(parameters, count, 2, stride, "parameters")?,
            })
        }
    }

    /// Point `i`, which is below the count.
    #[inline(always)]
    pub(super) fn get(&self, i: usize) -> Parameter {
        let uv = self.parameters.row(i);
        let corner = self.corners.map_or(0, |corners| corners[i]);
        Parameter { face: FaceId(self.faces[i]), corner, u: uv[0], v: uv[1] }
    }

    /// Looks at all points before the first result is written. `missing` says what is wrong with a face and its patch.
    pub(super) fn check(&self, missing: impl Fn(FaceId, u32) -> Option<String>) -> Result<(), Failure> {
        for i in 0..self.faces.len() {
            let Parameter { face, corner, u, v } = self.get(i);
            if u.is_nan() || v.is_nan() {
                return Err(Failure::argument(format!("a parameter of point {i} is NaN")));
            }
            if let Some(what) = missing(face, corner) {
                return Err(Failure::argument(what));
            }
        }
        Ok(())
    }
}

/// What is wrong where a face has patches, but not this one.
#[inline(always)]
pub(super) fn missing_patch(surface: &LimitSurface, face: FaceId, corner: u32) -> Option<String> {
    let missing = corner > 0 && (1..=corner as usize).contains(&surface.patch_count(face));
    missing.then(|| format!("face {} has no patch {corner}", face.0))
}

/// What `derivatives` asks for.
pub(super) fn order(derivatives: u32) -> Result<Derivatives, Failure> {
    match derivatives {
        0 => Ok(Derivatives::None),
        1 => Ok(Derivatives::First),
        2 => Ok(Derivatives::Second),
        _ => Err(Failure::argument(format!("derivatives is {derivatives}; it must be 0, 1 or 2"))),
    }
}
