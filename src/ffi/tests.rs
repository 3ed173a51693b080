//! What a C caller sees when it makes mistakes.

use super::*;
use crate::ffi::boundary::{Guarded, boundary};
use crate::ffi::failure::Failure;
use std::ffi::CStr;
use std::ptr::{null, null_mut};

const TETRAHEDRON: [f64; 12] = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
const SIZES: [u32; 4] = [3; 4];
const VERTICES: [u32; 12] = [0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3];

fn create(
    sizes: &[u32],
    vertices: &[u32],
    positions: &[f64],
    stride: usize,
    mesh: *mut *mut WeltMesh,
    error: *mut *mut WeltError,
) -> i32 {
    // SAFETY: slices give valid pointers; the rest is what each test checks.
    unsafe {
        welt_mesh_create(
            sizes.as_ptr(),
            sizes.len(),
            vertices.as_ptr(),
            vertices.len(),
            positions.as_ptr(),
            positions.len() / 3,
            stride,
            mesh,
            error,
        )
    }
}

fn tetrahedron() -> *mut WeltMesh {
    let mut mesh = null_mut();
    assert_eq!(create(&SIZES, &VERTICES, &TETRAHEDRON, 0, &mut mesh, null_mut()), WELT_OK);
    mesh
}

/// Code and message of a failed call, and frees the error.
fn take(error: &mut *mut WeltError) -> (i32, String) {
    // SAFETY: `error` was written by a call.
    unsafe {
        let message = CStr::from_ptr(welt_error_message(*error)).to_str().unwrap().to_owned();
        let code = welt_error_code(*error);
        welt_error_free(*error);
        *error = null_mut();
        (code, message)
    }
}

#[test]
fn version_is_that_of_the_package() {
    let parts = [WELT_VERSION_MAJOR, WELT_VERSION_MINOR, WELT_VERSION_PATCH];
    let text = parts.map(|part| part.to_string()).join(".");
    assert_eq!(text, env!("CARGO_PKG_VERSION"));
    assert_eq!(welt_version(), (parts[0] * 256 + parts[1]) * 256 + parts[2]);
    // SAFETY: a string that lives for ever.
    assert_eq!(unsafe { CStr::from_ptr(welt_version_string()) }.to_str().unwrap(), text);
}

#[test]
fn wrong_arguments_are_named() {
    let mut error = null_mut();
    let mut mesh = null_mut();
    assert_eq!(create(&SIZES, &VERTICES, &TETRAHEDRON, 0, null_mut(), &mut error), WELT_ERROR_ARGUMENT);
    assert_eq!(take(&mut error).1, "mesh is NULL");
    assert_eq!(create(&SIZES, &VERTICES, &TETRAHEDRON, 20, &mut mesh, &mut error), WELT_ERROR_ARGUMENT);
    assert!(take(&mut error).1.contains("stride of positions is 20 bytes"));
    assert_eq!(create(&[3, 3], &VERTICES, &TETRAHEDRON, 0, &mut mesh, &mut error), WELT_ERROR_ARGUMENT);
    assert!(take(&mut error).1.contains("add up to 6 but there are 12"));
    // SAFETY: NULL and impossible counts are what is tested; nothing behind them is read.
    unsafe {
        let (sizes, vertices) = (SIZES.as_ptr(), VERTICES.as_ptr());
        let positions = TETRAHEDRON.as_ptr();
        let status = welt_mesh_create(null(), 4, vertices, 12, positions, 4, 0, &mut mesh, &mut error);
        assert_eq!((status, take(&mut error).1.as_str()), (WELT_ERROR_ARGUMENT, "face_sizes is NULL"));
        let status =
            welt_mesh_create(sizes, 4, vertices, 12, positions, usize::MAX, 0, &mut mesh, &mut error);
        assert_eq!(status, WELT_ERROR_ARGUMENT);
        assert!(take(&mut error).1.contains("more than memory can hold"));
        let status =
            welt_mesh_create(sizes, usize::MAX, vertices, 12, positions, 4, 0, &mut mesh, &mut error);
        assert_eq!(status, WELT_ERROR_ARGUMENT);
        assert!(take(&mut error).1.contains("face_sizes"));
    }
    assert!(mesh.is_null(), "written by a call that failed");
}

