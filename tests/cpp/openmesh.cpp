// Refinement of closed meshes against OpenMesh, whose boundary rule is another.

#include "check.hpp"
#include "models.hpp"
#include "points.hpp"

#include <OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh>
#include <OpenMesh/Tools/Subdivider/Uniform/CatmullClarkT.hh>

namespace {

struct Traits : OpenMesh::DefaultTraits {
    using Point = OpenMesh::Vec3d;
    using Normal = OpenMesh::Vec3d;
};
using OtherMesh = OpenMesh::PolyMesh_ArrayKernelT<Traits>;

constexpr double tolerance = 1e-12;  // of the size

// Nothing where the mesh has a boundary.
std::vector<Vector> refine_there(Polygons const& polygons, std::size_t depth) {
    OtherMesh mesh;
    for (Vector p : polygons.positions) mesh.add_vertex({p.x, p.y, p.z});
    std::size_t start = 0;
    for (std::uint32_t size : polygons.sizes) {
        std::vector<OpenMesh::VertexHandle> face;
        for (std::size_t i = start; i < start + size; ++i) face.emplace_back(static_cast<int>(polygons.vertices[i]));
        mesh.add_face(face);
        start += size;
    }
    for (auto edge : mesh.edges()) {
        if (mesh.is_boundary(edge)) return {};
    }
    OpenMesh::Subdivider::Uniform::CatmullClarkT<OtherMesh, double> subdivider;
    subdivider.attach(mesh);
    subdivider(depth);
    subdivider.detach();
    std::vector<Vector> positions;
    for (auto v : mesh.vertices()) {
        auto const& p = mesh.point(v);
        positions.push_back({p[0], p[1], p[2]});
    }
    return positions;
}

int closed = 0;

void compare(std::string const& name, Polygons const& polygons, Mesh const& mesh) {
    // Vertices without a face are not OpenMesh's to move.
    std::vector<bool> used(polygons.positions.size());
    for (std::uint32_t v : polygons.vertices) used[v] = true;
    if (std::find(used.begin(), used.end(), false) != used.end()) return;
    double const size = size_of(polygons.positions);
    for (unsigned depth = 1; depth <= 2; ++depth) {
        auto const expected = refine_there(polygons, depth);
        if (expected.empty()) return;
        std::string const where = name + " level " + std::to_string(depth);
        auto const found = refine(mesh, depth)[depth].positions;
        check::that(found.size() == expected.size(), where + ": other counts");
        double kept = 0;
        for (std::size_t v = 0; v < polygons.positions.size(); ++v) {
            kept = std::max(kept, distance(found[v], expected[v]));
        }
        double const off = std::max(kept, set_distance(found, expected, 1e-6 * size)) / size;
        check::that(off <= tolerance, where + " is off by " + check::number(off));
        std::printf("%-45s level %u off by %.1e of the size\n", name.c_str(), depth, off);
    }
    ++closed;
}

}  // namespace

int main() {
    omerr().disable();
    int const code = for_each_cage(compare);
    std::printf("%d closed models\n", closed);
    if (code == 0 && closed < 40) return 1;
    return code;
}
