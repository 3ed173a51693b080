// welt in C++17: the C ABI with owning handles, exceptions and views. Header only; link what welt.h asks for.
//
//     welt::Mesh mesh = welt::Mesh::import_file("chair.obj");
//     welt::Report report = mesh.apply(mesh.select("ring:3,331"), "groove", "width=1.6 depth=0.6");
//     mesh.export_file("seam.obj");
//
// What a function does, its units and its errors stand in welt.h, at the C function that it calls. Here:
// - A handle is moved, not copied, and freed at the end of its life. One that was moved from is empty: using it throws.
// - A failure throws welt::Error with the code, the message and the places of welt_error; the C ABI's promises about
//   what is left behind hold.
// - Arrays go in as View: whatever has data() and size(). Nothing is copied on the way. Views that come out belong to the
//   handle, for as long as welt.h says.
// - const member functions may be called by several threads at once, the others by one.
#pragma once

#include <welt.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace welt {

// --- Views -------------------------------------------------------------------------------------------------------------

// Elements that belong to somebody else.
template <class T>
class View {
public:
    constexpr View() = default;
    constexpr View(T const* data, std::size_t size) : data_(data), size_(size) {}
    template <std::size_t N>
    constexpr View(T const (&array)[N]) : data_(array), size_(N) {}
    // A vector, an array, a span: whatever holds elements of this very type one after the other.
    template <class C, class = std::enable_if_t<std::is_convertible_v<decltype(std::declval<C const&>().data()), T const*>>>
    constexpr View(C const& container) : data_(container.data()), size_(container.size()) {}

    constexpr T const* data() const { return data_; }
    constexpr std::size_t size() const { return size_; }
    constexpr bool empty() const { return size_ == 0; }
    constexpr T const* begin() const { return data_; }
    constexpr T const* end() const { return data_ + size_; }
    constexpr T const& operator[](std::size_t i) const { return data_[i]; }

private:
    T const* data_ = nullptr;
    std::size_t size_ = 0;
};

using Vector = std::array<double, 3>;

// Points: three doubles each, alone or at the start of a larger struct.
class Points {
public:
    Points(double const* first, std::size_t count, std::size_t stride = 0) : first_(first), count_(count), stride_(stride) {}
    Points(View<Vector> points) : first_(points.empty() ? nullptr : points.data()->data()), count_(points.size()) {}
    template <class C, class = std::enable_if_t<std::is_convertible_v<C const&, View<Vector>>>>
    Points(C const& points) : Points(View<Vector>(points)) {}

    double const* first() const { return first_; }
    std::size_t count() const { return count_; }
    // Bytes from one to the next; 0 where nothing lies between them.
    std::size_t stride() const { return stride_; }

private:
    double const* first_;
    std::size_t count_;
    std::size_t stride_ = 0;
};

// --- Errors ------------------------------------------------------------------------------------------------------------

// A place that an error speaks of. Ids, line and column that there are none of are WELT_NONE and 0.
struct Place {
    std::uint32_t kind;  // One of WELT_PLACE_*.
    std::array<std::uint32_t, 2> ids;
    std::string message, file;
    std::uint32_t line, column;
};

class Error : public std::runtime_error {
public:
    explicit Error(welt_error const* error) : std::runtime_error(welt_error_message(error)), code_(welt_error_code(error)) {
        for (std::size_t i = 0; i < welt_error_place_count(error); ++i)
            places_.push_back({welt_error_place_kind(error, i),
                               {welt_error_place_id(error, i, 0), welt_error_place_id(error, i, 1)},
                               welt_error_place_message(error, i),
                               welt_error_place_file(error, i),
                               welt_error_place_line(error, i),
                               welt_error_place_column(error, i)});
    }
    Error(std::int32_t code, char const* message) : std::runtime_error(message), code_(code) {}

    // One of WELT_ERROR_*.
    std::int32_t code() const { return code_; }
    std::vector<Place> const& places() const { return places_; }

private:
    std::int32_t code_;
    std::vector<Place> places_;
};

// --- What the classes below are made of --------------------------------------------------------------------------------

