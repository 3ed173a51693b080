//! Status codes. Numbers are never reused.

/// Success.
pub const WELT_OK: i32 = 0;
/// An argument is NULL that must not be, or has a value outside its range. Nothing was changed.
pub const WELT_ERROR_ARGUMENT: i32 = -1;
/// The polygons are no surface: the places of the error list every defect.
pub const WELT_ERROR_MESH: i32 = -2;
/// The job was cancelled. What the call was changing is as it was before.
pub const WELT_ERROR_CANCELLED: i32 = -3;
/// The result would have more elements than 31 bits can number.
pub const WELT_ERROR_TOO_LARGE: i32 = -4;
/// A buffer is too small; the message says how much room is needed.
pub const WELT_ERROR_BUFFER: i32 = -5;
/// The handle was left half changed by a call that returned WELT_ERROR_INTERNAL. It can only be freed.
pub const WELT_ERROR_POISONED: i32 = -6;
/// A defect of the library; the message says where. Please report it.
pub const WELT_ERROR_INTERNAL: i32 = -7;
/// A file cannot be read or written.
pub const WELT_ERROR_FILE: i32 = -8;
/// A text or a file cannot be understood: the places of the error have file, line and column.
pub const WELT_ERROR_SYNTAX: i32 = -9;
/// A rule failed, or the rules do not come to an end, or, where that is asked for, a mark is left that no rule handles; the
/// message names rule and place. The mesh is as it was before.
pub const WELT_ERROR_RULE: i32 = -10;
/// There is no memory for a large list; the message says how much was asked for. Nothing was changed.
pub const WELT_ERROR_MEMORY: i32 = -11;
