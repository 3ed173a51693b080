#include "functions.hpp"

#include <cmath>
#include <cstdlib>
#include <cstdio>
#include <cstring>

namespace {

constexpr std::uint32_t side = 4;

// The tests stand on this: what fails here is no finding.
void need(std::int32_t status) {
    if (status == WELT_OK) return;
    std::fprintf(stderr, "the fixture cannot be made: %ld\n", long(status));
    std::abort();
}

template <class T>
void append(std::string& bytes, T const* data, std::size_t count) {
    bytes.append(reinterpret_cast<char const*>(data), count * sizeof(T));
}

std::vector<double> sheet(double height) {
    std::vector<double> positions;
    for (std::uint32_t y = 0; y <= side; ++y)
        for (std::uint32_t x = 0; x <= side; ++x) {
            double const z = height * std::sin(0.7 * x) * std::cos(0.9 * y);
            positions.insert(positions.end(), {double(x), double(y), z});
        }
    return positions;
}

welt_mesh* make(std::vector<std::uint32_t> const& sizes, std::vector<std::uint32_t> const& corners,
                std::vector<double> const& positions) {
    welt_mesh* mesh = nullptr;
    need(welt_mesh_create(sizes.data(), sizes.size(), corners.data(), corners.size(), positions.data(),
                          positions.size() / 3, 0, &mesh, nullptr));
    return mesh;
}

}  // namespace

World::World() : positions(sheet(0.2)), moved(sheet(0.1)), meshes_(3) {
    for (std::uint32_t y = 0; y < side; ++y)
        for (std::uint32_t x = 0; x < side; ++x) {
            std::uint32_t const a = x + (side + 1) * y;
            sizes.push_back(4);
            corners.insert(corners.end(), {a, a + 1, a + side + 2, a + side + 1});
        }
    out.doubles.assign(1000, -7.0);
    out.more_doubles.assign(1000, -7.0);
    out.integers.assign(1000, 7);
    out.more_integers.assign(1000, 7);
    out.places.assign(10, 7);
    out.points.assign(10, welt_surface_point{});
    out.text.assign(100, 'x');
    need(welt_import_options_init(&import_options_, sizeof import_options_));
    need(welt_feature_options_init(&feature_options_, sizeof feature_options_));
    // The fit of the surface has a call of its own; here it would make every place of a feature cost ten times as much.
    feature_options_.fit = WELT_FIT_SOLVE;
    feature_options_.deviation = 1;
    need(welt_batch_options_init(&batch_options_, sizeof batch_options_));
    need(welt_patch_options_init(&patch_options_, sizeof patch_options_));
}

World::~World() {
    for (welt_mesh* mesh : meshes_) welt_mesh_free(mesh);
    welt_mesh_free(out.mesh);
    for (welt_selection* selection : {selection_, out.selection}) welt_selection_free(selection);
    for (welt_rules* rules : {rules_, out.rules}) welt_rules_free(rules);
    for (welt_surface* surface : {surface_, closed_, out.surface}) welt_surface_free(surface);
    for (welt_patches* patches : {patches_, out.patches}) welt_patches_free(patches);
    for (welt_refinement* refinement : {refinement_, out.refinement}) welt_refinement_free(refinement);
    for (welt_report* report : {report_, out.report}) welt_report_free(report);
    for (welt_job* job : {job_, out.job}) welt_job_free(job);
    for (welt_error* error : {failure_, out.error}) welt_error_free(error);
}

welt_mesh*& World::mesh() {
    if (!meshes_[0]) meshes_[0] = make(sizes, corners, positions);
    return meshes_[0];
}

welt_mesh* World::second() {
    if (!meshes_[1]) meshes_[1] = make(sizes, corners, sheet(0.3));
    return meshes_[1];
}

welt_mesh* World::triangles() {
    if (!meshes_[2])
        meshes_[2] = make({3, 3, 3, 3}, {0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3}, {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1});
    return meshes_[2];
}

welt_selection*& World::selection() {
    if (!selection_) need(welt_selection_create(mesh(), "ring:1,2", SIZE_MAX, &selection_, nullptr));
    return selection_;
}

welt_rules*& World::rules() {
    if (!rules_) need(welt_rules_load(RULES, SIZE_MAX, &rules_, nullptr));
    return rules_;
}