#[test]
fn defects_become_places() {
    let mut error = null_mut();
    let mut mesh = null_mut();
    let inside_out = [0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 2, 3];
    assert_eq!(create(&SIZES, &inside_out, &TETRAHEDRON, 0, &mut mesh, &mut error), WELT_ERROR_MESH);
    // SAFETY: `error` was written by the call.
    unsafe {
        assert_eq!(welt_error_place_count(error), 3);
        assert_eq!(welt_error_place_kind(error, 0), WELT_PLACE_EDGE);
        let ids = [0, 1, 2].map(|which| welt_error_place_id(error, 0, which));
        assert_eq!(ids, [0, 2, WELT_NONE]);
        let message = CStr::from_ptr(welt_error_place_message(error, 0)).to_str().unwrap();
        assert!(message.contains("edge 0-2"), "{message}");
        assert_eq!(welt_error_place_id(error, 3, 0), WELT_NONE);
        welt_error_free(error);
    }
}

#[test]
fn null_handles_are_answered() {
    let mut error = null_mut();
    // SAFETY: NULL is what is tested.
    unsafe {
        welt_mesh_free(null_mut());
        welt_error_free(null_mut());
        welt_job_free(null_mut());
        welt_refinement_free(null_mut());
        welt_job_cancel(null());
        assert_eq!(welt_job_progress(null()), 0.0);
        assert_eq!(welt_job_stage(null(), null_mut(), 0), 0);
        assert_eq!(welt_mesh_vertex_count(null()), 0);
        assert_eq!(welt_refinement_face_count(null(), 0), 0);
        assert_eq!(welt_error_code(null()), WELT_OK);
        assert_eq!(CStr::from_ptr(welt_error_message(null())), c"");
        assert_eq!(welt_mesh_limit_positions(null(), null_mut(), 0, &mut error), WELT_ERROR_ARGUMENT);
    }
    assert_eq!(take(&mut error), (WELT_ERROR_ARGUMENT, "mesh is NULL".to_owned()));
}

#[test]
fn a_mesh_comes_back_as_it_was_given() {
    let mut padded = Vec::new();
    for point in TETRAHEDRON.chunks(3) {
        padded.extend_from_slice(point);
        padded.push(f64::NAN);
    }
    padded.pop();
    let mut mesh = null_mut();
    let mut view = null();
    let (mut sizes, mut vertices) = ([0; 4], [0; 12]);
    let mut error = null_mut();
    // SAFETY: buffers and counts agree.
    unsafe {
        let (s, v) = (SIZES.as_ptr(), VERTICES.as_ptr());
        assert_eq!(welt_mesh_create(s, 4, v, 12, padded.as_ptr(), 4, 32, &mut mesh, &mut error), WELT_OK);
        assert_eq!((welt_mesh_vertex_count(mesh), welt_mesh_edge_count(mesh)), (4, 6));
        assert_eq!((welt_mesh_face_count(mesh), welt_mesh_face_vertex_count(mesh)), (4, 12));
        assert_eq!(welt_mesh_positions(mesh, &mut view, &mut error), WELT_OK);
        assert_eq!(std::slice::from_raw_parts(view, 12), TETRAHEDRON);
        let (s, v) = (sizes.as_mut_ptr(), vertices.as_mut_ptr());
        assert_eq!(welt_mesh_faces(mesh, s, 4, v, 11, &mut error), WELT_ERROR_BUFFER);
        assert!(take(&mut error).1.contains("room for 11 elements; 12 are needed"));
        assert_eq!(sizes, [0; 4], "written by a call that failed");
        assert_eq!(welt_mesh_faces(mesh, s, 4, v, 12, &mut error), WELT_OK);
        let mut edges = [9; 12];
        assert_eq!(welt_mesh_edges(mesh, edges.as_mut_ptr(), 12, &mut error), WELT_OK);
        let mut pairs: Vec<_> =
            edges.chunks(2).map(|edge| (edge[0].min(edge[1]), edge[0].max(edge[1]))).collect();
        pairs.sort_unstable();
        assert_eq!(pairs, [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)]);
        welt_mesh_free(mesh);
    }
    assert_eq!((sizes, vertices), (SIZES, VERTICES));
}

