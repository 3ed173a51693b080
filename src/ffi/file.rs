//! Meshes from files and into files.

use super::arguments::{self, Output};
use super::boundary::boundary;
use super::error::WeltError;
use super::failure::Failure;
use super::mesh::{WeltMesh, mesh_of};
use super::options::{self, Options};
use super::report::WeltReport;
use crate::io::{self, Format, Import, ImportOptions, Limits};
use std::ffi::c_char;
use std::path::Path;

/// Wavefront OBJ.
pub const WELT_FORMAT_OBJ: u32 = 0;
/// PLY, ascii or binary.
pub const WELT_FORMAT_PLY: u32 = 1;

/// How a file is taken over. Set it by welt_import_options_init, then change what differs.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct WeltImportOptions {
    /// Set by welt_import_options_init; leave it.
    pub struct_size: u32,
    /// Not 0: split apart, turn round or remove what cannot be held, instead of refusing the file. Default 0.
    pub repair: u32,
    /// Merge vertices that are no further apart than this distance, in the unit of the file; 0 merges equal ones, a
    /// negative number none. Default -1.
    pub weld: f64,
    /// Most vertices of a file, and most texture coordinates. Default 2^28.
    pub max_vertices: u64,
    /// Most faces of a file. Default 2^28.
    pub max_faces: u64,
    /// Most vertices of a face. Default 1024.
    pub max_face_vertices: u64,
    /// Most faces at a vertex; work and memory there grow with its square. Default 1024.
    pub max_vertex_faces: u64,
}

// SAFETY: `repr(C)`, 4 + 4 + 8 + 4 * 8 bytes without padding, of integers and a double.
unsafe impl Options for WeltImportOptions {
    fn first_size() -> usize {
        16
    }

    fn defaults(struct_size: u32) -> Self {
        let Limits { max_vertices, max_faces, max_arity, max_valence } = Limits::default();
        Self {
            struct_size,
            repair: 0,
            weld: -1.0,
            max_vertices,
            max_faces,
            max_face_vertices: max_arity,
            max_vertex_faces: max_valence,
        }
    }
}

impl From<WeltImportOptions> for ImportOptions {
    fn from(options: WeltImportOptions) -> Self {
        // Not a number passes through, to be refused with its own message.
        let weld = if options.weld < 0.0 { None } else { Some(options.weld) };
        let limits = Limits {
            max_vertices: options.max_vertices,
            max_faces: options.max_faces,
            max_arity: options.max_face_vertices,
            max_valence: options.max_vertex_faces,
        };
        Self { repair: options.repair != 0, weld, limits }
    }
}

/// Sets options to their defaults. options: must not be NULL. size: sizeof *options. Fails with WELT_ERROR_ARGUMENT where the
/// size is none that the library knows, which is so when the program was compiled for a newer one. Since: 0.1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welt_import_options_init(options: *mut WeltImportOptions, size: usize) -> i32 {
    // SAFETY: the header asks for NULL or a struct of this size; no error is wanted.
    unsafe { boundary(std::ptr::null_mut(), || options::initialise(options, size)) }
}

/// Hands an imported mesh and its report to the caller.
///
/// # Safety
/// `mesh` and `report` are NULL or can be written to.
unsafe fn hand_over(
    mesh: *mut *mut WeltMesh,
    report: *mut *mut WeltReport,
    import: impl FnOnce() -> Result<Import, Failure>,
) -> Result<(), Failure> {
    // SAFETY: as for this function.
    let mesh = unsafe { Output::new(mesh, "mesh") }?;
    // SAFETY: as for this function.
    let report = unsafe { Output::optional(report, "report") }?;
    let imported = import()?;
    if let Some(report) = report {
        report.handle(WeltReport::new(&imported.report)?);
    }
    mesh.handle(WeltMesh::new(imported.mesh));
    Ok(())
}

