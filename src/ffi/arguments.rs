//! Arguments that come from C: pointers and counts are checked here and nowhere else.

use super::failure::Failure;
use super::status::WELT_ERROR_BUFFER;
use crate::memory;
use std::ffi::{CStr, c_char};

fn check<T>(pointer: *const T, name: &str) -> Result<(), Failure> {
    if pointer.is_null() {
        return Err(Failure::argument(format!("{name} is NULL")));
    }
    if !pointer.is_aligned() {
        return Err(Failure::argument(format!("{name} is not aligned")));
    }
    Ok(())
}

fn check_length<T>(count: usize, name: &str) -> Result<(), Failure> {
    match count.checked_mul(size_of::<T>()) {
        Some(bytes) if isize::try_from(bytes).is_ok() => Ok(()),
        _ => Err(Failure::argument(format!("{count} elements of {name} are more than memory can hold"))),
    }
}

/// A handle that is read.
///
/// # Safety
/// `pointer` is NULL or a living handle that nobody changes while the reference is used.
pub(super) unsafe fn handle<'a, T>(pointer: *const T, name: &str) -> Result<&'a T, Failure> {
    check(pointer, name)?;
    // SAFETY: not NULL and aligned; the rest is what the caller answers for.
    Ok(unsafe { &*pointer })
}

/// A handle that is changed.
///
/// # Safety
/// `pointer` is NULL or a living handle that nobody else uses while the reference is used.
pub(super) unsafe fn handle_mut<'a, T>(pointer: *mut T, name: &str) -> Result<&'a mut T, Failure> {
    check(pointer, name)?;
    // SAFETY: not NULL and aligned; the rest is what the caller answers for.
    Ok(unsafe { &mut *pointer })
}

/// A handle that may be left out.
///
/// # Safety
/// As for [`handle`].
pub(super) unsafe fn optional<'a, T>(pointer: *const T, name: &str) -> Result<Option<&'a T>, Failure> {
    if pointer.is_null() {
        return Ok(None);
    }
    // SAFETY: as for this function.
    unsafe { handle(pointer, name) }.map(Some)
}

/// Frees a handle; NULL is nothing to do.
///
/// # Safety
/// `pointer` is NULL or came from [`Output::handle`] and was not freed.
pub(super) unsafe fn free<T>(pointer: *mut T) {
    if !pointer.is_null() {
        // SAFETY: made by `Box::into_raw` and freed once, for which the caller answers.
        super::boundary::boundary_value((), || drop(unsafe { Box::from_raw(pointer) }));
    }
}

/// An array that is read. It may be NULL when it is empty.
///
/// # Safety
/// `pointer` is NULL or the start of `count` elements that nobody changes while the slice is used.
pub(super) unsafe fn array<'a, T>(pointer: *const T, count: usize, name: &str) -> Result<&'a [T], Failure> {
    if count == 0 {
        return Ok(&[]);
    }
    check(pointer, name)?;
    check_length::<T>(count, name)?;
    // SAFETY: not NULL, aligned, within the address space; the caller answers for the elements.
    Ok(unsafe { std::slice::from_raw_parts(pointer, count) })
}

/// A string of `length` bytes, or up to its NUL when the length is `usize::MAX`.
///
/// # Safety
/// `pointer` is NULL or the start of such a string, which nobody changes while the slice is used.
pub(super) unsafe fn text<'a>(pointer: *const c_char, length: usize, name: &str) -> Result<&'a str, Failure> {
    let bytes = if length == usize::MAX {
        check(pointer, name)?;
        // SAFETY: not NULL; the caller answers for the NUL at the end.
        unsafe { CStr::from_ptr(pointer) }.to_bytes()
    } else {
        // SAFETY: as for this function.
        unsafe { array(pointer.cast::<u8>(), length, name) }?
    };
    std::str::from_utf8(bytes).map_err(|error| Failure::argument(format!("{name} is not UTF-8: {error}")))
}

/// Rows of doubles, `stride` bytes apart from row to row; 0 means that nothing lies between them.
pub(super) struct Rows<'a> {
    doubles: &'a [f64],
    width: usize,
    step: usize,
}

/// Doubles from row to row.
fn row_step(width: usize, stride: usize, name: &str) -> Result<usize, Failure> {
    const DOUBLE: usize = size_of::<f64>();
    let least = width * DOUBLE;
    let stride = if stride == 0 { least } else { stride };
    if stride < least || !stride.is_multiple_of(DOUBLE) {
        return Err(Failure::argument(format!(
            "the stride of {name} is {stride} bytes; it must be 0 or a multiple of {DOUBLE} of at least {least}"
        )));
    }
    Ok(stride / DOUBLE)
}

/// Doubles from the first of the first row to the last of the last one.
fn row_extent(count: usize, width: usize, step: usize, name: &str) -> Result<usize, Failure> {
    let Some(last) = count.checked_sub(1) else { return Ok(0) };
    last.checked_mul(step)
        .and_then(|start| start.checked_add(width))
        .ok_or_else(|| Failure::argument(format!("{count} rows of {name} are more than memory can hold")))
}

impl<'a> Rows<'a> {
    /// # Safety
    /// `pointer` is NULL or the start of such an array of `count` rows that nobody changes during the call.
    pub(super) unsafe fn new(
        pointer: *const f64,
        count: usize,
        width: usize,
        stride: usize,
        name: &str,
    ) -> Result<Self, Failure> {
        let step = row_step(width, stride, name)?;
        // SAFETY: the last row ends with this many doubles, all of which belong to the caller's array.
        let doubles = unsafe { array(pointer, row_extent(count, width, step, name)?, name) }?;
        Ok(Self { doubles, width, step })
    }

