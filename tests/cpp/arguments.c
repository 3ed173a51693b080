/* Values that a call cannot take: structs of other sizes, numbers that are none, constants that do not exist; and the
 * arithmetic of versions. NULL and wrong counts are in hostile.cpp. */

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <welt.h>

#define NUL ((size_t)-1)

static int failures = 0;

static void check(int holds, const char *what) {
    if (!holds) {
        printf("FAILED: %s\n", what);
        ++failures;
    }
}

/* The preprocessor knows the version as well. */
#if WELT_VERSION != WELT_VERSION_MAJOR * 65536 + WELT_VERSION_MINOR * 256 + WELT_VERSION_PATCH
#error "WELT_VERSION is not what its parts say"
#endif
#if WELT_VERSION_MINOR > 255 || WELT_VERSION_PATCH > 255
#error "a part of the version needs more than eight bits"
#endif

static void versions(void) {
    char text[32];
    uint32_t version = welt_version();
    sprintf(text, "%lu.%lu.%lu", (unsigned long)(version >> 16), (unsigned long)(version >> 8 & 255),
            (unsigned long)(version & 255));
    check(strcmp(text, welt_version_string()) == 0, "number and text of the version agree");
    check(version == WELT_VERSION, "header and library are of one version");
    check(welt_is_compatible(WELT_VERSION, WELT_ABI_VERSION) == 1, "the header fits");
    check(welt_is_compatible(0, WELT_ABI_VERSION) == 1, "an older header fits");
    check(welt_is_compatible(WELT_VERSION + 1, WELT_ABI_VERSION) == 0, "a newer header does not");
    check(welt_is_compatible(UINT32_MAX, WELT_ABI_VERSION) == 0, "nor the newest");
    check(welt_is_compatible(WELT_VERSION, WELT_ABI_VERSION + 1) == 0, "nor another interface");
}

static const char *triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

static int32_t import(const welt_import_options *options, uint32_t format, welt_mesh **mesh) {
    return welt_mesh_import_memory(NULL, 0, format, (const uint8_t *)triangle, strlen(triangle), options, mesh, NULL,
                                   NULL);
}

/* A sheet of 3 by 3 squares. */
static welt_mesh *sheet(void) {
    uint32_t sizes[9], corners[36], i;
    double positions[48];
    welt_mesh *mesh = NULL;
    for (i = 0; i < 16; ++i) {
        positions[3 * i] = i % 4;
        positions[3 * i + 1] = (double)(i / 4);
        positions[3 * i + 2] = 0.0;
    }
    for (i = 0; i < 9; ++i) {
        uint32_t first = i % 3 + 4 * (i / 3);
        sizes[i] = 4;
        corners[4 * i] = first;
        corners[4 * i + 1] = first + 1;
        corners[4 * i + 2] = first + 5;
        corners[4 * i + 3] = first + 4;
    }
    check(welt_mesh_create(sizes, 9, corners, 36, positions, 16, 0, &mesh, NULL) == WELT_OK, "sheet");
    return mesh;
}

/* A struct of options that is followed by bytes which nobody may touch. */
typedef int32_t (*initialise)(void *options, size_t size);

static int32_t initialise_import(void *options, size_t size) {
    return welt_import_options_init((welt_import_options *)options, size);
}

static int32_t initialise_feature(void *options, size_t size) {
    return welt_feature_options_init((welt_feature_options *)options, size);
}

static int32_t initialise_batch(void *options, size_t size) {
    return welt_batch_options_init((welt_batch_options *)options, size);
}

static int32_t initialise_patch(void *options, size_t size) {
    return welt_patch_options_init((welt_patch_options *)options, size);
}

/* Whether a call accepts a struct whose first member is this size. */
static int32_t use_import(const void *options) {
    welt_mesh *mesh = NULL;
    int32_t status = import((const welt_import_options *)options, WELT_FORMAT_OBJ, &mesh);
    welt_mesh_free(mesh);
    return status;
}

static int32_t use_feature(const void *options) {
    welt_mesh *mesh = sheet();
    welt_selection *selection = NULL;
    int32_t status;
    check(welt_selection_create(mesh, "ring:1,2", NUL, &selection, NULL) == WELT_OK, "ring");
    status = welt_feature_apply(mesh, selection, "groove", NUL, "width=0.2 depth=0.1", NUL,
                                (const welt_feature_options *)options, NULL, NULL, NULL);
    check(welt_mesh_vertex_count(mesh) == (status == WELT_OK ? 28u : 16u), "a refused call changes nothing");
    welt_selection_free(selection);
    welt_mesh_free(mesh);
    return status;
}

