// Meshes, handles and clocks that the benches beside OpenSubdiv share.
#pragma once

#include <welt.h>

#include <opensubdiv/far/primvarRefiner.h>
#include <opensubdiv/far/topologyDescriptor.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <memory>
#include <vector>

#include <time.h>

namespace Far = OpenSubdiv::Far;
namespace Sdc = OpenSubdiv::Sdc;

struct Quads {
    std::vector<double> positions;
    std::vector<std::uint32_t> sizes;
    std::vector<std::uint32_t> vertices;

    std::size_t faces() const { return sizes.size(); }
    std::size_t points() const { return positions.size() / 3; }
};

inline Quads torus(std::uint32_t n, std::uint32_t m) {
    const double turn = 2 * std::acos(-1.0);
    Quads quads;
    for (std::uint32_t j = 0; j < m; ++j) {
        for (std::uint32_t i = 0; i < n; ++i) {
            const double u = turn * i / n, v = turn * j / m, r = 4 + std::cos(u);
            for (double x : {r * std::cos(v), r * std::sin(v), std::sin(u)}) quads.positions.push_back(x);
            const auto at = [&](std::uint32_t a, std::uint32_t b) { return (b % m) * n + a % n; };
            quads.sizes.push_back(4);
            for (std::uint32_t k : {at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)}) quads.vertices.push_back(k);
        }
    }
    return quads;
}

// Processor time of this thread, which other programs on the machine disturb less than the clock on the wall.
inline double seconds(const std::function<void()>& work) {
    const auto now = [] {
        timespec time;
        clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
        return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
    };
    const double start = now();
    work();
    return now() - start;
}

/// The median time of `runs` runs; `work` says itself what of it counts.
inline double median(int runs, const std::function<double()>& work) {
    std::vector<double> times;
    for (int i = 0; i < runs; ++i) times.push_back(work());
    std::sort(times.begin(), times.end());
    return times[times.size() / 2];
}

/// The medians of ours and theirs, run in turns, so that what else the machine does meets both.
struct Pair {
    double ours, theirs;
};
inline Pair in_turns(int runs, const std::function<double()>& ours, const std::function<double()>& theirs) {
    std::vector<double> first, second;
    for (int i = 0; i < runs; ++i) {
        first.push_back(ours());
        second.push_back(theirs());
    }
    for (auto* times : {&first, &second}) std::sort(times->begin(), times->end());
    return {first[first.size() / 2], second[second.size() / 2]};
}

inline void check(std::int32_t status) {
    if (status != WELT_OK) {
        std::fprintf(stderr, "welt: status %d\n", status);
        std::exit(1);
    }
}

struct MeshDeleter {
    void operator()(welt_mesh* mesh) const { welt_mesh_free(mesh); }
};
using WeltMesh = std::unique_ptr<welt_mesh, MeshDeleter>;

inline WeltMesh build(const Quads& quads) {
    welt_mesh* mesh = nullptr;
    check(welt_mesh_create(quads.sizes.data(), quads.faces(), quads.vertices.data(), quads.vertices.size(),
                           quads.positions.data(), quads.points(), 0, &mesh, nullptr));
    return WeltMesh(mesh);
}

inline std::unique_ptr<Far::TopologyRefiner> build_refiner(const Quads& quads) {
    const std::vector<int> sizes(quads.sizes.begin(), quads.sizes.end());
    const std::vector<int> vertices(quads.vertices.begin(), quads.vertices.end());
    Far::TopologyDescriptor descriptor;
    descriptor.numVertices = static_cast<int>(quads.points());
    descriptor.numFaces = static_cast<int>(quads.faces());
    descriptor.numVertsPerFace = sizes.data();
    descriptor.vertIndicesPerFace = vertices.data();
    Sdc::Options options;
    options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
    using Factory = Far::TopologyRefinerFactory<Far::TopologyDescriptor>;
    return std::unique_ptr<Far::TopologyRefiner>(
        Factory::Create(descriptor, Factory::Options(Sdc::SCHEME_CATMARK, options)));
}

struct Point {
    double x[3] = {0, 0, 0};
    void Clear() { x[0] = x[1] = x[2] = 0; }
    void AddWithWeight(const Point& p, double w) {
        for (int i = 0; i < 3; ++i) x[i] += w * p.x[i];
    }
};

inline std::vector<Point> points(const Quads& quads) {
    std::vector<Point> result(quads.points());
    for (std::size_t i = 0; i < result.size(); ++i) {
        std::copy_n(&quads.positions[3 * i], 3, result[i].x);
    }
    return result;
}
