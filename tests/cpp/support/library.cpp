#include "library.hpp"

namespace {

Vector vector(welt::Vector const& v) { return {v[0], v[1], v[2]}; }

std::vector<Vector> vectors(welt::View<welt::Vector> all) {
    std::vector<Vector> copy;
    for (welt::Vector const& v : all) copy.push_back(vector(v));
    return copy;
}

}  // namespace

Mesh make_mesh(Polygons const& polygons) {
    Mesh mesh(polygons.sizes, polygons.vertices, {&polygons.positions.data()->x, polygons.positions.size()});
    Tags const& tags = polygons.tags;
    constexpr std::uint32_t boundaries[] = {WELT_BOUNDARY_NONE, WELT_BOUNDARY_EDGE_AND_CORNER, WELT_BOUNDARY_EDGE_ONLY};
    mesh.set_subdivision(boundaries[tags.boundary], tags.chaikin ? WELT_CREASING_CHAIKIN : WELT_CREASING_UNIFORM);
    mesh.set_edge_sharpness(tags.crease_vertices, tags.crease_sharpness);
    mesh.set_vertex_sharpness(tags.corner_vertices, tags.corner_sharpness);
    mesh.set_holes(tags.holes);
    return mesh;
}

std::vector<Level> refine(Mesh const& mesh, unsigned depth) {
    welt::Refinement const refinement = mesh.refine(depth);
    std::vector<Level> levels;
    for (unsigned number = 0; number <= depth; ++number) {
        Level level;
        level.positions = vectors(refinement.positions(number));
        if (number > 0) {
            welt::View<std::uint32_t> const corners = refinement.face_vertices(number);
            level.face_vertices.assign(corners.begin(), corners.end());
            welt::Refinement::FaceParents parents = refinement.face_parents(number);
            level.parent_faces = std::move(parents.faces);
            level.parent_corners = std::move(parents.corners);
        }
        levels.push_back(std::move(level));
    }
    return levels;
}

Mesh refine_loop(Mesh const& mesh) { return mesh.refine_loop(1); }

std::vector<Vector> positions_of(Mesh const& mesh) { return vectors(mesh.positions()); }

std::vector<std::uint32_t> edges_of(Mesh const& mesh) { return mesh.edges(); }

LoopLimit loop_limit(Mesh const& mesh) {
    Mesh::LoopLimit const limit = mesh.loop_limit();
    return {vectors(limit.positions), vectors(limit.normals)};
}

std::vector<Jet> evaluate(Mesh const& mesh, std::vector<std::uint32_t> const& faces,
                          std::vector<std::uint32_t> const& corners, std::vector<double> const& parameters) {
    std::vector<std::array<double, 2>> pairs;
    for (std::size_t i = 0; i + 1 < parameters.size(); i += 2) pairs.push_back({parameters[i], parameters[i + 1]});
    std::vector<Jet> jets;
    for (welt::Jet const& jet : mesh.freeze(faces).evaluate(faces, corners, pairs))
        jets.push_back({vector(jet.position), vector(jet.du), vector(jet.dv), vector(jet.duu), vector(jet.duv),
                        vector(jet.dvv)});
    return jets;
}

std::vector<Vector> limit_positions(Mesh const& mesh) { return vectors(mesh.limit_positions()); }

std::vector<Vector> limit_normals(Mesh const& mesh) { return vectors(mesh.limit_normals()); }