namespace detail {

// Calls a function of the C ABI whose last parameter is the error, and throws what it reports.
template <class... P, class... A>
void call(std::int32_t (*function)(P...), A... arguments) {
    welt_error* error = nullptr;
    if (function(arguments..., &error) == WELT_OK) return;
    std::unique_ptr<welt_error, void (*)(welt_error*)> const owner(error, welt_error_free);
    throw Error(error);
}

template <class T, void (*Free)(T*)>
class Handle {
public:
    // Takes over a handle of welt.h; NULL makes an empty one.
    explicit Handle(T* handle = nullptr) : handle_(handle) {}
    // The handle for functions of welt.h; it stays with this object.
    T* get() const { return handle_.get(); }

private:
    struct Delete {
        void operator()(T* handle) const { Free(handle); }
    };
    std::unique_ptr<T, Delete> handle_;
};

// Makes a handle by a function that writes it to its last parameter but the error.
template <class T, class F, class... A>
T* make(F function, A... arguments) {
    T* handle = nullptr;
    call(function, arguments..., &handle);
    return handle;
}

}  // namespace detail

// --- Version -----------------------------------------------------------------------------------------------------------

// Of the library that runs, in the form of WELT_VERSION.
inline std::uint32_t version() { return welt_version(); }
inline std::string_view version_string() { return welt_version_string(); }
// Whether the library that runs serves a program that was compiled with this header.
inline bool is_compatible() { return welt_is_compatible(WELT_VERSION, WELT_ABI_VERSION) != 0; }

// --- Jobs and reports --------------------------------------------------------------------------------------------------

// Watches and cancels a call that it is passed to; serves one call.
class Job {
public:
    // Is told the progress in [0, 1] and the stage, by the thread that made the call. What it throws cancels the call and
    // comes out of it.
    using Observer = std::function<void(double progress, std::string_view stage)>;

    Job() : state_(std::make_unique<State>()) {}
    explicit Job(Observer observer) : Job() {
        state_->observer = std::move(observer);
        detail::call(welt_job_observe, get(), &State::observed, static_cast<void*>(state_.get()));
    }

    // From any thread.
    void cancel() const { welt_job_cancel(get()); }
    double progress() const { return welt_job_progress(get()); }
    std::string stage() const {
        std::string name(welt_job_stage(get(), nullptr, 0), ' ');
        // With its NUL, for which a string has room.
        std::size_t const length = welt_job_stage(get(), name.data(), name.size() + 1);
        // The work may have gone on to another stage meanwhile.
        name.resize(std::min(length, name.size()));
        return name;
    }
    welt_job* get() const { return state_ ? state_->handle.get() : nullptr; }

    // Runs a call that the job is passed to.
    template <class Call>
    static auto run(Job const* job, Call const& work) {
        try {
            return work(job ? job->get() : nullptr);
        } catch (Error const&) {
            if (job && job->state_ && job->state_->thrown) std::rethrow_exception(std::exchange(job->state_->thrown, nullptr));
            throw;
        }
    }

private:
    // Stays where it is when the job is moved.
    struct State {
        detail::Handle<welt_job, welt_job_free> handle{detail::make<welt_job>(welt_job_create)};
        Observer observer;
        std::exception_ptr thrown;

        static void observed(void* context, double progress) {
            State& state = *static_cast<State*>(context);
            if (state.thrown) return;
            try {
                char stage[64];
                std::size_t const length = welt_job_stage(state.handle.get(), stage, sizeof stage);
                state.observer(progress, {stage, std::min(length, sizeof stage - 1)});
            } catch (...) {
                state.thrown = std::current_exception();
                welt_job_cancel(state.handle.get());
            }
        }
    };
    std::unique_ptr<State> state_;
};

class Report : public detail::Handle<welt_report, welt_report_free> {
public:
    using Handle::Handle;
    // Valid as long as the report.
    std::string_view json() const { return welt_report_json(get()); }
};

// --- Options -----------------------------------------------------------------------------------------------------------

// The members of welt_import_options, set to their defaults.
struct ImportOptions : welt_import_options {
    ImportOptions() {
        if (welt_import_options_init(this, sizeof(welt_import_options)) != WELT_OK)
            throw Error(WELT_ERROR_ARGUMENT, "the library is older than welt.h: welt_import_options is unknown to it");
    }
};

// The members of welt_feature_options, set to their defaults.
struct FeatureOptions : welt_feature_options {
    FeatureOptions() {
        if (welt_feature_options_init(this, sizeof(welt_feature_options)) != WELT_OK)
            throw Error(WELT_ERROR_ARGUMENT, "the library is older than welt.h: welt_feature_options is unknown to it");
    }
};

