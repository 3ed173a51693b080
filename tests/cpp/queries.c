/* Queries without one answer, or with none, through the C ABI: docs/queries.md has the table. */

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <welt.h>

static int failures = 0;

static void check(int holds, const char *what) {
    if (!holds) {
        printf("FAILED: %s\n", what);
        ++failures;
    }
}

static int near(double a, double b) { return fabs(a - b) < 1e-14; }

/* A cube of edge 2 about the origin; all edges sharp or none. */
static welt_surface *cube(int sharp) {
    static const uint32_t corners[24] = {0, 2, 3, 1, 4, 5, 7, 6, 0, 1, 5, 4, 2, 6, 7, 3, 0, 4, 6, 2, 1, 3, 7, 5};
    static const uint32_t sizes[6] = {4, 4, 4, 4, 4, 4};
    double positions[24];
    welt_mesh *mesh = NULL;
    welt_surface *surface = NULL;
    int i, axis;
    for (i = 0; i < 8; ++i)
        for (axis = 0; axis < 3; ++axis) positions[3 * i + axis] = (i >> axis) & 1 ? 1.0 : -1.0;
    check(welt_mesh_create(sizes, 6, corners, 24, positions, 8, 0, &mesh, NULL) == WELT_OK, "a cube");
    if (sharp) {
        uint32_t ends[24];
        float sharpness[12];
        int a, b, count = 0;
        for (a = 0; a < 8; ++a)
            for (axis = 0; axis < 3; ++axis) {
                b = a | 1 << axis;
                if (b == a) continue;
                ends[2 * count] = (uint32_t)a;
                ends[2 * count + 1] = (uint32_t)b;
                sharpness[count++] = 10.0f;
            }
        check(welt_mesh_set_edge_sharpness(mesh, ends, sharpness, 12, NULL) == WELT_OK, "sharp edges");
    }
    check(welt_surface_create(mesh, NULL, 0, NULL, &surface, NULL) == WELT_OK, "a surface");
    welt_mesh_free(mesh);
    return surface;
}

/* A flat sheet from (0, 0) to (3, 3). */
static welt_surface *sheet(void) {
    uint32_t sizes[9], corners[36], i;
    double positions[48];
    welt_mesh *mesh = NULL;
    welt_surface *surface = NULL;
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
    check(welt_mesh_create(sizes, 9, corners, 36, positions, 16, 0, &mesh, NULL) == WELT_OK, "a sheet");
    check(welt_surface_create(mesh, NULL, 0, NULL, &surface, NULL) == WELT_OK, "its surface");
    welt_mesh_free(mesh);
    return surface;
}

/* The hits of a line; the number of them. */
static size_t hits(const welt_surface *surface, double x, double y, double z, double dx, double dy, double dz,
                   welt_surface_point found[16]) {
    double line[6];
    size_t starts[2] = {0, 0};
    welt_surface_point first;
    line[0] = x, line[1] = y, line[2] = z, line[3] = dx, line[4] = dy, line[5] = dz;
    check(welt_surface_all_hits(surface, line, 1, -HUGE_VAL, HUGE_VAL, NULL, starts, NULL, found, 16, NULL) == WELT_OK,
          "all hits");
    check(welt_surface_first_hits(surface, line, 1, -HUGE_VAL, HUGE_VAL, NULL, &first, 1, NULL) == WELT_OK, "first hits");
    check((first.face == WELT_NONE) == (starts[1] == 0), "a first hit where there are hits");
    return starts[1];
}

static welt_surface_point closest(const welt_surface *surface, double x, double y, double z) {
    double point[3];
    welt_surface_point found;
    point[0] = x, point[1] = y, point[2] = z;
    check(welt_surface_closest(surface, point, 1, HUGE_VAL, NULL, NULL, &found, 1, NULL) == WELT_OK, "closest");
    return found;
}

static double signed_distance(const welt_surface *surface, double x, double y, double z) {
    double point[3], distance = 0.0;
    point[0] = x, point[1] = y, point[2] = z;
    check(welt_surface_signed_distances(surface, point, 1, NULL, &distance, 1, NULL) == WELT_OK, "signed distance");
    return distance;
}