    /// Row `i`, which is below the count.
    #[inline(always)]
    pub(super) fn row(&self, i: usize) -> &'a [f64] {
        &self.doubles[i * self.step..i * self.step + self.width]
    }

    /// Rows `range`, in order.
    pub(super) fn range(&self, range: std::ops::Range<usize>) -> impl Iterator<Item = &'a [f64]> {
        let count = range.len();
        let (width, doubles) = (self.width, self.doubles.get(range.start * self.step..).unwrap_or_default());
        doubles.chunks(self.step).take(count).filter_map(move |row| row.get(..width))
    }
}

/// Points whose coordinates are `stride` bytes apart from point to point; 0 means that nothing lies between them.
///
/// # Safety
/// `pointer` is NULL or the start of such an array of `count` points that nobody changes during the call.
pub(super) unsafe fn points(
    pointer: *const f64,
    count: usize,
    stride: usize,
    name: &str,
) -> Result<Vec<glam::DVec3>, Failure> {
    // SAFETY: as for this function.
    let rows = unsafe { Rows::new(pointer, count, 3, stride, name) }?;
    Ok(memory::collected(count, rows.range(0..count).map(glam::DVec3::from_slice))?)
}

/// A place for one result. It is written only by a call that succeeds.
pub(super) struct Output<T>(*mut T);

impl<T> Output<T> {
    /// # Safety
    /// `pointer` is NULL or can be written to until the end of the call.
    pub(super) unsafe fn new(pointer: *mut T, name: &str) -> Result<Self, Failure> {
        check(pointer, name)?;
        Ok(Self(pointer))
    }

    /// A place that may be left out.
    ///
    /// # Safety
    /// As for [`new`](Self::new).
    pub(super) unsafe fn optional(pointer: *mut T, name: &str) -> Result<Option<Self>, Failure> {
        if pointer.is_null() {
            return Ok(None);
        }
        // SAFETY: as for this function.
        unsafe { Self::new(pointer, name) }.map(Some)
    }

    pub(super) fn set(self, value: T) {
        // SAFETY: whoever made `self` answers for the pointer. `write` because what is there may be uninitialised.
        unsafe { self.0.write(value) };
    }
}

impl<T> Output<*mut T> {
    /// Hands a new handle to the caller, who frees it with the function of its kind.
    pub(super) fn handle(self, content: T) {
        self.set(Box::into_raw(Box::new(content)));
    }
}

/// The caller's buffer for an array of results. No reference to it is made, since it may be uninitialised, and a careless
/// caller may pass the same buffer twice.
pub(super) struct Buffer<T> {
    start: *mut T,
    count: usize,
}

impl<T: Copy> Buffer<T> {
    /// A buffer that has room for the `needed` elements.
    ///
    /// # Safety
    /// `pointer` is NULL or the start of room for `capacity` elements, until the end of the call.
    pub(super) unsafe fn new(
        pointer: *mut T,
        capacity: usize,
        needed: usize,
        name: &str,
    ) -> Result<Self, Failure> {
        if capacity < needed {
            return Err(Failure::new(
                WELT_ERROR_BUFFER,
                format!("{name} has room for {capacity} elements; {needed} are needed"),
            ));
        }
        if needed > 0 {
            check(pointer, name)?;
        }
        Ok(Self { start: pointer, count: needed })
    }

    /// Writes the elements, as many as were said to be needed.
    pub(super) fn fill(self, elements: impl IntoIterator<Item = T>) {
        for (i, element) in elements.into_iter().take(self.count).enumerate() {
            // SAFETY: `i` is below the count, for whose room whoever made `self` answers.
            unsafe { self.start.add(i).write(element) };
        }
    }
}

/// The caller's rows of results, `stride` bytes apart; as [`Buffer`], but several threads may write different rows.
pub(super) struct RowBuffer {
    start: *mut f64,
    count: usize,
    width: usize,
    step: usize,
}

// SAFETY: who writes from several threads writes different rows, as `write` asks.
unsafe impl Sync for RowBuffer {}

impl RowBuffer {
    /// # Safety
    /// `pointer` is NULL or the start of room for `capacity` doubles, until the end of the call.
    pub(super) unsafe fn new(
        pointer: *mut f64,
        capacity: usize,
        [count, width, stride]: [usize; 3],
        name: &str,
    ) -> Result<Self, Failure> {
        let step = row_step(width, stride, name)?;
        // SAFETY: as for this function.
        let Buffer { start, .. } =
            unsafe { Buffer::new(pointer, capacity, row_extent(count, width, step, name)?, name) }?;
        Ok(Self { start, count, width, step })
    }

    /// Writes row `i`; what is not asked for is left out.
    ///
    /// # Safety
    /// No other thread writes this row meanwhile.
    #[inline(always)]
    pub(super) unsafe fn write(&self, i: usize, row: &[f64]) {
        if i < self.count && row.len() == self.width {
            // SAFETY: the row lies within the room for which whoever made `self` answers; what is read is no part of it.
            unsafe { std::ptr::copy_nonoverlapping(row.as_ptr(), self.start.add(i * self.step), row.len()) };
        }
    }
}
