"""The C ABI as `include/welt.h` declares it: constants, structs, functions.

`tests/test_header.py` compares all of it with the header.
"""

from __future__ import annotations

import ctypes
import re
from typing import Any, Dict, List, NamedTuple, Tuple

VERSION = 256
ABI_VERSION = 0

CONSTANTS: Dict[str, int] = {
    "WELT_VERSION_MAJOR": 0,
    "WELT_VERSION_MINOR": 1,
    "WELT_VERSION_PATCH": 0,
    "WELT_VERSION": VERSION,
    "WELT_ABI_VERSION": ABI_VERSION,
    "WELT_OK": 0,
    "WELT_ERROR_ARGUMENT": -1,
    "WELT_ERROR_MESH": -2,
    "WELT_ERROR_CANCELLED": -3,
    "WELT_ERROR_TOO_LARGE": -4,
    "WELT_ERROR_BUFFER": -5,
    "WELT_ERROR_POISONED": -6,
    "WELT_ERROR_INTERNAL": -7,
    "WELT_ERROR_FILE": -8,
    "WELT_ERROR_SYNTAX": -9,
    "WELT_ERROR_RULE": -10,
    "WELT_ERROR_MEMORY": -11,
    "WELT_PLACE_WHOLE": 0,
    "WELT_PLACE_VERTEX": 1,
    "WELT_PLACE_EDGE": 2,
    "WELT_PLACE_FACE": 3,
    "WELT_NONE": 4294967295,
    "WELT_BOUNDARY_NONE": 0,
    "WELT_BOUNDARY_EDGE_ONLY": 1,
    "WELT_BOUNDARY_EDGE_AND_CORNER": 2,
    "WELT_CREASING_UNIFORM": 0,
    "WELT_CREASING_CHAIKIN": 1,
    "WELT_FORMAT_OBJ": 0,
    "WELT_FORMAT_PLY": 1,
    "WELT_PARENT_VERTEX": 0,
    "WELT_PARENT_EDGE": 1,
    "WELT_PARENT_FACE": 2,
    "WELT_FIT_NONE": 0,
    "WELT_FIT_LOOP": 1,
    "WELT_FIT_SOLVE": 2,
    "WELT_FIT_SURFACE": 3,
    "WELT_FIT_SURFACE_SLIDE": 4,
    "WELT_PARITY_AUTO": 0,
    "WELT_PARITY_ALL_QUAD": 1,
    "WELT_PARITY_LOCAL": 2,
}


class ImportOptions(ctypes.Structure):
    _fields_ = [
        ("struct_size", ctypes.c_uint32),
        ("repair", ctypes.c_uint32),
        ("weld", ctypes.c_double),
        ("max_vertices", ctypes.c_uint64),
        ("max_faces", ctypes.c_uint64),
        ("max_face_vertices", ctypes.c_uint64),
        ("max_vertex_faces", ctypes.c_uint64),
    ]


class BatchOptions(ctypes.Structure):
    _fields_ = [
        ("struct_size", ctypes.c_uint32),
        ("threads", ctypes.c_uint32),
        ("input_stride", ctypes.c_size_t),
        ("output_stride", ctypes.c_size_t),
    ]


class FeatureOptions(ctypes.Structure):
    _fields_ = [
        ("struct_size", ctypes.c_uint32),
        ("fit", ctypes.c_uint32),
        ("deviation", ctypes.c_uint32),
        ("parity", ctypes.c_uint32),
        ("strict", ctypes.c_uint32),
        ("max_script_depth", ctypes.c_uint32),
        ("max_applications", ctypes.c_uint64),
        ("max_steps", ctypes.c_uint64),
        ("max_changes", ctypes.c_uint64),
        ("max_growth", ctypes.c_uint64),
        ("max_extra_elements", ctypes.c_uint64),
        ("max_seconds", ctypes.c_double),
    ]


class SurfacePoint(ctypes.Structure):
    """A point of a limit surface that a query found."""

    _fields_ = [
        ("face", ctypes.c_uint32),
        ("corner", ctypes.c_uint32),
        ("u", ctypes.c_double),
        ("v", ctypes.c_double),
        ("position", ctypes.c_double * 3),
        ("normal", ctypes.c_double * 3),
        ("distance", ctypes.c_double),
    ]


class PatchOptions(ctypes.Structure):
    _fields_ = [("struct_size", ctypes.c_uint32), ("most_faces", ctypes.c_uint32), ("tolerance", ctypes.c_double)]