// The members of welt_patch_options, set to their defaults.
struct PatchOptions : welt_patch_options {
    PatchOptions() {
        if (welt_patch_options_init(this, sizeof(welt_patch_options)) != WELT_OK)
            throw Error(WELT_ERROR_ARGUMENT, "the library is older than welt.h: welt_patch_options is unknown to it");
    }
};

// The members of welt_batch_options, set to their defaults.
struct BatchOptions : welt_batch_options {
    BatchOptions() {
        if (welt_batch_options_init(this, sizeof(welt_batch_options)) != WELT_OK)
            throw Error(WELT_ERROR_ARGUMENT, "the library is older than welt.h: welt_batch_options is unknown to it");
    }
    explicit BatchOptions(std::uint32_t how_many_threads, std::size_t stride = 0) : BatchOptions() {
        threads = how_many_threads;
        input_stride = stride;
    }
};

// --- Surfaces ----------------------------------------------------------------------------------------------------------

class Mesh;

// One number or view per level; level 0 is the mesh.
class Refinement : public detail::Handle<welt_refinement, welt_refinement_free> {
public:
    using Handle::Handle;
    std::size_t vertex_count(std::uint32_t level) const { return welt_refinement_vertex_count(get(), level); }
    std::size_t edge_count(std::uint32_t level) const { return welt_refinement_edge_count(get(), level); }
    std::size_t face_count(std::uint32_t level) const { return welt_refinement_face_count(get(), level); }

    View<Vector> positions(std::uint32_t level) const {
        double const* first = nullptr;
        detail::call(welt_refinement_positions, get(), level, &first);
        return {reinterpret_cast<Vector const*>(first), vertex_count(level)};
    }
    // Of all faces one after the other; four each from level 1.
    View<std::uint32_t> face_vertices(std::uint32_t level) const {
        std::uint32_t const* first = nullptr;
        detail::call(welt_refinement_face_vertices, get(), level, &first);
        return {first, welt_refinement_face_vertex_count(get(), level)};
    }

    // Another control mesh of the same surface, numbered as the level.
    Mesh mesh(std::uint32_t level) const;

    struct VertexParents {
        std::vector<std::uint32_t> kinds, elements;
    };
    VertexParents vertex_parents(std::uint32_t level) const {
        std::size_t const count = vertex_count(level);
        VertexParents parents{std::vector<std::uint32_t>(count), std::vector<std::uint32_t>(count)};
        detail::call(welt_refinement_vertex_parents, get(), level, parents.kinds.data(), parents.elements.data(), count);
        return parents;
    }

    struct FaceParents {
        std::vector<std::uint32_t> faces, corners;
    };
    FaceParents face_parents(std::uint32_t level) const {
        std::size_t const count = face_count(level);
        FaceParents parents{std::vector<std::uint32_t>(count), std::vector<std::uint32_t>(count)};
        detail::call(welt_refinement_face_parents, get(), level, parents.faces.data(), parents.corners.data(), count);
        return parents;
    }
};

// A point of the limit surface and its first derivatives, and second ones.
struct Tangents {
    Vector position, du, dv;
};
struct Jet {
    Vector position, du, dv, duu, duv, dvv;
};
using Parameter = std::array<double, 2>;

namespace detail {

// The order of derivatives that T holds.
template <class T>
constexpr std::uint32_t order() {
    static_assert(std::is_same_v<T, Vector> || std::is_same_v<T, Tangents> || std::is_same_v<T, Jet>,
                  "evaluate gives Vector, Tangents or Jet");
    static_assert(sizeof(T) % sizeof(Vector) == 0, "nothing lies between doubles");
    return std::is_same_v<T, Vector> ? 0 : std::is_same_v<T, Tangents> ? 1 : 2;
}

inline void same(std::size_t first, std::size_t second, char const* message) {
    if (first != second) throw Error(WELT_ERROR_ARGUMENT, message);
}

}  // namespace detail

struct Curvature {
    double greater, smaller;  // The principal curvatures.
    Vector greater_direction, smaller_direction;
    double mean, gaussian;
};

struct Line {
    Vector origin, direction;
};

// The hits of line i are those from starts[i] up to starts[i + 1], exclusive.
struct Hits {
    std::vector<std::size_t> starts;
    std::vector<welt_surface_point> points;
};

// Queries run on as many threads as they are told; 0 for as many as the machine has.
class Surface : public detail::Handle<welt_surface, welt_surface_free> {
public:
    using Handle::Handle;
    static constexpr double infinity = std::numeric_limits<double>::infinity();

