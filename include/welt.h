/* welt: procedural features on Catmull-Clark control meshes. Generated from src/ffi: do not edit.
 *
 * Linking: the shared library is libwelt.so (SONAME libwelt.so.0); the static one is libwelt.a.
 *
 * Handles (welt_mesh, welt_job, ...) are opaque. Each kind has one function that frees it, which accepts NULL. A handle is
 * used only between the call that made it and the call that frees it.
 *
 * Status: functions that can fail return WELT_OK or one of WELT_ERROR_*, which are negative; numbers are never reused. Their
 * last parameter, error, may be NULL. Otherwise it receives NULL on success and an error on failure, which the caller
 * frees with welt_error_free; what it held before is overwritten without being freed. Results are written only on success;
 * but a call that returns WELT_ERROR_INTERNAL may have written some of what it writes to a buffer of the caller.
 *
 * Threads: there is no global state. Calls on different handles may run at the same time. A parameter "const welt_x *" is
 * only read: any number of threads may pass the same handle to such parameters at the same time. A parameter
 * "welt_x *" is changed: no other thread may use the handle meanwhile. A welt_job may be used by all threads at any time.
 *
 * Memory: arrays that are passed in are copied. Pointers that are given out belong to the library, for as long as the
 * function says. Buffers belong to the caller; one that is too small is an error (WELT_ERROR_BUFFER) and is not written to.
 *
 * Numbers: indices are 0-based; coordinates are doubles in the unit of the caller; text is UTF-8.
 */

#ifndef WELT_H
#define WELT_H


#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* What stands before every function: a program may define it, for example as __declspec(dllimport). */
#ifndef WELT_API
#define WELT_API
#endif


/*
 Major version of this header.
 */
#define WELT_VERSION_MAJOR 0

/*
 Minor version of this header.
 */
#define WELT_VERSION_MINOR 1

/*
 Patch version of this header.
 */
#define WELT_VERSION_PATCH 0

/*
 Version of this header as one number, for comparisons: major * 65536 + minor * 256 + patch.
 */
#define WELT_VERSION 256

/*
 Version of the binary interface, the number in the name of the shared library. It grows only when a program that was
 compiled before would no longer run.
 */
#define WELT_ABI_VERSION 0

/*
 Success.
 */
#define WELT_OK 0

/*
 An argument is NULL that must not be, or has a value outside its range. Nothing was changed.
 */
#define WELT_ERROR_ARGUMENT -1

/*
 The polygons are no surface: the places of the error list every defect.
 */
#define WELT_ERROR_MESH -2

/*
 The job was cancelled. What the call was changing is as it was before.
 */
#define WELT_ERROR_CANCELLED -3

/*
 The result would have more elements than 31 bits can number.
 */
#define WELT_ERROR_TOO_LARGE -4

/*
 A buffer is too small; the message says how much room is needed.
 */
#define WELT_ERROR_BUFFER -5

/*
 The handle was left half changed by a call that returned WELT_ERROR_INTERNAL. It can only be freed.
 */
#define WELT_ERROR_POISONED -6

/*
 A defect of the library; the message says where. Please report it.
 */
#define WELT_ERROR_INTERNAL -7

/*
 A file cannot be read or written.
 */
#define WELT_ERROR_FILE -8

/*
 A text or a file cannot be understood: the places of the error have file, line and column.
 */
#define WELT_ERROR_SYNTAX -9

/*
 A rule failed, or the rules do not come to an end, or, where that is asked for, a mark is left that no rule handles; the
 message names rule and place. The mesh is as it was before.
 */
#define WELT_ERROR_RULE -10

/*
 There is no memory for a large list; the message says how much was asked for. Nothing was changed.
 */
#define WELT_ERROR_MEMORY -11

/*
 The place is no element of a mesh: the input as a whole, or a place in a text.
 */
#define WELT_PLACE_WHOLE 0

/*
 The place is a vertex; its first id is the vertex.
 */
#define WELT_PLACE_VERTEX 1

/*
 The place is an edge; its ids are the vertices of the edge.
 */
#define WELT_PLACE_EDGE 2

/*
 The place is a face; its first id is the face.
 */
#define WELT_PLACE_FACE 3

/*
 The id that stands for "none".
 */
#define WELT_NONE 4294967295

/*
 Faces at a boundary vertex are no part of the surface, unless all boundary edges there are infinitely sharp.
 */
#define WELT_BOUNDARY_NONE 0

/*
 The boundary is a cubic B-spline curve. The default.
 */
#define WELT_BOUNDARY_EDGE_ONLY 1

/*
 As WELT_BOUNDARY_EDGE_ONLY, but vertices of a single face stay where they are.
 */
#define WELT_BOUNDARY_EDGE_AND_CORNER 2

/*
 Sharpness falls by one from level to level. The default.
 */
#define WELT_CREASING_UNIFORM 0

/*
 Sharpness falls by one from level to level after it was averaged along the crease (Chaikin).
 */
#define WELT_CREASING_CHAIKIN 1

/*
 Wavefront OBJ.
 */
#define WELT_FORMAT_OBJ 0

/*
 PLY, ascii or binary.
 */
#define WELT_FORMAT_PLY 1

/*
 The vertex stands for a vertex of the level before.
 */
#define WELT_PARENT_VERTEX 0

/*
 The vertex stands for an edge of the level before.
 */
#define WELT_PARENT_EDGE 1

/*
 The vertex stands for a face of the level before.
 */
#define WELT_PARENT_FACE 2

/*
 Leave vertices where the rules put them.
 */
#define WELT_FIT_NONE 0

/*
 The iteration of Thaller, Augsdoerfer and Fellner 2016, section 5.3.
 */
#define WELT_FIT_LOOP 1

/*
 The sparse system which that iteration converges to.
 */
#define WELT_FIT_SOLVE 2

/*
 Least squares of distance and slope over samples of the surface; vertices move along the normal.
 */
#define WELT_FIT_SURFACE 3

/*
 The same; vertices that were there before may also slide along the surface, which brings the new surface closest.
 */
#define WELT_FIT_SURFACE_SLIDE 4

/*
 A line of vertices between faces that the marks leave with an odd number of sides, where the way is short; one irregular
 face each elsewhere.
 */
#define WELT_PARITY_AUTO 0

/*
 Lines wherever there is a way, also to triangles and pentagons, so that no new face is other than a quad.
 */
#define WELT_PARITY_ALL_QUAD 1

/*
 No lines: one irregular face each.
 */
#define WELT_PARITY_LOCAL 2

/*
 Why a call failed: a code, a message of one line, and the places it speaks of. Never changes.
 */
typedef struct welt_error welt_error;

/*
 Watches and cancels a long call. All functions of a job may be called from any thread at any time, also while a call
 works with it. Cancelling is for good: use a new job for the next call.
 */
typedef struct welt_job welt_job;

/*
 A control mesh. Its vertices, edges and faces are numbered from 0 without gaps.
 */
typedef struct welt_mesh welt_mesh;

/*
 The limit surface as bicubic B-spline patches. Never changes.
 */
typedef struct welt_patches welt_patches;

/*
 The Catmull-Clark refinements of a mesh, level by level. Level 0 is the mesh itself as it was. Never changes, and does
 not depend on the mesh after it was made.
 */
typedef struct welt_refinement welt_refinement;

