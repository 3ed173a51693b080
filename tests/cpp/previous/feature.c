/* Selections, rules, features and surfaces in C89: what they do, and that wrong arguments are refused with the mesh as it
 * was. */

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <welt.h>

#define NUL ((size_t)-1)
/* Squares per side of the sheet. */
#define SIDE 8
#define VERTICES ((SIDE + 1) * (SIDE + 1))
#define FACES (SIDE * SIDE)

static int failures = 0;

static void check(int holds, const char *what) {
    if (!holds) {
        printf("FAILED: %s\n", what);
        ++failures;
    }
}

/* A flat sheet of unit squares at height z. Vertex number is x + (SIDE + 1) * y. */
static welt_mesh *sheet(double z) {
    static uint32_t sizes[FACES], corners[4 * FACES];
    static double points[3 * VERTICES];
    welt_mesh *mesh = NULL;
    uint32_t x, y, f = 0;
    for (y = 0; y <= SIDE; ++y)
        for (x = 0; x <= SIDE; ++x) {
            double *point = points + 3 * (x + (SIDE + 1) * y);
            point[0] = x;
            point[1] = y;
            point[2] = z;
        }
    for (y = 0; y < SIDE; ++y)
        for (x = 0; x < SIDE; ++x, ++f) {
            uint32_t first = x + (SIDE + 1) * y;
            sizes[f] = 4;
            corners[4 * f] = first;
            corners[4 * f + 1] = first + 1;
            corners[4 * f + 2] = first + SIDE + 2;
            corners[4 * f + 3] = first + SIDE + 1;
        }
    check(welt_mesh_create(sizes, FACES, corners, 4 * FACES, points, VERTICES, 0, &mesh, NULL) == WELT_OK, "sheet");
    return mesh;
}

/* The ring from the middle of the lower side to the middle of the upper one: SIDE + 1 edges. */
static welt_selection *across(const welt_mesh *mesh) {
    welt_selection *selection = NULL;
    check(welt_selection_create(mesh, "ring:3,4", NUL, &selection, NULL) == WELT_OK, "ring");
    check(welt_selection_count(selection) == SIDE + 1, "the ring crosses every row");
    return selection;
}

/* Whether a mesh is the sheet at height 0, bit for bit. */
static int is_sheet(const welt_mesh *mesh) {
    uint32_t sizes[2][FACES], corners[2][4 * FACES];
    const double *points[2];
    welt_mesh *fresh = sheet(0.0);
    int same = welt_mesh_vertex_count(mesh) == VERTICES && welt_mesh_face_count(mesh) == FACES &&
               welt_mesh_faces(mesh, sizes[0], FACES, corners[0], 4 * FACES, NULL) == WELT_OK &&
               welt_mesh_faces(fresh, sizes[1], FACES, corners[1], 4 * FACES, NULL) == WELT_OK &&
               welt_mesh_positions(mesh, &points[0], NULL) == WELT_OK &&
               welt_mesh_positions(fresh, &points[1], NULL) == WELT_OK &&
               memcmp(sizes[0], sizes[1], sizeof sizes[0]) == 0 &&
               memcmp(corners[0], corners[1], sizeof corners[0]) == 0 &&
               memcmp(points[0], points[1], 3 * VERTICES * sizeof(double)) == 0;
    welt_mesh_free(fresh);
    return same;
}

/* A failure with a code, a message that says a word, and no change of the mesh. Frees the error. */
static void refused(int32_t status, int32_t expected, welt_error *error, const char *word, const welt_mesh *mesh) {
    if (status != expected || welt_error_code(error) != expected)
        printf("status %ld, expected %ld: %s\n", (long)status, (long)expected, welt_error_message(error));
    check(status == expected && welt_error_code(error) == expected, word);
    if (strstr(welt_error_message(error), word) == NULL)
        printf("the message is: %s\n", welt_error_message(error));
    check(strstr(welt_error_message(error), word) != NULL, word);
    check(mesh == NULL || is_sheet(mesh), "the mesh is as it was");
    welt_error_free(error);
}