class Patch(ctypes.Structure):
    _fields_ = [
        ("poles", ctypes.POINTER(ctypes.c_double)),
        ("knots_u", ctypes.POINTER(ctypes.c_double)),
        ("knots_v", ctypes.POINTER(ctypes.c_double)),
        ("faces", ctypes.POINTER(ctypes.c_uint32)),
        ("face_count", ctypes.c_size_t),
        ("degree_u", ctypes.c_uint32),
        ("degree_v", ctypes.c_uint32),
        ("pole_count_u", ctypes.c_uint32),
        ("pole_count_v", ctypes.c_uint32),
        ("neighbours", ctypes.c_uint32 * 4),
        ("neighbour_sides", ctypes.c_uint32 * 4),
        ("irregular", ctypes.c_uint32 * 4),
        ("deviation", ctypes.c_double),
        ("relative_deviation", ctypes.c_double),
    ]


STRUCTS = {
    "welt_import_options": ImportOptions,
    "welt_batch_options": BatchOptions,
    "welt_feature_options": FeatureOptions,
    "welt_surface_point": SurfacePoint,
    "welt_patch_options": PatchOptions,
    "welt_patch": Patch,
}

PROTOTYPES = """
uint32_t welt_version(void);
int32_t welt_is_compatible(uint32_t version, uint32_t abi_version);
const char *welt_version_string(void);
void welt_error_free(welt_error *error);
int32_t welt_error_code(const welt_error *error);
const char *welt_error_message(const welt_error *error);
size_t welt_error_place_count(const welt_error *error);
uint32_t welt_error_place_kind(const welt_error *error, size_t index);
uint32_t welt_error_place_id(const welt_error *error, size_t index, uint32_t which);
const char *welt_error_place_message(const welt_error *error, size_t index);
const char *welt_error_place_file(const welt_error *error, size_t index);
uint32_t welt_error_place_line(const welt_error *error, size_t index);
uint32_t welt_error_place_column(const welt_error *error, size_t index);
int32_t welt_job_create(welt_job **job, welt_error **error);
int32_t welt_job_observe(welt_job *job, void (*observer)(void *context, double progress), void *context,
    welt_error **error);
void welt_job_free(welt_job *job);
void welt_job_cancel(const welt_job *job);
double welt_job_progress(const welt_job *job);
size_t welt_job_stage(const welt_job *job, char *buffer, size_t capacity);
void welt_report_free(welt_report *report);
const char *welt_report_json(const welt_report *report);
int32_t welt_mesh_create(const uint32_t *face_sizes, size_t face_count, const uint32_t *face_vertices, size_t
    face_vertex_count, const double *positions, size_t vertex_count, size_t stride, welt_mesh **mesh,
    welt_error **error);
void welt_mesh_free(welt_mesh *mesh);
int32_t welt_mesh_copy(const welt_mesh *mesh, welt_mesh **copy, welt_error **error);
size_t welt_mesh_vertex_count(const welt_mesh *mesh);
size_t welt_mesh_edge_count(const welt_mesh *mesh);
size_t welt_mesh_face_count(const welt_mesh *mesh);
size_t welt_mesh_face_vertex_count(const welt_mesh *mesh);
int32_t welt_mesh_positions(const welt_mesh *mesh, const double **positions, welt_error **error);
int32_t welt_mesh_set_positions(welt_mesh *mesh, const double *positions, size_t vertex_count, size_t stride,
    welt_error **error);
int32_t welt_mesh_faces(const welt_mesh *mesh, uint32_t *face_sizes, size_t face_capacity, uint32_t
    *face_vertices, size_t face_vertex_capacity, welt_error **error);
int32_t welt_mesh_edges(const welt_mesh *mesh, uint32_t *vertices, size_t capacity, welt_error **error);
int32_t welt_mesh_set_subdivision(welt_mesh *mesh, uint32_t boundary, uint32_t creasing, welt_error **error);
int32_t welt_mesh_set_edge_sharpness(welt_mesh *mesh, const uint32_t *vertices, const float *sharpness, size_t
    count, welt_error **error);
int32_t welt_mesh_set_vertex_sharpness(welt_mesh *mesh, const uint32_t *vertices, const float *sharpness,
    size_t count, welt_error **error);
int32_t welt_mesh_set_holes(welt_mesh *mesh, const uint32_t *faces, size_t count, welt_error **error);
int32_t welt_import_options_init(welt_import_options *options, size_t size);
int32_t welt_mesh_import_file(const char *path, size_t path_length, const welt_import_options *options,
    welt_mesh **mesh, welt_report **report, welt_error **error);
int32_t welt_mesh_import_memory(const char *name, size_t name_length, uint32_t format, const uint8_t *content,
    size_t size, const welt_import_options *options, welt_mesh **mesh, welt_report **report, welt_error
    **error);
int32_t welt_mesh_export_file(const welt_mesh *mesh, const char *path, size_t path_length, welt_error
    **error);
int32_t welt_mesh_limit_positions(const welt_mesh *mesh, double *positions, size_t capacity, welt_error
    **error);
int32_t welt_mesh_limit_normals(const welt_mesh *mesh, double *normals, size_t capacity, welt_error **error);
int32_t welt_refinement_create(const welt_mesh *mesh, uint32_t depth, const welt_job *job, welt_refinement
    **refinement, welt_error **error);
void welt_refinement_free(welt_refinement *refinement);
size_t welt_refinement_vertex_count(const welt_refinement *refinement, uint32_t level);
size_t welt_refinement_edge_count(const welt_refinement *refinement, uint32_t level);
size_t welt_refinement_face_count(const welt_refinement *refinement, uint32_t level);
size_t welt_refinement_face_vertex_count(const welt_refinement *refinement, uint32_t level);
int32_t welt_refinement_positions(const welt_refinement *refinement, uint32_t level, const double **positions,
    welt_error **error);
int32_t welt_refinement_face_vertices(const welt_refinement *refinement, uint32_t level, const uint32_t
    **vertices, welt_error **error);
int32_t welt_refinement_mesh(const welt_refinement *refinement, uint32_t level, welt_mesh **mesh, welt_error
    **error);
int32_t welt_refinement_vertex_parents(const welt_refinement *refinement, uint32_t level, uint32_t *kinds,
    uint32_t *elements, size_t capacity, welt_error **error);
int32_t welt_refinement_face_parents(const welt_refinement *refinement, uint32_t level, uint32_t *faces,
    uint32_t *corners, size_t capacity, welt_error **error);
int32_t welt_mesh_refine_loop(const welt_mesh *mesh, uint32_t levels, welt_mesh **refined, welt_error
    **error);
int32_t welt_mesh_loop_limit(const welt_mesh *mesh, double *positions, double *normals, size_t capacity,
    welt_error **error);
int32_t welt_mesh_loop_evaluate(const welt_mesh *mesh, const uint32_t *faces, const double *parameters, size_t
    count, uint32_t derivatives, const welt_batch_options *options, double *values, size_t capacity,
    welt_error **error);
int32_t welt_selection_create(const welt_mesh *mesh, const char *selectors, size_t length, welt_selection
    **selection, welt_error **error);
void welt_selection_free(welt_selection *selection);
size_t welt_selection_count(const welt_selection *selection);
int32_t welt_selection_edges(const welt_selection *selection, const welt_mesh *mesh, uint32_t *edges, size_t
    capacity, double *places, size_t place_capacity, welt_error **error);
int32_t welt_mesh_mark(welt_mesh *mesh, const welt_selection *selection, welt_error **error);
int32_t welt_rules_load(const char *path, size_t path_length, welt_rules **rules, welt_error **error);
int32_t welt_rules_linear(welt_rules **rules, welt_error **error);
void welt_rules_free(welt_rules *rules);
size_t welt_rules_parameter_count(const welt_rules *rules);
const char *welt_rules_parameter_name(const welt_rules *rules, size_t index);
const char *welt_rules_parameter_unit(const welt_rules *rules, size_t index);
const char *welt_rules_parameter_help(const welt_rules *rules, size_t index);
double welt_rules_parameter_default(const welt_rules *rules, size_t index);
int32_t welt_rules_parameter_range(const welt_rules *rules, size_t index, double *low, double *high,
    welt_error **error);
int32_t welt_feature_options_init(welt_feature_options *options, size_t size);
int32_t welt_feature_list(welt_report **list, welt_error **error);
int32_t welt_feature_apply(welt_mesh *mesh, const welt_selection *selection, const char *features, size_t
    features_length, const char *settings, size_t settings_length, const welt_feature_options *options, const
    welt_job *job, welt_report **report, welt_error **error);
int32_t welt_rules_apply(welt_mesh *mesh, const welt_selection *selection, const welt_rules *rules, const char
    *settings, size_t settings_length, const welt_feature_options *options, const welt_job *job, welt_report
    **report, welt_error **error);
int32_t welt_mesh_displace(welt_mesh *mesh, const uint32_t *vertices, const double *heights, size_t count,
    welt_error **error);
int32_t welt_mesh_deviation(const welt_mesh *first, const welt_mesh *second, uint32_t samples, double *values,
    const welt_job *job, welt_error **error);
int32_t welt_mesh_compare(const welt_mesh *first, const welt_mesh *second, uint32_t samples, uint32_t threads,
    double *values, const welt_job *job, welt_error **error);
int32_t welt_surface_create(const welt_mesh *mesh, const uint32_t *faces, size_t count, const welt_job *job,
    welt_surface **surface, welt_error **error);
void welt_surface_free(welt_surface *surface);
int32_t welt_surface_curvature(const welt_surface *surface, const uint32_t *faces, const uint32_t *corners,
    const double *parameters, size_t count, double *values, size_t capacity, welt_error **error);
int32_t welt_mesh_fit(welt_mesh *mesh, const uint32_t *vertices, size_t count, const welt_surface *surface,
    uint32_t fit, const welt_job *job, welt_report **report, welt_error **error);
int32_t welt_batch_options_init(welt_batch_options *options, size_t size);
int32_t welt_surface_evaluate(const welt_surface *surface, const uint32_t *faces, const uint32_t *corners,
    const double *parameters, size_t count, uint32_t derivatives, const welt_batch_options *options, double
    *values, size_t capacity, welt_error **error);
int32_t welt_surface_closest(const welt_surface *surface, const double *points, size_t count, double radius,
    const welt_surface_point *starts, const welt_batch_options *options, welt_surface_point *found, size_t
    capacity, welt_error **error);
int32_t welt_surface_signed_distances(const welt_surface *surface, const double *points, size_t count, const
    welt_batch_options *options, double *distances, size_t capacity, welt_error **error);
int32_t welt_surface_first_hits(const welt_surface *surface, const double *lines, size_t count, double first,
    double last, const welt_batch_options *options, welt_surface_point *found, size_t capacity, welt_error
    **error);
int32_t welt_surface_all_hits(const welt_surface *surface, const double *lines, size_t count, double first,
    double last, const welt_batch_options *options, size_t *starts, size_t *needed, welt_surface_point *found,
    size_t capacity, welt_error **error);
int32_t welt_patch_options_init(welt_patch_options *options, size_t size);
int32_t welt_patches_create(const welt_mesh *mesh, const uint32_t *faces, size_t count, const
    welt_patch_options *options, const welt_job *job, welt_patches **patches, welt_error **error);
void welt_patches_free(welt_patches *patches);
size_t welt_patches_count(const welt_patches *patches);
int32_t welt_patches_get(const welt_patches *patches, size_t index, welt_patch *patch, welt_error **error);
int32_t welt_patches_report(const welt_patches *patches, welt_report **report, welt_error **error);
"""