/*
 What a call did, beyond its result. Never changes.
 */
typedef struct welt_report welt_report;

/*
 A rule set. Never changes.
 */
typedef struct welt_rules welt_rules;

/*
 Marked edges: which edges of a mesh a feature crosses, and where. Never changes; it belongs to the mesh as it was when the
 selection was made.
 */
typedef struct welt_selection welt_selection;

/*
 A limit surface, frozen: it stays as it is when its mesh changes. Never changes.
 */
typedef struct welt_surface welt_surface;

/*
 How a file is taken over. Set it by welt_import_options_init, then change what differs.
 */
typedef struct {
    /*
     Set by welt_import_options_init; leave it.
     */
    uint32_t struct_size;
    /*
     Not 0: split apart, turn round or remove what cannot be held, instead of refusing the file. Default 0.
     */
    uint32_t repair;
    /*
     Merge vertices that are no further apart than this distance, in the unit of the file; 0 merges equal ones, a
     negative number none. Default -1.
     */
    double weld;
    /*
     Most vertices of a file, and most texture coordinates. Default 2^28.
     */
    uint64_t max_vertices;
    /*
     Most faces of a file. Default 2^28.
     */
    uint64_t max_faces;
    /*
     Most vertices of a face. Default 1024.
     */
    uint64_t max_face_vertices;
    /*
     Most faces at a vertex; work and memory there grow with its square. Default 1024.
     */
    uint64_t max_vertex_faces;
} welt_import_options;

/*
 How a call does a batch of points or lines. Set it with welt_batch_options_init before use.
 */
typedef struct {
    /*
     sizeof (welt_batch_options).
     */
    uint32_t struct_size;
    /*
     Threads to use, 1 by default; 0 for as many as the machine has. Results do not depend on it.
     */
    uint32_t threads;
    /*
     Bytes from one element of the input (a pair of parameters, a point, a line) to the next; 0, the default, where nothing
     lies between them.
     */
    size_t input_stride;
    /*
     Bytes from one element of the results to the next; 0, the default, where nothing lies between them.
     */
    size_t output_stride;
} welt_batch_options;

/*
 How a feature is applied. Set it by welt_feature_options_init, then change what differs.
 */
typedef struct {
    /*
     Set by welt_feature_options_init; leave it.
     */
    uint32_t struct_size;
    /*
     How the changed mesh is fitted to the surface as it was: one of WELT_FIT_*. Default WELT_FIT_SURFACE_SLIDE.
     */
    uint32_t fit;
    /*
     Not 0: measure deviations and look for thin walls; costs more than the feature. Default 0.
     */
    uint32_t deviation;
    /*
     What is done about faces that the marks leave with an odd number of sides: one of WELT_PARITY_*. Default
     WELT_PARITY_AUTO.
     */
    uint32_t parity;
    /*
     Not 0: marks that no rule handles are an error, WELT_ERROR_RULE, whose places are the marked edges; else they
     are kept and the report lists them. Default 0.
     */
    uint32_t strict;
    /*
     Most procedures and loops of a script of the rules inside one another. Default 1000.
     */
    uint32_t max_script_depth;
    /*
     Most applications of rules. This and what follows is for each run of the rules; correcting widths and depths takes
     several. Default 10 million.
     */
    uint64_t max_applications;
    /*
     Most steps of scripts and of the search for matches. Default 10^9.
     */
    uint64_t max_steps;
    /*
     Most changes of the mesh; bounds the memory, about 150 bytes each. Default 20 million.
     */
    uint64_t max_changes;
    /*
     The mesh may come to have at most this many times the vertices, edges and faces that it has, together, default 16,
     */
    uint64_t max_growth;
    /*
     and this many more. Default 1 million.
     */
    uint64_t max_extra_elements;
    /*
     Most seconds, at least 0, infinite for no bound. Default 60.
     */
    double max_seconds;
} welt_feature_options;

/*
 A point of the surface that a query found.
 */
typedef struct {
    /*
     The face in which it lies; WELT_NONE where nothing was found, the rest is 0 then.
     */
    uint32_t face;
    /*
     The patch of the face; see welt_surface_evaluate.
     */
    uint32_t corner;
    /*
     Parameter of the patch.
     */
    double u;
    /*
     Parameter of the patch.
     */
    double v;
    /*
     x, y and z.
     */
    double position[3];
    /*
     The unit normal, outwards; (0, 0, 0) where the surface has none.
     */
    double normal[3];
    /*
     For a closest point the distance; for a hit the parameter s of the line: the hit is origin + s * direction.
     */
    double distance;
} welt_surface_point;

/*
 How patches are made.
 */
typedef struct {
    /*
     Set by welt_patch_options_init; leave it.
     */
    uint32_t struct_size;
    /*
     Faces along a side of a patch at most, 1 or more. Default 10.
     */
    uint32_t most_faces;
    /*
     Aim for the deviation beside extraordinary vertices, in parts of the mean length of the edges of the control face
     there; greater than 0. Default 1e-4.
     */
    double tolerance;
} welt_patch_options;

/*
 A bicubic B-spline patch of the limit surface. The arrays belong to the patches and are valid until they are freed.
 */
typedef struct {
    /*
     x, y and z of each pole, row by row, u running fastest: pole (i, j) is number j * pole_count_u + i.
     */
    const double *poles;
    /*
     Knots along u, ascending, pole_count_u + degree_u + 1 of them: the first and the last one stand degree_u + 1 times, those
     between once.
     */
    const double *knots_u;
    /*
     Knots along v, likewise.
     */
    const double *knots_v;
    /*
     The control faces whose surface it is, row by row, u running fastest, each once.
     */
    const uint32_t *faces;
    /*
     Number of faces.
     */
    size_t face_count;
    /*
     3.
     */
    uint32_t degree_u;
    /*
     3.
     */
    uint32_t degree_v;
    /*
     Poles along u.
     */
    uint32_t pole_count_u;
    /*
     Poles along v.
     */
    uint32_t pole_count_v;
    /*
     Per side the patch beyond it, or WELT_NONE at the border of the surface. Sides: 0 at the first v in the direction of u,
     1 at the last u, 2 at the last v against u, 3 at the first u. The two patches have the same poles along the side, in
     opposite order, equal to the last bit, and the same spans of knots.
     */
    uint32_t neighbours[4];
    /*
     Which side of that patch; WELT_NONE at the border.
     */
    uint32_t neighbour_sides[4];
    /*
     Per corner, at which side of the same number begins, not 0 where an extraordinary vertex lies there: in the last
     three spans beside it the patch is an approximation. Everywhere else it is the limit surface itself.
     */
    uint32_t irregular[4];
    /*
     Greatest distance to the limit surface that was found; 0 where the patch is exact.
     */
    double deviation;
    /*
     The same in parts of the mean length of the edges of the control face.
     */
    double relative_deviation;
} welt_patch;

/*
 The version of the library that runs, in the form of WELT_VERSION. It can differ from that of the header when the
 shared library was replaced. Since: 0.1.
 */
WELT_API
uint32_t welt_version(void);

/*
 1 where a program runs with this library that was compiled with a header of this WELT_VERSION and WELT_ABI_VERSION: the
 binary interface is the same, and the library is not older than the header. Else 0. Since: 0.1.
 */
WELT_API
int32_t welt_is_compatible(uint32_t version,
                           uint32_t abi_version);

