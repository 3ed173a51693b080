//! Structs of options, which grow at their end from version to version.
//!
//! The first member of each is `struct_size`, as the caller's compiler saw it: an older caller knows fewer members, and the
//! rest keeps its defaults.

use super::failure::Failure;

/// A struct of options.
///
/// # Safety
/// The type is `repr(C)`, begins with `struct_size: u32`, has no padding, and every pattern of bits is a value of it.
pub(super) unsafe trait Options: Copy {
    /// Size of the first version that was ever released.
    fn first_size() -> usize;

    /// The defaults, for a caller whose struct has `struct_size` bytes.
    fn defaults(struct_size: u32) -> Self;
}

fn check_size<T: Options>(size: usize) -> Result<usize, Failure> {
    if (T::first_size()..=size_of::<T>()).contains(&size) {
        return Ok(size);
    }
    let (first, last) = (T::first_size(), size_of::<T>());
    Err(Failure::argument(format!(
        "the size of the options is {size} bytes; this version of the library knows sizes from {first} to {last}"
    )))
}

/// Writes the defaults into the caller's struct of `size` bytes, and not a byte more.
///
/// # Safety
/// `options` is NULL or has `size` bytes to write to.
pub(super) unsafe fn initialise<T: Options>(options: *mut T, size: usize) -> Result<(), Failure> {
    if options.is_null() {
        return Err(Failure::argument("options is NULL"));
    }
    let size = check_size::<T>(size)?;
    let defaults = T::defaults(size as u32);
    // SAFETY: `size` is within both; bytes need no alignment.
    unsafe { std::ptr::copy_nonoverlapping((&raw const defaults).cast::<u8>(), options.cast(), size) };
    Ok(())
}

/// The caller's options, completed with defaults; all defaults where `options` is NULL.
///
/// # Safety
/// `options` is NULL or was initialised, so that it has as many bytes as its `struct_size` says.
pub(super) unsafe fn complete<T: Options>(options: *const T) -> Result<T, Failure> {
    let mut complete = T::defaults(size_of::<T>() as u32);
    if options.is_null() {
        return Ok(complete);
    }
    // SAFETY: `struct_size` stands first; the read asks for no alignment.
    let size = unsafe { options.cast::<u32>().read_unaligned() };
    let size = check_size::<T>(size as usize)?;
    // SAFETY: `size` is within both, and any bits are a value of the type.
    unsafe { std::ptr::copy_nonoverlapping(options.cast::<u8>(), (&raw mut complete).cast(), size) };
    Ok(complete)
}