static void null_pointers(void) {
    welt_mesh *mesh = sheet(0.0);
    welt_selection *selection = across(mesh), *no_selection = NULL;
    welt_rules *rules = NULL, *no_rules = NULL;
    welt_surface *surface = NULL, *no_surface = NULL;
    welt_feature_options options;
    uint32_t edges[2 * (SIDE + 1)], vertex = 0;
    double number = 0.0, values[3];
    const int32_t bad = WELT_ERROR_ARGUMENT;

    check(welt_rules_linear(&rules, NULL) == WELT_OK, "linear rules");
    check(welt_surface_create(mesh, NULL, 0, NULL, &surface, NULL) == WELT_OK, "surface");

    check(welt_selection_create(NULL, "ring:3,4", NUL, &no_selection, NULL) == bad, "selection: mesh");
    check(welt_selection_create(mesh, NULL, NUL, &no_selection, NULL) == bad, "selection: text");
    check(welt_selection_create(mesh, NULL, 3, &no_selection, NULL) == bad, "selection: text with a length");
    check(welt_selection_create(mesh, "ring:3,4", NUL, NULL, NULL) == bad, "selection: handle");
    check(welt_selection_edges(NULL, mesh, edges, 2 * (SIDE + 1), NULL, 0, NULL) == bad, "edges: selection");
    check(welt_selection_edges(selection, NULL, edges, 2 * (SIDE + 1), NULL, 0, NULL) == bad, "edges: mesh");
    check(welt_selection_edges(selection, mesh, NULL, 2 * (SIDE + 1), NULL, 0, NULL) == bad, "edges: buffer");
    check(welt_selection_edges(selection, mesh, edges, 2 * SIDE + 1, NULL, 0, NULL) == WELT_ERROR_BUFFER,
          "edges: capacity");
    check(welt_selection_edges(selection, mesh, edges, 2 * (SIDE + 1), &number, 1, NULL) == WELT_ERROR_BUFFER,
          "edges: capacity of the places");
    check(welt_mesh_mark(NULL, selection, NULL) == bad, "mark: mesh");
    check(welt_mesh_mark(mesh, NULL, NULL) == bad, "mark: selection");
    check(welt_selection_count(NULL) == 0, "count of NULL");

    check(welt_rules_load(NULL, NUL, &no_rules, NULL) == bad, "load: path");
    check(welt_rules_load("x.rules", NUL, NULL, NULL) == bad, "load: handle");
    check(welt_rules_linear(NULL, NULL) == bad, "linear: handle");
    check(welt_rules_parameter_count(NULL) == 0, "parameters of NULL");
    check(*welt_rules_parameter_name(NULL, 0) == '\0' && *welt_rules_parameter_name(rules, 1000) == '\0', "name");
    check(*welt_rules_parameter_unit(NULL, 0) == '\0' && *welt_rules_parameter_unit(rules, NUL) == '\0', "unit");
    check(*welt_rules_parameter_help(NULL, 0) == '\0' && *welt_rules_parameter_help(rules, NUL) == '\0', "help");
    check(welt_rules_parameter_default(NULL, 0) == 0.0, "default");
    check(welt_rules_parameter_range(NULL, 0, &number, &number, NULL) == bad, "range: rules");
    check(welt_rules_parameter_range(rules, 1000, &number, &number, NULL) == bad, "range: index");
    check(welt_rules_parameter_range(rules, 0, NULL, &number, NULL) == bad, "range: low");
    check(welt_rules_parameter_range(rules, 0, &number, NULL, NULL) == bad, "range: high");

    check(welt_feature_options_init(NULL, sizeof options) == bad, "options: pointer");
    check(welt_feature_options_init(&options, 0) == bad, "options: size 0");
    check(welt_feature_options_init(&options, sizeof options + 4096) == bad, "options: size of a newer library");
    check(welt_feature_list(NULL, NULL) == bad, "list: handle");
    check(welt_feature_apply(NULL, selection, "groove", NUL, NULL, 0, NULL, NULL, NULL, NULL) == bad, "apply: mesh");
    check(welt_feature_apply(mesh, NULL, "groove", NUL, NULL, 0, NULL, NULL, NULL, NULL) == bad, "apply: selection");
    check(welt_feature_apply(mesh, selection, NULL, NUL, NULL, 0, NULL, NULL, NULL, NULL) == bad, "apply: name");
    check(welt_feature_apply(mesh, selection, "groove", 3, NULL, 0, NULL, NULL, NULL, NULL) == bad,
          "apply: a length that cuts the name");
    check(welt_feature_apply(mesh, selection, "\xff", NUL, NULL, 0, NULL, NULL, NULL, NULL) == bad,
          "apply: a name that is not UTF-8");
    check(welt_rules_apply(NULL, selection, rules, NULL, 0, NULL, NULL, NULL, NULL) == bad, "rules apply: mesh");
    check(welt_rules_apply(mesh, NULL, rules, NULL, 0, NULL, NULL, NULL, NULL) == bad, "rules apply: selection");
    check(welt_rules_apply(mesh, selection, NULL, NULL, 0, NULL, NULL, NULL, NULL) == bad, "rules apply: rules");

    check(welt_mesh_displace(NULL, &vertex, &number, 1, NULL) == bad, "displace: mesh");
    check(welt_mesh_displace(mesh, NULL, &number, 1, NULL) == bad, "displace: vertices");
    check(welt_mesh_displace(mesh, &vertex, NULL, 1, NULL) == bad, "displace: heights");
    check(welt_mesh_displace(mesh, &vertex, &number, NUL, NULL) == bad, "displace: count");
    check(welt_mesh_displace(mesh, NULL, NULL, 0, NULL) == WELT_OK, "displace: nothing");
    check(welt_mesh_deviation(NULL, mesh, 8, values, NULL, NULL) == bad, "deviation: first");
    check(welt_mesh_deviation(mesh, NULL, 8, values, NULL, NULL) == bad, "deviation: second");
    check(welt_mesh_deviation(mesh, mesh, 8, NULL, NULL, NULL) == bad, "deviation: values");
    check(welt_mesh_deviation(mesh, mesh, 0, values, NULL, NULL) == bad, "deviation: 0 samples");
    check(welt_mesh_deviation(mesh, mesh, 65, values, NULL, NULL) == bad, "deviation: 65 samples");

    check(welt_surface_create(NULL, NULL, 0, NULL, &no_surface, NULL) == bad, "surface: mesh");
    check(welt_surface_create(mesh, NULL, 0, NULL, NULL, NULL) == bad, "surface: handle");
    check(welt_surface_create(mesh, &vertex, NUL, NULL, &no_surface, NULL) == bad, "surface: count");
    vertex = FACES;
    check(welt_surface_create(mesh, &vertex, 1, NULL, &no_surface, NULL) == bad, "surface: face");
    vertex = WELT_NONE;
    check(welt_surface_create(mesh, &vertex, 1, NULL, &no_surface, NULL) == bad, "surface: face WELT_NONE");
    check(welt_mesh_fit(NULL, NULL, 0, surface, WELT_FIT_SOLVE, NULL, NULL, NULL) == bad, "fit: mesh");
    check(welt_mesh_fit(mesh, NULL, 0, NULL, WELT_FIT_SOLVE, NULL, NULL, NULL) == bad, "fit: surface");
    check(welt_mesh_fit(mesh, NULL, 0, surface, 77, NULL, NULL, NULL) == bad, "fit: method");
    check(welt_mesh_fit(mesh, &vertex, 1, surface, WELT_FIT_SOLVE, NULL, NULL, NULL) == bad, "fit: vertex");

    check(no_selection == NULL && no_rules == NULL && no_surface == NULL, "no handle is written on failure");
    check(is_sheet(mesh), "the mesh is as it was");
    welt_selection_free(NULL);
    welt_rules_free(NULL);
    welt_surface_free(NULL);
    welt_surface_free(surface);
    welt_rules_free(rules);
    welt_selection_free(selection);
    welt_mesh_free(mesh);
}

