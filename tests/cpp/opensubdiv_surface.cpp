// The limit surface at 10,000 random parameters of each shape against OpenSubdiv's Bfr, for the shapes of OpenSubdiv with
// and without their tags: Catmull-Clark for all, Loop for those of triangles.
//
// Beside an extraordinary vertex Bfr refines to a level that is asked for (10 here) and puts an approximation into the
// last square; parameters there are left out. Holes and faces that the boundary rule leaves out have no surface in both.
// Faces with a semi-sharp edge at an interior vertex of two faces are left out: Bfr of OpenSubdiv 3.5 numbers the vertices
// of its neighbourhood wrongly there and reads beyond an array.

#include "check.hpp"
#include "models.hpp"
#include "opensubdiv.hpp"

#include <opensubdiv/bfr/refinerSurfaceFactory.h>

#include <algorithm>
#include <random>
#include <tuple>

namespace {

namespace Bfr = OpenSubdiv::Bfr;

constexpr double tolerance = 1e-10;          // of the size
constexpr int points_per_shape = 10000;
constexpr int levels = 10;
// Over all shapes, by scheme: parameters that were compared, and second derivatives.
std::size_t all_compared[2] = {0, 0}, all_seconds[2] = {0, 0};

struct Largest {
    double position = 0, first = 0, second = 0;
};

// True in the last squares at the corners of a quad, in which Bfr approximates. `used` levels are spent before the quad.
bool in_last_square(double u, double v, int used) {
    double const size = std::ldexp(1.0, used - levels) * 1.0001;
    return std::min(u, 1 - u) <= size && std::min(v, 1 - v) <= size;
}

bool breaks_bfr(Far::TopologyLevel const& level, int face) {
    for (int vertex : level.GetFaceVertices(face)) {
        if (level.IsVertexBoundary(vertex) || level.GetVertexFaces(vertex).size() != 2) continue;
        for (int edge : level.GetVertexEdges(vertex)) {
            if (Sdc::Crease::IsSemiSharp(level.GetEdgeSharpness(edge))) return true;
        }
    }
    return false;
}

// True where Bfr approximates.
bool is_approximated(Bfr::Surface<double> const& surface, double u, double v, int arity) {
    if (surface.IsRegular()) return false;
    if (arity != 3) return in_last_square(u, v, arity == 4 ? 0 : 1);
    return std::max({1 - u - v, u, v}) >= 1 - std::ldexp(1.0001, -levels);
}

void compare_scheme(std::string const& name, Polygons const& polygons, Mesh const& mesh, Sdc::SchemeType scheme) {
    bool const loop = scheme == Sdc::SCHEME_LOOP;
    double const size = size_of(polygons.positions);
    auto const refiner = make_refiner(polygons, 0, scheme);
    Bfr::SurfaceFactory::Options options;
    options.SetApproxLevelSmooth(levels).SetApproxLevelSharp(levels);
    Bfr::RefinerSurfaceFactory<> const factory(*refiner, options);

    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> parameter(0, 1);
    Bfr::Surface<double> surface;
    std::vector<double> points;
    Largest largest;
    int compared = 0, nowhere = 0, seconds = 0, approximated = 0, broken = 0;
    int const face_count = static_cast<int>(polygons.sizes.size());
    int const per_face = points_per_shape / face_count + 1;
    for (int face = 0; face < face_count; ++face) {
        std::uint32_t const arity = polygons.sizes[face];
        std::vector<std::uint32_t> faces(per_face, face), corners(per_face, 0);
        std::vector<double> parameters;
        for (int i = 0; i < per_face; ++i) {
            double u = parameter(random), v = parameter(random);
            if (loop && u + v > 1) std::tie(u, v) = std::make_pair(1 - u, 1 - v);
            parameters.insert(parameters.end(), {u, v});
            corners[i] = arity == 4 ? 0 : static_cast<std::uint32_t>(i) % arity;
        }
        auto const jets = loop ? evaluate_loop(mesh, faces, parameters) : evaluate(mesh, faces, corners, parameters);
        std::string const where = name + " face " + std::to_string(face);
        if (breaks_bfr(refiner->GetLevel(0), face)) {
            broken += per_face;
            continue;
        }
        if (!factory.InitVertexSurface(face, &surface)) {
            for (auto const& jet : jets) check::that(std::isnan(jet.position.x), where + " has a surface");
            ++nowhere;
            continue;
        }
        Bfr::Surface<double>::PointDescriptor const three(3);
        points.resize(3 * surface.GetNumPatchPoints());
        surface.PreparePatchPoints(&polygons.positions.data()->x, three, points.data(), three);
        for (int i = 0; i < per_face; ++i) {
            double uv[2] = {parameters[2 * i], parameters[2 * i + 1]};
            if (is_approximated(surface, uv[0], uv[1], loop ? 3 : arity == 4 ? 4 : 5)) {
                ++approximated;
                continue;
            }
            double scale = 1;
            if (!loop && arity != 4) {
                double const normalized[2] = {uv[0], uv[1]};
                surface.GetParameterization().ConvertNormalizedSubFaceToCoord(static_cast<int>(corners[i]), normalized, uv);
                scale = 0.5;
            }
            Jet there;
            surface.Evaluate(uv, points.data(), three, &there.position.x, &there.du.x, &there.dv.x, &there.duu.x,
                             &there.duv.x, &there.dvv.x);
            Jet const& here = jets[i];
            double const position = distance(here.position, there.position) / size;
            double const first = std::max(distance(here.du, there.du / (1 / scale)),
                                          distance(here.dv, there.dv / (1 / scale))) / size;
            largest.position = std::max(largest.position, position);
            largest.first = std::max(largest.first, first);
            check::that(position <= tolerance && first <= tolerance,
                        where + " is off by " + check::number(position) + ", " + check::number(first) + " at " +
                            std::to_string(parameters[2 * i]) + " " + std::to_string(parameters[2 * i + 1]));
            ++compared;
            if (!surface.IsRegular()) continue;
            double const second = std::max({distance(here.duu, there.duu), distance(here.duv, there.duv),
                                            distance(here.dvv, there.dvv)}) / size;
            largest.second = std::max(largest.second, second);
            check::that(second <= tolerance, where + ": second derivatives are off by " + check::number(second));
            ++seconds;
        }
    }
    // Of the parameters where both have a surface and Bfr can be relied upon, Bfr approximates a few.
    int const reliable = per_face * (face_count - nowhere) - broken;
    check::that(compared + approximated == reliable && compared >= 0.99 * reliable, name + ": too few points are compared");
    all_compared[loop] += compared;
    all_seconds[loop] += seconds;
    std::printf("%-45s %s %6d points %.1e, tangents %.1e, %d second %.1e, %d faces without surface, %d points in Bfr's last "
                "squares, %d where it breaks\n",
                name.c_str(), loop ? "Loop" : "CC  ", compared, largest.position, largest.first, seconds, largest.second,
                nowhere, approximated, broken);
}

void compare(std::string const& name, Polygons const& polygons, Mesh const& mesh) {
    if (name.rfind("osd/", 0) != 0) return;
    compare_scheme(name, polygons, mesh, Sdc::SCHEME_CATMARK);
    bool const triangles = std::all_of(polygons.sizes.begin(), polygons.sizes.end(), [](auto size) { return size == 3; });
    if (triangles) compare_scheme(name, polygons, mesh, Sdc::SCHEME_LOOP);
}

}  // namespace

int main() {
    int const code = for_each_cage(compare, true);
    std::printf("Catmull-Clark: %zu parameters, %zu with second derivatives; Loop: %zu, %zu\n", all_compared[0], all_seconds[0],
                all_compared[1], all_seconds[1]);
    if (code == skipped) return code;
    check::that(all_compared[0] > 1000000 && all_compared[1] > 100000, "too few points");
    check::that(all_seconds[0] > 100000 && all_seconds[1] > 10000, "too few second derivatives");
    return check::result();
}
