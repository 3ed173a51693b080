//! Version of the library.

use std::ffi::c_char;

/// Major version of this header.
pub const WELT_VERSION_MAJOR: u32 = 0;
/// Minor version of this header.
pub const WELT_VERSION_MINOR: u32 = 1;
/// Patch version of this header.
pub const WELT_VERSION_PATCH: u32 = 0;
/// Version of this header as one number, for comparisons: major * 65536 + minor * 256 + patch.
pub const WELT_VERSION: u32 = 256;
/// Version of the binary interface, the number in the name of the shared library. It grows only when a program that was
/// compiled before would no longer run.
pub const WELT_ABI_VERSION: u32 = 0;

/// The version of the library that runs, in the form of WELT_VERSION. It can differ from that of the header when the
/// shared library was replaced. Since: 0.1.
#[unsafe(no_mangle)]
pub extern "C" fn welt_version() -> u32 {
    WELT_VERSION
}

/// 1 where a program runs with this library that was compiled with a header of this WELT_VERSION and WELT_ABI_VERSION: the
/// binary interface is the same, and the library is not older than the header. Else 0. Since: 0.1.
#[unsafe(no_mangle)]
pub extern "C" fn welt_is_compatible(version: u32, abi_version: u32) -> i32 {
    i32::from(abi_version == WELT_ABI_VERSION && version <= WELT_VERSION)
}

/// The version of the library that runs as text, such as "0.1.0". Owned by the library, valid for ever. Since: 0.1.
#[unsafe(no_mangle)]
pub extern "C" fn welt_version_string() -> *const c_char {
    concat!(env!("CARGO_PKG_VERSION"), "\0").as_ptr().cast()
}