/*
 The version of the library that runs as text, such as "0.1.0". Owned by the library, valid for ever. Since: 0.1.
 */
WELT_API
const char *welt_version_string(void);

/*
 Frees an error. NULL is allowed. Since: 0.1.
 */
WELT_API void welt_error_free(welt_error *error);

/*
 The status code of the call that failed; WELT_OK where error is NULL. Since: 0.1.
 */
WELT_API int32_t welt_error_code(const welt_error *error);

/*
 What went wrong and what to do about it: one line, UTF-8, NUL-terminated, valid until the error is freed. Empty where
 error is NULL. Since: 0.1.
 */
WELT_API
const char *welt_error_message(const welt_error *error);

/*
 Number of places the error speaks of; 0 where error is NULL. Since: 0.1.
 */
WELT_API size_t welt_error_place_count(const welt_error *error);

/*
 What kind of place number index is: one of WELT_PLACE_*. WELT_PLACE_WHOLE where there is no such place. Since: 0.1.
 */
WELT_API
uint32_t welt_error_place_kind(const welt_error *error,
                               size_t index);

/*
 Id number which (0 or 1) of place number index, 0-based: a place that is an edge has two, a vertex and a face have one.
 WELT_NONE where there is none. Since: 0.1.
 */
WELT_API
uint32_t welt_error_place_id(const welt_error *error,
                             size_t index,
                             uint32_t which);

/*
 What is wrong at place number index: one line, UTF-8, NUL-terminated, valid until the error is freed. Empty where there
 is no such place. Since: 0.1.
 */
WELT_API
const char *welt_error_place_message(const welt_error *error,
                                     size_t index);

/*
 The file in which place number index is: UTF-8, NUL-terminated, valid until the error is freed. Empty where the place is in
 no file, or there is no such place. Since: 0.1.
 */
WELT_API
const char *welt_error_place_file(const welt_error *error,
                                  size_t index);

/*
 The line of place number index, 1-based; 0 where there is none. Since: 0.1.
 */
WELT_API uint32_t welt_error_place_line(const welt_error *error, size_t index);

/*
 The column of place number index in bytes, 1-based; 0 where there is none. Since: 0.1.
 */
WELT_API uint32_t welt_error_place_column(const welt_error *error, size_t index);

/*
 Makes a job. job: receives the handle; free it with welt_job_free after every call that uses it has returned.
 Since: 0.1.
 */
WELT_API int32_t welt_job_create(welt_job **job, welt_error **error);

/*
 Has a function called with the progress at every step of a call that works with the job.

 job: must not be NULL; no call may work with it meanwhile.
 observer: is called by the thread that made the call, with the progress in [0, 1]. It may use the functions of this job,
 welt_job_cancel above all, and handles that the call does not change. It must come back: no exception, no longjmp.
 context: is passed to the function as it is; may be NULL.

 Since: 0.1.
 */
WELT_API
int32_t welt_job_observe(welt_job *job,
                         void (*observer)(void *context, double progress),
                         void *context,
                         welt_error **error);

/*
 Frees a job. NULL is allowed. Since: 0.1.
 */
WELT_API void welt_job_free(welt_job *job);

/*
 Asks the call that works with the job to stop. It returns WELT_ERROR_CANCELLED soon after, and what it was changing is
 as it was before. NULL is allowed. Since: 0.1.
 */
WELT_API
void welt_job_cancel(const welt_job *job);

/*
 How much of the present call is done, in [0, 1]; 0 where job is NULL. Since: 0.1.
 */
WELT_API double welt_job_progress(const welt_job *job);

/*
 Writes the name of the present stage of the work, UTF-8 and NUL-terminated, cut where the buffer ends. Gives the length
 of the whole name without its NUL; 0 where job is NULL. buffer: may be NULL when capacity is 0. capacity: room in
 bytes. Since: 0.1.
 */
WELT_API
size_t welt_job_stage(const welt_job *job,
                      char *buffer,
                      size_t capacity);

/*
 Frees a report. NULL is allowed. Since: 0.1.
 */
WELT_API void welt_report_free(welt_report *report);

/*
 The report as JSON, UTF-8, NUL-terminated, valid until the report is freed. Empty where report is NULL. Since: 0.1.
 */
WELT_API
const char *welt_report_json(const welt_report *report);

/*
 Makes a mesh of polygons.

 face_sizes: number of vertices of each face, 3 or more.
 face_count: number of faces.
 face_vertices: the vertices of all faces one after the other, counter-clockwise seen from outside, 0-based.
 face_vertex_count: number of entries of face_vertices, the sum of face_sizes.
 positions: x, y and z of each vertex, finite numbers.
 vertex_count: number of vertices; those without a face are kept.
 stride: bytes from one vertex to the next, a multiple of 8 and at least 24; 0 for 24.
 mesh: receives the handle; free it with welt_mesh_free.

 The arrays are copied. Fails with WELT_ERROR_MESH where the polygons are no surface (an edge with three faces, fans of
 faces that meet in a vertex only, neighbours that are inside out to each other, ...): each place of the error is one
 defect; with WELT_ERROR_TOO_LARGE beyond the default limits of welt_import_options; with WELT_ERROR_MEMORY. Since: 0.1.
 */
WELT_API
int32_t welt_mesh_create(const uint32_t *face_sizes,
                         size_t face_count,
                         const uint32_t *face_vertices,
                         size_t face_vertex_count,
                         const double *positions,
                         size_t vertex_count,
                         size_t stride,
                         welt_mesh **mesh,
                         welt_error **error);

/*
 Frees a mesh. NULL is allowed. Since: 0.1.
 */
WELT_API void welt_mesh_free(welt_mesh *mesh);

/*
 Copies a mesh, with all that it holds: options, sharpness, holes, marks, groups and texture coordinates.

 mesh: must not be NULL.
 copy: receives the handle; free it with welt_mesh_free.

 Selections that were made on the mesh serve the copy too. Fails with WELT_ERROR_MEMORY. Since: 0.1.
 */
WELT_API int32_t welt_mesh_copy(const welt_mesh *mesh, welt_mesh **copy, welt_error **error);

/*
 Number of vertices; 0 where mesh is NULL or poisoned. Since: 0.1.
 */
WELT_API size_t welt_mesh_vertex_count(const welt_mesh *mesh);

/*
 Number of edges; 0 where mesh is NULL or poisoned. Since: 0.1.
 */
WELT_API size_t welt_mesh_edge_count(const welt_mesh *mesh);

/*
 Number of faces; 0 where mesh is NULL or poisoned. Since: 0.1.
 */
WELT_API size_t welt_mesh_face_count(const welt_mesh *mesh);

/*
 Sum of the numbers of vertices of all faces; 0 where mesh is NULL or poisoned. Since: 0.1.
 */
WELT_API size_t welt_mesh_face_vertex_count(const welt_mesh *mesh);

/*
 The positions of the vertices as a view.

 mesh: must not be NULL.
 positions: receives the address of x, y and z of each vertex, 3 * welt_mesh_vertex_count(mesh) doubles that belong to
 the mesh and are valid until it is changed or freed.

 Since: 0.1.
 */
WELT_API
int32_t welt_mesh_positions(const welt_mesh *mesh,
                            const double **positions,
                            welt_error **error);

