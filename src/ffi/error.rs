//! `welt_error`.

use super::arguments;
use super::boundary::boundary_value;
use super::failure::{Failure, Location, Place};
use super::status::WELT_OK;
use std::ffi::{CString, c_char};

/// The place is no element of a mesh: the input as a whole, or a place in a text.
pub const WELT_PLACE_WHOLE: u32 = 0;
/// The place is a vertex; its first id is the vertex.
pub const WELT_PLACE_VERTEX: u32 = 1;
/// The place is an edge; its ids are the vertices of the edge.
pub const WELT_PLACE_EDGE: u32 = 2;
/// The place is a face; its first id is the face.
pub const WELT_PLACE_FACE: u32 = 3;

/// The id that stands for "none".
pub const WELT_NONE: u32 = 0xffff_ffff;

/// Why a call failed: a code, a message of one line, and the places it speaks of. Never changes.
pub struct WeltError {
    code: i32,
    message: CString,
    places: Vec<ErrorPlace>,
}

struct ErrorPlace {
    location: Location,
    message: CString,
    file: CString,
    line: u32,
    column: u32,
}

impl From<Place> for ErrorPlace {
    fn from(place: Place) -> Self {
        let (file, line, column) =
            place.text.map_or_else(Default::default, |text| (text.file, text.line, text.column));
        Self {
            location: place.location,
            message: one_line(place.message),
            file: one_line(file),
            line,
            column,
        }
    }
}

impl WeltError {
    pub(super) fn new(failure: Failure) -> Self {
        Self {
            code: failure.code,
            message: one_line(failure.message),
            places: failure.places.into_iter().map(ErrorPlace::from).collect(),
        }
    }
}

/// The text as a C string of one line.
fn one_line(text: String) -> CString {
    let text = text.replace(['\0', '\n', '\r'], " ");
    CString::new(text).unwrap_or_default()
}

/// Looks at an error from C, where NULL stands for success.
///
/// # Safety
/// `error` is NULL or a living error.
unsafe fn look<T>(error: *const WeltError, none: T, value: impl FnOnce(&WeltError) -> Option<T>) -> T
where
    T: Copy,
{
    boundary_value(none, || {
        // SAFETY: as for this function.
        let error = unsafe { arguments::optional(error, "error") };
        error.ok().flatten().and_then(value).unwrap_or(none)
    })
}

/// Frees an error. NULL is allowed. Since: 0.1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welt_error_free(error: *mut WeltError) {
    // SAFETY: the header asks for NULL or an error that was not freed.
    unsafe { arguments::free(error) };
}

/// The status code of the call that failed; WELT_OK where error is NULL. Since: 0.1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welt_error_code(error: *const WeltError) -> i32 {
    // SAFETY: the header asks for NULL or a living error.
    unsafe { look(error, WELT_OK, |error| Some(error.code)) }
}

/// What went wrong and what to do about it: one line, UTF-8, NUL-terminated, valid until the error is freed. Empty where
/// error is NULL. Since: 0.1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welt_error_message(error: *const WeltError) -> *const c_char {
    // SAFETY: the header asks for NULL or a living error.
    unsafe { look(error, c"".as_ptr(), |error| Some(error.message.as_ptr())) }
}

/// Number of places the error speaks of; 0 where error is NULL. Since: 0.1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welt_error_place_count(error: *const WeltError) -> usize {
    // SAFETY: the header asks for NULL or a living error.
    unsafe { look(error, 0, |error| Some(error.places.len())) }
}

/// What kind of place number index is: one of WELT_PLACE_*. WELT_PLACE_WHOLE where there is no such place. Since: 0.1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welt_error_place_kind(error: *const WeltError, index: usize) -> u32 {
    let kind = |error: &WeltError| {
        Some(match error.places.get(index)?.location {
            Location::Whole => WELT_PLACE_WHOLE,
            Location::Vertex(_) => WELT_PLACE_VERTEX,
            Location::Edge(..) => WELT_PLACE_EDGE,
            Location::Face(_) => WELT_PLACE_FACE,
        })
    };
    // SAFETY: the header asks for NULL or a living error.
    unsafe { look(error, WELT_PLACE_WHOLE, kind) }
}

/// Id number which (0 or 1) of place number index, 0-based: a place that is an edge has two, a vertex and a face have one.
/// WELT_NONE where there is none. Since: 0.1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welt_error_place_id(error: *const WeltError, index: usize, which: u32) -> u32 {
    let id = |error: &WeltError| match (error.places.get(index)?.location, which) {
        (Location::Vertex(id) | Location::Face(id) | Location::Edge(id, _), 0) => Some(id),
        (Location::Edge(_, id), 1) => Some(id),
        _ => None,
    };
    // SAFETY: the header asks for NULL or a living error.
    unsafe { look(error, WELT_NONE, id) }
}

/// What is wrong at place number index: one line, UTF-8, NUL-terminated, valid until the error is freed. Empty where there
/// is no such place. Since: 0.1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welt_error_place_message(error: *const WeltError, index: usize) -> *const c_char {
    // SAFETY: the header asks for NULL or a living error.
    unsafe { look(error, c"".as_ptr(), |error| Some(error.places.get(index)?.message.as_ptr())) }
}

/// The file in which place number index is: UTF-8, NUL-terminated, valid until the error is freed. Empty where the place is in
/// no file, or there is no such place. Since: 0.1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welt_error_place_file(error: *const WeltError, index: usize) -> *const c_char {
    // SAFETY: the header asks for NULL or a living error.
    unsafe { look(error, c"".as_ptr(), |error| Some(error.places.get(index)?.file.as_ptr())) }
}

/// The line of place number index, 1-based; 0 where there is none. Since: 0.1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welt_error_place_line(error: *const WeltError, index: usize) -> u32 {
    // SAFETY: the header asks for NULL or a living error.
    unsafe { look(error, 0, |error| Some(error.places.get(index)?.line)) }
}

/// The column of place number index in bytes, 1-based; 0 where there is none. Since: 0.1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welt_error_place_column(error: *const WeltError, index: usize) -> u32 {
    // SAFETY: the header asks for NULL or a living error.
    unsafe { look(error, 0, |error| Some(error.places.get(index)?.column)) }
}
