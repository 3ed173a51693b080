// Loop refinement of closed triangle meshes against OpenMesh, whose boundary rule is another.

#include "check.hpp"
#include "models.hpp"
#include "points.hpp"

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Tools/Subdivider/Uniform/LoopT.hh>

namespace {

struct Traits : OpenMesh::DefaultTraits {
    using Point = OpenMesh::Vec3d;
    using Normal = OpenMesh::Vec3d;
};
using OtherMesh = OpenMesh::TriMesh_ArrayKernelT<Traits>;

constexpr double tolerance = 1e-12;  // of the size
constexpr std::size_t depth = 3;
int closed = 0;

// Nothing where the mesh has a boundary.
std::vector<Vector> refine_there(Polygons const& polygons) {
    OtherMesh mesh;
    for (Vector p : polygons.positions) mesh.add_vertex({p.x, p.y, p.z});
    for (std::size_t i = 0; i < polygons.vertices.size(); i += 3) {
        auto const corner = [&](std::size_t k) {
            return OpenMesh::VertexHandle(static_cast<int>(polygons.vertices[i + k]));
        };
        mesh.add_face(corner(0), corner(1), corner(2));
    }
    for (auto edge : mesh.edges()) {
        if (mesh.is_boundary(edge)) return {};
    }
    OpenMesh::Subdivider::Uniform::LoopT<OtherMesh, double> subdivider;
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

void compare(std::string const& name, Polygons const& polygons, Mesh const& mesh) {
    std::vector<bool> used(polygons.positions.size());
    for (std::uint32_t v : polygons.vertices) used[v] = true;
    bool const triangles = std::all_of(polygons.sizes.begin(), polygons.sizes.end(), [](auto size) { return size == 3; });
    if (!triangles || std::find(used.begin(), used.end(), false) != used.end()) return;
    auto const expected = refine_there(polygons);
    if (expected.empty()) return;
    Mesh level = refine_loop(mesh);
    for (std::size_t number = 1; number < depth; ++number) level = refine_loop(level);
    auto const found = positions_of(level);
    double const size = size_of(polygons.positions);
    check::that(found.size() == expected.size(), name + ": other counts");
    double const off = set_distance(found, expected, 1e-6 * size) / size;
    check::that(off <= tolerance, name + " is off by " + check::number(off));
    std::printf("%-45s off by %.1e of the size\n", name.c_str(), off);
    ++closed;
}

}  // namespace

int main() {
    omerr().disable();
    int const code = for_each_cage(compare);
    std::printf("%d closed triangle meshes\n", closed);
    if (code == 0 && closed < 5) return 1;
    return code;
}