/*
 Moves all vertices.

 mesh: must not be NULL.
 positions: x, y and z of each vertex, finite numbers.
 vertex_count: must be that of the mesh.
 stride: bytes from one vertex to the next, a multiple of 8 and at least 24; 0 for 24.

 After a failure the mesh is as it was before. Since: 0.1.
 */
WELT_API
int32_t welt_mesh_set_positions(welt_mesh *mesh,
                                const double *positions,
                                size_t vertex_count,
                                size_t stride,
                                welt_error **error);

/*
 Writes the faces, in the form that welt_mesh_create takes.

 mesh: must not be NULL.
 face_sizes: receives the number of vertices of each face.
 face_capacity: room in face_sizes, at least welt_mesh_face_count(mesh) elements.
 face_vertices: receives the vertices of all faces one after the other, counter-clockwise, 0-based.
 face_vertex_capacity: room in face_vertices, at least welt_mesh_face_vertex_count(mesh) elements.

 Since: 0.1.
 */
WELT_API
int32_t welt_mesh_faces(const welt_mesh *mesh,
                        uint32_t *face_sizes,
                        size_t face_capacity,
                        uint32_t *face_vertices,
                        size_t face_vertex_capacity,
                        welt_error **error);

/*
 Writes the two vertices of each edge, in the order in which welt_refinement_vertex_parents numbers the edges of level 0.

 mesh: must not be NULL.
 vertices: receives two vertices per edge.
 capacity: room in vertices, at least 2 * welt_mesh_edge_count(mesh) elements.

 Since: 0.1.
 */
WELT_API
int32_t welt_mesh_edges(const welt_mesh *mesh,
                        uint32_t *vertices,
                        size_t capacity,
                        welt_error **error);

/*
 Sets the options under which a mesh is subdivided.

 mesh: must not be NULL.
 boundary: one of WELT_BOUNDARY_*.
 creasing: one of WELT_CREASING_*.

 Since: 0.1.
 */
WELT_API
int32_t welt_mesh_set_subdivision(welt_mesh *mesh,
                                  uint32_t boundary,
                                  uint32_t creasing,
                                  welt_error **error);

/*
 Sets the sharpness of edges.

 mesh: must not be NULL.
 vertices: the two vertices of each edge.
 sharpness: of each edge, 0 (smooth) or more; 10 and more is infinitely sharp.
 count: number of edges.

 Fails with WELT_ERROR_MESH where two vertices are not joined by an edge; the mesh is as it was then. Since: 0.1.
 */
WELT_API
int32_t welt_mesh_set_edge_sharpness(welt_mesh *mesh,
                                     const uint32_t *vertices,
                                     const float *sharpness,
                                     size_t count,
                                     welt_error **error);

/*
 Sets the sharpness of vertices.

 mesh: must not be NULL.
 vertices: the vertices.
 sharpness: of each vertex, 0 (smooth) or more; 10 and more is infinitely sharp.
 count: number of vertices.

 After a failure the mesh is as it was before. Since: 0.1.
 */
WELT_API
int32_t welt_mesh_set_vertex_sharpness(welt_mesh *mesh,
                                       const uint32_t *vertices,
                                       const float *sharpness,
                                       size_t count,
                                       welt_error **error);

/*
 Says which faces are holes: faces that are subdivided like others but are no part of the surface.

 mesh: must not be NULL.
 faces: the holes; all other faces are none.
 count: number of holes.

 After a failure the mesh is as it was before. Since: 0.1.
 */
WELT_API
int32_t welt_mesh_set_holes(welt_mesh *mesh,
                            const uint32_t *faces,
                            size_t count,
                            welt_error **error);

/*
 Sets options to their defaults. options: must not be NULL. size: sizeof *options. Fails with WELT_ERROR_ARGUMENT where the
 size is none that the library knows, which is so when the program was compiled for a newer one. Since: 0.1.
 */
WELT_API
int32_t welt_import_options_init(welt_import_options *options,
                                 size_t size);

/*
 Reads a mesh from a file, OBJ or PLY by its extension.

 path: UTF-8.
 path_length: in bytes, SIZE_MAX for a NUL-terminated path.
 options: may be NULL for defaults.
 mesh: receives the handle; free it with welt_mesh_free.
 report: may be NULL; else receives what the file holds and the mesh does not ("ignored") and what was changed ("repairs");
 free it with welt_report_free.

 Fails with WELT_ERROR_FILE where the file cannot be read, WELT_ERROR_SYNTAX where it cannot be understood (the place
 has the line), WELT_ERROR_MESH where the faces are no surface (each place has a defect and its line),
 WELT_ERROR_TOO_LARGE where more faces meet at a vertex than the options allow. Since: 0.1.
 */
WELT_API
int32_t welt_mesh_import_file(const char *path,
                              size_t path_length,
                              const welt_import_options *options,
                              welt_mesh **mesh,
                              welt_report **report,
                              welt_error **error);

/*
 Reads a mesh from the content of a file.

 name: stands for the file in messages; UTF-8, NULL for "memory".
 name_length: in bytes, SIZE_MAX for a NUL-terminated name.
 format: one of WELT_FORMAT_*.
 content: the bytes of the file; may be NULL when size is 0.
 size: number of bytes.
 options: may be NULL for defaults.
 mesh: receives the handle; free it with welt_mesh_free.
 report: as for welt_mesh_import_file.

 Fails as welt_mesh_import_file does. Since: 0.1.
 */
WELT_API
int32_t welt_mesh_import_memory(const char *name,
                                size_t name_length,
                                uint32_t format,
                                const uint8_t *content,
                                size_t size,
                                const welt_import_options *options,
                                welt_mesh **mesh,
                                welt_report **report,
                                welt_error **error);

/*
 Writes a mesh to a file, OBJ or PLY by its extension. A file that was there is replaced at the very end, so that it is as
 it was before when writing fails.

 mesh: must not be NULL.
 path: UTF-8.
 path_length: in bytes, SIZE_MAX for a NUL-terminated path.

 Fails with WELT_ERROR_FILE and WELT_ERROR_MEMORY. Since: 0.1.
 */
WELT_API
int32_t welt_mesh_export_file(const welt_mesh *mesh,
                              const char *path,
                              size_t path_length,
                              welt_error **error);

/*
 Writes the point of the limit surface that belongs to each vertex. A vertex without a face stays where it is.

 mesh: must not be NULL.
 positions: receives x, y and z of each point.
 capacity: room in positions, at least 3 * welt_mesh_vertex_count(mesh) doubles.

 Since: 0.1.
 */
WELT_API
int32_t welt_mesh_limit_positions(const welt_mesh *mesh,
                                  double *positions,
                                  size_t capacity,
                                  welt_error **error);

/*
 Writes the unit normal of the limit surface at each vertex, outwards; (0, 0, 0) where there is none: at a vertex without
 a face, and where the surface has no tangent plane.

 mesh: must not be NULL.
 normals: receives x, y and z of each normal.
 capacity: room in normals, at least 3 * welt_mesh_vertex_count(mesh) doubles.

 Since: 0.1.
 */
WELT_API
int32_t welt_mesh_limit_normals(const welt_mesh *mesh,
                                double *normals,
                                size_t capacity,
                                welt_error **error);

