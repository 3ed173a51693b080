#include "welt.hpp"

namespace {

static_assert(sizeof(Vector) == 3 * sizeof(double), "points are passed as three doubles");

// `error` by reference: it is read after the call that sets it, whatever the order in which arguments are evaluated.
void require(std::int32_t status, welt_error* const& error) {
    if (status == WELT_OK) return;
    std::string const message = welt_error_message(error);
    welt_error_free(error);
    if (status == WELT_ERROR_MESH) throw Refused(message);
    throw std::runtime_error(message);
}

}  // namespace

Mesh make_mesh(Polygons const& polygons) {
    welt_mesh* mesh = nullptr;
    welt_error* error = nullptr;
    require(welt_mesh_create(polygons.sizes.data(), polygons.sizes.size(), polygons.vertices.data(),
                             polygons.vertices.size(), &polygons.positions.data()->x, polygons.positions.size(), 0,
                             &mesh, &error),
            error);
    Mesh owner(mesh);
    Tags const& tags = polygons.tags;
    constexpr std::uint32_t boundaries[] = {WELT_BOUNDARY_NONE, WELT_BOUNDARY_EDGE_AND_CORNER, WELT_BOUNDARY_EDGE_ONLY};
    require(welt_mesh_set_subdivision(mesh, boundaries[tags.boundary],
                                      tags.chaikin ? WELT_CREASING_CHAIKIN : WELT_CREASING_UNIFORM, &error),
            error);
    require(welt_mesh_set_edge_sharpness(mesh, tags.crease_vertices.data(), tags.crease_sharpness.data(),
                                         tags.crease_sharpness.size(), &error),
            error);
    require(welt_mesh_set_vertex_sharpness(mesh, tags.corner_vertices.data(), tags.corner_sharpness.data(),
                                           tags.corner_sharpness.size(), &error),
            error);
    require(welt_mesh_set_holes(mesh, tags.holes.data(), tags.holes.size(), &error), error);
    return owner;
}

Mesh refine_loop(Mesh const& mesh) {
    welt_mesh* refined = nullptr;
    welt_error* error = nullptr;
    require(welt_mesh_refine_loop(mesh.get(), 1, &refined, &error), error);
    return Mesh(refined);
}

std::vector<Vector> positions_of(Mesh const& mesh) {
    double const* positions = nullptr;
    welt_error* error = nullptr;
    require(welt_mesh_positions(mesh.get(), &positions, &error), error);
    std::vector<Vector> points(welt_mesh_vertex_count(mesh.get()));
    for (Vector& p : points) p = {positions[0], positions[1], positions[2]}, positions += 3;
    return points;
}

std::vector<std::uint32_t> edges_of(Mesh const& mesh) {
    std::vector<std::uint32_t> vertices(2 * welt_mesh_edge_count(mesh.get()));
    welt_error* error = nullptr;
    require(welt_mesh_edges(mesh.get(), vertices.data(), vertices.size(), &error), error);
    return vertices;
}

LoopLimit loop_limit(Mesh const& mesh) {
    std::size_t const count = welt_mesh_vertex_count(mesh.get());
    LoopLimit limit{std::vector<Vector>(count), std::vector<Vector>(count)};
    welt_error* error = nullptr;
    require(welt_mesh_loop_limit(mesh.get(), &limit.positions.data()->x, &limit.normals.data()->x, 3 * count, &error),
            error);
    return limit;
}

std::vector<Jet> evaluate(Mesh const& mesh, std::vector<std::uint32_t> const& faces,
                          std::vector<std::uint32_t> const& corners, std::vector<double> const& parameters) {
    static_assert(sizeof(Jet) == 18 * sizeof(double), "points are written as 18 doubles");
    std::vector<Jet> jets(faces.size());
    welt_error* error = nullptr;
    welt_surface* made = nullptr;
    require(welt_surface_create(mesh.get(), faces.data(), faces.size(), &made, &error), error);
    Surface const surface(made);
    require(welt_surface_evaluate(made, faces.data(), corners.data(), parameters.data(), faces.size(), 2, nullptr,
                               &jets.data()->position.x, 18 * jets.size(), &error),
            error);
    return jets;
}

std::vector<Jet> evaluate_loop(Mesh const& mesh, std::vector<std::uint32_t> const& faces,
                               std::vector<double> const& parameters) {
    std::vector<Jet> jets(faces.size());
    welt_error* error = nullptr;
    require(welt_mesh_loop_evaluate(mesh.get(), faces.data(), parameters.data(), faces.size(), 2, nullptr,
                                    &jets.data()->position.x, 18 * jets.size(), &error),
            error);
    return jets;
}

std::vector<Level> refine(Mesh const& mesh, unsigned depth) {
    welt_refinement* made = nullptr;
    welt_error* error = nullptr;
    require(welt_refinement_create(mesh.get(), depth, nullptr, &made, &error), error);
    Refinement const refinement(made);
    std::vector<Level> levels;
    for (unsigned number = 0; number <= depth; ++number) {
        Level level;
        double const* positions = nullptr;
        std::uint32_t const* vertices = nullptr;
        require(welt_refinement_positions(made, number, &positions, &error), error);
        require(welt_refinement_face_vertices(made, number, &vertices, &error), error);
        std::size_t const vertex_count = welt_refinement_vertex_count(made, number);
        std::size_t const face_count = welt_refinement_face_count(made, number);
        for (std::size_t v = 0; v < vertex_count; ++v, positions += 3) {
            level.positions.push_back({positions[0], positions[1], positions[2]});
        }
        if (number > 0) {
            level.face_vertices.assign(vertices, vertices + 4 * face_count);
            level.parent_faces.resize(face_count);
            level.parent_corners.resize(face_count);
            require(welt_refinement_face_parents(made, number, level.parent_faces.data(),
                                                 level.parent_corners.data(), face_count, &error),
                    error);
        }
        levels.push_back(std::move(level));
    }
    return levels;
}

namespace {

using Limit = std::int32_t (*)(welt_mesh const*, double*, std::size_t, welt_error**);

std::vector<Vector> limit(Mesh const& mesh, Limit function) {
    std::vector<Vector> points(welt_mesh_vertex_count(mesh.get()));
    welt_error* error = nullptr;
    require(function(mesh.get(), &points.data()->x, 3 * points.size(), &error), error);
    return points;
}

}  // namespace

std::vector<Vector> limit_positions(Mesh const& mesh) { return limit(mesh, welt_mesh_limit_positions); }

std::vector<Vector> limit_normals(Mesh const& mesh) { return limit(mesh, welt_mesh_limit_normals); }