static int32_t use_batch(const void *options) {
    const uint32_t face = 4;
    const double middle[2] = {0.5, 0.5};
    double position[3] = {-7.0, -7.0, -7.0};
    welt_mesh *mesh = sheet();
    welt_surface *surface = NULL;
    int32_t status;
    check(welt_surface_create(mesh, NULL, 0, NULL, &surface, NULL) == WELT_OK, "surface");
    status = welt_surface_evaluate(surface, &face, NULL, middle, 1, 0, (const welt_batch_options *)options, position, 3,
                                   NULL);
    check(fabs(position[0] - (status == WELT_OK ? 1.5 : -7.0)) < 1e-14, "a refused call writes nothing");
    welt_surface_free(surface);
    welt_mesh_free(mesh);
    return status;
}

static int32_t use_patch(const void *options) {
    welt_mesh *mesh = sheet();
    welt_patches *patches = NULL;
    int32_t status = welt_patches_create(mesh, NULL, 0, (const welt_patch_options *)options, NULL, &patches, NULL);
    check(welt_patches_count(patches) == (status == WELT_OK ? 1u : 0u), "a refused call makes nothing");
    welt_patches_free(patches);
    welt_mesh_free(mesh);
    return status;
}

/* first: size of the first version that was released; last: that of the present one. */
static void sizes(const char *name, initialise init, int32_t (*use)(const void *), size_t first, size_t last) {
    union {
        unsigned char bytes[256];
        uint32_t size;
        double alignment;
    } options;
    const size_t huge[3] = {(size_t)-1, (size_t)-1 / 2, (size_t)65536 * 65535};
    size_t size, i;
    for (size = 0; size <= 128; ++size) {
        int32_t status;
        memset(&options, 0xa5, sizeof options);
        status = init(&options, size);
        check(status == (size >= first && size <= last ? WELT_OK : WELT_ERROR_ARGUMENT), name);
        for (i = status == WELT_OK ? size : 0; i < sizeof options; ++i)
            if (options.bytes[i] != 0xa5) break;
        check(i == sizeof options, "no byte is written beyond the size");
        if (status == WELT_OK) check(options.size == size, "the struct knows its size");
    }
    memset(&options, 0xa5, sizeof options);
    for (i = 0; i < 3; ++i) check(init(&options, huge[i]) == WELT_ERROR_ARGUMENT, "a huge size");
    check(options.bytes[0] == 0xa5, "nothing is written");

    check(init(&options, last) == WELT_OK && use(&options) == WELT_OK, name);
    check(init(&options, first) == WELT_OK, name);
    memset(options.bytes + first, 0xa5, sizeof options - first);
    check(use(&options) == WELT_OK, "an old caller's struct is not read beyond its size");
    options.size = 0;
    check(use(&options) == WELT_ERROR_ARGUMENT, "a struct that was never set");
    options.size = (uint32_t)first - 1;
    check(use(&options) == WELT_ERROR_ARGUMENT, "a struct that is too small");
    options.size = (uint32_t)last + 8;
    check(use(&options) == WELT_ERROR_ARGUMENT, "a struct of a newer header");
    options.size = UINT32_MAX;
    check(use(&options) == WELT_ERROR_ARGUMENT, "a struct of a size that cannot be");
}