/*
 Refines a mesh.

 mesh: must not be NULL.
 depth: number of the last level, 0 or more; each level has four times the faces of the one before.
 job: may be NULL.
 refinement: receives the handle; free it with welt_refinement_free.

 Fails with WELT_ERROR_TOO_LARGE before anything is computed where a level would have more elements than 31 bits can
 number, with WELT_ERROR_MEMORY, and with WELT_ERROR_CANCELLED. Memory: about 100 bytes for each face of the last level.
 Since: 0.1.
 */
WELT_API
int32_t welt_refinement_create(const welt_mesh *mesh,
                               uint32_t depth,
                               const welt_job *job,
                               welt_refinement **refinement,
                               welt_error **error);

/*
 Frees a refinement. NULL is allowed. Since: 0.1.
 */
WELT_API void welt_refinement_free(welt_refinement *refinement);

/*
 Number of vertices of a level; 0 where refinement is NULL or has no such level. Since: 0.1.
 */
WELT_API size_t welt_refinement_vertex_count(const welt_refinement *refinement, uint32_t level);

/*
 Number of edges of a level; 0 where refinement is NULL or has no such level. Since: 0.1.
 */
WELT_API size_t welt_refinement_edge_count(const welt_refinement *refinement, uint32_t level);

/*
 Number of faces of a level; 0 where refinement is NULL or has no such level. All levels but 0 have quads only.
 Since: 0.1.
 */
WELT_API
size_t welt_refinement_face_count(const welt_refinement *refinement,
                                  uint32_t level);

/*
 Sum of the numbers of vertices of all faces of a level; 0 where refinement is NULL or has no such level. Since: 0.1.
 */
WELT_API
size_t welt_refinement_face_vertex_count(const welt_refinement *refinement,
                                         uint32_t level);

/*
 The positions of the vertices of a level as a view.

 refinement: must not be NULL.
 level: 0 to the depth.
 positions: receives the address of x, y and z of each vertex, 3 * welt_refinement_vertex_count(refinement, level)
 doubles that belong to the refinement and are valid until it is freed.

 Since: 0.1.
 */
WELT_API
int32_t welt_refinement_positions(const welt_refinement *refinement,
                                  uint32_t level,
                                  const double **positions,
                                  welt_error **error);

/*
 The vertices of the faces of a level as a view.

 refinement: must not be NULL.
 level: 0 to the depth.
 vertices: receives the address of the vertices of all faces one after the other, counter-clockwise, 0-based:
 welt_refinement_face_vertex_count(refinement, level) numbers that belong to the refinement and are valid until it is freed. On level 1 and above there are 4 per face: a face covers one
 corner of a face of the level before, and has the point of that corner, of the edge that leaves it, of the face, and
 of the edge that arrives. On level 0 the numbers of vertices are those that welt_mesh_faces gives.

 Since: 0.1.
 */
WELT_API
int32_t welt_refinement_face_vertices(const welt_refinement *refinement,
                                      uint32_t level,
                                      const uint32_t **vertices,
                                      welt_error **error);

/*
 Gives a level as a mesh: another control mesh of the same surface. It has the sharpness that is left and the options of
 subdivision; faces without a limit surface are holes.

 refinement: must not be NULL.
 level: 0 to the depth.
 mesh: receives the handle; free it with welt_mesh_free.

 Its vertices and faces are numbered as those of the level, so that welt_mesh_limit_positions of it moves the level onto
 the limit surface. Since: 0.1.
 */
WELT_API
int32_t welt_refinement_mesh(const welt_refinement *refinement,
                             uint32_t level,
                             welt_mesh **mesh,
                             welt_error **error);

/*
 What the vertices of a level stand for on the level before.

 refinement: must not be NULL.
 level: 1 to the depth.
 kinds: receives one of WELT_PARENT_* per vertex.
 elements: receives the number of that vertex, edge or face.
 capacity: room in each of both, at least welt_refinement_vertex_count(refinement, level) elements.

 Points of vertices come first, then those of edges, then those of faces, each in the order of the elements.
 Since: 0.1.
 */
WELT_API
int32_t welt_refinement_vertex_parents(const welt_refinement *refinement,
                                       uint32_t level,
                                       uint32_t *kinds,
                                       uint32_t *elements,
                                       size_t capacity,
                                       welt_error **error);

/*
 Which faces of the level before the faces of a level cover.

 refinement: must not be NULL.
 level: 1 to the depth.
 faces: receives the face of the level before per face.
 corners: receives the corner of that face, 0-based.
 capacity: room in each of both, at least welt_refinement_face_count(refinement, level) elements.

 Since: 0.1.
 */
WELT_API
int32_t welt_refinement_face_parents(const welt_refinement *refinement,
                                     uint32_t level,
                                     uint32_t *faces,
                                     uint32_t *corners,
                                     size_t capacity,
                                     welt_error **error);

/*
 Refines a triangle mesh by Loop's rules, with its sharpness and options.

 mesh: must not be NULL.
 levels: how often; each time one triangle becomes four.
 refined: receives the last level, another control mesh of the same surface: it has the sharpness that is left, and holes
 where the mesh has no surface. Free it with welt_mesh_free.

 At each step the vertices are those of the vertices, then those of the edges in the order of welt_mesh_edges; faces 4 f to
 4 f + 2 lie at the corners of face f, and 4 f + 3 is the one in its middle. Fails with WELT_ERROR_MESH where a face is
 no triangle and with WELT_ERROR_TOO_LARGE. Since: 0.1.
 */
WELT_API
int32_t welt_mesh_refine_loop(const welt_mesh *mesh,
                              uint32_t levels,
                              welt_mesh **refined,
                              welt_error **error);

/*
 Writes the point and the unit normal of the Loop limit surface at each vertex of a triangle mesh.

 mesh: must not be NULL.
 positions: receives x, y and z of each point.
 normals: receives x, y and z of each normal, outwards; (0, 0, 0) where there is none. NULL where they are not wanted.
 capacity: room in each of both, at least 3 * welt_mesh_vertex_count(mesh) doubles.

 Fails with WELT_ERROR_MESH where a face is no triangle. Since: 0.1.
 */
WELT_API
int32_t welt_mesh_loop_limit(const welt_mesh *mesh,
                             double *positions,
                             double *normals,
                             size_t capacity,
                             welt_error **error);

/*
 Evaluates the Loop limit surface of a triangle mesh at parameters of faces.

 mesh: must not be NULL.
 faces: the face of each point.
 parameters: u and v of each point, the weights of the second and the third corner: u >= 0, v >= 0, u + v <= 1; what lies
 outside is moved inside.
 count: number of points.
 derivatives: up to which order, 0 to 2.
 options: threads and strides; NULL for the defaults.
 values: receives per point what welt_surface_evaluate writes.
 capacity: room in values, in doubles up to the end of the last point.

 Fails with WELT_ERROR_MESH where a face of the mesh is no triangle, and with WELT_ERROR_ARGUMENT where a face does not
 exist or a parameter is NaN. Since: 0.1.
 */
WELT_API
int32_t welt_mesh_loop_evaluate(const welt_mesh *mesh,
                                const uint32_t *faces,
                                const double *parameters,
                                size_t count,
                                uint32_t derivatives,
                                const welt_batch_options *options,
                                double *values,
                                size_t capacity,
                                welt_error **error);