#[test]
fn bad_positions_change_nothing() {
    let mesh = tetrahedron();
    let mut moved = TETRAHEDRON;
    moved[4] = f64::NAN;
    let (mut error, mut view) = (null_mut(), null());
    // SAFETY: buffers and counts agree.
    unsafe {
        assert_eq!(welt_mesh_set_positions(mesh, moved.as_ptr(), 4, 0, &mut error), WELT_ERROR_MESH);
        assert_eq!(welt_error_place_id(error, 0, 0), 1);
        take(&mut error);
        assert_eq!(welt_mesh_set_positions(mesh, moved.as_ptr(), 3, 0, &mut error), WELT_ERROR_ARGUMENT);
        assert!(take(&mut error).1.contains("the mesh has 4 vertices"));
        assert_eq!(welt_mesh_positions(mesh, &mut view, null_mut()), WELT_OK);
        assert_eq!(std::slice::from_raw_parts(view, 12), TETRAHEDRON);
        moved[4] = 7.0;
        assert_eq!(welt_mesh_set_positions(mesh, moved.as_ptr(), 4, 0, &mut error), WELT_OK);
        assert_eq!(welt_mesh_positions(mesh, &mut view, null_mut()), WELT_OK);
        assert_eq!(*view.add(4), 7.0);
        welt_mesh_free(mesh);
    }
}

#[test]
fn a_cancelled_job_stops_the_work() {
    let mesh = tetrahedron();
    let (mut job, mut refinement, mut error) = (null_mut(), null_mut(), null_mut());
    // SAFETY: handles are made here and freed at the end.
    unsafe {
        assert_eq!(welt_job_create(&mut job, &mut error), WELT_OK);
        assert_eq!(welt_refinement_create(mesh, 2, job, &mut refinement, &mut error), WELT_OK);
        assert_eq!(welt_job_progress(job), 1.0);
        let mut stage = [0x7f; 4];
        assert_eq!(welt_job_stage(job, stage.as_mut_ptr(), stage.len()), "refine".len());
        assert_eq!(CStr::from_ptr(stage.as_ptr()), c"ref");
        welt_refinement_free(refinement);
        refinement = null_mut();
        welt_job_cancel(job);
        let status = welt_refinement_create(mesh, 2, job, &mut refinement, &mut error);
        assert_eq!((status, refinement), (WELT_ERROR_CANCELLED, null_mut()));
        assert_eq!(take(&mut error).1, "cancelled");
        welt_job_free(job);
        welt_mesh_free(mesh);
    }
}

#[test]
fn levels_outside_the_range_are_refused() {
    let mesh = tetrahedron();
    let (mut refinement, mut error, mut view) = (null_mut(), null_mut(), null());
    // SAFETY: handles are made here and freed at the end.
    unsafe {
        let status = welt_refinement_create(mesh, u32::MAX, null(), &mut refinement, &mut error);
        assert_eq!(status, WELT_ERROR_TOO_LARGE);
        take(&mut error);
        assert_eq!(welt_refinement_create(mesh, 1, null(), &mut refinement, &mut error), WELT_OK);
        assert_eq!(welt_refinement_positions(refinement, 2, &mut view, &mut error), WELT_ERROR_ARGUMENT);
        assert_eq!(take(&mut error).1, "there is no level 2; the last is 1");
        let parents = welt_refinement_face_parents;
        assert_eq!(parents(refinement, 0, null_mut(), null_mut(), 0, &mut error), WELT_ERROR_ARGUMENT);
        take(&mut error);
        let (mut faces, mut corners) = ([0; 12], [0; 12]);
        let (f, c) = (faces.as_mut_ptr(), corners.as_mut_ptr());
        assert_eq!(parents(refinement, 1, f, c, 12, &mut error), WELT_OK);
        assert_eq!((faces[11], corners[11]), (3, 2));
        welt_refinement_free(refinement);
        welt_mesh_free(mesh);
    }
}