static void constants_that_do_not_exist(void) {
    const uint32_t wrong[3] = {3, 1000, UINT32_MAX}, wrong_fit[3] = {5, 1000, UINT32_MAX}, face = 4;
    const double middle[2] = {0.5, 0.5};
    double values[18];
    welt_mesh *mesh = sheet(), *none = NULL;
    welt_surface *surface = NULL;
    welt_selection *selection = NULL;
    welt_feature_options options;
    int i;
    check(welt_surface_create(mesh, NULL, 0, NULL, &surface, NULL) == WELT_OK, "surface");
    check(welt_selection_create(mesh, "ring:1,2", NUL, &selection, NULL) == WELT_OK, "ring");
    check(welt_feature_options_init(&options, sizeof options) == WELT_OK, "options");
    for (i = 0; i < 3; ++i) {
        check(welt_mesh_set_subdivision(mesh, wrong[i], 0, NULL) == WELT_ERROR_ARGUMENT, "WELT_BOUNDARY_*");
        check(welt_mesh_set_subdivision(mesh, 0, wrong[i], NULL) == WELT_ERROR_ARGUMENT, "WELT_CREASING_*");
        check(import(NULL, wrong[i], &none) == WELT_ERROR_ARGUMENT && !none, "WELT_FORMAT_*");
        check(welt_mesh_fit(mesh, NULL, 0, surface, wrong_fit[i], NULL, NULL, NULL) == WELT_ERROR_ARGUMENT, "WELT_FIT_*");
        options.fit = wrong_fit[i];
        check(welt_feature_apply(mesh, selection, "groove", NUL, NULL, 0, &options, NULL, NULL, NULL) ==
                  WELT_ERROR_ARGUMENT,
              "WELT_FIT_* of options");
        options.fit = WELT_FIT_NONE;
        options.parity = wrong[i];
        check(welt_feature_apply(mesh, selection, "groove", NUL, NULL, 0, &options, NULL, NULL, NULL) ==
                  WELT_ERROR_ARGUMENT,
              "WELT_PARITY_*");
        options.parity = WELT_PARITY_AUTO;
        check(welt_surface_evaluate(surface, &face, NULL, middle, 1, wrong[i], NULL, values, 18, NULL) ==
                  WELT_ERROR_ARGUMENT,
              "an order of derivatives");
    }
    check(welt_mesh_vertex_count(mesh) == 16, "the mesh is as it was");
    welt_selection_free(selection);
    welt_surface_free(surface);
    welt_mesh_free(mesh);
}

/* What is wrong with the last of many points is found before the result of the first is written. */
static void bad_last_points(void) {
    const uint32_t faces[2] = {4, 4}, corners[2] = {0, 1}, triangle_faces[2] = {0, 1}, no_faces[2] = {0, UINT32_MAX};
    const double nan = -sqrt(-1.0), middle[4] = {0.5, 0.5, 0.5, 0.5};
    double parameters[4] = {0.5, 0.5, 0.5, 0.0}, values[36], before[36];
    welt_mesh *mesh = sheet(), *flat = NULL;
    welt_surface *surface = NULL;
    int i;
    parameters[3] = nan;
    for (i = 0; i < 36; ++i) before[i] = values[i] = 7.0;
    check(welt_surface_create(mesh, NULL, 0, NULL, &surface, NULL) == WELT_OK, "surface");
    check(import(NULL, WELT_FORMAT_OBJ, &flat) == WELT_OK, "a triangle");
    check(welt_surface_evaluate(surface, faces, NULL, parameters, 2, 2, NULL, values, 36, NULL) == WELT_ERROR_ARGUMENT,
          "the last parameter is NaN");
    check(welt_surface_evaluate(surface, faces, corners, middle, 2, 2, NULL, values, 36, NULL) == WELT_ERROR_ARGUMENT,
          "the last patch is none");
    check(welt_surface_evaluate(surface, faces, NULL, middle, 2, 2, NULL, values, 35, NULL) == WELT_ERROR_BUFFER,
          "the last row has no room");
    check(welt_surface_curvature(surface, faces, NULL, parameters, 2, values, 36, NULL) == WELT_ERROR_ARGUMENT,
          "the last parameter of curvature is NaN");
    check(welt_surface_curvature(surface, faces, corners, middle, 2, values, 36, NULL) == WELT_ERROR_ARGUMENT,
          "the last patch of curvature is none");
    check(welt_mesh_loop_evaluate(flat, no_faces, middle, 2, 2, NULL, values, 36, NULL) == WELT_ERROR_ARGUMENT &&
              welt_mesh_loop_evaluate(flat, triangle_faces, middle, 2, 2, NULL, values, 36, NULL) == WELT_ERROR_ARGUMENT,
          "the last triangle is none");
    check(welt_mesh_loop_evaluate(flat, triangle_faces, parameters, 1, 2, NULL, values, 17, NULL) == WELT_ERROR_BUFFER,
          "a row of a triangle has no room");
    check(memcmp(values, before, sizeof values) == 0, "nothing is written");
    check(welt_surface_evaluate(surface, faces, NULL, middle, 2, 2, NULL, values, 36, NULL) == WELT_OK &&
              values[0] != 7.0 && values[18] != 7.0,
          "good points are");
    welt_surface_free(surface);
    welt_mesh_free(flat);
    welt_mesh_free(mesh);
}