/*
 Finds the edges that selectors name.

 mesh: must not be NULL.
 selectors: one or more, separated by blanks or newlines, UTF-8: edge:A,B[@t] (crossed at t in (0, 1) from A, 0.5 unless
 given), ring:A,B (the edges a loop cut from AB crosses), path:A,B:C,D (shortest path of quads between two edges),
 cut:V,V,... (all edges that leave a set of vertices), polyline:X,Y,Z;X,Y,Z;... and spline:X,Y,Z;... (a curve on or near the
 surface, model units, with ;closed at the end if it closes; which edges it crosses is found when a feature is applied),
 select:FILE (JSON). Vertices are 0-based; #kind may follow.
 length: in bytes, SIZE_MAX for a NUL-terminated text.
 selection: receives the handle; free it with welt_selection_free.

 Fails with WELT_ERROR_ARGUMENT: what is wrong and what there is; WELT_ERROR_FILE where a mark file cannot be used. Since: 0.1.
 */
WELT_API
int32_t welt_selection_create(const welt_mesh *mesh,
                              const char *selectors,
                              size_t length,
                              welt_selection **selection,
                              welt_error **error);

/*
 Frees a selection. NULL is allowed. Since: 0.1.
 */
WELT_API void welt_selection_free(welt_selection *selection);

/*
 Number of marked edges, those of curves not counted; 0 where selection is NULL. Since: 0.1.
 */
WELT_API size_t welt_selection_count(const welt_selection *selection);

/*
 Writes the marked edges.

 selection: must not be NULL.
 mesh: the mesh the selection was made on, unchanged since.
 edges: receives two vertices per edge.
 capacity: room in edges, at least 2 * welt_selection_count(selection) elements.
 places: may be NULL; else receives, per edge, where it is crossed, in (0, 1) from the first vertex.
 place_capacity: room in places, at least welt_selection_count(selection) doubles.

 Fails with WELT_ERROR_ARGUMENT where the mesh is another or has changed, and WELT_ERROR_BUFFER. Since: 0.1.
 */
WELT_API
int32_t welt_selection_edges(const welt_selection *selection,
                             const welt_mesh *mesh,
                             uint32_t *edges,
                             size_t capacity,
                             double *places,
                             size_t place_capacity,
                             welt_error **error);

/*
 Stores the marks on the mesh, as the attributes color and t of both half-edges, for rules that look for them.
 welt_feature_apply and welt_rules_apply do so by themselves.

 mesh: is changed; the mesh the selection was made on, its edges unchanged since.
 selection: must not be NULL.

 Fails with WELT_ERROR_ARGUMENT where the mesh is another or has changed; nothing is stored then. Since: 0.1.
 */
WELT_API int32_t welt_mesh_mark(welt_mesh *mesh, const welt_selection *selection, welt_error **error);

/*
 Loads a rule file and checks it.

 path: UTF-8.
 path_length: in bytes, SIZE_MAX for a NUL-terminated path.
 rules: receives the handle; free it with welt_rules_free.

 Fails with WELT_ERROR_FILE, or with WELT_ERROR_SYNTAX: each place of the error has file, line and column. Since: 0.1.
 */
WELT_API
int32_t welt_rules_load(const char *path,
                        size_t path_length,
                        welt_rules **rules,
                        welt_error **error);

/*
 Gives the rules of linear features that come with the library.

 rules: receives the handle; free it with welt_rules_free.

 Since: 0.1.
 */
WELT_API int32_t welt_rules_linear(welt_rules **rules, welt_error **error);

/*
 Frees rules. NULL is allowed. Since: 0.1.
 */
WELT_API void welt_rules_free(welt_rules *rules);

/*
 Number of parameters that the rules declare; 0 where rules is NULL. Since: 0.1.
 */
WELT_API size_t welt_rules_parameter_count(const welt_rules *rules);

/*
 Name of parameter number index, valid until the rules are freed; empty where there is none. Since: 0.1.
 */
WELT_API const char *welt_rules_parameter_name(const welt_rules *rules, size_t index);

/*
 Unit of parameter number index, such as length, angle or count, valid until the rules are freed; empty where there is
 none. Since: 0.1.
 */
WELT_API
const char *welt_rules_parameter_unit(const welt_rules *rules,
                                      size_t index);

/*
 One line of help for parameter number index, valid until the rules are freed; empty where there is none. Since: 0.1.
 */
WELT_API
const char *welt_rules_parameter_help(const welt_rules *rules,
                                      size_t index);

/*
 Default of parameter number index; 0 where there is none. Since: 0.1.
 */
WELT_API double welt_rules_parameter_default(const welt_rules *rules, size_t index);

/*
 Writes the least and the greatest value of parameter number index; they may be infinite.

 rules: must not be NULL.
 index: below welt_rules_parameter_count(rules), 0-based.
 low, high: receive one number each.

 Fails with WELT_ERROR_ARGUMENT where there is no such parameter. Since: 0.1.
 */
WELT_API
int32_t welt_rules_parameter_range(const welt_rules *rules,
                                   size_t index,
                                   double *low,
                                   double *high,
                                   welt_error **error);

/*
 Sets options to their defaults. options: must not be NULL. size: sizeof *options. Fails with WELT_ERROR_ARGUMENT where the
 size is none that the library knows. Since: 0.1.
 */
WELT_API
int32_t welt_feature_options_init(welt_feature_options *options,
                                  size_t size);

/*
 Lists the features that come with the library.

 list: receives a report whose JSON is an array of features, each with name, help and parameters: name, unit (length or
 count), default (a number in model units, or a text such as "30%"), low, high (null where only the mesh sets a bound), help;
 free it with welt_report_free.

 Since: 0.1.
 */
WELT_API
int32_t welt_feature_list(welt_report **list,
                          welt_error **error);

/*
 Applies features: rewrites the mesh along the marked edges, fits it to the surface as it was, displaces it to the asked
 widths, depths and heights.

 mesh: is changed; vertices keep their numbers, new ones follow.
 selection: the marked edges, made on this mesh, whose edges are unchanged since. A mark asks for the feature that its kind
 (#kind) names; one without a kind asks for the first feature.
 features: one or more, one per line: FEATURE or KIND=FEATURE, where FEATURE is one that welt_feature_list lists, such as
 groove, or a profile file ending in .toml. Features of the list that marks name need not be given here.
 features_length: in bytes, SIZE_MAX for a NUL-terminated text.
 settings: may be NULL; NAME=VALUE, or KIND.NAME=VALUE for one feature of several, separated by blanks, such as
 "width=0.2 depth=30%": model units, or a percentage of the length of the marked edge.
 settings_length: in bytes, SIZE_MAX for a NUL-terminated text.
 options: may be NULL for defaults.
 job: may be NULL.
 report: may be NULL; else receives what was done: counts, rules, leftovers, dimensions asked and reached, deviations,
 warnings. Free it with welt_report_free.

 Fails with WELT_ERROR_ARGUMENT (an unknown feature or setting, a selection of another mesh, a width that an edge cannot
 take: the place is the edge), WELT_ERROR_FILE, WELT_ERROR_RULE (also for rules that go beyond a limit of the options and, when
 strict, for marks that no rule handles),
 WELT_ERROR_CANCELLED; the mesh is as it was before then. Since: 0.1.
 */
