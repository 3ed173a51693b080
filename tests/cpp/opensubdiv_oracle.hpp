// OpenSubdiv's limit surface as the oracle of queries: its points at the spacing of level 4 in a tree find the candidates, those
// at the spacing of level 8 decide.
#pragma once

#include "opensubdiv.hpp"

#include <opensubdiv/bfr/refinerSurfaceFactory.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>
#include <vector>

namespace Bfr = OpenSubdiv::Bfr;
using BfrSurface = Bfr::Surface<double>;
constexpr int coarse = 16, fine = 16;  // cells per side of a face, and of a cell

struct Box {
    Vector low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};
    void add(Vector const& p) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    double distance_to(Vector const& p) const {
        auto const gap = [](double from, double to, double x) { return std::max({from - x, x - to, 0.0}); };
        return length(Vector{gap(low.x, high.x, p.x), gap(low.y, high.y, p.y), gap(low.z, high.z, p.z)});
    }
    bool meets(Vector const& o, Vector const& d) const {
        double enter = -1e300, leave = 1e300;
        auto const slab = [&](double from, double to, double start, double way) {
            if (way == 0) return from <= start && start <= to;
            double const a = (from - start) / way, b = (to - start) / way;
            enter = std::max(enter, std::min(a, b));
            leave = std::min(leave, std::max(a, b));
            return true;
        };
        return slab(low.x, high.x, o.x, d.x) && slab(low.y, high.y, o.y, d.y) && slab(low.z, high.z, o.z, d.z) && enter <= leave;
    }
};

// OpenSubdiv's limit surface, face by face.
struct Oracle {
    std::unique_ptr<Far::TopologyRefiner> refiner;
    std::vector<BfrSurface> surfaces;
    std::vector<std::vector<double>> points;
    struct Cell {
        int face, corner;
        double u, v;
        Box box;
    };
    std::vector<Cell> cells;
    struct Node {
        Box box;
        int left, count, first;
    };
    std::vector<Node> nodes;

    // On a quad `corner` is 0, on another face it names the quadrant.
    Vector at(int face, int corner, double u, double v) const {
        double const normalized[2] = {u, v};
        double uv[2] = {u, v};
        auto const parameterization = surfaces[face].GetParameterization();
        if (parameterization.HasSubFaces()) parameterization.ConvertNormalizedSubFaceToCoord(corner, normalized, uv);
        Vector p{};
        surfaces[face].Evaluate(uv, points[face].data(), BfrSurface::PointDescriptor(3), &p.x);
        return p;
    }

    explicit Oracle(Polygons const& polygons) : refiner(make_refiner(polygons, 0)) {
        Bfr::SurfaceFactory::Options options;
        options.SetApproxLevelSmooth(10).SetApproxLevelSharp(10);
        Bfr::RefinerSurfaceFactory<> const factory(*refiner, options);
        BfrSurface::PointDescriptor const three(3);
        surfaces.resize(polygons.sizes.size());
        points.resize(polygons.sizes.size());
        for (std::size_t face = 0; face < surfaces.size(); ++face) {
            if (!factory.InitVertexSurface(static_cast<int>(face), &surfaces[face])) continue;
            points[face].resize(3 * surfaces[face].GetNumPatchPoints());
            surfaces[face].PreparePatchPoints(&polygons.positions.data()->x, three, points[face].data(), three);
            int const patches = polygons.sizes[face] == 4 ? 1 : static_cast<int>(polygons.sizes[face]);
            for (int k = 0; k < patches * coarse * coarse; ++k) {
                int const place = k % (coarse * coarse);
                Cell cell{static_cast<int>(face), k / (coarse * coarse), double(place % coarse) / coarse,
                          double(place / coarse) / coarse, {}};
                for (int corner = 0; corner < 4; ++corner) {
                    cell.box.add(at(cell.face, cell.corner, cell.u + (corner & 1) / double(coarse),
                                    cell.v + (corner >> 1) / double(coarse)));
                }
                // The surface may bulge out of the box of the corners.
                double const pad = 0.5 * length(cell.box.high - cell.box.low);
                cell.box.low = cell.box.low - Vector{pad, pad, pad};
                cell.box.high = cell.box.high + Vector{pad, pad, pad};
                cells.push_back(cell);
            }
        }
        build(0, static_cast<int>(cells.size()));
    }