_VALUES = {
    "int32_t": ctypes.c_int32,
    "uint32_t": ctypes.c_uint32,
    "size_t": ctypes.c_size_t,
    "uint64_t": ctypes.c_uint64,
    "double": ctypes.c_double,
    "float": ctypes.c_float,
    "uint8_t": ctypes.c_uint8,
    **STRUCTS,
}

Observer = ctypes.CFUNCTYPE(None, ctypes.c_void_p, ctypes.c_double)


class Function(NamedTuple):
    """A function of the ABI."""

    result: Any
    arguments: List[Any]
    # Index of each parameter that is a handle, whether the call changes what it leads to, and its kind.
    handles: List[Tuple[int, bool, str]]
    # Whether the last parameter is the error.
    fails: bool


def ctype(declaration: str) -> Any:
    """The ctypes type of a C type, such as `const double **`. Handles and pointers to them are `void *`."""
    words = declaration.replace("const", " ").replace("*", " * ").split()
    stars = words.count("*")
    name = words[0]
    if name == "void":
        return ctypes.c_void_p if stars else None
    if name == "char":
        return ctypes.c_char_p
    if name not in _VALUES:
        return ctypes.c_void_p if stars == 1 else ctypes.POINTER(ctypes.c_void_p)
    result: Any = _VALUES[name]
    for _ in range(stars):
        result = ctypes.POINTER(result)
    return result