WELT_API
int32_t welt_feature_apply(welt_mesh *mesh,
                           const welt_selection *selection,
                           const char *features,
                           size_t features_length,
                           const char *settings,
                           size_t settings_length,
                           const welt_feature_options *options,
                           const welt_job *job,
                           welt_report **report,
                           welt_error **error);

/*
 Runs a rule set on the marked edges and fits the changed mesh to the surface as it was; nothing is displaced.

 mesh, selection, options, job, report: as for welt_feature_apply.
 rules: must not be NULL.
 settings: may be NULL; NAME=VALUE with numbers, separated by blanks, for parameters of the rules.
 settings_length: in bytes, SIZE_MAX for a NUL-terminated text.

 Fails as welt_feature_apply does. Since: 0.1.
 */
WELT_API
int32_t welt_rules_apply(welt_mesh *mesh,
                         const welt_selection *selection,
                         const welt_rules *rules,
                         const char *settings,
                         size_t settings_length,
                         const welt_feature_options *options,
                         const welt_job *job,
                         welt_report **report,
                         welt_error **error);

/*
 Displaces vertices along the normals of the limit surface, so that their limit points rise by the given heights, all
 together.

 mesh: must not be NULL; is changed.
 vertices: the vertices, 0-based, each once; may be NULL when count is 0.
 heights: how far the limit point of each rises, in model units; negative is inwards; may be
 NULL when count is 0.
 count: number of vertices and of heights.

 Fails with WELT_ERROR_ARGUMENT where a vertex does not exist, or has no normal (the places list them), or a height is not
 finite; the mesh is as it was before then. Since: 0.1.
 */
WELT_API
int32_t welt_mesh_displace(welt_mesh *mesh,
                           const uint32_t *vertices,
                           const double *heights,
                           size_t count,
                           welt_error **error);

/*
 Measures how far the limit surfaces of two control meshes are apart, both ways.

 first, second: must not be NULL.
 samples: samples per side of each face, 1 to 64; 8 is usual.
 values: receives the largest distance, the root mean square and the distance that 95 % of the area do not exceed, in
 model units: 3 doubles.
 job: may be NULL.

 Fails with WELT_ERROR_ARGUMENT, WELT_ERROR_CANCELLED and WELT_ERROR_MEMORY. Since: 0.1.
 */
WELT_API
int32_t welt_mesh_deviation(const welt_mesh *first,
                            const welt_mesh *second,
                            uint32_t samples,
                            double *values,
                            const welt_job *job,
                            welt_error **error);

/*
 Measures how far the limit surfaces of two control meshes are apart, both ways, and how their normals and curvatures differ.

 first, second: must not be NULL.
 samples: samples per side of each face, 1 to 64; 8 is usual.
 threads: 0 for as many as the machine has; the result does not depend on it.
 values: receives 6 doubles: the three of welt_mesh_deviation; the largest angle between the normals of a point and of its
 closest point, in degrees; the root mean square and the largest difference of the mean curvatures there, per model unit.
 Beside extraordinary vertices curvature is not bounded, so that the last figure grows with samples.
 job: may be NULL.

 Fails with WELT_ERROR_ARGUMENT, WELT_ERROR_CANCELLED and WELT_ERROR_MEMORY. Since: 0.1.
 */
WELT_API
int32_t welt_mesh_compare(const welt_mesh *first,
                          const welt_mesh *second,
                          uint32_t samples,
                          uint32_t threads,
                          double *values,
                          const welt_job *job,
                          welt_error **error);

/*
 Freezes the limit surface of a mesh.

 mesh: must not be NULL.
 faces: the faces whose surface is frozen, 0-based; NULL for all. Cost follows their number.
 count: number of faces; 0 where faces is NULL.
 job: may be NULL.
 surface: receives the handle; free it with welt_surface_free.

 Fails with WELT_ERROR_ARGUMENT where a face does not exist, and with WELT_ERROR_CANCELLED. Since: 0.1.
 */
WELT_API
int32_t welt_surface_create(const welt_mesh *mesh,
                            const uint32_t *faces,
                            size_t count,
                            const welt_job *job,
                            welt_surface **surface,
                            welt_error **error);

/*
 Frees a surface. NULL is allowed. Since: 0.1.
 */
WELT_API void welt_surface_free(welt_surface *surface);

/*
 Curvature of the limit surface at parameters of faces.

 surface, faces, corners, parameters, count: as for welt_surface_evaluate.
 values: receives per point 10 doubles: the principal curvatures, the greater first; the unit tangents along which the normal
 curvature takes these values; mean and Gaussian curvature. Curvature is positive where the surface bends towards its
 normal: a sphere of radius r whose normals point outwards has -1/r, in units of the model. All are NaN at an extraordinary vertex, where curvature is
 not defined, where the tangents span no plane, and where the surface has no part of the face.
 capacity: room in values, at least 10 * count doubles.

 Fails with WELT_ERROR_ARGUMENT where a face has no such patch, or a parameter is NaN. Since: 0.1.
 */
WELT_API
int32_t welt_surface_curvature(const welt_surface *surface,
                               const uint32_t *faces,
                               const uint32_t *corners,
                               const double *parameters,
                               size_t count,
                               double *values,
                               size_t capacity,
                               welt_error **error);

/*
 Moves vertices so that their limit points lie on a frozen surface.

 mesh: must not be NULL; is changed.
 vertices: the vertices that may move, 0-based; NULL for all.
 count: number of vertices; 0 where vertices is NULL.
 surface: must not be NULL.
 fit: one of WELT_FIT_*.
 job: may be NULL.
 report: may be NULL; else receives method, steps, stop reason, residual and the vertices that found no surface. Free it
 with welt_report_free.

 Fails with WELT_ERROR_ARGUMENT and WELT_ERROR_CANCELLED; the mesh is as it was before then. Since: 0.1.
 */
WELT_API
int32_t welt_mesh_fit(welt_mesh *mesh,
                      const uint32_t *vertices,
                      size_t count,
                      const welt_surface *surface,
                      uint32_t fit,
                      const welt_job *job,
                      welt_report **report,
                      welt_error **error);

/*
 Sets options to their defaults. options: must not be NULL. size: sizeof *options. Fails with WELT_ERROR_ARGUMENT where the
 size is none that the library knows. Since: 0.1.
 */
WELT_API
int32_t welt_batch_options_init(welt_batch_options *options,
                                size_t size);

/*
 Evaluates the limit surface at parameters of faces.

 surface: must not be NULL.
 faces: the face of each point.
 corners: the patch of each point; NULL for 0 everywhere. A quad has patch 0 only, another face one per corner.
 parameters: u and v of each point, in [0, 1]; what lies outside is moved to the nearest inside. On a quad (0, 0) is its
 first corner, u runs along the first edge and v against the last one. On patch c of another face (0, 0) is corner c,
 (1, 0) the middle of the edge that leaves it, (0, 1) that of the edge that arrives, (1, 1) the face point.
 count: number of points.
 derivatives: up to which order, 0 to 2.
 options: threads and strides; NULL for the defaults.
 values: receives per point the position, with order 1 also the derivatives by u and by v, with order 2 also those by u
 twice, by u and v, by v twice: 3, 9 or 18 doubles. At an extraordinary vertex the first derivatives are tangents of
 conventional length, and the second ones, which are not defined, are NaN. Where the surface has no part of the face, which
 may not have been frozen or is a hole or left out by the boundary rule, all are NaN.
 capacity: room in values, in doubles up to the end of the last point.

 Points that are sorted by face cost less on large surfaces. Fails with WELT_ERROR_ARGUMENT where a face has no such patch,
 or a parameter is NaN. Since: 0.1.
 */