/// Reads a mesh from a file, OBJ or PLY by its extension.
///
/// path: UTF-8.
/// path_length: in bytes, SIZE_MAX for a NUL-terminated path.
/// options: may be NULL for defaults.
/// mesh: receives the handle; free it with welt_mesh_free.
/// report: may be NULL; else receives what the file holds and the mesh does not ("ignored") and what was changed ("repairs");
/// free it with welt_report_free.
///
/// Fails with WELT_ERROR_FILE where the file cannot be read, WELT_ERROR_SYNTAX where it cannot be understood (the place
/// has the line), WELT_ERROR_MESH where the faces are no surface (each place has a defect and its line),
/// WELT_ERROR_TOO_LARGE where more faces meet at a vertex than the options allow. Since: 0.1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welt_mesh_import_file(
    path: *const c_char,
    path_length: usize,
    options: *const WeltImportOptions,
    mesh: *mut *mut WeltMesh,
    report: *mut *mut WeltReport,
    error: *mut *mut WeltError,
) -> i32 {
    let body = || {
        // SAFETY: the header asks for a string of this length, and NULL or options that were set.
        let (path, options) =
            unsafe { (arguments::text(path, path_length, "path")?, options::complete(options)?) };
        // SAFETY: the header asks for places for the handles.
        unsafe { hand_over(mesh, report, || Ok(io::import(Path::new(path), &options.into())?)) }
    };
    // SAFETY: the header asks for NULL or a place for an error.
    unsafe { boundary(error, body) }
}

/// Reads a mesh from the content of a file.
///
/// name: stands for the file in messages; UTF-8, NULL for "memory".
/// name_length: in bytes, SIZE_MAX for a NUL-terminated name.
/// format: one of WELT_FORMAT_*.
/// content: the bytes of the file; may be NULL when size is 0.
/// size: number of bytes.
/// options: may be NULL for defaults.
/// mesh: receives the handle; free it with welt_mesh_free.
/// report: as for welt_mesh_import_file.
///
/// Fails as welt_mesh_import_file does. Since: 0.1.
#[unsafe(no_mangle)]
#[allow(clippy::too_many_arguments)]
pub unsafe extern "C" fn welt_mesh_import_memory(
    name: *const c_char,
    name_length: usize,
    format: u32,
    content: *const u8,
    size: usize,
    options: *const WeltImportOptions,
    mesh: *mut *mut WeltMesh,
    report: *mut *mut WeltReport,
    error: *mut *mut WeltError,
) -> i32 {
    let body = || {
        let format = match format {
            WELT_FORMAT_OBJ => Format::Obj,
            WELT_FORMAT_PLY => Format::Ply,
            _ => return Err(Failure::argument(format!("format is {format}, which is no WELT_FORMAT_*"))),
        };
        // SAFETY: the header asks for a string and an array of these lengths, and NULL or options that were set.
        let (name, content, options) = unsafe {
            let name = if name.is_null() { "memory" } else { arguments::text(name, name_length, "name")? };
            (name, arguments::array(content, size, "content")?, options::complete(options)?)
        };
        // SAFETY: the header asks for places for the handles.
        unsafe { hand_over(mesh, report, || Ok(io::import_bytes(name, format, content, &options.into())?)) }
    };
    // SAFETY: the header asks for NULL or a place for an error.
    unsafe { boundary(error, body) }
}

/// Writes a mesh to a file, OBJ or PLY by its extension. A file that was there is replaced at the very end, so that it is as
/// it was before when writing fails.
///
/// mesh: must not be NULL.
/// path: UTF-8.
/// path_length: in bytes, SIZE_MAX for a NUL-terminated path.
///
/// Fails with WELT_ERROR_FILE and WELT_ERROR_MEMORY. Since: 0.1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welt_mesh_export_file(
    mesh: *const WeltMesh,
    path: *const c_char,
    path_length: usize,
    error: *mut *mut WeltError,
) -> i32 {
    let body = || {
        // SAFETY: the header asks for a living mesh and a string of this length.
        let (mesh, path) = unsafe { (mesh_of(mesh)?, arguments::text(path, path_length, "path")?) };
        Ok(io::export(Path::new(path), mesh)?)
    };
    // SAFETY: the header asks for NULL or a place for an error.
    unsafe { boundary(error, body) }
}