#[test]
fn a_panic_is_an_error_and_poisons_what_was_being_changed() {
    let mut guarded = Guarded::new(1);
    let mut error = null_mut();
    // SAFETY: `error` can be written to.
    let status = unsafe {
        boundary(&mut error, || {
            guarded.change(|_| -> Result<(), Failure> { std::panic::resume_unwind(Box::new("broken\nhere")) })
        })
    };
    assert_eq!(status, WELT_ERROR_INTERNAL);
    assert_eq!(take(&mut error).1, "internal error: broken here; please report it");
    assert_eq!(guarded.read().unwrap_err().code, WELT_ERROR_POISONED);
    assert_eq!(guarded.change(|_| Ok(())).unwrap_err().code, WELT_ERROR_POISONED);
    let mut sound = Guarded::new(1);
    assert!(sound.change(|_| -> Result<(), Failure> { Err(Failure::argument("no")) }).is_err());
    assert!(sound.read().is_ok());
}

/// Imports an OBJ from memory with the given options.
fn import(
    content: &str,
    options: *const WeltImportOptions,
    mesh: *mut *mut WeltMesh,
    report: *mut *mut WeltReport,
    error: *mut *mut WeltError,
) -> i32 {
    let (name, bytes) = (c"cage.obj".as_ptr(), content.as_ptr());
    let size = content.len();
    // SAFETY: pointers and lengths agree.
    unsafe {
        welt_mesh_import_memory(name, usize::MAX, WELT_FORMAT_OBJ, bytes, size, options, mesh, report, error)
    }
}

#[test]
fn files_in_memory() {
    let (mut mesh, mut report, mut error) = (null_mut(), null_mut(), null_mut());
    let triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nf 1 2 3\n";
    assert_eq!(import(triangle, null(), &mut mesh, &mut report, &mut error), WELT_OK);
    // SAFETY: handles are made here and freed.
    unsafe {
        assert_eq!((welt_mesh_vertex_count(mesh), welt_mesh_face_count(mesh)), (3, 1));
        let json = CStr::from_ptr(welt_report_json(report)).to_str().unwrap();
        assert!(json.contains("normals"), "{json}");
        welt_report_free(report);
        let path = c"/no/such/folder/out.obj".as_ptr();
        assert_eq!(welt_mesh_export_file(mesh, path, usize::MAX, &mut error), WELT_ERROR_FILE);
        assert!(take(&mut error).1.contains("/no/such/folder"));
        welt_mesh_free(mesh);
    }
    let broken = "v 0 0 0\nv 1 0 zero\n";
    assert_eq!(import(broken, null(), &mut mesh, null_mut(), &mut error), WELT_ERROR_SYNTAX);
    // SAFETY: `error` was written by the call.
    unsafe {
        assert_eq!(CStr::from_ptr(welt_error_place_file(error, 0)), c"cage.obj");
        assert_eq!((welt_error_place_line(error, 0), welt_error_place_column(error, 0)), (2, 7));
        welt_error_free(error);
    }
    let repeated = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 2\n";
    assert_eq!(import(repeated, null(), &mut mesh, null_mut(), &mut error), WELT_ERROR_MESH);
    // SAFETY: `error` was written by the call.
    unsafe {
        assert_eq!(welt_error_place_kind(error, 0), WELT_PLACE_FACE);
        assert_eq!((welt_error_place_id(error, 0, 0), welt_error_place_line(error, 0)), (0, 4));
        welt_error_free(error);
    }
}