static void lines(const welt_surface *smooth, const welt_surface *sharp, const welt_surface *flat) {
    const double top = 68.0 / 81.0, nan = sqrt(-1.0);
    welt_surface_point found[16];
    size_t i, count;
    check(hits(smooth, -5, -5, -5, 1, 1, 1, found) == 2 && near(found[0].distance, 4.5) && near(found[1].distance, 5.5),
          "through two extraordinary vertices");
    check(hits(smooth, -5, 0, top, 1, 0, 0, found) == 1 && fabs(found[0].position[0]) < 1e-6, "tangent");
    check(hits(smooth, -5, 0, top + 1e-11, 1, 0, 0, found) == 0 && hits(smooth, -5, 0, top - 1e-11, 1, 0, 0, found) == 2,
          "beside the tangent");
    check(hits(sharp, 5, 5, 5, -1, -1, -1, found) == 2 && near(found[0].distance, 4), "through two corners");
    check(hits(sharp, 0.1, 0, 2, 0, 1, -1, found) == 1, "an edge that is touched");
    count = hits(sharp, -5, 1, 1, 1, 0, 0, found);
    check(count == 1 || count == 2, "along an edge");
    count = hits(flat, -5, 1, 0, 1, 0, 0, found);
    check(count >= 1 && count <= 6, "in a flat surface, along edges");
    for (i = 0; i < count; ++i)
        check(near(found[i].position[0], found[i].distance - 5) && found[i].position[1] == 1.0, "a point of the line");
    check(hits(flat, -5, 0, 0, 1, 0, 0, found) >= 1, "along the border");
    check(hits(flat, 1.5, 0, 5, 0, 0, -1, found) == 1 && hits(flat, 1.5, -1e-11, 5, 0, 0, -1, found) == 0, "at the border");
    check(hits(flat, 1, 1, 1e12, 0, 0, -1, found) == 1 && found[0].distance == 1e12, "from far away, through a vertex");
    check(hits(smooth, 0, 0, 0, 0, 0, 0, found) == 0, "no direction");
    check(hits(smooth, nan, 0, 0, 0, 0, 1, found) == 0 && hits(smooth, 0, 0, 0, 0, nan, 1, found) == 0, "NaN");
    check(hits(smooth, HUGE_VAL, 0, 0, 0, 0, 1, found) == 0 && hits(smooth, 0, 0, 0, 0, 0, HUGE_VAL, found) == 0, "infinite");
}

static void points(const welt_surface *smooth, const welt_surface *sharp, const welt_surface *flat) {
    const double top = 68.0 / 81.0, nan = sqrt(-1.0);
    double distance = 7.0, origin[3] = {0.0, 0.0, 0.0};
    welt_surface_point found;
    check(near(closest(smooth, 0, 0, 0).distance, top) && closest(sharp, 0, 0, 0).distance == 1.0, "equally close");
    found = closest(sharp, 2, 3, 3);
    check(found.position[0] == 1.0 && found.position[1] == 1.0 && found.position[2] == 1.0, "a corner");
    check(closest(smooth, 0.5, 0.5, 0.5).distance == 0.0, "on the surface");
    check(closest(flat, -4, 1, 3).distance == 5.0, "beyond the border");
    check(fabs(closest(smooth, 0, 0, 1e12).distance - 1e12) < 1.0, "far away");
    check(closest(smooth, nan, 0, 0).face == WELT_NONE && closest(smooth, HUGE_VAL, 0, 0).face == WELT_NONE &&
              closest(smooth, 0, 1e61, 0).face == WELT_NONE,
          "nowhere");
    check(welt_surface_closest(smooth, origin, 1, 0.0, NULL, NULL, &found, 1, NULL) == WELT_OK && found.face == WELT_NONE,
          "a radius of 0");

    check(signed_distance(sharp, 0, 0, 0) == -1.0 && signed_distance(sharp, 1, 0.2, 0.1) == 0.0, "inside and on it");
    check(near(signed_distance(sharp, 2, 2, 1), sqrt(2.0)) && near(signed_distance(sharp, 2, 2, 2), sqrt(3.0)),
          "outside, at an edge and at a corner");
    check(signed_distance(smooth, 1e12, 0, 0) > 0.0, "far outside");
    distance = signed_distance(smooth, nan, 0, 0);
    check(distance != distance, "NaN");
    check(welt_surface_signed_distances(flat, origin, 1, NULL, &distance, 1, NULL) == WELT_ERROR_ARGUMENT, "no inside");
}

int main(void) {
    welt_surface *smooth = cube(0), *sharp = cube(1), *flat = sheet();
    lines(smooth, sharp, flat);
    points(smooth, sharp, flat);
    welt_surface_free(smooth);
    welt_surface_free(sharp);
    welt_surface_free(flat);
    printf("%d failures\n", failures);
    return failures == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
