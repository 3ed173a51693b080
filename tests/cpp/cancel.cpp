// A feature that another thread cancels at some moment is applied whole or not at all, and several threads may read one mesh.

#include "check.hpp"
#include "library.hpp"

#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <thread>

namespace {

constexpr std::uint32_t side = 40;

Polygons sheet() {
    Polygons polygons;
    for (std::uint32_t y = 0; y <= side; ++y)
        for (std::uint32_t x = 0; x <= side; ++x)
            polygons.positions.push_back({double(x), double(y), std::sin(0.2 * x) * std::cos(0.3 * y)});
    for (std::uint32_t y = 0; y < side; ++y)
        for (std::uint32_t x = 0; x < side; ++x) {
            std::uint32_t const a = x + (side + 1) * y;
            polygons.sizes.push_back(4);
            for (std::uint32_t v : {a, a + 1, a + side + 2, a + side + 1}) polygons.vertices.push_back(v);
        }
    return polygons;
}

Polygons tetrahedron() {
    Polygons polygons;
    polygons.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    polygons.sizes.assign(4, 3);
    polygons.vertices = {0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3};
    return polygons;
}

struct Content {
    std::vector<double> positions;
    std::vector<std::uint32_t> sizes, vertices;
    bool operator==(Content const& other) const {
        return positions == other.positions && sizes == other.sizes && vertices == other.vertices;
    }
};

Content content(welt_mesh const* mesh) {
    Content all;
    double const* view = nullptr;
    check::that(welt_mesh_positions(mesh, &view, nullptr) == WELT_OK, "positions");
    all.positions.assign(view, view + 3 * welt_mesh_vertex_count(mesh));
    all.sizes.resize(welt_mesh_face_count(mesh));
    all.vertices.resize(welt_mesh_face_vertex_count(mesh));
    check::that(welt_mesh_faces(mesh, all.sizes.data(), all.sizes.size(), all.vertices.data(), all.vertices.size(),
                                nullptr) == WELT_OK,
                "faces");
    return all;
}

std::int32_t groove(welt_mesh* mesh, welt_selection const* selection, welt_job const* job) {
    welt_feature_options options;
    check::that(welt_feature_options_init(&options, sizeof options) == WELT_OK, "options");
    options.deviation = 1;
    return welt_feature_apply(mesh, selection, "groove", SIZE_MAX, "width=0.3 depth=0.1", SIZE_MAX, &options, job,
                              nullptr, nullptr);
}

void cancelled_at_any_moment() {
    Polygons const polygons = sheet();
    Mesh const untouched = make_mesh(polygons);
    Content const before = content(untouched.get());
    welt_selection* selection = nullptr;
    check::that(welt_selection_create(untouched.get(), "ring:20,21", SIZE_MAX, &selection, nullptr) == WELT_OK, "ring");
    Mesh const finished = make_mesh(polygons);
    auto const start = std::chrono::steady_clock::now();
    // A selection also fits a mesh with the same edges.
    check::that(groove(finished.get(), selection, nullptr) == WELT_OK, "the feature");
    auto const duration = std::chrono::steady_clock::now() - start;
    Content const after = content(finished.get());

    int cancelled = 0;
    constexpr int moments = 12;
    for (int i = 0; i < moments; ++i) {
        Mesh const mesh = make_mesh(polygons);
        welt_job* job = nullptr;
        check::that(welt_job_create(&job, nullptr) == WELT_OK, "job");
        std::thread other([&] {
            std::this_thread::sleep_for(duration * i / moments);
            double const progress = welt_job_progress(job);
            check::that(progress >= 0.0 && progress <= 1.0, "progress");
            welt_job_cancel(job);
        });
        std::int32_t const status = groove(mesh.get(), selection, job);
        other.join();
        welt_job_free(job);
        cancelled += status == WELT_ERROR_CANCELLED;
        if (status == WELT_ERROR_CANCELLED)
            check::that(content(mesh.get()) == before, "a cancelled feature leaves the mesh as it was");
        else
            check::that(status == WELT_OK && content(mesh.get()) == after, "else it is applied whole");
        if (status == WELT_ERROR_CANCELLED && i % 5 == 0) {
            check::that(groove(mesh.get(), selection, nullptr) == WELT_OK, "the mesh can still be used");
            check::that(content(mesh.get()) == after, "and the feature comes out the same");
        }
    }
    std::printf("%d of %d were cancelled\n", cancelled, moments);
    check::that(cancelled > 0, "a job that is cancelled at once is cancelled");
    welt_selection_free(selection);
}

// One handle of each kind that several threads may read.
struct Handles {
    Mesh mesh = make_mesh(sheet());
    Mesh triangles = make_mesh(tetrahedron());
    welt::Surface surface = mesh.freeze(), closed = triangles.freeze();
    welt::Refinement refinement = mesh.refine(1);
    welt::Selection marks = mesh.select("ring:20,21");
};

// What they say, in numbers.
std::vector<double> answers(Handles const& of) {
    std::vector<double> all;
    auto const add = [&](auto const& values) { all.insert(all.end(), std::begin(values), std::end(values)); };
    auto const add_vectors = [&](auto const& vectors) {
        for (auto const& v : vectors) all.insert(all.end(), std::begin(v), std::end(v));
    };
    auto const add_points = [&](std::vector<welt_surface_point> const& points) {
        for (welt_surface_point const& p : points) {
            all.insert(all.end(), {double(p.face), p.u, p.v, p.distance});
            add(p.position);
        }
    };
    std::vector<std::uint32_t> const faces = {0, 41, 820, 1599};
    std::vector<welt::Parameter> const places(4, {0.25, 0.75});
    std::vector<std::uint32_t> const two_faces = {0, 3};
    std::vector<welt::Parameter> const two_places(2, {0.25, 0.5});
    std::vector<welt::Vector> const points = {{3, 4, 1}, {20, 30, -1}, {50, 50, 0}};
    std::vector<welt::Line> const lines = {{{3.2, 4.1, 5}, {0, 0, -1}}, {{-1, 20.3, 0}, {1, 0, 0}}};
    add_vectors(of.mesh.positions());
    add(of.mesh.edges());
    add_vectors(of.mesh.limit_positions());
    add_vectors(of.mesh.limit_normals());
    add_vectors(of.mesh.refine(2).positions(2));
    all.push_back(double(of.mesh.select("ring:20,21").count()));
    all.push_back(of.mesh.deviation(of.mesh, 1).root_mean_square);
    add_vectors(of.triangles.loop_limit().positions);
    add_vectors(of.triangles.refine_loop(2).positions());
    for (welt::Jet const& jet : of.triangles.loop_evaluate(two_faces, two_places)) add(jet.position);
    for (welt::Jet const& jet : of.surface.evaluate(faces, {}, places)) add(jet.position), add(jet.duv);
    for (welt::Curvature const& at : of.surface.curvature(faces, {}, places)) all.push_back(at.gaussian);
    add_points(of.surface.closest(points));
    add_points(of.surface.first_hits(lines));
    add_points(of.surface.all_hits(lines).points);
    add(of.closed.signed_distances(points));
    add_vectors(of.refinement.positions(1));
    add(of.refinement.face_vertices(1));
    add(of.marks.edges(of.mesh).places);
    return all;
}

// New handles each time, so that what is made at the first query is made by several threads at once.
void many_readers() {
    std::vector<double> const alone = answers(Handles());
    check::that(alone.size() > 10000, "handles say something");
    std::atomic<int> different{0};
    for (int round = 0; round < 2; ++round) {
        Handles const shared;
#if defined(__SANITIZE_THREAD__)
        // Who comes second waits in the standard library of Rust, which is not instrumented.
        different += answers(shared) != alone;
#endif
        std::vector<std::thread> readers;
        for (int i = 0; i < 4; ++i) readers.emplace_back([&] { different += answers(shared) != alone; });
        for (std::thread& reader : readers) reader.join();
    }
    check::that(different == 0, "four threads read the same handles");
}

void different_handles_at_once() {
    auto const work = [] {
        Mesh mesh = make_mesh(sheet());
        welt::Selection const marks = mesh.select("ring:20,21");
        check::that(groove(mesh.get(), marks.get(), nullptr) == WELT_OK, "a feature beside others");
        return content(mesh.get());
    };
    Content const alone = work();
    std::atomic<int> different{0};
    std::vector<std::thread> workers;
    for (int i = 0; i < 4; ++i) workers.emplace_back([&] { different += !(work() == alone); });
    for (std::thread& worker : workers) worker.join();
    check::that(different == 0, "four threads change a mesh each");
}

}  // namespace

int main() {
    cancelled_at_any_moment();
    different_handles_at_once();
    many_readers();
    return check::result();
}
