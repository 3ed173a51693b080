/* A C89 program that uses every handle of the library as a host would. */

#include <stdio.h>
#include <string.h>
#include <welt.h>

static int failures = 0;

static void check(int holds, const char *what) {
    if (!holds) {
        printf("FAILED: %s\n", what);
        ++failures;
    }
}

/* A pyramid with a square base. */
static const char *pyramid = "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nv 1 1 2\n"
                             "f 4 3 2 1\nf 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\n";

static void errors_tell_where(void) {
    welt_mesh *mesh = NULL;
    welt_error *error = NULL;
    const char *text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n";
    int32_t status =
        welt_mesh_import_memory("cage.obj", SIZE_MAX, WELT_FORMAT_OBJ, (const uint8_t *)text, strlen(text), NULL,
                                &mesh, NULL, &error);
    check(status < 0 && status == welt_error_code(error), "a face that names a vertex which is not there is refused");
    check(strstr(welt_error_message(error), "cage.obj") != NULL, "the message names the file");
    check(welt_error_place_count(error) > 0 && welt_error_place_line(error, 0) == 4, "the place has the line");
    check(mesh == NULL, "no mesh is written");
    welt_error_free(error);
}

static void limit_and_refinement(void) {
    welt_import_options options;
    welt_mesh *mesh = NULL;
    welt_job *job = NULL;
    welt_refinement *refinement = NULL;
    welt_report *report = NULL;
    welt_error *error = NULL;
    const double *view = NULL;
    double normals[15];

    check(welt_import_options_init(&options, sizeof options) == WELT_OK, "options");
    check(welt_mesh_import_memory(NULL, 0, WELT_FORMAT_OBJ, (const uint8_t *)pyramid, strlen(pyramid), &options,
                                  &mesh, &report, &error) == WELT_OK,
          "import");
    check(strchr(welt_report_json(report), '{') != NULL, "the report is JSON");
    check(welt_mesh_vertex_count(mesh) == 5 && welt_mesh_edge_count(mesh) == 8, "counts");
    check(welt_mesh_limit_normals(mesh, normals, 15, &error) == WELT_OK, "normals");
    check(normals[14] > 0.999999, "the apex points upwards");
    check(welt_mesh_limit_normals(mesh, normals, 14, NULL) == WELT_ERROR_BUFFER, "a small buffer is refused");

    check(welt_job_create(&job, &error) == WELT_OK, "job");
    check(welt_refinement_create(mesh, 2, job, &refinement, &error) == WELT_OK, "refinement");
    check(welt_job_progress(job) == 1.0, "progress");
    welt_mesh_free(mesh);
    check(welt_refinement_face_count(refinement, 2) == 64, "a pyramid has 16 corners, thus 16 and 64 quads");
    check(welt_refinement_positions(refinement, 2, &view, &error) == WELT_OK, "the refinement outlives the mesh");
    check(view != NULL && view[2] > 0.0 && view[2] < 2.0, "corners move inwards");
    welt_refinement_free(refinement);
    welt_job_free(job);
    welt_report_free(report);
}

static void errors_are_written(void) {
    welt_mesh *mesh = NULL;
    /* Not an error: whatever stands there is overwritten, not freed. */
    welt_error *error = (welt_error *)pyramid;
    const uint8_t *text = (const uint8_t *)pyramid;
    const size_t size = strlen(pyramid);
    check(welt_mesh_import_memory(NULL, 0, WELT_FORMAT_OBJ, text, size, NULL, &mesh, NULL, &error) == WELT_OK, "import");
    check(error == NULL, "success writes NULL");
    check(welt_mesh_set_holes(mesh, NULL, 1, &error) == WELT_ERROR_ARGUMENT && error != NULL, "a failure an error");
    check(welt_error_code(error) == WELT_ERROR_ARGUMENT, "with its code");
    check(welt_mesh_set_holes(mesh, NULL, 1, NULL) == WELT_ERROR_ARGUMENT, "which may be unwanted");
    welt_error_free(error);
    welt_mesh_free(mesh);
}

static void arrays_are_copied(void) {
    uint32_t sizes[1] = {3}, corners[3] = {0, 1, 2}, got[3] = {9, 9, 9};
    double positions[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    char selectors[] = "edge:0,1";
    const double *view = NULL;
    welt_mesh *mesh = NULL;
    welt_selection *selection = NULL;
    check(welt_mesh_create(sizes, 1, corners, 3, positions, 3, 0, &mesh, NULL) == WELT_OK, "create");
    check(welt_selection_create(mesh, selectors, (size_t)-1, &selection, NULL) == WELT_OK, "selection");
    memset(sizes, 0xff, sizeof sizes);
    memset(corners, 0xff, sizeof corners);
    memset(positions, 0xff, sizeof positions);
    memset(selectors, 0xff, sizeof selectors);
    check(welt_mesh_positions(mesh, &view, NULL) == WELT_OK && view[3] == 1.0 && view[7] == 1.0, "positions");
    check(welt_mesh_faces(mesh, sizes, 1, got, 3, NULL) == WELT_OK && got[0] == 0 && got[2] == 2, "faces");
    check(welt_selection_edges(selection, mesh, got, 2, NULL, 0, NULL) == WELT_OK && got[0] + got[1] == 1, "marks");
    welt_selection_free(selection);
    welt_mesh_free(mesh);
}

static void results_outlive_the_mesh(void) {
    welt_mesh *mesh = NULL;
    welt_surface *surface = NULL;
    welt_refinement *refinement = NULL;
    const uint32_t base = 0;
    const double middle[2] = {0.5, 0.5}, *view = NULL;
    double flat[15], before[18], after[18], first;
    memset(flat, 0, sizeof flat);
    check(welt_mesh_import_memory(NULL, 0, WELT_FORMAT_OBJ, (const uint8_t *)pyramid, strlen(pyramid), NULL, &mesh, NULL,
                                  NULL) == WELT_OK,
          "import");
    check(welt_surface_create(mesh, NULL, 0, NULL, &surface, NULL) == WELT_OK, "surface");
    check(welt_refinement_create(mesh, 1, NULL, &refinement, NULL) == WELT_OK, "refinement");
    check(welt_surface_evaluate(surface, &base, NULL, middle, 1, 2, NULL, before, 18, NULL) == WELT_OK, "evaluate");
    check(welt_refinement_positions(refinement, 1, &view, NULL) == WELT_OK, "view");
    first = view[0];
    check(welt_mesh_set_positions(mesh, flat, 5, 0, NULL) == WELT_OK, "the mesh changes");
    check(view[0] == first, "the refinement does not");
    welt_mesh_free(mesh);
    check(welt_surface_evaluate(surface, &base, NULL, middle, 1, 2, NULL, after, 18, NULL) == WELT_OK, "evaluate");
    check(memcmp(before, after, sizeof before) == 0 && view[0] == first, "they outlive it");
    welt_surface_free(surface);
    welt_refinement_free(refinement);
}

int main(void) {
    check(welt_version() == WELT_VERSION, "header and library are of one version");
    errors_tell_where();
    errors_are_written();
    arrays_are_copied();
    results_outlive_the_mesh();
    limit_and_refinement();
    printf("%d failures\n", failures);
    return failures != 0;
}
