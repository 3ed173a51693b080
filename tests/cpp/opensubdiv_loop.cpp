// Loop subdivision against OpenSubdiv: positions of levels 1 to 3, limit positions and normals at the vertices, for all
// triangle meshes of OpenSubdiv's shapes with and without their tags.
//
// OpenSubdiv's limit is compared on a level on which no sharpness falls any longer. It is not exact at darts, to which it
// applies the masks of smooth vertices, and its tangents at boundary vertices are those of other rules unless there are
// three faces: these are left out, as are normals on creases inside the surface, which have two, and at corners.

#include "check.hpp"
#include "models.hpp"
#include "opensubdiv.hpp"

namespace {

constexpr int depth = 3;
constexpr int limit_depth = 6;
constexpr double tolerance = 1e-12;  // of the size
constexpr double normal_tolerance = 1e-10;
int tested = 0;

void compare_limit(std::string const& name, Polygons const& polygons, Mesh const& mesh) {
    double const size = size_of(polygons.positions);
    auto const refiner = make_refiner(polygons, limit_depth, Sdc::SCHEME_LOOP);
    auto const refined = refine_positions(*refiner, polygons)[limit_depth];
    std::vector<Vector> positions(refined.size()), first(refined.size()), second(refined.size());
    PrimvarRefiner(*refiner).Limit(refined, positions, first, second);
    LoopLimit const limit = loop_limit(mesh);
    Far::TopologyLevel const& last = refiner->GetLevel(limit_depth);
    double largest = 0, largest_normal = 0;
    int compared = 0, compared_normals = 0;
    for (std::size_t v = 0; v < polygons.positions.size(); ++v) {
        int const there = descendant(*refiner, static_cast<int>(v));
        int sharp = 0;
        bool semi_sharp = Sdc::Crease::IsSemiSharp(last.GetVertexSharpness(there));
        for (int edge : last.GetVertexEdges(there)) {
            sharp += Sdc::Crease::IsInfinite(last.GetEdgeSharpness(edge));
            semi_sharp |= Sdc::Crease::IsSemiSharp(last.GetEdgeSharpness(edge));
        }
        bool const fixed = Sdc::Crease::IsInfinite(last.GetVertexSharpness(there));
        if (semi_sharp || (sharp == 1 && !fixed)) continue;
        std::string const where = name + " vertex " + std::to_string(v);
        double const error = distance(limit.positions[v], positions[there]) / size;
        largest = std::max(largest, error);
        check::that(error <= tolerance, where + ": the limit is off by " + check::number(error));
        ++compared;
        bool const boundary = last.IsVertexBoundary(there);
        Vector const normal = cross(first[there], second[there]);
        bool const plane = length(normal) > 1e-5 * length(first[there]) * length(second[there]) &&
                           length(first[there]) > 1e-12 * size && length(second[there]) > 1e-12 * size;
        if (fixed || !plane || sharp != (boundary ? 2 : 0)) continue;
        if (boundary && last.GetVertexFaces(there).size() != 3) continue;
        double const normal_error = distance(limit.normals[v], normal / length(normal));
        largest_normal = std::max(largest_normal, normal_error);
        check::that(normal_error <= normal_tolerance, where + ": the normal is off by " + check::number(normal_error));
        ++compared_normals;
    }
    std::printf("%-45s %d limits %.1e, %d normals %.1e\n", name.c_str(), compared, largest, compared_normals,
                largest_normal);
}

void compare(std::string const& name, Polygons const& polygons, Mesh const& mesh) {
    bool const triangles = std::all_of(polygons.sizes.begin(), polygons.sizes.end(), [](auto size) { return size == 3; });
    if (name.rfind("osd/", 0) != 0 || !triangles) return;
    double const size = size_of(polygons.positions);
    auto const refiner = make_refiner(polygons, depth, Sdc::SCHEME_LOOP);
    auto const expected = refine_positions(*refiner, polygons);
    std::vector<int> there;
    for (std::size_t v = 0; v < polygons.positions.size(); ++v) there.push_back(static_cast<int>(v));
    double largest = 0;
    Mesh level;
    for (int number = 1; number <= depth; ++number) {
        Mesh const& parent = number == 1 ? mesh : level;
        Far::TopologyLevel const& before = refiner->GetLevel(number - 1);
        std::vector<int> next;
        for (int v : there) next.push_back(before.GetVertexChildVertex(v));
        auto const edges = edges_of(parent);
        for (std::size_t e = 0; e < edges.size(); e += 2) {
            next.push_back(before.GetEdgeChildVertex(before.FindEdge(there[edges[e]], there[edges[e + 1]])));
        }
        level = refine_loop(parent);
        auto const positions = positions_of(level);
        std::string const where = name + " level " + std::to_string(number);
        check::that(positions.size() == expected[number].size() && positions.size() == next.size(),
                    where + ": other counts");
        if (positions.size() != next.size()) return;
        for (std::size_t v = 0; v < positions.size(); ++v) {
            double const error = distance(positions[v], expected[number][next[v]]) / size;
            largest = std::max(largest, error);
            check::that(error <= tolerance, where + ": vertex " + std::to_string(v) + " is off by " + check::number(error));
        }
        there = std::move(next);
    }
    std::printf("%-45s levels off by %.1e of the size\n", name.c_str(), largest);
    compare_limit(name, polygons, mesh);
    ++tested;
}

}  // namespace

int main() {
    int const code = for_each_cage(compare, true);
    std::printf("%d triangle meshes\n", tested);
    if (code == 0 && tested < 20) return 1;
    return code;
}