/* Distances and parameters of lines that are NaN are refused; coordinates find nothing. */
static void queries(const welt_surface *surface, int kind, double bad) {
    double line[6] = {1.5, 1.5, 1.0, 0.0, 0.0, -1.0};
    const int32_t expected = kind == 0 ? WELT_ERROR_ARGUMENT : WELT_OK;
    welt_surface_point point;
    size_t starts[2] = {7, 7}, needed = 7;
    check(welt_surface_closest(surface, line, 1, bad, NULL, NULL, &point, 1, NULL) == expected, "a radius");
    check(welt_surface_first_hits(surface, line, 1, bad, HUGE_VAL, NULL, &point, 1, NULL) == expected, "first");
    check(welt_surface_all_hits(surface, line, 1, 0.0, bad, NULL, starts, &needed, &point, 1, NULL) == expected, "last");
    check(starts[0] == (kind == 0 ? 7u : 0u) && needed == (kind == 0 ? 7u : kind == 1 ? 1u : 0u), "hits");
    line[1] = bad;
    check(welt_surface_closest(surface, line, 1, HUGE_VAL, NULL, NULL, &point, 1, NULL) == WELT_OK, "a point");
    check(point.face == WELT_NONE && point.distance == 0.0, "is close to nothing");
    check(welt_surface_first_hits(surface, line, 1, 0.0, HUGE_VAL, NULL, &point, 1, NULL) == WELT_OK, "a line");
    check(point.face == WELT_NONE && point.distance == 0.0, "hits nothing");
}

/* Every number that a call reads, as none: kind 0 is NaN, 1 and 2 are the infinities. */
static void numbers_that_are_none(int kind) {
    const double bad = kind == 0 ? -sqrt(-1.0) : kind == 1 ? HUGE_VAL : -HUGE_VAL;
    const char *const width = kind == 0 ? "width=nan depth=0.1" : kind == 1 ? "width=inf depth=0.1" : "width=0.1 depth=-inf";
    const uint32_t face = 4, edge[2] = {5, 6};
    double positions[48], parameters[2], values[18];
    const double *view = NULL;
    float sharpness = (float)bad;
    welt_mesh *mesh = sheet(), *none = NULL;
    welt_surface *surface = NULL;
    welt_selection *selection = NULL;
    welt_import_options options;
    const uint32_t size = 3, corners[3] = {0, 1, 2};

    check(welt_mesh_positions(mesh, &view, NULL) == WELT_OK, "view");
    memcpy(positions, view, sizeof positions);
    positions[7] = bad;
    check(welt_mesh_set_positions(mesh, positions, 16, 0, NULL) == WELT_ERROR_MESH, "positions");
    check(welt_mesh_create(&size, 1, corners, 3, positions, 3, 0, &none, NULL) == WELT_ERROR_MESH && !none, "a mesh");
    check(welt_mesh_displace(mesh, edge, &bad, 1, NULL) == WELT_ERROR_ARGUMENT, "a height");
    check(welt_import_options_init(&options, sizeof options) == WELT_OK, "options");
    options.weld = bad;
    if (kind < 2) check(import(&options, WELT_FORMAT_OBJ, &none) == WELT_ERROR_ARGUMENT && !none, "a welding distance");
    /* Infinite sharpness is sharp. */
    if (kind != 1) {
        check(welt_mesh_set_edge_sharpness(mesh, edge, &sharpness, 1, NULL) == WELT_ERROR_ARGUMENT, "an edge");
        check(welt_mesh_set_vertex_sharpness(mesh, edge, &sharpness, 1, NULL) == WELT_ERROR_ARGUMENT, "a vertex");
    }
    check(welt_selection_create(mesh, "ring:1,2", NUL, &selection, NULL) == WELT_OK, "ring");
    check(welt_feature_apply(mesh, selection, "groove", NUL, width, NUL, NULL, NULL, NULL, NULL) == WELT_ERROR_ARGUMENT,
          width);
    check(welt_surface_create(mesh, NULL, 0, NULL, &surface, NULL) == WELT_OK, "surface");
    parameters[0] = 0.5;
    parameters[1] = bad;
    if (kind == 0) {
        check(welt_surface_evaluate(surface, &face, NULL, parameters, 1, 2, NULL, values, 18, NULL) == WELT_ERROR_ARGUMENT,
              "a parameter");
    } else {
        check(welt_surface_evaluate(surface, &face, NULL, parameters, 1, 2, NULL, values, 18, NULL) == WELT_OK, "a parameter");
        check(fabs(values[1] - (kind == 1 ? 2.0 : 1.0)) < 1e-14, "is moved to the nearest inside");
    }
    check(welt_surface_curvature(surface, &face, NULL, parameters, 1, values, 18, NULL) ==
              (kind == 0 ? WELT_ERROR_ARGUMENT : WELT_OK),
          "a parameter of curvature");
    queries(surface, kind, bad);
    check(welt_mesh_positions(mesh, &view, NULL) == WELT_OK && welt_mesh_vertex_count(mesh) == 16, "view");
    positions[7] = view[7];
    check(memcmp(positions, view, sizeof positions) == 0, "the mesh is as it was");
    welt_surface_free(surface);
    welt_selection_free(selection);
    welt_mesh_free(mesh);
}