    // One point per face, as Vector (the position alone), Tangents or Jet; corners may be empty for 0 everywhere.
    template <class T = Jet>
    std::vector<T> evaluate(View<std::uint32_t> faces, View<std::uint32_t> corners, View<Parameter> parameters,
                            std::uint32_t threads = 1) const {
        equally_many(faces, corners, parameters);
        BatchOptions const options(threads);
        std::vector<T> values(faces.size());
        detail::call(welt_surface_evaluate, get(), faces.data(), corners.data(), doubles(parameters), faces.size(),
                     detail::order<T>(), &options, reinterpret_cast<double*>(values.data()),
                     sizeof(T) / sizeof(double) * values.size());
        return values;
    }
    std::vector<Curvature> curvature(View<std::uint32_t> faces, View<std::uint32_t> corners,
                                     View<Parameter> parameters) const {
        static_assert(sizeof(Curvature) == 10 * sizeof(double), "a curvature is 10 doubles");
        equally_many(faces, corners, parameters);
        std::vector<Curvature> values(faces.size());
        detail::call(welt_surface_curvature, get(), faces.data(), corners.data(), doubles(parameters), faces.size(),
                     reinterpret_cast<double*>(values.data()), 10 * values.size());
        return values;
    }
    // starts: one per point, or empty.
    std::vector<welt_surface_point> closest(Points points, double radius = infinity, View<welt_surface_point> starts = {},
                                            std::uint32_t threads = 1) const {
        if (!starts.empty()) detail::same(starts.size(), points.count(), "there must be one start per point");
        BatchOptions const options(threads, points.stride());
        std::vector<welt_surface_point> found(points.count());
        detail::call(welt_surface_closest, get(), points.first(), points.count(), radius, starts.data(), &options,
                     found.data(), found.size());
        return found;
    }
    std::vector<double> signed_distances(Points points, std::uint32_t threads = 1) const {
        BatchOptions const options(threads, points.stride());
        std::vector<double> distances(points.count());
        detail::call(welt_surface_signed_distances, get(), points.first(), points.count(), &options, distances.data(),
                     distances.size());
        return distances;
    }
    // first, last: which parameters of the lines count; rays unless told otherwise.
    std::vector<welt_surface_point> first_hits(View<Line> lines, double first = 0, double last = infinity,
                                               std::uint32_t threads = 1) const {
        BatchOptions const options(threads);
        std::vector<welt_surface_point> found(lines.size());
        detail::call(welt_surface_first_hits, get(), doubles(lines), lines.size(), first, last, &options, found.data(),
                     found.size());
        return found;
    }
    Hits all_hits(View<Line> lines, double first = 0, double last = infinity, std::uint32_t threads = 1) const {
        BatchOptions const options(threads);
        Hits hits{std::vector<std::size_t>(lines.size() + 1), std::vector<welt_surface_point>(lines.size())};
        std::size_t needed = 0;
        auto const ask = [&] {
            detail::call(welt_surface_all_hits, get(), doubles(lines), lines.size(), first, last, &options,
                         hits.starts.data(), &needed, hits.points.data(), hits.points.size());
        };
        try {
            ask();
        } catch (Error const& error) {
            if (error.code() != WELT_ERROR_BUFFER || needed <= hits.points.size()) throw;
            hits.points.resize(needed);
            ask();
        }
        hits.points.resize(needed);
        return hits;
    }

private:
    static void equally_many(View<std::uint32_t> faces, View<std::uint32_t> corners, View<Parameter> parameters) {
        if (parameters.size() != faces.size() || (!corners.empty() && corners.size() != faces.size()))
            throw Error(WELT_ERROR_ARGUMENT, "faces, corners and parameters are not equally many");
    }
    template <class T>
    static double const* doubles(View<T> values) {
        return reinterpret_cast<double const*>(values.data());
    }
};

// The limit surface as bicubic B-spline patches.
class Patches : public detail::Handle<welt_patches, welt_patches_free> {
public:
    using Handle::Handle;
    std::size_t count() const { return welt_patches_count(get()); }

    // Its arrays are valid as long as the patches.
    welt_patch operator[](std::size_t index) const {
        welt_patch patch;
        detail::call(welt_patches_get, get(), index, &patch);
        return patch;
    }
    Report report() const { return Report(detail::make<welt_report>(welt_patches_report, get())); }
};