/* Applies a groove with these settings and options. */
static int32_t groove(welt_mesh *mesh, const welt_selection *selection, const char *settings,
                      const welt_feature_options *options, const welt_job *job, welt_error **error) {
    return welt_feature_apply(mesh, selection, "groove", NUL, settings, NUL, options, job, NULL, error);
}

static void mistakes(void) {
    welt_mesh *mesh = sheet(0.0);
    welt_selection *selection = across(mesh), *none = NULL;
    welt_rules *rules = NULL;
    welt_feature_options options;
    welt_error *error = NULL;
    welt_job *job = NULL;
    double values[3];
    int32_t status;
    uint32_t twice[2];
    double heights[2];

    status = welt_selection_create(mesh, "edge:0,40", NUL, &none, &error);
    refused(status, WELT_ERROR_ARGUMENT, error, "no edge 0,40", mesh);
    status = welt_selection_create(mesh, "edge:0,4000", NUL, &none, &error);
    refused(status, WELT_ERROR_ARGUMENT, error, "0 to 80", mesh);
    status = welt_selection_create(mesh, "loop:0,1", NUL, &none, &error);
    refused(status, WELT_ERROR_ARGUMENT, error, "no selector 'loop'", mesh);
    status = welt_selection_create(mesh, "select:absent.json", NUL, &none, &error);
    refused(status, WELT_ERROR_FILE, error, "absent.json", mesh);
    check(welt_selection_create(mesh, " \n", NUL, &none, NULL) == WELT_OK, "no selector marks nothing");
    status = groove(mesh, none, "width=0.2", NULL, NULL, &error);
    refused(status, WELT_ERROR_ARGUMENT, error, "no edge is marked", mesh);
    welt_selection_free(none);

    status = welt_feature_apply(mesh, selection, "grove", NUL, NULL, 0, NULL, NULL, NULL, &error);
    refused(status, WELT_ERROR_ARGUMENT, error, "groove", mesh);
    status = groove(mesh, selection, "width", NULL, NULL, &error);
    refused(status, WELT_ERROR_ARGUMENT, error, "NAME=VALUE", mesh);
    status = groove(mesh, selection, "width=wide", NULL, NULL, &error);
    refused(status, WELT_ERROR_ARGUMENT, error, "wide", mesh);
    status = groove(mesh, selection, "width=nan", NULL, NULL, &error);
    refused(status, WELT_ERROR_ARGUMENT, error, "width", mesh);
    status = groove(mesh, selection, "width=-0.2", NULL, NULL, &error);
    refused(status, WELT_ERROR_ARGUMENT, error, "than 0", mesh);
    status = groove(mesh, selection, "breadth=0.2", NULL, NULL, &error);
    refused(status, WELT_ERROR_ARGUMENT, error, "width, depth", mesh);
    status = groove(mesh, selection, "width=5", NULL, NULL, &error);
    check(welt_error_place_count(error) == 1 && welt_error_place_kind(error, 0) == WELT_PLACE_EDGE, "a place");
    check(welt_error_place_id(error, 0, 1) == welt_error_place_id(error, 0, 0) + 1, "the edge is one of the ring");
    refused(status, WELT_ERROR_ARGUMENT, error, "edge", mesh);

    check(welt_feature_options_init(&options, sizeof options) == WELT_OK, "options");
    options.struct_size = 3;
    status = groove(mesh, selection, "width=0.2", &options, NULL, &error);
    refused(status, WELT_ERROR_ARGUMENT, error, "size", mesh);
    options.struct_size = 4096;
    status = groove(mesh, selection, "width=0.2", &options, NULL, &error);
    refused(status, WELT_ERROR_ARGUMENT, error, "size", mesh);
    options.struct_size = sizeof options;
    options.fit = 9;
    status = groove(mesh, selection, "width=0.2", &options, NULL, &error);
    refused(status, WELT_ERROR_ARGUMENT, error, "WELT_FIT_", mesh);
    options.fit = WELT_FIT_SOLVE;
    options.parity = 3;
    status = groove(mesh, selection, "width=0.2", &options, NULL, &error);
    refused(status, WELT_ERROR_ARGUMENT, error, "WELT_PARITY_", mesh);
    options.parity = WELT_PARITY_ALL_QUAD;
    options.strict = 1;
    check(welt_selection_create(mesh, "edge:0,1 edge:1,10#piping", NUL, &none, NULL) == WELT_OK, "unlike marks");
    status = groove(mesh, none, "width=0.2", &options, NULL, &error);
    check(welt_error_place_count(error) == 2 && welt_error_place_kind(error, 0) == WELT_PLACE_EDGE, "marked edges");
    refused(status, WELT_ERROR_RULE, error, "no rule handles", mesh);
    welt_selection_free(none);

    check(welt_rules_linear(&rules, NULL) == WELT_OK, "linear rules");
    status = welt_rules_apply(mesh, selection, rules, "no_such_thing=1", NUL, NULL, NULL, NULL, &error);
    refused(status, WELT_ERROR_ARGUMENT, error, "no_such_thing", mesh);
    welt_rules_free(rules);

    check(welt_job_create(&job, NULL) == WELT_OK, "job");
    welt_job_cancel(job);
    status = groove(mesh, selection, "width=0.2", NULL, job, &error);
    refused(status, WELT_ERROR_CANCELLED, error, "cancelled", mesh);
    check(welt_mesh_deviation(mesh, mesh, 8, values, job, NULL) == WELT_ERROR_CANCELLED, "deviation is cancelled");
    welt_job_free(job);

    twice[0] = twice[1] = 40;
    heights[0] = heights[1] = 0.1;
    status = welt_mesh_displace(mesh, twice, heights, 2, &error);
    refused(status, WELT_ERROR_ARGUMENT, error, "twice", mesh);
    twice[1] = VERTICES;
    status = welt_mesh_displace(mesh, twice, heights, 2, &error);
    refused(status, WELT_ERROR_ARGUMENT, error, "vertex 81 does not exist", mesh);
    twice[1] = 41;
    heights[1] = HUGE_VAL;
    status = welt_mesh_displace(mesh, twice, heights, 2, &error);
    refused(status, WELT_ERROR_ARGUMENT, error, "vertex 41 is not a finite number", mesh);

    check(groove(mesh, selection, "width=0.2 depth=0.1", NULL, NULL, &error) == WELT_OK, "and then it works");
    check(welt_mesh_vertex_count(mesh) == VERTICES + 3 * (SIDE + 1), "three vertices per marked edge");
    welt_selection_free(selection);
    welt_mesh_free(mesh);
}

