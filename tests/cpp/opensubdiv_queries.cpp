// Queries against an independent search over OpenSubdiv's limit surface, see opensubdiv_oracle.hpp. What welt finds must be a point
// of OpenSubdiv's surface; no point of the fine tessellation may be closer; every hit of its triangles that is not grazing must
// have one of welt's beside it; and the sign of distances must be that of its winding number.
//
// Ten tagged shapes and ten cages; 2,000 queries of each class over all, or as many as the argument says; with a second argument
// only those whose name it is part of. Signed distances are
// asked of those that are closed. The table at the end has per class how many were asked, how many points found, how many of
// these compared, the largest difference in parts of the size, and how many answers are wrong.

#include "check.hpp"
#include "models.hpp"
#include "opensubdiv_oracle.hpp"

#include <cstdlib>
#include <limits>
#include <random>

namespace {

constexpr int shapes = 20;
int tagged_tested = 0, cages_tested = 0;
std::size_t queries_per_shape = 100;
std::string part_of_name;
double largest_off = 0;

// What was asked of one class of queries, how often welt found something, with how much that was compared, and how much the
// answers differ at most, in parts of the size.
struct Class {
    char const* name;
    std::size_t asked = 0, answered = 0, compared = 0;
    double worst = 0;
    int missed = 0;

    void that(bool holds, std::string const& what) {
        check::that(holds, what);
        missed += holds ? 0 : 1;
    }
};
Class closest{"closest point"}, with_start{"closest point, with a start"}, with_radius{"closest point, with a radius"},
    all_hits{"all hits of a line"}, first_hit{"first hit of a ray"}, signed_distance{"signed distance"};

using Points = std::vector<welt_surface_point>;

Vector position_of(welt_surface_point const& point) { return {point.position[0], point.position[1], point.position[2]}; }

// One shape, its oracle, and what is asked.
struct Shape {
    std::string name;
    Oracle oracle;
    welt::Surface surface;
    double size;
    std::vector<Vector> points, lines;

    Shape(std::string name_, Polygons const& polygons, Mesh const& mesh)
        : name(std::move(name_)), oracle(polygons), surface(mesh.freeze()) {
        Box box;
        for (Vector const& p : polygons.positions) box.add(p);
        Vector const extent = box.high - box.low, middle = (box.low + box.high) / 2;
        size = length(extent);
        std::mt19937_64 random(7);
        std::uniform_real_distribution<double> unit(-0.7, 0.7);
        auto const anywhere = [&] {
            double const x = unit(random), y = unit(random), z = unit(random);
            return middle + Vector{extent.x * x, extent.y * y, extent.z * z};
        };
        for (std::size_t i = 0; i < queries_per_shape; ++i) {
            points.push_back(anywhere());
            Vector const origin = anywhere();
            lines.insert(lines.end(), {origin, anywhere() - origin});
        }
    }

    std::string where(char const* what, std::size_t i) const { return name + " " + what + " " + std::to_string(i); }

    Points ask_closest(double radius, std::size_t first, std::size_t count, welt_surface_point const* starts) const {
        Points feet(count);
        check::that(welt_surface_closest(surface.get(), &points[first].x, count, radius, starts, nullptr, feet.data(), count,
                                         nullptr) == WELT_OK, name + ": closest");
        return feet;
    }

    // True for a point of OpenSubdiv's surface: Bfr is exact to its last squares, of 2^-10 of a face.
    bool is_on(welt_surface_point const& found) const {
        Vector const there = oracle.at(static_cast<int>(found.face), static_cast<int>(found.corner), found.u, found.v);
        double const off = distance(there, position_of(found)) / size;
        largest_off = std::max(largest_off, off);
        return off < 1e-6;
    }

    Points closest_points() const {
        Points const feet = ask_closest(INFINITY, 0, points.size(), nullptr);
        for (std::size_t i = 0; i < points.size(); ++i) {
            welt_surface_point const& foot = feet[i];
            std::string const at = where("point", i);
            ++closest.asked;
            closest.that(foot.face != WELT_NONE, at + " has no closest point");
            if (foot.face == WELT_NONE) continue;
            ++closest.answered;
            closest.that(is_on(foot), at + ": the closest point is off the surface");
            double const error = std::abs(distance(position_of(foot), points[i]) - foot.distance);
            closest.that(error <= 1e-12 * size, at + ": wrong distance");
            double const other = oracle.closest(points[i], foot.distance * (1 - 1e-12) - 1e-12 * size);
            double const gap = (foot.distance - other) / size;
            ++closest.compared;
            closest.worst = std::max(closest.worst, gap);
            closest.that(gap <= 1e-8, at + ": a point is closer by " + check::number(gap));
        }
        return feet;
    }