// --- Marks and rules ---------------------------------------------------------------------------------------------------

class Selection : public detail::Handle<welt_selection, welt_selection_free> {
public:
    using Handle::Handle;
    std::size_t count() const { return welt_selection_count(get()); }

    struct Edges {
        std::vector<std::uint32_t> vertices;  // Two per edge.
        std::vector<double> places;
    };
    Edges edges(Mesh const& mesh) const;
};

class Rules : public detail::Handle<welt_rules, welt_rules_free> {
public:
    using Handle::Handle;
    static Rules load(std::string_view path) {
        return Rules(detail::make<welt_rules>(welt_rules_load, path.data(), path.size()));
    }
    static Rules linear() { return Rules(detail::make<welt_rules>(welt_rules_linear)); }

    struct Parameter {
        std::string name, unit, help;
        double value, low, high;  // The default, the least and the greatest value.
    };
    std::vector<Parameter> parameters() const {
        std::vector<Parameter> all;
        for (std::size_t i = 0; i < welt_rules_parameter_count(get()); ++i) {
            Parameter next{welt_rules_parameter_name(get(), i), welt_rules_parameter_unit(get(), i),
                           welt_rules_parameter_help(get(), i), welt_rules_parameter_default(get(), i), 0, 0};
            detail::call(welt_rules_parameter_range, get(), i, &next.low, &next.high);
            all.push_back(std::move(next));
        }
        return all;
    }
};

// The features that Mesh::apply knows.
inline Report feature_list() { return Report(detail::make<welt_report>(welt_feature_list)); }

// --- Meshes ------------------------------------------------------------------------------------------------------------

class Mesh : public detail::Handle<welt_mesh, welt_mesh_free> {
public:
    using Handle::Handle;

    struct Faces {
        std::vector<std::uint32_t> sizes, vertices;
    };
    Mesh(View<std::uint32_t> face_sizes, View<std::uint32_t> face_vertices, Points positions)
        : Handle(detail::make<welt_mesh>(welt_mesh_create, face_sizes.data(), face_sizes.size(), face_vertices.data(),
                                         face_vertices.size(), positions.first(), positions.count(),
                                         positions.stride())) {}

    // With all that the mesh holds. Handles are moved, so that a copy is never made by mistake.
    Mesh copy() const { return Mesh(detail::make<welt_mesh>(welt_mesh_copy, get())); }

    // Files. What was ignored and repaired stands in the report, for those who ask.
    static Mesh import_file(std::string_view path, ImportOptions const& options = {}, Report* report = nullptr) {
        return imported(report, welt_mesh_import_file, path.data(), path.size(), &options);
    }
    // content: the bytes of a file; format: one of WELT_FORMAT_*; name: stands for the file in messages.
    static Mesh import_memory(std::string_view content, std::uint32_t format, std::string_view name = "memory",
                              ImportOptions const& options = {}, Report* report = nullptr) {
        return imported(report, welt_mesh_import_memory, name.data(), name.size(), format,
                        reinterpret_cast<std::uint8_t const*>(content.data()), content.size(), &options);
    }
    void export_file(std::string_view path) const { detail::call(welt_mesh_export_file, get(), path.data(), path.size()); }

    // Elements.
    std::size_t vertex_count() const { return welt_mesh_vertex_count(get()); }
    std::size_t edge_count() const { return welt_mesh_edge_count(get()); }
    std::size_t face_count() const { return welt_mesh_face_count(get()); }
    // Valid until the mesh is changed.
    View<Vector> positions() const {
        double const* first = nullptr;
        detail::call(welt_mesh_positions, get(), &first);
        return {reinterpret_cast<Vector const*>(first), vertex_count()};
    }
    void set_positions(Points positions) {
        detail::call(welt_mesh_set_positions, get(), positions.first(), positions.count(), positions.stride());
    }
    Faces faces() const {
        Faces all{std::vector<std::uint32_t>(face_count()),
                  std::vector<std::uint32_t>(welt_mesh_face_vertex_count(get()))};
        detail::call(welt_mesh_faces, get(), all.sizes.data(), all.sizes.size(), all.vertices.data(), all.vertices.size());
        return all;
    }
    // Two vertices per edge.
    std::vector<std::uint32_t> edges() const {
        std::vector<std::uint32_t> vertices(2 * edge_count());
        detail::call(welt_mesh_edges, get(), vertices.data(), vertices.size());
        return vertices;
    }

