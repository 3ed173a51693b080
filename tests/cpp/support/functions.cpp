#include "functions.hpp"

#include <cmath>
#include <cstring>
#include <tuple>
#include <type_traits>
#include <utility>

namespace {

std::vector<Function> table;

template <class T>
constexpr bool is_integer = std::is_integral_v<T>;

// Spoils one argument; counts pointers and integers on the way.
template <class T>
void spoil(T& argument, Change const& change, int& pointers, int& integers) {
    if constexpr (std::is_pointer_v<T>) {
        if (pointers++ == change.null) argument = nullptr;
    } else if constexpr (is_integer<T>) {
        if (integers++ == change.integer)
            argument = T(change.value(std::uint64_t(argument), std::uint64_t(T(-1))));
    }
}

// Adds an entry. `arguments` makes those of a call that succeeds from a world.
template <class R, class... P, class Arguments>
void add(char const* name, char const* pointers, R (*function)(P...), Arguments arguments) {
    Function entry;
    entry.name = name;
    entry.pointers = pointers;
    entry.integers = (0 + ... + int(is_integer<P>));
    if ((0 + ... + int(std::is_pointer_v<P>)) != int(entry.pointers.size())) entry.pointers = "wrong";
    entry.has_error = (false || ... || std::is_same_v<P, welt_error**>);
    entry.has_status = entry.has_error || std::strstr(name, "_options_init");
    entry.has_job = entry.has_error && (false || ... || std::is_same_v<P, welt_job const*>);
    entry.changes_mesh = (false || ... || std::is_same_v<P, welt_mesh*>);
    entry.reads_mesh = (false || ... || std::is_same_v<P, welt_mesh const*>);
    bool const frees = entry.pointers == "f", has_status = entry.has_status;
    entry.call = [=](World& world, Change const& change) -> std::int32_t {
        std::tuple<P...> all{};
        // What is to be freed must not get lost.
        if (!frees || change.null < 0) all = arguments(world);
        int seen_pointers = 0, seen_integers = 0;
        std::apply([&](auto&... argument) { (spoil(argument, change, seen_pointers, seen_integers), ...); }, all);
        if (change.before) change.before();
        if constexpr (std::is_void_v<R>) {
            std::apply(function, all);
        } else {
            R const result = std::apply(function, all);
            if constexpr (std::is_same_v<R, std::int32_t>) {
                if (has_status) return result;
            } else if constexpr (std::is_same_v<R, char const*>) {
                if (!result) return WELT_ERROR_INTERNAL;
            }
        }
        return WELT_OK;
    };
    table.push_back(std::move(entry));
}

template <class T>
T take(T& handle) {
    return std::exchange(handle, nullptr);
}

void observe(void*, double) {}

char const* const pyramid = "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nv 1 1 2\n"
                            "f 4 3 2 1\nf 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\n";
// Read by some calls; constants, so that a call can have their address.
std::uint32_t const edge[] = {6, 7, 7, 8};
float const sharpness[] = {2.5f, 10.0f};
std::uint32_t const some_vertices[] = {12, 7};
double const heights[] = {0.1, -0.1};
std::uint32_t const some_faces[] = {5, 9};
std::uint32_t const no_corners[] = {0, 0};
double const parameters[] = {0.25, 0.5, 1.0, 0.0};
std::uint32_t const triangle_faces[] = {0, 3};
double const points[] = {1.0, 2.0, 0.5, 2.5, 0.5, -1.0};
double const lines[] = {1.2, 1.3, 5.0, 0.0, 0.0, -1.0, 2.6, 2.3, -5.0, 0.0, 0.1, 1.0};

#define ADD(function, pointers, ...) add(#function, pointers, function, [](World& w) { (void)w; return std::tuple __VA_ARGS__; })

void version_error_job_report() {
    ADD(welt_version, "", {});
    ADD(welt_version_string, "", {});
    ADD(welt_is_compatible, "", {WELT_VERSION, WELT_ABI_VERSION});
    ADD(welt_error_free, "f", {take(w.failure())});
    ADD(welt_error_code, "o", {w.failure()});
    ADD(welt_error_message, "o", {w.failure()});
    ADD(welt_error_place_count, "o", {w.failure()});
    ADD(welt_error_place_kind, "o", {w.failure(), 0});
    ADD(welt_error_place_id, "o", {w.failure(), 0, 1});
    ADD(welt_error_place_message, "o", {w.failure(), 0});
    ADD(welt_error_place_file, "o", {w.failure(), 0});
    ADD(welt_error_place_line, "o", {w.failure(), 0});
    ADD(welt_error_place_column, "o", {w.failure(), 0});
    ADD(welt_job_create, "ro", {&w.out.job, &w.out.error});
    ADD(welt_job_observe, "rroo", {w.job(), &observe, &w, &w.out.error});
    ADD(welt_job_free, "f", {take(w.job())});
    ADD(welt_job_cancel, "o", {w.job()});
    ADD(welt_job_progress, "o", {w.job()});
    ADD(welt_job_stage, "oo", {w.job(), w.out.text.data(), w.out.text.size()});
    ADD(welt_report_free, "f", {take(w.report())});
    ADD(welt_report_json, "o", {w.report()});
}

void mesh_and_files() {
    ADD(welt_mesh_create, "rrrro", {w.sizes.data(), w.sizes.size(), w.corners.data(), w.corners.size(),
        w.positions.data(), w.positions.size() / 3, 0, &w.out.mesh, &w.out.error});
    ADD(welt_mesh_copy, "rro", {w.mesh(), &w.out.mesh, &w.out.error});
    ADD(welt_mesh_free, "f", {take(w.mesh())});
    ADD(welt_mesh_vertex_count, "o", {w.mesh()});
    ADD(welt_mesh_edge_count, "o", {w.mesh()});
    ADD(welt_mesh_face_count, "o", {w.mesh()});
    ADD(welt_mesh_face_vertex_count, "o", {w.mesh()});
    ADD(welt_mesh_positions, "rro", {w.mesh(), &w.out.doubles_view, &w.out.error});
    ADD(welt_mesh_set_positions, "rro", {w.mesh(), w.moved.data(), w.moved.size() / 3, 0, &w.out.error});
    ADD(welt_mesh_faces, "rrro", {w.mesh(), w.out.integers.data(), w.out.integers.size(), w.out.more_integers.data(),
        w.out.more_integers.size(), &w.out.error});
    ADD(welt_mesh_edges, "rro", {w.mesh(), w.out.integers.data(), w.out.integers.size(), &w.out.error});
    ADD(welt_mesh_set_subdivision, "ro", {w.mesh(), WELT_BOUNDARY_EDGE_AND_CORNER, WELT_CREASING_CHAIKIN, &w.out.error});
    ADD(welt_mesh_set_edge_sharpness, "rrro", {w.mesh(), edge, sharpness, 2, &w.out.error});
    ADD(welt_mesh_set_vertex_sharpness, "rrro", {w.mesh(), some_vertices, sharpness, 2, &w.out.error});
    ADD(welt_mesh_set_holes, "rro", {w.mesh(), some_faces, 2, &w.out.error});
    ADD(welt_import_options_init, "r", {w.import_options(), sizeof(welt_import_options)});
    ADD(welt_mesh_import_file, "roroo", {MODEL, SIZE_MAX, w.import_options(), &w.out.mesh, &w.out.report, &w.out.error});
    ADD(welt_mesh_import_memory, "ororoo", {"pyramid.obj", SIZE_MAX, WELT_FORMAT_OBJ,
        reinterpret_cast<std::uint8_t const*>(pyramid), std::strlen(pyramid), w.import_options(), &w.out.mesh,
        &w.out.report, &w.out.error});
    ADD(welt_mesh_export_file, "rro", {w.mesh(), "functions.obj", SIZE_MAX, &w.out.error});
}

void surfaces() {
    ADD(welt_mesh_limit_positions, "rro", {w.mesh(), w.out.doubles.data(), w.out.doubles.size(), &w.out.error});
    ADD(welt_mesh_limit_normals, "rro", {w.mesh(), w.out.doubles.data(), w.out.doubles.size(), &w.out.error});
    ADD(welt_refinement_create, "roro", {w.mesh(), 2, w.job(), &w.out.refinement, &w.out.error});
    ADD(welt_refinement_free, "f", {take(w.refinement())});
    ADD(welt_refinement_vertex_count, "o", {w.refinement(), 1});
    ADD(welt_refinement_edge_count, "o", {w.refinement(), 1});
    ADD(welt_refinement_face_count, "o", {w.refinement(), 1});
    ADD(welt_refinement_face_vertex_count, "o", {w.refinement(), 1});
    ADD(welt_refinement_positions, "rro", {w.refinement(), 1, &w.out.doubles_view, &w.out.error});
    ADD(welt_refinement_face_vertices, "rro", {w.refinement(), 1, &w.out.integers_view, &w.out.error});
    ADD(welt_refinement_mesh, "rro", {w.refinement(), 1, &w.out.mesh, &w.out.error});
    ADD(welt_refinement_vertex_parents, "rrro", {w.refinement(), 1, w.out.integers.data(), w.out.more_integers.data(),
        w.out.integers.size(), &w.out.error});
    ADD(welt_refinement_face_parents, "rrro", {w.refinement(), 1, w.out.integers.data(), w.out.more_integers.data(),
        w.out.integers.size(), &w.out.error});
    ADD(welt_mesh_refine_loop, "rro", {w.triangles(), 2, &w.out.mesh, &w.out.error});
    ADD(welt_mesh_loop_limit, "rroo", {w.triangles(), w.out.doubles.data(), w.out.more_doubles.data(),
        w.out.doubles.size(), &w.out.error});
    ADD(welt_surface_create, "rooro", {w.mesh(), some_faces, 2, w.job(), &w.out.surface, &w.out.error});
    ADD(welt_surface_free, "f", {take(w.surface())});
    ADD(welt_batch_options_init, "r", {w.batch_options(), sizeof(welt_batch_options)});
    ADD(welt_mesh_loop_evaluate, "rrroro", {w.triangles(), triangle_faces, parameters, 2, 2, w.batch_options(),
        w.out.doubles.data(), w.out.doubles.size(), &w.out.error});
    ADD(welt_surface_evaluate, "rrororo", {w.surface(), some_faces, no_corners, parameters, 2, 2, w.batch_options(),
        w.out.doubles.data(), w.out.doubles.size(), &w.out.error});
    ADD(welt_surface_curvature, "rrorro", {w.surface(), some_faces, no_corners, parameters, 2, w.out.doubles.data(),
        w.out.doubles.size(), &w.out.error});
    ADD(welt_surface_closest, "rrooro", {w.surface(), points, 2, HUGE_VAL, w.starts, w.batch_options(),
        w.out.points.data(), w.out.points.size(), &w.out.error});
    ADD(welt_surface_signed_distances, "rroro", {w.closed(), points, 2, w.batch_options(), w.out.doubles.data(),
        w.out.doubles.size(), &w.out.error});
    ADD(welt_surface_first_hits, "rroro", {w.surface(), lines, 2, 0.0, HUGE_VAL, w.batch_options(),
        w.out.points.data(), w.out.points.size(), &w.out.error});
    ADD(welt_surface_all_hits, "rrororo", {w.surface(), lines, 2, 0.0, HUGE_VAL, w.batch_options(), w.out.places.data(),
        &w.out.needed, w.out.points.data(), w.out.points.size(), &w.out.error});
    ADD(welt_patch_options_init, "r", {w.patch_options(), sizeof(welt_patch_options)});
    ADD(welt_patches_create, "roooro", {w.mesh(), some_faces, 2, w.patch_options(), w.job(), &w.out.patches,
        &w.out.error});
    ADD(welt_patches_free, "f", {take(w.patches())});
    ADD(welt_patches_count, "o", {w.patches()});
    ADD(welt_patches_get, "rro", {w.patches(), 0, &w.out.patch, &w.out.error});
    ADD(welt_patches_report, "rro", {w.patches(), &w.out.report, &w.out.error});
    ADD(welt_mesh_deviation, "rrroo", {w.mesh(), w.second(), 2, w.out.doubles.data(), w.job(), &w.out.error});
    ADD(welt_mesh_compare, "rrroo", {w.mesh(), w.second(), 2, 2, w.out.doubles.data(), w.job(), &w.out.error});
}

void features() {
    ADD(welt_selection_create, "rrro", {w.mesh(), "ring:1,2", SIZE_MAX, &w.out.selection, &w.out.error});
    ADD(welt_selection_free, "f", {take(w.selection())});
    ADD(welt_selection_count, "o", {w.selection()});
    ADD(welt_selection_edges, "rrroo", {w.selection(), w.mesh(), w.out.integers.data(), w.out.integers.size(),
        w.out.doubles.data(), w.out.doubles.size(), &w.out.error});
    ADD(welt_mesh_mark, "rro", {w.mesh(), w.selection(), &w.out.error});
    ADD(welt_rules_load, "rro", {RULES, SIZE_MAX, &w.out.rules, &w.out.error});
    ADD(welt_rules_linear, "ro", {&w.out.rules, &w.out.error});
    ADD(welt_rules_free, "f", {take(w.rules())});
    ADD(welt_rules_parameter_count, "o", {w.rules()});
    ADD(welt_rules_parameter_name, "o", {w.rules(), 0});
    ADD(welt_rules_parameter_unit, "o", {w.rules(), 0});
    ADD(welt_rules_parameter_help, "o", {w.rules(), 0});
    ADD(welt_rules_parameter_default, "o", {w.rules(), 0});
    ADD(welt_rules_parameter_range, "rrro", {w.rules(), 0, w.out.doubles.data(), w.out.more_doubles.data(), &w.out.error});
    ADD(welt_feature_options_init, "r", {w.feature_options(), sizeof(welt_feature_options)});
    ADD(welt_feature_list, "ro", {&w.out.report, &w.out.error});
    ADD(welt_feature_apply, "rrrooooo", {w.mesh(), w.selection(), "groove", SIZE_MAX, "width=0.3 depth=0.1", SIZE_MAX,
        w.feature_options(), w.job(), &w.out.report, &w.out.error});
    ADD(welt_rules_apply, "rrrooooo", {w.mesh(), w.selection(), w.rules(), "", SIZE_MAX, w.feature_options(), w.job(),
        &w.out.report, &w.out.error});
    ADD(welt_mesh_displace, "rrro", {w.mesh(), some_vertices, heights, 2, &w.out.error});
    ADD(welt_mesh_fit, "rorooo", {w.mesh(), some_vertices, 2, w.surface(), WELT_FIT_SURFACE_SLIDE, w.job(), &w.out.report,
        &w.out.error});
}

}  // namespace

std::vector<Function> const& functions() {
    if (table.empty()) {
        version_error_job_report();
        mesh_and_files();
        surfaces();
        features();
    }
    return table;
}