    int build(int first, int last) {
        int const index = static_cast<int>(nodes.size());
        nodes.push_back({});
        Box box;
        for (int i = first; i < last; ++i) {
            box.add(cells[i].box.low);
            box.add(cells[i].box.high);
        }
        nodes[index].box = box;
        if (last - first <= 4) {
            nodes[index].count = last - first;
            nodes[index].first = first;
            return index;
        }
        Vector const extent = box.high - box.low;
        auto const key = [&](Cell const& cell) {
            if (extent.x >= extent.y && extent.x >= extent.z) return cell.box.low.x + cell.box.high.x;
            return extent.y >= extent.z ? cell.box.low.y + cell.box.high.y : cell.box.low.z + cell.box.high.z;
        };
        int const middle = (first + last) / 2;
        std::nth_element(cells.begin() + first, cells.begin() + middle, cells.begin() + last,
                         [&](Cell const& a, Cell const& b) { return key(a) < key(b); });
        build(first, middle);
        nodes[index].left = build(middle, last);
        nodes[index].count = 0;
        return index;
    }

    // The fine tessellation of a cell, kept as long as there is room: queries come back to the same cells.
    struct Grid {
        std::array<Vector, (fine + 1) * (fine + 1)> points;
        Box box;
    };
    static constexpr std::size_t most_grids = 30000;  // of 7 kB each
    mutable std::unordered_map<int, Grid> grids;

    Grid const& grid(int number) const {
        auto const known = grids.find(number);
        if (known != grids.end()) return known->second;
        if (grids.size() >= most_grids) grids.clear();
        Grid& made = grids[number];
        Cell const& cell = cells[number];
        for (int k = 0; k < (fine + 1) * (fine + 1); ++k) {
            made.points[k] = at(cell.face, cell.corner, cell.u + k % (fine + 1) / double(coarse * fine),
                                cell.v + k / (fine + 1) / double(coarse * fine));
            made.box.add(made.points[k]);
        }
        return made;
    }

    // Distance of the closest point of the fine tessellation; `best` is a distance that may be undercut.
    double closest(Vector const& p, double best, int node = 0) const {
        Node const& here = nodes[node];
        if (here.box.distance_to(p) >= best) return best;
        for (int i = here.first; i < here.first + here.count; ++i) {
            if (cells[i].box.distance_to(p) >= best) continue;
            Grid const& fine_points = grid(i);
            if (fine_points.box.distance_to(p) >= best) continue;
            for (Vector const& q : fine_points.points) best = std::min(best, distance(p, q));
        }
        if (here.count > 0) return best;
        int a = node + 1, b = here.left;
        if (nodes[b].box.distance_to(p) < nodes[a].box.distance_to(p)) std::swap(a, b);
        return closest(p, closest(p, best, a), b);
    }

    // `cosine` is that of the angle between the line and the normal: negative where the line enters.
    struct Crossing {
        double s, spacing, cosine;
    };
    std::vector<Crossing> crossings(Vector const& o, Vector const& d) const {
        std::vector<Crossing> found;
        crossings(o, d, found, 0);
        return found;
    }

    void crossings(Vector const& o, Vector const& d, std::vector<Crossing>& found, int node) const {
        Node const& here = nodes[node];
        if (!here.box.meets(o, d)) return;
        for (int i = here.first; i < here.first + here.count; ++i) {
            if (!cells[i].box.meets(o, d)) continue;
            Grid const& fine_points = grid(i);
            if (!fine_points.box.meets(o, d)) continue;
            auto const& p = fine_points.points;
            for (int k = 0; k < fine * fine; ++k) {
                int const at = k / fine * (fine + 1) + k % fine;
                triangle(o, d, p[at], p[at + 1], p[at + fine + 2], found);
                triangle(o, d, p[at], p[at + fine + 2], p[at + fine + 1], found);
            }
        }
        if (here.count > 0) return;
        crossings(o, d, found, node + 1);
        crossings(o, d, found, here.left);
    }

    static void triangle(Vector const& o, Vector const& d, Vector const& a, Vector const& b, Vector const& c,
                         std::vector<Crossing>& found) {
        Vector const e = b - a, f = c - a, h = cross(d, f), normal = cross(e, f);
        double const det = dot(e, h);
        if (det == 0) return;
        Vector const t = o - a;
        double const u = dot(t, h) / det;
        Vector const q = cross(t, e);
        double const v = dot(d, q) / det;
        if (u < 0 || v < 0 || u + v > 1) return;
        double const spacing = std::max({length(e), length(f), distance(b, c)});
        found.push_back({dot(f, q) / det, spacing, dot(normal, d) / (length(normal) * length(d))});
    }
};