    // Bad guesses, the feet of other points, lead to the same distances; a radius just above them too, one just below to nothing.
    void starts_and_radii(Points const& feet) const {
        Points starts(feet.begin() + 1, feet.end());
        starts.push_back(feet.front());
        Points const started = ask_closest(INFINITY, 0, points.size(), starts.data());
        for (std::size_t i = 0; i < points.size(); ++i) {
            double const expected = feet[i].distance;
            same(with_start, started[i], i, expected, where("point with a start", i));
            bool const inside = i % 2 == 0;
            Points const limited = ask_closest(expected * (inside ? 1 + 1e-9 : 1 - 1e-9), i, 1, nullptr);
            same(with_radius, limited[0], i, inside ? expected : INFINITY, where("point with a radius", i));
        }
    }

    // `expected` is infinite where nothing is to be found.
    void same(Class& kind, welt_surface_point const& found, std::size_t i, double expected, std::string const& at) const {
        ++kind.asked;
        ++kind.compared;
        bool const answered = found.face != WELT_NONE;
        kind.that(answered == std::isfinite(expected), at + (answered ? " finds what is too far" : " finds nothing"));
        if (!answered) return;
        ++kind.answered;
        kind.that(is_on(found), at + ": the closest point is off the surface");
        double const error = std::max(std::abs(found.distance - expected),
                                      std::abs(distance(position_of(found), points[i]) - expected)) / size;
        kind.worst = std::max(kind.worst, error);
        kind.that(error <= 1e-12, at + ": another distance, by " + check::number(error));
    }

    void hits_of_lines() const {
        std::size_t const count = points.size();
        std::vector<std::size_t> starts(count + 1);
        Points hits(64 * count), firsts(count);
        std::size_t needed = 0;
        check::that(welt_surface_all_hits(surface.get(), &lines.data()->x, count, -INFINITY, INFINITY, nullptr, starts.data(),
                                          &needed, hits.data(), hits.size(), nullptr) == WELT_OK, name + ": hits");
        check::that(welt_surface_first_hits(surface.get(), &lines.data()->x, count, 0, INFINITY, nullptr, firsts.data(), count,
                                            nullptr) == WELT_OK, name + ": first hits");
        for (std::size_t i = 0; i < count; ++i) {
            hits_of_line(i, hits.data() + starts[i], hits.data() + starts[i + 1]);
            first_of_ray(i, firsts[i], hits.data() + starts[i], hits.data() + starts[i + 1]);
        }
    }

    void hits_of_line(std::size_t i, welt_surface_point const* begin, welt_surface_point const* end) const {
        Vector const o = lines[2 * i], d = lines[2 * i + 1];
        std::string const at = where("line", i);
        ++all_hits.asked;
        for (auto const* hit = begin; hit != end; ++hit) {
            ++all_hits.answered;
            all_hits.that(is_on(*hit), at + ": a hit is off the surface");
            double const aside = distance(o + d * hit->distance, position_of(*hit)) / size;
            all_hits.worst = std::max(all_hits.worst, aside);
            all_hits.that(aside <= 1e-11, at + ": a hit is off the line by " + check::number(aside));
        }
        for (auto const& crossing : oracle.crossings(o, d)) {
            if (std::abs(crossing.cosine) < 0.1) continue;
            double nearest = INFINITY;
            for (auto const* hit = begin; hit != end; ++hit) {
                nearest = std::min(nearest, std::abs(hit->distance - crossing.s) * length(d));
            }
            ++all_hits.compared;
            all_hits.that(nearest <= crossing.spacing, at + ": a hit is missed, the nearest is " + check::number(nearest / size) +
                                                           " away, cosine " + check::number(crossing.cosine));
        }
    }