/* Each limit of a file, as large as the triangle and one less, or larger than all that is. */
static void limits_of_files(void) {
    const uint64_t needed[4] = {3, 1, 3, 1};
    const char *const words[4] = {"vert", "face", "a face with more than", "vertex"};
    welt_import_options options;
    uint64_t *members[4];
    size_t i;
    members[0] = &options.max_vertices;
    members[1] = &options.max_faces;
    members[2] = &options.max_face_vertices;
    members[3] = &options.max_vertex_faces;
    for (i = 0; i < 4; ++i) {
        uint64_t tried[4];
        size_t k;
        tried[0] = 0;
        tried[1] = needed[i] - 1;
        tried[2] = needed[i];
        tried[3] = UINT64_MAX;
        for (k = 0; k < 4; ++k) {
            welt_mesh *mesh = NULL;
            welt_error *error = NULL;
            int32_t status;
            check(welt_import_options_init(&options, sizeof options) == WELT_OK, "options");
            *members[i] = tried[k];
            status = welt_mesh_import_memory(NULL, 0, WELT_FORMAT_OBJ, (const uint8_t *)triangle, strlen(triangle), &options,
                                             &mesh, NULL, &error);
            if (k < 2) {
                check(status != WELT_OK && !mesh, words[i]);
                check(strstr(welt_error_message(error), words[i]) != NULL, welt_error_message(error));
                check(strstr(welt_error_message(error), "raise the limit") != NULL, welt_error_message(error));
            } else {
                check(status == WELT_OK && mesh, words[i]);
            }
            welt_error_free(error);
            welt_mesh_free(mesh);
        }
    }
}

/* A groove with these options on a sheet, and the message of the error; the size of the mesh afterwards is written. */
static int32_t groove(const welt_feature_options *options, char *message, size_t *vertices) {
    welt_mesh *mesh = sheet();
    welt_selection *selection = NULL;
    welt_error *error = NULL;
    int32_t status;
    check(welt_selection_create(mesh, "ring:1,2", NUL, &selection, NULL) == WELT_OK, "ring");
    status = welt_feature_apply(mesh, selection, "groove", NUL, "width=0.2 depth=0.1", NUL, options, NULL, NULL, &error);
    sprintf(message, "%.500s", welt_error_message(error));
    *vertices = welt_mesh_vertex_count(mesh);
    welt_error_free(error);
    welt_selection_free(selection);
    welt_mesh_free(mesh);
    return status;
}