#[test]
fn options_of_other_sizes_and_bad_strings_are_refused() {
    let (mut mesh, mut error) = (null_mut(), null_mut());
    let mut options = WeltImportOptions {
        struct_size: 0,
        repair: 7,
        weld: 7.0,
        max_vertices: 7,
        max_faces: 7,
        max_face_vertices: 7,
        max_vertex_faces: 7,
    };
    let size = size_of::<WeltImportOptions>();
    // SAFETY: the struct has these bytes, or the size is refused.
    unsafe {
        assert_eq!(welt_import_options_init(&mut options, 15), WELT_ERROR_ARGUMENT);
        assert_eq!(welt_import_options_init(&mut options, size + 8), WELT_ERROR_ARGUMENT);
        assert_eq!(welt_import_options_init(null_mut(), size), WELT_ERROR_ARGUMENT);
        assert_eq!(options.repair, 7, "written by a call that failed");
        // The struct of the first version ended with the welding distance.
        assert_eq!(welt_import_options_init(&mut options, 16), WELT_OK);
        assert_eq!((options.struct_size, options.weld, options.max_vertices), (16, -1.0, 7));
        assert_eq!(welt_import_options_init(&mut options, size), WELT_OK);
    }
    assert_eq!((options.struct_size as usize, options.repair, options.weld), (size, 0, -1.0));
    let fan = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv -1 0 0\nf 1 2 3\nf 1 3 4\n";
    options.max_vertex_faces = 1;
    assert_eq!(import(fan, &options, &mut mesh, null_mut(), &mut error), WELT_ERROR_TOO_LARGE);
    assert!(take(&mut error).1.contains("2 faces meet at vertex 0"));
    options.max_vertex_faces = 2;
    options.struct_size = 8;
    let text = "v 0 0 0\n";
    assert_eq!(import(text, &options, &mut mesh, null_mut(), &mut error), WELT_ERROR_ARGUMENT);
    assert!(take(&mut error).1.contains("size of the options is 8 bytes"));
    options.struct_size = size as u32;
    options.weld = f64::NAN;
    assert_eq!(import(text, &options, &mut mesh, null_mut(), &mut error), WELT_ERROR_ARGUMENT);
    assert!(take(&mut error).1.contains("welding distance"));
    // SAFETY: strings and lengths agree.
    unsafe {
        let path = c"\xff.obj".as_ptr();
        let read = welt_mesh_import_file;
        assert_eq!(read(path, 5, null(), &mut mesh, null_mut(), &mut error), WELT_ERROR_ARGUMENT);
        assert!(take(&mut error).1.contains("path is not UTF-8"));
        assert_eq!(
            read(c"absent.obj".as_ptr(), usize::MAX, null(), &mut mesh, null_mut(), &mut error),
            WELT_ERROR_FILE
        );
        assert!(take(&mut error).1.contains("absent.obj: cannot be read"));
    }
}