    // The subdivision scheme. boundary: one of WELT_BOUNDARY_*; creasing: one of WELT_CREASING_*.
    void set_subdivision(std::uint32_t boundary, std::uint32_t creasing) {
        detail::call(welt_mesh_set_subdivision, get(), boundary, creasing);
    }
    // edges: two vertices per edge.
    void set_edge_sharpness(View<std::uint32_t> edges, View<float> sharpness) {
        detail::same(edges.size(), 2 * sharpness.size(), "there must be two vertices per sharpness");
        detail::call(welt_mesh_set_edge_sharpness, get(), edges.data(), sharpness.data(), sharpness.size());
    }
    void set_vertex_sharpness(View<std::uint32_t> vertices, View<float> sharpness) {
        detail::same(vertices.size(), sharpness.size(), "there must be one vertex per sharpness");
        detail::call(welt_mesh_set_vertex_sharpness, get(), vertices.data(), sharpness.data(), sharpness.size());
    }
    void set_holes(View<std::uint32_t> faces) { detail::call(welt_mesh_set_holes, get(), faces.data(), faces.size()); }

    // The limit surface.
    std::vector<Vector> limit_positions() const { return limit(welt_mesh_limit_positions); }
    std::vector<Vector> limit_normals() const { return limit(welt_mesh_limit_normals); }
    Refinement refine(std::uint32_t depth, Job const* job = nullptr) const {
        return Job::run(job, [&](welt_job const* watched) {
            return Refinement(detail::make<welt_refinement>(welt_refinement_create, get(), depth, watched));
        });
    }
    Surface freeze(Job const* job = nullptr) const { return frozen(nullptr, 0, job); }
    Surface freeze(View<std::uint32_t> faces, Job const* job = nullptr) const {
        // NULL would stand for all faces.
        static constexpr std::uint32_t none = 0;
        return frozen(faces.empty() ? &none : faces.data(), faces.size(), job);
    }
    // For CAD.
    Patches patches(PatchOptions const& options = {}, Job const* job = nullptr) const {
        return patched(nullptr, 0, options, job);
    }
    Patches patches(View<std::uint32_t> faces, PatchOptions const& options = {}, Job const* job = nullptr) const {
        // NULL would stand for all faces.
        static constexpr std::uint32_t none = 0;
        return patched(faces.empty() ? &none : faces.data(), faces.size(), options, job);
    }
    struct Deviation {
        double largest, root_mean_square, percentile_95;
    };
    Deviation deviation(Mesh const& other, std::uint32_t samples = 8, Job const* job = nullptr) const {
        return Job::run(job, [&](welt_job const* watched) {
            std::array<double, 3> values;
            detail::call(welt_mesh_deviation, get(), other.get(), samples, values.data(), watched);
            return Deviation{values[0], values[1], values[2]};
        });
    }

    // The same with the largest angle between normals and the differences of mean curvatures.
    struct Comparison {
        Deviation deviation;
        double degrees, curvature_root_mean_square, curvature_largest;
    };
    Comparison compare(Mesh const& other, std::uint32_t samples = 8, std::uint32_t threads = 1, Job const* job = nullptr) const {
        return Job::run(job, [&](welt_job const* watched) {
            std::array<double, 6> values;
            detail::call(welt_mesh_compare, get(), other.get(), samples, threads, values.data(), watched);
            return Comparison{{values[0], values[1], values[2]}, values[3], values[4], values[5]};
        });
    }

    // Loop subdivision, of triangles.
    Mesh refine_loop(std::uint32_t levels) const {
        return Mesh(detail::make<welt_mesh>(welt_mesh_refine_loop, get(), levels));
    }
    struct LoopLimit {
        std::vector<Vector> positions, normals;
    };
    LoopLimit loop_limit() const {
        LoopLimit points{std::vector<Vector>(vertex_count()), std::vector<Vector>(vertex_count())};
        detail::call(welt_mesh_loop_limit, get(), doubles(points.positions), doubles(points.normals), 3 * vertex_count());
        return points;
    }
    // As Surface::evaluate: Vector, Tangents or Jet.
    template <class T = Jet>
    std::vector<T> loop_evaluate(View<std::uint32_t> faces, View<Parameter> parameters, std::uint32_t threads = 1) const {
        detail::same(faces.size(), parameters.size(), "there must be one face per pair of parameters");
        BatchOptions const options(threads);
        std::vector<T> values(faces.size());
        detail::call(welt_mesh_loop_evaluate, get(), faces.data(), reinterpret_cast<double const*>(parameters.data()),
                     faces.size(), detail::order<T>(), &options, reinterpret_cast<double*>(values.data()),
                     sizeof(T) / sizeof(double) * values.size());
        return values;
    }

