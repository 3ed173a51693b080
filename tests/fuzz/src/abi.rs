//! Calls of the C ABI as a bad host makes them: in any order, with handles of other meshes, missing handles and
//! outputs, wrong counts, numbers from anywhere. Pointers that are given are real and have the room that is told; no
//! library can check those.

use std::ffi::{CStr, c_char};
use std::ptr::{null, null_mut};
use welt::ffi::*;

/// Handles of one kind.
const SLOTS: usize = 3;
/// Room of every buffer, in elements.
const ROOM: usize = 2000;
const MOST_CALLS: usize = 40;
const MOST_VERTICES: usize = 300;

const NUMBERS: [f64; 16] = [
    0.0,
    1.0,
    -1.0,
    0.5,
    0.3,
    2.0,
    1e-9,
    -0.0,
    1e9,
    1e-300,
    1e300,
    f64::MIN_POSITIVE / 4.0,
    f64::MAX,
    f64::NAN,
    f64::INFINITY,
    f64::NEG_INFINITY,
];

const SELECTORS: [&str; 8] = [
    "ring:0,1",
    "edge:0,1@0.3",
    "path:0,1:2,3",
    "cut:0",
    "polyline:0,0,1;1,1,1;2,2,1",
    "ring:0,2#piping",
    "edge:9,9",
    "spline:-1,0,0;0,1,0;1,0,0;0,-1,0;closed",
];

const FEATURES: [&str; 8] =
    ["groove", "piping", "dent", "loop", "a=groove\nb=ridge", "bead", "step", "nothing"];
const SETTINGS: [&str; 8] =
    ["", "width=0.2", "width=20% depth=10%", "depth=1e300", "width=nan", "width=-1", "a.width=10%", "no=1"];

struct Host<'a> {
    bytes: std::slice::Iter<'a, u8>,
    meshes: [*mut WeltMesh; SLOTS],
    surfaces: [*mut WeltSurface; SLOTS],
    selections: [*mut WeltSelection; SLOTS],
    rules: [*mut WeltRules; SLOTS],
    refinements: [*mut WeltRefinement; SLOTS],
    jobs: [*mut WeltJob; SLOTS],
    indices: Vec<u32>,
    more: Vec<u32>,
    numbers: Vec<f64>,
    values: Vec<f64>,
    sharpness: Vec<f32>,
    points: Vec<WeltSurfacePoint>,
    failed: bool,
}

/// Each byte chooses a call or one of its arguments.
pub fn abi(bytes: &[u8]) -> bool {
    let mut host = Host {
        bytes: bytes.iter(),
        meshes: [null_mut(); SLOTS],
        surfaces: [null_mut(); SLOTS],
        selections: [null_mut(); SLOTS],
        rules: [null_mut(); SLOTS],
        refinements: [null_mut(); SLOTS],
        jobs: [null_mut(); SLOTS],
        indices: vec![0; ROOM],
        more: vec![0; ROOM],
        numbers: vec![0.0; ROOM],
        values: vec![0.0; ROOM],
        sharpness: vec![0.0; ROOM],
        // SAFETY: numbers only; all zero is a value.
        points: vec![unsafe { std::mem::zeroed() }; ROOM],
        failed: false,
    };
    for _ in 0..MOST_CALLS {
        let Some(&call) = host.bytes.next() else { break };
        host.call(call);
    }
    !host.failed
}

impl Drop for Host<'_> {
    fn drop(&mut self) {
        // SAFETY: each slot holds a handle that is freed once, or NULL.
        unsafe {
            self.meshes.iter().for_each(|&h| welt_mesh_free(h));
            self.surfaces.iter().for_each(|&h| welt_surface_free(h));
            self.selections.iter().for_each(|&h| welt_selection_free(h));
            self.rules.iter().for_each(|&h| welt_rules_free(h));
            self.refinements.iter().for_each(|&h| welt_refinement_free(h));
            self.jobs.iter().for_each(|&h| welt_job_free(h));
        }
    }
}

