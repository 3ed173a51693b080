#include "points.hpp"

#include <cstdint>
#include <limits>
#include <map>
#include <tuple>

namespace {

using Cell = std::tuple<std::int64_t, std::int64_t, std::int64_t>;

Cell cell_of(Vector p, double reach) {
    auto index = [reach](double x) { return static_cast<std::int64_t>(std::floor(x / reach)); };
    return {index(p.x), index(p.y), index(p.z)};
}

double one_way(std::vector<Vector> const& from, std::vector<Vector> const& to, double reach) {
    std::map<Cell, std::vector<Vector>> cells;
    for (Vector p : to) cells[cell_of(p, reach)].push_back(p);
    double largest = 0;
    for (Vector p : from) {
        auto const [x, y, z] = cell_of(p, reach);
        double nearest = std::numeric_limits<double>::infinity();
        for (int i = 0; i < 27; ++i) {
            auto const found = cells.find({x + i % 3 - 1, y + i / 3 % 3 - 1, z + i / 9 - 1});
            if (found == cells.end()) continue;
            for (Vector q : found->second) nearest = std::min(nearest, distance(p, q));
        }
        largest = std::max(largest, nearest);
    }
    return largest;
}

}  // namespace

double set_distance(std::vector<Vector> const& a, std::vector<Vector> const& b, double reach) {
    return std::max(one_way(a, b, reach), one_way(b, a, reach));
}