def is_handle(declaration: str) -> bool:
    """Whether a parameter is a handle: one star, and a kind that has no layout here."""
    words = declaration.replace("const", " ").replace("*", " * ").split()
    return words[0].startswith("welt_") and words[0] not in STRUCTS and words.count("*") == 1


def parse(prototype: str) -> Tuple[str, str, List[str]]:
    """Name, type of the result and types of the parameters of a prototype, each without the parameter's name."""
    head, tail = " ".join(prototype.split()).split("(", 1)
    name = re.search(r"\w+$", head).group()  # type: ignore[union-attr]
    result = head[: -len(name)].strip()
    tail = tail.rsplit(")", 1)[0]
    tail = re.sub(r"void \(\*(\w+)\)\([^)]*\)", r"observer \1", tail)
    parameters = [] if tail == "void" else [re.sub(r"\w+$", "", p.strip()).strip() for p in tail.split(",")]
    return name, result, parameters


def functions() -> Dict[str, Function]:
    """All functions by name."""
    table = {}
    for prototype in PROTOTYPES.split(";"):
        if not prototype.strip():
            continue
        name, result, parameters = parse(prototype)
        handles = [(i, not p.startswith("const"), p.replace("const ", "").split()[0]) for i, p in enumerate(parameters) if is_handle(p)]
        arguments = [Observer if p == "observer" else ctype(p) for p in parameters]
        fails = bool(parameters) and parameters[-1] == "welt_error **"
        table[name] = Function(ctype(result), arguments, handles, fails)
    return table