/* A selection knows the mesh it was made on. */
static void stale_selections(void) {
    const char *triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    welt_mesh *mesh = sheet(0.0), *small = NULL;
    welt_selection *selection = across(mesh);
    welt_rules *rules = NULL;
    welt_error *error = NULL;
    uint32_t edges[2 * (SIDE + 1)];
    size_t vertices;
    int32_t status;

    check(welt_mesh_import_memory(NULL, 0, WELT_FORMAT_OBJ, (const uint8_t *)triangle, strlen(triangle), NULL, &small,
                                  NULL, NULL) == WELT_OK,
          "triangle");
    status = groove(small, selection, "width=0.2", NULL, NULL, &error);
    refused(status, WELT_ERROR_ARGUMENT, error, "another mesh", NULL);
    status = welt_mesh_mark(small, selection, &error);
    refused(status, WELT_ERROR_ARGUMENT, error, "another mesh", NULL);
    status = welt_selection_edges(selection, small, edges, 2 * (SIDE + 1), NULL, 0, &error);
    refused(status, WELT_ERROR_ARGUMENT, error, "another mesh", NULL);
    check(welt_mesh_vertex_count(small) == 3 && welt_mesh_face_count(small) == 1, "the triangle is as it was");

    check(groove(mesh, selection, "width=0.2", NULL, NULL, NULL) == WELT_OK, "the first time");
    vertices = welt_mesh_vertex_count(mesh);
    status = groove(mesh, selection, "width=0.2", NULL, NULL, &error);
    check(welt_error_place_kind(error, 0) == WELT_PLACE_EDGE, "the place is an edge");
    refused(status, WELT_ERROR_ARGUMENT, error, "before it was changed", NULL);
    check(welt_rules_linear(&rules, NULL) == WELT_OK, "linear rules");
    status = welt_rules_apply(mesh, selection, rules, NULL, 0, NULL, NULL, NULL, &error);
    refused(status, WELT_ERROR_ARGUMENT, error, "before it was changed", NULL);
    check(welt_mesh_vertex_count(mesh) == vertices, "the second time nothing happens, and the mesh is not poisoned");
    welt_rules_free(rules);
    welt_selection_free(selection);
    welt_mesh_free(small);
    welt_mesh_free(mesh);
}