WELT_API
int32_t welt_surface_evaluate(const welt_surface *surface,
                              const uint32_t *faces,
                              const uint32_t *corners,
                              const double *parameters,
                              size_t count,
                              uint32_t derivatives,
                              const welt_batch_options *options,
                              double *values,
                              size_t capacity,
                              welt_error **error);

/*
 Finds the point of the surface that is closest to each of many points, exactly: also beside extraordinary vertices,
 creases and boundaries.

 surface: must not be NULL.
 points: x, y and z of each point.
 count: number of points.
 radius: points of the surface at this distance and farther are not found; infinity for no limit.
 starts: per point a place of the surface near which the closest point is thought to be, of which face, corner, u and v are
 read; the result is the same, sooner where the thought is right. NULL where there are none; one that is no place of the
 surface is passed over.
 options: threads and the stride of points; NULL for the defaults.
 found: receives the closest points. Where nothing lies within the radius, where the surface is empty and where a
 coordinate is NaN or beyond 1e60 the face is WELT_NONE. Of several points that are equally close one is found.
 capacity: room in found, at least count elements.

 Fails with WELT_ERROR_ARGUMENT where radius is NaN. Since: 0.1.
 */
WELT_API
int32_t welt_surface_closest(const welt_surface *surface,
                             const double *points,
                             size_t count,
                             double radius,
                             const welt_surface_point *starts,
                             const welt_batch_options *options,
                             welt_surface_point *found,
                             size_t capacity,
                             welt_error **error);

/*
 Measures the distance of each of many points to a closed surface, negative inside: where the winding number of the
 surface is positive. Parts that overlap count as one solid; what lies in a hollow, whose normals point inwards, is outside.
 The distance is that of the nearest point of the surface, also where this lies inside another part.

 surface: must not be NULL.
 points: x, y and z of each point.
 count: number of points.
 options: threads and strides; NULL for the defaults.
 distances: receives the distances; NaN where a coordinate is NaN or beyond 1e60.
 capacity: room in distances, in doubles up to the last distance.

 Fails with WELT_ERROR_ARGUMENT where the surface has a border: not all faces of a closed mesh are frozen, or some have no
 surface. Since: 0.1.
 */
WELT_API
int32_t welt_surface_signed_distances(const welt_surface *surface,
                                      const double *points,
                                      size_t count,
                                      const welt_batch_options *options,
                                      double *distances,
                                      size_t capacity,
                                      welt_error **error);

/*
 Finds the first point in which each of many lines meets the surface, exactly: edges and vertices let nothing through.

 surface: must not be NULL.
 lines: x, y and z of the origin and of the direction of each line, which need not have length 1.
 count: number of lines.
 first: smallest parameter s that counts: 0 for rays, minus infinity for whole lines.
 last: largest parameter s that counts.
 options: threads and the stride of lines; NULL for the defaults.
 found: receives per line the hit with the smallest amount of s. Where there is none, where the direction is 0 and where a
 coordinate is not finite the face is WELT_NONE.
 capacity: room in found, at least count elements.

 A line that touches the surface without crossing it hits it there, within the rounding of the coordinates. Fails with
 WELT_ERROR_ARGUMENT where first or last is NaN. Since: 0.1.
 */
WELT_API
int32_t welt_surface_first_hits(const welt_surface *surface,
                                const double *lines,
                                size_t count,
                                double first,
                                double last,
                                const welt_batch_options *options,
                                welt_surface_point *found,
                                size_t capacity,
                                welt_error **error);

/*
 Finds all points in which each of many lines meets the surface.

 surface, lines, count, first, last, options: as for welt_surface_first_hits.
 starts: receives count + 1 numbers: the hits of line i are those from starts[i] up to starts[i + 1], exclusive, by s.
 needed: receives the number of all hits, also where found has no room for them. May be NULL.
 found: receives the hits. NULL with capacity 0 to ask for their number.
 capacity: room in found.

 A hit on an edge that faces share, or at a vertex, is given once. A line that lies in the surface gives some of the points
 that they share. Fails with WELT_ERROR_BUFFER where found is too small: then needed is written, and nothing else; and with
 WELT_ERROR_ARGUMENT where first or last is NaN. Since: 0.1.
 */
WELT_API
int32_t welt_surface_all_hits(const welt_surface *surface,
                              const double *lines,
                              size_t count,
                              double first,
                              double last,
                              const welt_batch_options *options,
                              size_t *starts,
                              size_t *needed,
                              welt_surface_point *found,
                              size_t capacity,
                              welt_error **error);

/*
 Sets options to their defaults. options: must not be NULL. size: sizeof *options. Fails with WELT_ERROR_ARGUMENT where the
 size is none that the library knows. Since: 0.1.
 */
WELT_API
int32_t welt_patch_options_init(welt_patch_options *options,
                                size_t size);

/*
 Makes bicubic B-spline patches of the limit surface (Catmull-Clark), for CAD.

 mesh: must not be NULL.
 faces: the faces whose surface is wanted, 0-based; NULL for all. Cost follows their number.
 count: number of faces; 0 where faces is NULL.
 options: NULL for the defaults.
 job: may be NULL.
 patches: receives the handle; free it with welt_patches_free.

 The patches meet side to side: no corner of one lies within a side of another. Extraordinary vertices and
 creases lie at corners and along sides only. Fails with WELT_ERROR_ARGUMENT where a face does not exist or an option is out of
 its range, and with WELT_ERROR_CANCELLED. Since: 0.1.
 */
WELT_API
int32_t welt_patches_create(const welt_mesh *mesh,
                            const uint32_t *faces,
                            size_t count,
                            const welt_patch_options *options,
                            const welt_job *job,
                            welt_patches **patches,
                            welt_error **error);

/*
 Frees patches. NULL is allowed. Since: 0.1.
 */
WELT_API void welt_patches_free(welt_patches *patches);

/*
 Number of patches; 0 where patches is NULL. Since: 0.1.
 */
WELT_API size_t welt_patches_count(const welt_patches *patches);

/*
 One of the patches.

 patches: must not be NULL.
 index: below welt_patches_count(patches).
 patch: receives it; its arrays belong to patches and are valid until that is freed.

 Fails with WELT_ERROR_ARGUMENT where there is no such patch. Since: 0.1.
 */
WELT_API
int32_t welt_patches_get(const welt_patches *patches,
                         size_t index,
                         welt_patch *patch,
                         welt_error **error);

/*
 What was made.

 patches: must not be NULL.
 report: receives a report whose JSON has patches, exact, approximate and faces (numbers), rings (of exact pieces round
 extraordinary vertices), max_deviation (in units of the model), max_relative_deviation (in parts of the mean length of
 the edges of the control face), rms_relative_deviation (root mean square of what was measured in the spans beside
 extraordinary vertices) and max_normal_jump (greatest angle in degrees between the normals of two patches along
 a side that is no crease). Free it with welt_report_free.

 Since: 0.1.
 */
WELT_API
int32_t welt_patches_report(const welt_patches *patches,
                            welt_report **report,
                            welt_error **error);

#ifdef __cplusplus
}
#endif

#endif
