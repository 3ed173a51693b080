// Positions, connectivity and parents of levels 1 to 3 against OpenSubdiv.

#include "check.hpp"
#include "models.hpp"
#include "opensubdiv.hpp"

namespace {

constexpr int depth = 3;
constexpr double tolerance = 1e-12;  // of the size

// The vertices of a child face in our order: corner, edge that leaves it, face, edge that arrives. OpenSubdiv starts
// elsewhere, but knows which vertex stands for the parent face.
std::vector<int> quad_of(Far::TopologyRefiner const& refiner, int level, int face, int corner) {
    Far::TopologyLevel const& before = refiner.GetLevel(level - 1);
    auto const vertices = refiner.GetLevel(level).GetFaceVertices(before.GetFaceChildFaces(face)[corner]);
    std::vector<int> quad(vertices.begin(), vertices.end());
    auto const middle = std::find(quad.begin(), quad.end(), before.GetFaceChildVertex(face));
    std::rotate(quad.begin(), quad.begin() + (middle - quad.begin() + 2) % 4, quad.end());
    return quad;
}

void compare(std::string const& name, Polygons const& polygons, Mesh const& mesh) {
    double const size = size_of(polygons.positions);
    auto const refiner = make_refiner(polygons, depth);
    auto const expected = refine_positions(*refiner, polygons);
    auto const levels = refine(mesh, depth);

    // Numbers that OpenSubdiv gives to our vertices and faces, level by level.
    std::vector<int> vertex_there, face_there(polygons.sizes.size());
    for (std::size_t f = 0; f < face_there.size(); ++f) face_there[f] = static_cast<int>(f);
    for (std::size_t v = 0; v < polygons.positions.size(); ++v) vertex_there.push_back(static_cast<int>(v));
    double largest = 0;
    for (int number = 1; number <= depth; ++number) {
        Level const& level = levels[number];
        std::string const where = name + " level " + std::to_string(number);
        Far::TopologyLevel const& there = refiner->GetLevel(number);
        bool const same_counts = level.positions.size() == static_cast<std::size_t>(there.GetNumVertices()) &&
                                 level.parent_faces.size() == static_cast<std::size_t>(there.GetNumFaces());
        check::that(same_counts, where + ": other counts");
        if (!same_counts) return;

        std::vector<int> next_vertices(level.positions.size(), -1), next_faces;
        // Vertices without a face are reached by no quad.
        for (std::size_t v = 0; v < vertex_there.size(); ++v) {
            next_vertices[v] = refiner->GetLevel(number - 1).GetVertexChildVertex(vertex_there[v]);
        }
        for (std::size_t f = 0; f < level.parent_faces.size(); ++f) {
            int const parent = face_there[level.parent_faces[f]];
            int corner = static_cast<int>(level.parent_corners[f]);
            if (number > 1) {
                // The parent begins at another of its corners there.
                auto const vertex = levels[number - 1].face_vertices[4 * level.parent_faces[f] + corner];
                corner = refiner->GetLevel(number - 1).GetFaceVertices(parent).FindIndex(vertex_there[vertex]);
            }
            auto const quad = quad_of(*refiner, number, parent, corner);
            for (int i = 0; i < 4; ++i) {
                int& known = next_vertices[level.face_vertices[4 * f + i]];
                check::that(known == -1 || known == quad[i],
                            where + ": face " + std::to_string(f) + " is connected otherwise");
                known = quad[i];
            }
            next_faces.push_back(refiner->GetLevel(number - 1).GetFaceChildFaces(parent)[corner]);
        }
        for (std::size_t v = 0; v < level.positions.size(); ++v) {
            double const error = distance(level.positions[v], expected[number][next_vertices[v]]) / size;
            largest = std::max(largest, error);
            check::that(error <= tolerance,
                        where + ": vertex " + std::to_string(v) + " is off by " + check::number(error));
        }
        vertex_there = std::move(next_vertices);
        face_there = std::move(next_faces);
    }
    std::printf("%-45s %8zu faces, off by %.1e of the size\n", name.c_str(), levels[depth].parent_faces.size(),
                largest);
}

}  // namespace

int main() { return for_each_cage(compare, true); }