welt_surface*& World::surface() {
    if (!surface_) need(welt_surface_create(second(), nullptr, 0, nullptr, &surface_, nullptr));
    return surface_;
}

welt_surface* World::closed() {
    if (!closed_) need(welt_surface_create(triangles(), nullptr, 0, nullptr, &closed_, nullptr));
    return closed_;
}

welt_patches*& World::patches() {
    if (!patches_) need(welt_patches_create(second(), nullptr, 0, nullptr, nullptr, &patches_, nullptr));
    return patches_;
}

welt_refinement*& World::refinement() {
    if (!refinement_) need(welt_refinement_create(mesh(), 1, nullptr, &refinement_, nullptr));
    return refinement_;
}

welt_report*& World::report() {
    if (!report_) need(welt_feature_list(&report_, nullptr));
    return report_;
}

// A face that names a vertex which is not there: one place, with a line.
welt_error*& World::failure() {
    char const* const text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n";
    welt_mesh* none = nullptr;
    if (!failure_)
        need(welt_mesh_import_memory(nullptr, 0, WELT_FORMAT_OBJ, reinterpret_cast<std::uint8_t const*>(text),
                                     std::strlen(text), nullptr, &none, nullptr, &failure_) == WELT_ERROR_SYNTAX ||
                     welt_error_code(failure_) == WELT_ERROR_MESH
                 ? WELT_OK
                 : WELT_ERROR_INTERNAL);
    return failure_;
}

welt_job*& World::job() {
    if (!job_) need(welt_job_create(&job_, nullptr));
    return job_;
}

welt_import_options* World::import_options() { return &import_options_; }
welt_feature_options* World::feature_options() { return &feature_options_; }
welt_batch_options* World::batch_options() { return &batch_options_; }
welt_patch_options* World::patch_options() { return &patch_options_; }

std::string content_of(welt_mesh const* mesh) {
    if (!mesh) return "none";
    double const* view = nullptr;
    std::int32_t const status = welt_mesh_positions(mesh, &view, nullptr);
    if (status == WELT_ERROR_POISONED) return "poisoned";
    need(status);
    std::string bytes;
    append(bytes, view, 3 * welt_mesh_vertex_count(mesh));
    std::vector<std::uint32_t> sizes(welt_mesh_face_count(mesh)), corners(welt_mesh_face_vertex_count(mesh));
    need(welt_mesh_faces(mesh, sizes.data(), sizes.size(), corners.data(), corners.size(), nullptr));
    append(bytes, sizes.data(), sizes.size());
    append(bytes, corners.data(), corners.size());
    // Sharpness, holes and options show one level on.
    welt_refinement* refinement = nullptr;
    need(welt_refinement_create(mesh, 1, nullptr, &refinement, nullptr));
    need(welt_refinement_positions(refinement, 1, &view, nullptr));
    append(bytes, view, 3 * welt_refinement_vertex_count(refinement, 1));
    welt_refinement_free(refinement);
    return bytes;
}

std::string World::handles() const {
    std::string bytes;
    for (welt_mesh* mesh : {meshes_[0], meshes_[1], meshes_[2], out.mesh}) bytes += content_of(mesh);
    bytes += "selection " + std::to_string(welt_selection_count(out.selection));
    bytes += "rules " + std::to_string(welt_rules_parameter_count(out.rules));
    bytes += "refinement " + std::to_string(welt_refinement_vertex_count(out.refinement, 1));
    bytes += "patches " + std::to_string(welt_patches_count(out.patches)) + " " + std::to_string(out.patch.face_count);
    bytes += out.surface ? "surface" : "";
    bytes += out.job ? "job" : "";
    return bytes;
}

std::string World::buffers() const {
    std::string bytes;
    append(bytes, out.doubles.data(), out.doubles.size());
    append(bytes, out.more_doubles.data(), out.more_doubles.size());
    append(bytes, out.integers.data(), out.integers.size());
    append(bytes, out.more_integers.data(), out.more_integers.size());
    append(bytes, out.places.data(), out.places.size());
    append(bytes, out.points.data(), out.points.size());
    append(bytes, out.text.data(), out.text.size());
    return bytes;
}

bool World::has_result() const {
    return out.mesh || out.selection || out.rules || out.surface || out.patches || out.refinement || out.report || out.job ||
           out.doubles_view || out.integers_view || out.patch.poles;
}