static void rule_files(void) {
    const char *path = "typo.rules";
    welt_rules *rules = NULL;
    welt_error *error = NULL;
    FILE *file = fopen(path, "w");
    int32_t status;
    check(file != NULL, "the rule file can be written");
    if (file == NULL)
        return;
    fputs("% a comment\nruel x {\n}\n", file);
    fclose(file);
    status = welt_rules_load(path, NUL, &rules, &error);
    check(welt_error_place_count(error) >= 1 && strcmp(welt_error_place_file(error, 0), path) == 0, "file");
    check(welt_error_place_line(error, 0) == 2 && welt_error_place_column(error, 0) == 1, "line and column");
    check(strlen(welt_error_place_message(error, 0)) > 0, "the place has a message");
    refused(status, WELT_ERROR_SYNTAX, error, "ruel", NULL);
    remove(path);
    status = welt_rules_load("absent.rules", NUL, &rules, &error);
    refused(status, WELT_ERROR_FILE, error, "absent.rules", NULL);
    check(rules == NULL, "no rules are written");
}

/* Step by step: rules by hand, heights by hand. */
static void stages(void) {
    welt_mesh *mesh = sheet(0.0), *above = sheet(0.25);
    welt_selection *selection = across(mesh);
    welt_surface *surface = NULL;
    welt_rules *rules = NULL;
    welt_report *report = NULL;
    uint32_t vertices[5], edges[2 * (SIDE + 1)];
    double heights[5], places[SIDE + 1], values[3], *limit;
    size_t i, count;

    check(welt_selection_edges(selection, mesh, edges, 2 * (SIDE + 1), places, SIDE + 1, NULL) == WELT_OK, "edges");
    for (i = 0; i <= SIDE; ++i)
        check(edges[2 * i] % (SIDE + 1) + edges[2 * i + 1] % (SIDE + 1) == 7 && places[i] == 0.5, "a middle edge");
    check(welt_mesh_mark(mesh, selection, NULL) == WELT_OK && is_sheet(mesh), "marks change no shape");
    check(welt_surface_create(mesh, NULL, 0, NULL, &surface, NULL) == WELT_OK, "surface");
    check(welt_rules_linear(&rules, NULL) == WELT_OK, "rules");
    check(welt_rules_apply(mesh, selection, rules, NULL, 0, NULL, NULL, &report, NULL) == WELT_OK, "rules run");
    check(strchr(welt_report_json(report), '{') != NULL, "report");
    welt_report_free(report);
    report = NULL;
    check(welt_mesh_fit(mesh, NULL, 0, surface, WELT_FIT_SOLVE, NULL, &report, NULL) == WELT_OK, "fit");
    check(strchr(welt_report_json(report), '{') != NULL, "report of the fit");

    for (i = 0; i < 5; ++i) {
        vertices[i] = (uint32_t)(20 + 9 * i);
        heights[i] = 0.05 * (double)i - 0.1;
    }
    check(welt_mesh_displace(mesh, vertices, heights, 5, NULL) == WELT_OK, "displace");
    count = welt_mesh_vertex_count(mesh);
    limit = (double *)malloc(3 * count * sizeof(double));
    check(limit != NULL && welt_mesh_limit_positions(mesh, limit, 3 * count, NULL) == WELT_OK, "limit");
    for (i = 0; limit != NULL && i < 5; ++i)
        check(fabs(limit[3 * vertices[i] + 2] - heights[i]) < 1e-9, "a limit point is as high as was asked");
    free(limit);

    check(welt_mesh_deviation(above, above, 8, values, NULL, NULL) == WELT_OK, "deviation");
    check(values[0] <= 1e-12 && values[1] <= 1e-12 && values[2] <= 1e-12, "a mesh is where it is");
    welt_mesh_free(mesh);
    mesh = sheet(0.0);
    check(welt_mesh_deviation(mesh, above, 8, values, NULL, NULL) == WELT_OK, "deviation");
    check(fabs(values[0] - 0.25) < 1e-12 && fabs(values[1] - 0.25) < 1e-12 && fabs(values[2] - 0.25) < 1e-12,
          "a raised sheet is a quarter away");
    welt_report_free(report);
    welt_rules_free(rules);
    welt_surface_free(surface);
    welt_selection_free(selection);
    welt_mesh_free(above);
    welt_mesh_free(mesh);
}

static void the_list(void) {
    welt_report *list = NULL;
    check(welt_feature_list(&list, NULL) == WELT_OK, "list");
    check(strstr(welt_report_json(list), "\"groove\"") != NULL && strstr(welt_report_json(list), "\"ridge\"") != NULL,
          "groove and ridge are listed");
    welt_report_free(list);
}

int main(void) {
    null_pointers();
    mistakes();
    stale_selections();
    rule_files();
    stages();
    the_list();
    printf("%d failures\n", failures);
    return failures != 0;
}