/* Each limit of the rules, too small and larger than all that is. */
static void limits_of_rules(void) {
    const char *const names[7] = {"depth", "applications", "steps", "changes", "growth", "elements", "seconds"};
    const char *const words[7] = {"inside one another", "applications", "steps", "changes", "vertices, edges and faces",
                                  "vertices, edges and faces", "more than 0 s"};
    welt_feature_options options;
    char message[512];
    size_t vertices;
    int i, large;
    for (i = 0; i < 7; ++i) {
        for (large = 0; large < 2; ++large) {
            const uint64_t most = large ? UINT64_MAX : i == 4 || i == 5 ? 0 : i == 0 ? 0 : 1;
            int32_t status;
            check(welt_feature_options_init(&options, sizeof options) == WELT_OK, "options");
            switch (i) {
            case 0: options.max_script_depth = large ? UINT32_MAX : 0; break;
            case 1: options.max_applications = most; break;
            case 2: options.max_steps = most; break;
            case 3: options.max_changes = most; break;
            /* The two are added up. */
            case 4: options.max_growth = large ? UINT64_MAX : 1; options.max_extra_elements = 0; break;
            case 5: options.max_extra_elements = most; options.max_growth = 0; break;
            default: options.max_seconds = large ? HUGE_VAL : 0.0;
            }
            status = groove(&options, message, &vertices);
            if (large) {
                check(status == WELT_OK && vertices == 28, names[i]);
                continue;
            }
            check(status == WELT_ERROR_RULE && vertices == 16, names[i]);
            check(strstr(message, words[i]) != NULL, message);
            check(strstr(message, "raise the limit") != NULL, message);
        }
    }
}

/* Seconds that are no time are refused; times that no clock can count are none. */
static void seconds(void) {
    const double bad[3] = {-1.0, -1e-300, -HUGE_VAL}, good[4] = {-0.0, 1e300, 1.8e19, HUGE_VAL};
    welt_feature_options options;
    char message[512];
    size_t vertices;
    int i;
    check(welt_feature_options_init(&options, sizeof options) == WELT_OK && options.max_seconds == 60.0, "the default");
    options.max_seconds = -sqrt(-1.0);
    check(groove(&options, message, &vertices) == WELT_ERROR_ARGUMENT && vertices == 16, "NaN seconds");
    check(strstr(message, "max_seconds is NaN") != NULL, message);
    for (i = 0; i < 3; ++i) {
        options.max_seconds = bad[i];
        check(groove(&options, message, &vertices) == WELT_ERROR_ARGUMENT && vertices == 16, "negative seconds");
        check(strstr(message, "max_seconds is -") != NULL, message);
    }
    for (i = 1; i < 4; ++i) {
        options.max_seconds = good[i];
        check(groove(&options, message, &vertices) == WELT_OK && vertices == 28, "seconds without end");
    }
    options.max_seconds = good[0];
    check(groove(&options, message, &vertices) == WELT_ERROR_RULE && vertices == 16, "no time at all");
}

/* A caller that was compiled before there were limits gets the defaults, whatever lies behind its struct. */
static void limits_of_old_callers(void) {
    const size_t features[3] = {20, 24, 56};
    union {
        welt_feature_options options;
        unsigned char bytes[256];
    } known;
    union {
        welt_import_options options;
        unsigned char bytes[256];
    } files;
    char message[512];
    size_t vertices, i;
    welt_mesh *mesh = NULL;
    for (i = 0; i < 3; ++i) {
        memset(&known, 0, sizeof known);
        check(welt_feature_options_init(&known.options, features[i]) == WELT_OK, "an old size");
        check(groove(&known.options, message, &vertices) == WELT_OK && vertices == 28, "limits of 0 are not read");
        memset(known.bytes + features[i], 0xff, sizeof known - features[i]);
        check(groove(&known.options, message, &vertices) == WELT_OK && vertices == 28, "nor is NaN");
    }
    memset(&files, 0, sizeof files);
    check(welt_import_options_init(&files.options, 16) == WELT_OK, "an old size");
    check(import(&files.options, WELT_FORMAT_OBJ, &mesh) == WELT_OK, "limits of 0 are not read");
    welt_mesh_free(mesh);
}

int main(void) {
    versions();
    limits_of_files();
    limits_of_rules();
    seconds();
    limits_of_old_callers();
    sizes("welt_import_options_init", initialise_import, use_import, 16, sizeof(welt_import_options));
    sizes("welt_feature_options_init", initialise_feature, use_feature, 20, sizeof(welt_feature_options));
    sizes("welt_batch_options_init", initialise_batch, use_batch, sizeof(welt_batch_options), sizeof(welt_batch_options));
    sizes("welt_patch_options_init", initialise_patch, use_patch, 16, sizeof(welt_patch_options));
    constants_that_do_not_exist();
    bad_last_points();
    numbers_that_are_none(0);
    numbers_that_are_none(1);
    numbers_that_are_none(2);
    printf("%d failures\n", failures);
    return failures != 0;
}
