/* Puts a groove across the edges you name and writes the new control mesh.
 *
 *   cc groove.c -lwelt -o groove
 *   ./groove chair.obj seam.obj ring:3,331 "width=1.6 depth=0.6"
 */
#include <stdio.h>
#include <welt.h>

/* Tells what went wrong, and each place it went wrong at. */
static void explain(const welt_error *error) {
    size_t i;
    fprintf(stderr, "%s\n", welt_error_message(error));
    for (i = 0; i < welt_error_place_count(error); ++i) {
        if (welt_error_place_line(error, i) > 0) {
            fprintf(stderr, "  %s:%lu:%lu: ", welt_error_place_file(error, i),
                    (unsigned long)welt_error_place_line(error, i),
                    (unsigned long)welt_error_place_column(error, i));
        } else if (welt_error_place_kind(error, i) == WELT_PLACE_EDGE) {
            fprintf(stderr, "  edge %lu,%lu: ", (unsigned long)welt_error_place_id(error, i, 0),
                    (unsigned long)welt_error_place_id(error, i, 1));
        } else if (welt_error_place_kind(error, i) != WELT_PLACE_WHOLE) {
            fprintf(stderr, "  %s %lu: ",
                    welt_error_place_kind(error, i) == WELT_PLACE_FACE ? "face" : "vertex",
                    (unsigned long)welt_error_place_id(error, i, 0));
        } else {
            fprintf(stderr, "  ");
        }
        fprintf(stderr, "%s\n", welt_error_place_message(error, i));
    }
}

int main(int count, char **arguments) {
    welt_mesh *mesh = NULL;
    welt_selection *selection = NULL;
    welt_report *report = NULL;
    welt_error *error = NULL;
    int32_t status;

    if (count != 5) {
        fprintf(stderr, "usage: groove IN.obj OUT.obj MARKS SETTINGS\n");
        return 2;
    }

    /* SIZE_MAX, here (size_t)-1, says that a text ends with its NUL. */
    status = welt_mesh_import_file(arguments[1], (size_t)-1, NULL, &mesh, NULL, &error);
    if (status == WELT_OK)
        status = welt_selection_create(mesh, arguments[3], (size_t)-1, &selection, &error);
    if (status == WELT_OK)
        status = welt_feature_apply(mesh, selection, "groove", (size_t)-1, arguments[4], (size_t)-1, NULL, NULL,
                                    &report, &error);
    if (status == WELT_OK)
        status = welt_mesh_export_file(mesh, arguments[2], (size_t)-1, &error);

    if (status == WELT_OK) {
        printf("%lu edges marked; the mesh now has %lu vertices\n",
               (unsigned long)welt_selection_count(selection), (unsigned long)welt_mesh_vertex_count(mesh));
        printf("%s\n", welt_report_json(report));
    } else {
        explain(error);
    }

    /* Each of these accepts NULL. */
    welt_error_free(error);
    welt_report_free(report);
    welt_selection_free(selection);
    welt_mesh_free(mesh);
    return status == WELT_OK ? 0 : 1;
}