#[test]
fn sharpness_and_evaluation_check_their_arguments() {
    let mesh = tetrahedron();
    let mut error = null_mut();
    let mut surface = null_mut();
    let mut values = [0.0; 36];
    let out = values.as_mut_ptr();
    // SAFETY: handles live until they are freed; arrays have the counts that are passed, or the call has to notice first.
    unsafe {
        assert_eq!(welt_mesh_set_subdivision(mesh, 3, 0, &mut error), WELT_ERROR_ARGUMENT);
        assert!(take(&mut error).1.contains("WELT_BOUNDARY_"));
        assert_eq!(welt_mesh_set_subdivision(mesh, 0, 2, &mut error), WELT_ERROR_ARGUMENT);
        assert!(take(&mut error).1.contains("WELT_CREASING_"));
        assert_eq!(welt_mesh_set_subdivision(null_mut(), 0, 0, &mut error), WELT_ERROR_ARGUMENT);
        assert_eq!(take(&mut error).1, "mesh is NULL");

        let (ends, bad) = ([0u32, 1, 1, 1], [1.0f32, f32::NAN]);
        assert_eq!(
            welt_mesh_set_edge_sharpness(mesh, ends.as_ptr(), bad.as_ptr(), 2, &mut error),
            WELT_ERROR_ARGUMENT
        );
        assert!(take(&mut error).1.contains("NaN"));
        let sharp = [10.0f32, 10.0];
        assert_eq!(
            welt_mesh_set_edge_sharpness(mesh, ends.as_ptr(), sharp.as_ptr(), 2, &mut error),
            WELT_ERROR_MESH
        );
        assert_eq!(welt_error_place_count(error), 1);
        take(&mut error);
        let too_many = usize::MAX;
        assert_eq!(
            welt_mesh_set_edge_sharpness(mesh, ends.as_ptr(), sharp.as_ptr(), too_many, &mut error),
            WELT_ERROR_ARGUMENT
        );
        take(&mut error);
        assert_eq!(
            welt_mesh_set_vertex_sharpness(mesh, [4].as_ptr(), sharp.as_ptr(), 1, &mut error),
            WELT_ERROR_ARGUMENT
        );
        assert!(take(&mut error).1.contains("there is no vertex 4"));
        assert_eq!(welt_mesh_set_holes(mesh, [4].as_ptr(), 1, &mut error), WELT_ERROR_ARGUMENT);
        assert!(take(&mut error).1.contains("there is no face 4"));

        // A corner stays where it is, and a hole has no surface.
        assert_eq!(
            welt_mesh_set_vertex_sharpness(mesh, [0].as_ptr(), sharp.as_ptr(), 1, null_mut()),
            WELT_OK
        );
        assert_eq!(welt_mesh_set_holes(mesh, [2].as_ptr(), 1, null_mut()), WELT_OK);
        assert_eq!(welt_surface_create(mesh, null(), 0, null(), &mut surface, null_mut()), WELT_OK);
        let (faces, corners, parameters) = ([0u32, 2], [0u32, 1], [0.0f64, 0.0, 0.5, 0.5]);
        let (f, c, p) = (faces.as_ptr(), corners.as_ptr(), parameters.as_ptr());
        assert_eq!(
            welt_surface_evaluate(surface, f, c, p, 2, 2, null(), out, 35, &mut error),
            WELT_ERROR_BUFFER
        );
        take(&mut error);
        assert_eq!(welt_surface_evaluate(surface, f, c, p, 2, 2, null(), out, 36, null_mut()), WELT_OK);
        assert_eq!(values[..3], TETRAHEDRON[..3]);
        assert!(values[18..].iter().all(|value| value.is_nan()));
        assert_eq!(
            welt_surface_evaluate(surface, f, [3, 0].as_ptr(), p, 2, 2, null(), out, 36, &mut error),
            WELT_ERROR_ARGUMENT
        );
        assert_eq!(take(&mut error).1, "face 0 has no patch 3");
        // Curvature: none at the corner and in the hole, one inside a face, where the shape is convex.
        assert_eq!(welt_surface_curvature(surface, f, c, p, 2, out, 19, &mut error), WELT_ERROR_BUFFER);
        take(&mut error);
        assert_eq!(welt_surface_curvature(surface, f, c, p, 2, out, 36, null_mut()), WELT_OK);
        assert!(values[..20].iter().all(|value| value.is_nan()));
        let inside = [0.6, 0.7, 0.5, 0.5];
        assert_eq!(welt_surface_curvature(surface, f, c, inside.as_ptr(), 1, out, 10, null_mut()), WELT_OK);
        let [first, second, mean, gaussian] = [0, 1, 8, 9].map(|i| values[i]);
        assert!(second <= first && first < 0.0);
        assert!((mean - 0.5 * (first + second)).abs() < 1e-12 && (gaussian - first * second).abs() < 1e-12);
        let nowhere = [f64::NAN; 4];
        assert_eq!(
            welt_surface_evaluate(surface, f, c, nowhere.as_ptr(), 2, 2, null(), out, 36, &mut error),
            WELT_ERROR_ARGUMENT
        );
        assert!(take(&mut error).1.contains("NaN"));
        welt_surface_free(surface);

        let mut refined = null_mut();
        assert_eq!(welt_mesh_refine_loop(mesh, 2, &mut refined, null_mut()), WELT_OK);
        assert_eq!((welt_mesh_face_count(refined), welt_mesh_vertex_count(refined)), (64, 34));
        welt_mesh_free(refined);
        assert_eq!(welt_mesh_refine_loop(mesh, u32::MAX, &mut refined, &mut error), WELT_ERROR_TOO_LARGE);
        take(&mut error);
        assert_eq!(welt_mesh_loop_limit(mesh, out, null_mut(), 12, null_mut()), WELT_OK);
        assert_eq!(values[..3], TETRAHEDRON[..3]);
        welt_mesh_free(mesh);
    }
}