    // Of all hits the first with s >= 0.
    void first_of_ray(std::size_t i, welt_surface_point const& first, welt_surface_point const* begin,
                      welt_surface_point const* end) const {
        std::string const at = where("ray", i);
        auto const* const expected = std::find_if(begin, end, [](auto const& hit) { return hit.distance >= 0; });
        ++first_hit.asked;
        ++first_hit.compared;
        bool const answered = first.face != WELT_NONE;
        first_hit.that(answered == (expected != end), at + (answered ? " hits what no line does" : " misses what the line hits"));
        if (!answered || expected == end) return;
        ++first_hit.answered;
        double const error = std::abs(first.distance - expected->distance) * length(lines[2 * i + 1]) / size;
        first_hit.worst = std::max(first_hit.worst, error);
        first_hit.that(error <= 1e-11, at + ": another first hit, by " + check::number(error));
    }

    // The sign is that of the winding number of the tessellation, counted along a line from the point.
    bool signed_distances(Points const& feet) const {
        std::vector<double> distances(points.size());
        if (welt_surface_signed_distances(surface.get(), &points.data()->x, points.size(), nullptr, distances.data(),
                                          points.size(), nullptr) != WELT_OK) {
            return false;
        }
        for (std::size_t i = 0; i < points.size(); ++i) {
            std::string const at = where("signed distance", i);
            ++signed_distance.asked;
            ++signed_distance.answered;
            double const error = std::abs(std::abs(distances[i]) - feet[i].distance) / size;
            signed_distance.worst = std::max(signed_distance.worst, error);
            signed_distance.that(error <= 1e-12, at + ": another distance, by " + check::number(error));
            // Nearer, the point may be between the surface and the tessellation.
            if (feet[i].distance < 1e-4 * size) continue;
            int winding = 0;
            for (auto const& crossing : oracle.crossings(points[i], lines[2 * i + 1])) {
                if (crossing.s >= 0) winding += crossing.cosine > 0 ? 1 : -1;
            }
            ++signed_distance.compared;
            signed_distance.that((winding > 0) == (distances[i] < 0), at + " is " + check::number(distances[i]) +
                                                                         ", winding number " + std::to_string(winding));
        }
        return true;
    }
};

void compare(std::string const& name, Polygons const& polygons, Mesh const& mesh) {
    bool const tagged = name.find("with tags") != std::string::npos;
    // Ten shapes with creases, boundaries and the like, and as many cages that people made.
    int& count = name.rfind("osd/catmark", 0) == 0 && tagged ? tagged_tested : cages_tested;
    if (name.rfind("osd/", 0) == 0 && !tagged) return;
    if (name.rfind("osd/loop", 0) == 0 || polygons.sizes.size() > 800 || polygons.sizes.size() < 6 || count == shapes / 2) return;
    ++count;
    if (name.find(part_of_name) == std::string::npos) return;
    Shape const shape(name, polygons, mesh);
    Points const feet = shape.closest_points();
    shape.starts_and_radii(feet);
    std::size_t const hits_before = all_hits.answered;
    shape.hits_of_lines();
    bool const closed = shape.signed_distances(feet);
    std::printf("%-50s %4zu faces, %s, %zu queries of each class, %zu hits\n", name.c_str(), polygons.sizes.size(),
                closed ? "closed" : "open", queries_per_shape, all_hits.answered - hits_before);
    std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
    if (argc > 1) queries_per_shape = std::strtoul(argv[1], nullptr, 10) / shapes;
    if (argc > 2) part_of_name = argv[2];
    int const code = for_each_cage(compare, true);
    int const tested = tagged_tested + cages_tested;
    std::printf("%d shapes; found points are off OpenSubdiv's surface by at most %.1e of the size\n", tested, largest_off);
    std::printf("%-30s %9s %9s %9s %9s %7s\n", "class", "asked", "found", "compared", "largest", "missed");
    for (Class const* kind : {&closest, &with_start, &with_radius, &all_hits, &first_hit, &signed_distance}) {
        std::printf("%-30s %9zu %9zu %9zu %9.1e %7d\n", kind->name, kind->asked, kind->answered, kind->compared, kind->worst,
                    kind->missed);
    }
    if (code == 0 && tested < shapes) return 1;
    return code;
}