    // Features.
    Selection select(std::string_view selectors) const {
        return Selection(detail::make<welt_selection>(welt_selection_create, get(), selectors.data(), selectors.size()));
    }
    void mark(Selection const& selection) { detail::call(welt_mesh_mark, get(), selection.get()); }
    // features: one per line.
    Report apply(Selection const& selection, std::string_view features, std::string_view settings = "",
                 FeatureOptions const& options = {}, Job const* job = nullptr) {
        return Job::run(job, [&](welt_job const* watched) {
            return Report(detail::make<welt_report>(welt_feature_apply, get(), selection.get(), features.data(),
                                                    features.size(), settings.data(), settings.size(), &options, watched));
        });
    }
    Report apply(Selection const& selection, Rules const& rules, std::string_view settings = "",
                 FeatureOptions const& options = {}, Job const* job = nullptr) {
        return Job::run(job, [&](welt_job const* watched) {
            return Report(detail::make<welt_report>(welt_rules_apply, get(), selection.get(), rules.get(), settings.data(),
                                                    settings.size(), &options, watched));
        });
    }
    void displace(View<std::uint32_t> vertices, View<double> heights) {
        detail::same(vertices.size(), heights.size(), "there must be one vertex per height");
        detail::call(welt_mesh_displace, get(), vertices.data(), heights.data(), heights.size());
    }
    // fit: one of WELT_FIT_*.
    Report fit(Surface const& surface, std::uint32_t fit = WELT_FIT_SURFACE_SLIDE, Job const* job = nullptr) {
        return fitted(nullptr, 0, surface, fit, job);
    }
    Report fit(View<std::uint32_t> vertices, Surface const& surface, std::uint32_t fit = WELT_FIT_SURFACE_SLIDE,
               Job const* job = nullptr) {
        // NULL would stand for all vertices.
        static constexpr std::uint32_t none = 0;
        return fitted(vertices.empty() ? &none : vertices.data(), vertices.size(), surface, fit, job);
    }

private:
    static double* doubles(std::vector<Vector>& vectors) { return reinterpret_cast<double*>(vectors.data()); }

    template <class F, class... A>
    static Mesh imported(Report* report, F function, A... arguments) {
        welt_mesh* mesh = nullptr;
        welt_report* found = nullptr;
        detail::call(function, arguments..., &mesh, report ? &found : nullptr);
        if (report) *report = Report(found);
        return Mesh(mesh);
    }
    template <class F>
    std::vector<Vector> limit(F function) const {
        std::vector<Vector> vectors(vertex_count());
        detail::call(function, get(), doubles(vectors), 3 * vectors.size());
        return vectors;
    }
    Surface frozen(std::uint32_t const* faces, std::size_t count, Job const* job) const {
        return Job::run(job, [&](welt_job const* watched) {
            return Surface(detail::make<welt_surface>(welt_surface_create, get(), faces, count, watched));
        });
    }
    Patches patched(std::uint32_t const* faces, std::size_t count, PatchOptions const& options, Job const* job) const {
        return Job::run(job, [&](welt_job const* watched) {
            return Patches(
                detail::make<welt_patches>(welt_patches_create, get(), faces, count, &options, watched));
        });
    }
    Report fitted(std::uint32_t const* vertices, std::size_t count, Surface const& surface, std::uint32_t fit,
                  Job const* job) {
        return Job::run(job, [&](welt_job const* watched) {
            return Report(detail::make<welt_report>(welt_mesh_fit, get(), vertices, count, surface.get(), fit, watched));
        });
    }
};

inline Mesh Refinement::mesh(std::uint32_t level) const {
    return Mesh(detail::make<welt_mesh>(welt_refinement_mesh, get(), level));
}

inline Selection::Edges Selection::edges(Mesh const& mesh) const {
    Edges all{std::vector<std::uint32_t>(2 * count()), std::vector<double>(count())};
    detail::call(welt_selection_edges, get(), mesh.get(), all.vertices.data(), all.vertices.size(), all.places.data(),
                 all.places.size());
    return all;
}

}  // namespace welt