/// Puts what `make` makes into a slot, in place of the handle that is there.
macro_rules! renew {
    ($host:ident.$slots:ident[$index:expr], $free:ident, $make:expr) => {{
        let index = $index;
        let mut handle = null_mut();
        let code = $make(&mut handle);
        assert_eq!(code == WELT_OK, !handle.is_null());
        if !handle.is_null() {
            // The handle in the slot is freed once.
            $free($host.$slots[index]);
            $host.$slots[index] = handle;
        }
    }};
}

impl Host<'_> {
    fn byte(&mut self) -> usize {
        usize::from(self.bytes.next().copied().unwrap_or(0))
    }

    fn slot(&mut self) -> usize {
        self.byte() % SLOTS
    }

    /// A count that is right, nearly right, or neither; never more than the buffers hold.
    fn count(&mut self, right: usize) -> usize {
        let count = match self.byte() {
            0..=127 => right,
            128..=159 => right.wrapping_sub(1),
            160..=191 => right + 1,
            192..=223 => 0,
            byte => byte - 224,
        };
        count.min(ROOM / 18)
    }

    /// A handle of the slots, or NULL.
    fn pick<T>(&mut self, handles: fn(&Self) -> &[*mut T; SLOTS]) -> *mut T {
        let byte = self.byte();
        if byte >= 250 { null_mut() } else { handles(self)[byte % SLOTS] }
    }

    fn mesh(&mut self) -> *mut WeltMesh {
        self.pick(|host| &host.meshes)
    }

    fn surface(&mut self) -> *mut WeltSurface {
        self.pick(|host| &host.surfaces)
    }

    fn job(&mut self) -> *mut WeltJob {
        self.pick(|host| &host.jobs)
    }

    fn vertex_count(&self, mesh: *mut WeltMesh) -> usize {
        // SAFETY: a handle or NULL.
        unsafe { welt_mesh_vertex_count(mesh) }
    }

    /// Fills the inputs: small indices, numbers from the table.
    fn fill(&mut self) {
        let (start, step) = (self.byte(), self.byte() % 7);
        for i in 0..ROOM {
            self.indices[i] = ((start + i * step) % 30) as u32;
            self.more[i] = ((start + i) % 5) as u32;
            let kind = if start > 200 { start + i } else { (start + i) % 6 };
            self.numbers[i] = NUMBERS[kind % 16] + if start > 200 { 0.0 } else { 0.01 * (i % 17) as f64 };
            self.sharpness[i] = NUMBERS[(start + i * step) % 16] as f32;
        }
        if start > 250 {
            self.indices[start % 9] = u32::MAX;
        }
    }

    fn call(&mut self, call: u8) {
        let mut error = null_mut();
        // SAFETY: every pointer is NULL, a live handle, or a buffer with the room that is told.
        unsafe {
            match call % 31 {
                0 => self.create(&mut error),
                1 => {
                    let (mesh, bytes) = (self.mesh(), self.byte());
                    self.fill();
                    let count = self.count(self.vertex_count(mesh)).min(ROOM / 3);
                    let stride = if bytes > 200 { bytes } else { 0 };
                    let count = if stride > 0 { count.min(ROOM * 8 / stride.max(24)) } else { count };
                    welt_mesh_set_positions(mesh, self.numbers.as_ptr(), count, stride, &mut error);
                }
                2 => {
                    let mesh = self.mesh();
                    let (boundary, creasing) = (self.byte() as u32 % 4, self.byte() as u32 % 3);
                    welt_mesh_set_subdivision(mesh, boundary, creasing, &mut error);
                }
                3 => {
                    let mesh = self.mesh();
                    self.fill();
                    let count = self.count(3).min(ROOM / 2);
                    let edges = self.indices.as_ptr();
                    welt_mesh_set_edge_sharpness(mesh, edges, self.sharpness.as_ptr(), count, &mut error);
                }
                4 => {
                    let mesh = self.mesh();
                    self.fill();
                    let count = self.count(2);
                    let vertices = self.indices.as_ptr();
                    welt_mesh_set_vertex_sharpness(
                        mesh,
                        vertices,
                        self.sharpness.as_ptr(),
                        count,
                        &mut error,
                    );
                }
                5 => {
                    let mesh = self.mesh();
                    self.fill();
                    let count = self.count(1);
                    welt_mesh_set_holes(mesh, self.indices.as_ptr(), count, &mut error);
                }
                6 => {
                    let mesh = self.mesh();
                    let capacity = self.count(3 * self.vertex_count(mesh));
                    welt_mesh_limit_positions(mesh, self.values.as_mut_ptr(), capacity, &mut error);
                    welt_error_free(error);
                    error = null_mut();
                    welt_mesh_limit_normals(mesh, self.values.as_mut_ptr(), capacity, &mut error);
                }
                7 => {
                    let (mesh, depth, job) = (self.mesh(), self.byte(), self.job());
                    let depth = if depth > 250 { u32::MAX } else { depth as u32 % 3 };
                    let index = self.slot();
                    renew!(self.refinements[index], welt_refinement_free, |handle| {
                        welt_refinement_create(mesh, depth, job, handle, &mut error)
                    });
                }
                8 => {
                    let refinement = self.pick(|host| &host.refinements);
                    let level = self.byte() as u32 % 5;
                    let mut view = null();
                    welt_refinement_positions(refinement, level, &mut view, &mut error);
                    for i in 0..3 * if view.is_null() {
                        0
                    } else {
                        welt_refinement_vertex_count(refinement, level)
                    } {
                        std::hint::black_box(*view.add(i));
                    }
                    welt_error_free(error);
                    error = null_mut();
                    let capacity = self.count(welt_refinement_face_count(refinement, level)).min(ROOM);
                    let (faces, corners) = (self.indices.as_mut_ptr(), self.more.as_mut_ptr());
                    welt_refinement_face_parents(refinement, level, faces, corners, capacity, &mut error);
                }
                9 => {
                    let (mesh, levels, index) = (self.mesh(), self.byte() as u32 % 3, self.slot());
                    renew!(self.meshes[index], welt_mesh_free, |handle| {
                        welt_mesh_refine_loop(mesh, levels, handle, &mut error)
                    });
                }
                10 => {
                    let mesh = self.mesh();
                    self.fill();
                    let (count, derivatives) = (self.count(5), self.byte() as u32 % 4);
                    let (faces, parameters) = (self.indices.as_ptr(), self.numbers.as_ptr());
                    let values = self.values.as_mut_ptr();
                    let options = null();
                    welt_mesh_loop_evaluate(
                        mesh,
                        faces,
                        parameters,
                        count,
                        derivatives,
                        options,
                        values,
                        ROOM,
                        &mut error,
                    );
                }
                11 | 12 => {
                    let (mesh, text) = (self.mesh(), SELECTORS[self.byte() % 8]);
                    let index = self.slot();
                    renew!(self.selections[index], welt_selection_free, |handle| {
                        welt_selection_create(mesh, text.as_ptr().cast(), text.len(), handle, &mut error)
                    });
                }
                13 => {
                    let (mesh, selection) = (self.mesh(), self.pick(|host| &host.selections));
                    let capacity = self.count(2 * welt_selection_count(selection));
                    let places = self.values.as_mut_ptr();
                    let edges = self.indices.as_mut_ptr();
                    welt_selection_edges(selection, mesh, edges, capacity, places, capacity, &mut error);
                }
                14 => {
                    let (mesh, selection) = (self.mesh(), self.pick(|host| &host.selections));
                    welt_mesh_mark(mesh, selection, &mut error);
                }
                15 => {
                    let index = self.slot();
                    renew!(self.rules[index], welt_rules_free, |handle| welt_rules_linear(
                        handle, &mut error
                    ));
                }
                16 => self.surface_of(&mut error),
                17 | 18 => self.apply(&mut error),
                19 => {
                    let mesh = self.mesh();
                    self.fill();
                    let (first, count) = (self.byte() % 8, self.count(2));
                    let (vertices, heights) = (self.indices.as_ptr().add(first), self.numbers.as_ptr());
                    welt_mesh_displace(mesh, vertices, heights, count, &mut error);
                }
                20 => {
                    let (first, second, job) = (self.mesh(), self.mesh(), self.job());
                    let samples = self.byte() as u32 % 4;
                    let values = self.values.as_mut_ptr();
                    if self.byte() > 128 {
                        welt_mesh_deviation(first, second, samples, values, job, &mut error);
                    } else {
                        welt_mesh_compare(first, second, samples, samples, values, job, &mut error);
                    }
                }
                21 => {
                    let surface = self.surface();
                    self.fill();
                    let (count, derivatives) = (self.count(20), self.byte() as u32 % 4);
                    let options = self.batch();
                    let corners = if self.byte() > 128 { self.more.as_ptr() } else { null() };
                    let (faces, parameters) = (self.indices.as_ptr(), self.numbers.as_ptr());
                    let values = self.values.as_mut_ptr();
                    welt_surface_evaluate(
                        surface,
                        faces,
                        corners,
                        parameters,
                        count,
                        derivatives,
                        &options,
                        values,
                        ROOM,
                        &mut error,
                    );
                    welt_error_free(error);
                    error = null_mut();
                    welt_surface_curvature(
                        surface, faces, corners, parameters, count, values, ROOM, &mut error,
                    );
                }
                22 => {
                    let surface = self.surface();
                    self.fill();
                    let (count, radius) = (self.count(9), NUMBERS[self.byte() % 16]);
                    let options = self.batch();
                    let starts = if self.byte() > 128 { self.points.as_ptr() } else { null() };
                    let mut found = self.points.clone();
                    let numbers = self.numbers.as_ptr();
                    welt_surface_closest(
                        surface,
                        numbers,
                        count,
                        radius,
                        starts,
                        &options,
                        found.as_mut_ptr(),
                        ROOM,
                        &mut error,
                    );
                    self.points = found;
                }
                23 => {
                    let surface = self.surface();
                    self.fill();
                    let count = self.count(9);
                    let options = self.batch();
                    let (numbers, values) = (self.numbers.as_ptr(), self.values.as_mut_ptr());
                    welt_surface_signed_distances(
                        surface, numbers, count, &options, values, ROOM, &mut error,
                    );
                }
                24 => {
                    let surface = self.surface();
                    self.fill();
                    let count = self.count(9);
                    let (first, last) = (NUMBERS[self.byte() % 16], NUMBERS[self.byte() % 16]);
                    let options = self.batch();
                    let (lines, found) = (self.numbers.as_ptr(), self.points.as_mut_ptr());
                    welt_surface_first_hits(
                        surface, lines, count, first, last, &options, found, ROOM, &mut error,
                    );
                    welt_error_free(error);
                    error = null_mut();
                    let mut starts = vec![0; count + 1];
                    let mut needed = 0;
                    let capacity = self.count(count).min(ROOM);
                    welt_surface_all_hits(
                        surface,
                        lines,
                        count,
                        first,
                        last,
                        &options,
                        starts.as_mut_ptr(),
                        &mut needed,
                        found,
                        capacity,
                        &mut error,
                    );
                }
                25 => {
                    let (mesh, surface, job) = (self.mesh(), self.surface(), self.job());
                    self.fill();
                    let (count, fit) = (self.count(2), self.byte() as u32 % 6);
                    let vertices = if count == 0 { null() } else { self.indices.as_ptr() };
                    welt_mesh_fit(mesh, vertices, count, surface, fit, job, null_mut(), &mut error);
                }
                28 => {
                    let (mesh, index) = (self.mesh(), self.slot());
                    renew!(self.meshes[index], welt_mesh_free, |handle| {
                        welt_mesh_copy(mesh, handle, &mut error)
                    });
                }
                29 => {
                    let refinement = self.pick(|host| &host.refinements);
                    let (level, index) = (self.byte() as u32 % 3, self.slot());
                    renew!(self.meshes[index], welt_mesh_free, |handle| {
                        welt_refinement_mesh(refinement, level, handle, &mut error)
                    });
                }
                30 => self.patches(&mut error),
                26 => {
                    let index = self.slot();
                    renew!(self.jobs[index], welt_job_free, |handle| welt_job_create(handle, &mut error));
                }
                _ => {
                    let job = self.job();
                    if self.byte() > 128 {
                        welt_job_cancel(job);
                    }
                    assert!(!welt_job_progress(job).is_nan());
                }
            }
            if !error.is_null() {
                self.failed = true;
                assert_ne!(welt_error_code(error), WELT_OK);
                assert_ne!(
                    welt_error_code(error),
                    WELT_ERROR_INTERNAL,
                    "{:?}",
                    CStr::from_ptr(welt_error_message(error))
                );
                assert!(
                    CStr::from_ptr(welt_error_message(error)).to_str().is_ok_and(|text| !text.is_empty())
                );
                for i in 0..welt_error_place_count(error) {
                    assert!(!welt_error_place_message(error, i).is_null());
                }
            }
            welt_error_free(error);
        }
    }

    fn batch(&mut self) -> WeltBatchOptions {
        // SAFETY: numbers only.
        let mut options: WeltBatchOptions = unsafe { std::mem::zeroed() };
        // SAFETY: a struct of its size.
        unsafe { welt_batch_options_init(&mut options, size_of::<WeltBatchOptions>()) };
        match self.byte() {
            255 => options.struct_size = 3,
            254 => options.output_stride = 7,
            253 => options.input_stride = 7,
            252 => options.threads = 2,
            _ => {}
        }
        options
    }

    /// A mesh from a grid of quads, a file's text, or any faces.
    unsafe fn create(&mut self, error: *mut *mut WeltError) {
        let (kind, index) = (self.byte(), self.slot());
        if kind < 64 {
            let text = "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nv 0 0 2\nv 2 0 2\nv 2 2 2\nv 0 2 2\nf 4 3 2 1\nf 5 6 7 8\n\
                        f 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
            let name = "cube.obj";
            unsafe {
                renew!(self.meshes[index], welt_mesh_free, |handle| {
                    welt_mesh_import_memory(
                        name.as_ptr().cast::<c_char>(),
                        name.len(),
                        WELT_FORMAT_OBJ,
                        text.as_ptr(),
                        text.len(),
                        null(),
                        handle,
                        null_mut(),
                        error,
                    )
                })
            };
            return;
        }
        let (columns, rows) = if kind < 160 { (4, 3) } else { (1 + kind % 6, 1 + kind % 3) };
        let (mut sizes, mut corners, mut positions) = (Vec::new(), Vec::new(), Vec::new());
        for y in 0..=rows {
            for x in 0..=columns {
                positions.extend([x as f64, y as f64, NUMBERS[(x * y) % if kind > 240 { 16 } else { 6 }]]);
            }
        }
        for y in 0..rows {
            for x in 0..columns {
                let at = (y * (columns + 1) + x) as u32;
                let up = at + columns as u32 + 1;
                if (x + y) % 3 == 2 {
                    sizes.extend([3, 3]);
                    corners.extend([at, at + 1, up + 1, at, up + 1, up]);
                } else {
                    sizes.push(4);
                    corners.extend([at, at + 1, up + 1, up]);
                }
            }
        }
        if kind > 220 {
            let at = self.byte() % corners.len();
            corners[at] = self.byte() as u32;
        }
        let vertices = positions.len() / 3;
        unsafe {
            renew!(self.meshes[index], welt_mesh_free, |handle| {
                welt_mesh_create(
                    sizes.as_ptr(),
                    sizes.len(),
                    corners.as_ptr(),
                    corners.len(),
                    positions.as_ptr(),
                    vertices,
                    0,
                    handle,
                    error,
                )
            })
        };
    }

    /// Patches for CAD, and one of them read to its end.
    unsafe fn patches(&mut self, error: *mut *mut WeltError) {
        let (mesh, job) = (self.mesh(), self.job());
        if self.vertex_count(mesh) > MOST_VERTICES {
            return;
        }
        self.fill();
        let (count, index) = (self.count(0), self.byte());
        let faces = if count == 0 { null() } else { self.indices.as_ptr() };
        // SAFETY: numbers only; set by the call.
        let mut options: WeltPatchOptions = unsafe { std::mem::zeroed() };
        unsafe { welt_patch_options_init(&mut options, size_of::<WeltPatchOptions>()) };
        if index > 240 {
            options.tolerance = NUMBERS[index % 16];
        }
        let mut patches = null_mut();
        // SAFETY: handles, and arrays with the room that is told.
        unsafe {
            if welt_patches_create(mesh, faces, count, &options, job, &mut patches, error) != WELT_OK {
                return;
            }
            let number = index % (welt_patches_count(patches) + 1);
            let mut patch: WeltPatch = std::mem::zeroed();
            if welt_patches_get(patches, number, &mut patch, error) == WELT_OK {
                let poles = 3 * patch.pole_count_u as usize * patch.pole_count_v as usize;
                for i in 0..poles {
                    std::hint::black_box(*patch.poles.add(i));
                }
                for i in 0..patch.face_count {
                    std::hint::black_box(*patch.faces.add(i));
                }
            }
            welt_patches_free(patches);
        }
    }

    unsafe fn surface_of(&mut self, error: *mut *mut WeltError) {
        let (mesh, job, index) = (self.mesh(), self.job(), self.slot());
        if self.vertex_count(mesh) > MOST_VERTICES {
            return;
        }
        self.fill();
        let count = self.count(0);
        let faces = if count == 0 { null() } else { self.indices.as_ptr() };
        unsafe {
            renew!(self.surfaces[index], welt_surface_free, |handle| {
                welt_surface_create(mesh, faces, count, job, handle, error)
            })
        };
    }

    unsafe fn apply(&mut self, error: *mut *mut WeltError) {
        let (mesh, selection, job) = (self.mesh(), self.pick(|host| &host.selections), self.job());
        if self.vertex_count(mesh) > MOST_VERTICES {
            return;
        }
        let settings = SETTINGS[self.byte() % 8];
        let mut report = null_mut();
        // SAFETY: numbers only; set by the call.
        let mut options: WeltFeatureOptions = unsafe { std::mem::zeroed() };
        unsafe { welt_feature_options_init(&mut options, size_of::<WeltFeatureOptions>()) };
        options.fit = self.byte() as u32 % 6;
        options.parity = self.byte() as u32 % 4;
        options.strict = u32::from(self.byte() > 200);
        if self.byte() > 240 {
            options.max_steps = 1 << self.byte().min(40);
            options.max_growth = self.byte() as u64 % 4;
            options.max_extra_elements = self.byte() as u64;
            options.max_script_depth = self.byte() as u32;
        }
        let (text, length) = (settings.as_ptr().cast::<c_char>(), settings.len());
        if self.byte() > 220 {
            let rules = self.pick(|host| &host.rules);
            unsafe {
                welt_rules_apply(mesh, selection, rules, text, length, &options, job, &mut report, error)
            };
        } else {
            let feature = FEATURES[self.byte() % 8];
            let name = feature.as_ptr().cast::<c_char>();
            unsafe {
                welt_feature_apply(
                    mesh,
                    selection,
                    name,
                    feature.len(),
                    text,
                    length,
                    &options,
                    job,
                    &mut report,
                    error,
                )
            };
        }
        if !report.is_null() {
            // SAFETY: the report was just made.
            assert!(unsafe { CStr::from_ptr(welt_report_json(report)) }.to_str().is_ok());
            unsafe { welt_report_free(report) };
        }
    }
}
