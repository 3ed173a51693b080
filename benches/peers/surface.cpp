// Evaluation of the limit surface and queries on it, through the C ABI, beside OpenSubdiv's Bfr and Far. One thread.
//
// Nanoseconds per point, medians of runs in turns. Both write into arrays that were written before. "kept": the surface of every face was
// made beforehand, of welt as of Bfr (Surface and patch points per face, in double precision); "fresh": Bfr makes the surface of
// a face when the face changes, as its own examples do, which needs no memory for the mesh.

#include "common.hpp"

#include <opensubdiv/bfr/refinerSurfaceFactory.h>
#include <opensubdiv/far/patchMap.h>
#include <opensubdiv/far/patchTableFactory.h>

#include <random>
#include <string>

namespace {

namespace Bfr = OpenSubdiv::Bfr;
using Factory = Bfr::RefinerSurfaceFactory<>;

struct SurfaceDeleter {
    void operator()(welt_surface* surface) const { welt_surface_free(surface); }
};
using WeltSurface = std::unique_ptr<welt_surface, SurfaceDeleter>;

WeltSurface freeze(const WeltMesh& mesh) {
    welt_surface* surface = nullptr;
    check(welt_surface_create(mesh.get(), nullptr, 0, nullptr, &surface, nullptr));
    return WeltSurface(surface);
}

// Positions of the points, and what Bfr takes for them.
template <class Real> std::vector<Real> positions_of(const Quads& quads) {
    return std::vector<Real>(quads.positions.begin(), quads.positions.end());
}

template <class Real> struct Kept {
    std::vector<Bfr::Surface<Real>> surfaces;
    std::vector<std::size_t> first;
    std::vector<Real> points;
};

template <class Real> Kept<Real> keep(const Factory& factory, const Quads& quads) {
    const auto positions = positions_of<Real>(quads);
    typename Bfr::Surface<Real>::PointDescriptor const three(3);
    Kept<Real> kept;
    kept.surfaces.resize(quads.faces());
    for (std::size_t face = 0; face < quads.faces(); ++face) {
        if (!factory.InitVertexSurface(static_cast<int>(face), &kept.surfaces[face])) std::exit(1);
        kept.first.push_back(kept.points.size());
        kept.points.resize(kept.points.size() + 3 * kept.surfaces[face].GetNumPatchPoints());
        kept.surfaces[face].PreparePatchPoints(positions.data(), three, &kept.points[kept.first[face]], three);
    }
    return kept;
}

struct Batch {
    std::vector<std::uint32_t> faces;
    std::vector<double> parameters;
    std::size_t size() const { return faces.size(); }
};

Batch points_on(std::size_t faces, std::size_t count, bool sorted) {
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> parameter(0, 1);
    Batch batch;
    for (std::size_t i = 0; i < count; ++i) {
        batch.faces.push_back(static_cast<std::uint32_t>(sorted ? i * faces / count : random() % faces));
        batch.parameters.push_back(parameter(random));
        batch.parameters.push_back(parameter(random));
    }
    return batch;
}

template <class Real> void evaluate(const Bfr::Surface<Real>& surface, const Real* uv, const Real* points, int order, Real* at) {
    typename Bfr::Surface<Real>::PointDescriptor const three(3);
    if (order == 0) surface.Evaluate(uv, points, three, at);
    if (order == 1) surface.Evaluate(uv, points, three, at, at + 3, at + 6);
    if (order == 2) surface.Evaluate(uv, points, three, at, at + 3, at + 6, at + 9, at + 12, at + 15);
}

const char* const orders[] = {"position", "position, 1st", "position, 1st, 2nd"};
constexpr int widths[] = {3, 9, 18};

void print(const char* mesh, std::size_t faces, const std::string& work, Pair times, const char* peer) {
    std::printf("| %-9s | %8zu | %-28s | %7.1f | %-20s | %8.1f | %5.1f |\n", mesh, faces, work.c_str(), 1e9 * times.ours, peer,
                1e9 * times.theirs, times.theirs / times.ours);
    std::fflush(stdout);
}

template <class Real>
Pair bfr_times(const std::function<double()>& ours, const Factory& factory, const Quads& quads, const Batch& batch, int order,
               int runs, const Kept<Real>* kept) {
    const auto positions = positions_of<Real>(quads);
    const std::vector<Real> parameters(batch.parameters.begin(), batch.parameters.end());
    std::vector<Real> values(widths[order] * batch.size(), 1), points;
    typename Bfr::Surface<Real>::PointDescriptor const three(3);
    return in_turns(runs, ours, [&] {
        return seconds([&] {
            Bfr::Surface<Real> fresh;
            std::uint32_t last = UINT32_MAX;
            for (std::size_t i = 0; i < batch.size(); ++i) {
                const std::uint32_t face = batch.faces[i];
                if (kept) {
                    evaluate(kept->surfaces[face], &parameters[2 * i], &kept->points[kept->first[face]], order,
                             &values[widths[order] * i]);
                    continue;
                }
                if (face != last) {
                    factory.InitVertexSurface(static_cast<int>(face), &fresh);
                    points.resize(3 * fresh.GetNumPatchPoints());
                    fresh.PreparePatchPoints(positions.data(), three, points.data(), three);
                    last = face;
                }
                evaluate(fresh, &parameters[2 * i], points.data(), order, &values[widths[order] * i]);
            }
        }) / batch.size();
    });
}

void evaluation(const char* name, const Quads& quads, int runs) {
    const WeltMesh mesh = build(quads);
    const WeltSurface surface = freeze(mesh);
    const auto refiner = build_refiner(quads);
    const Factory factory(*refiner);
    const std::size_t count = quads.faces() < 100000 ? 200000 : quads.faces();
    const Kept<double> doubles = keep<double>(factory, quads);
    const Kept<float> floats = keep<float>(factory, quads);
    for (const bool sorted : {true, false}) {
        const Batch batch = points_on(quads.faces(), count, sorted);
        for (int order = 0; order < 3; ++order) {
            std::vector<double> values(widths[order] * count, 1);
            const auto ours = [&] {
                return seconds([&] {
                    check(welt_surface_evaluate(surface.get(), batch.faces.data(), nullptr, batch.parameters.data(), count,
                                                order, nullptr, values.data(), values.size(), nullptr));
                }) / count;
            };
            const std::string work = std::string(sorted ? "sorted, " : "random, ") + orders[order];
            print(name, quads.faces(), work, bfr_times(ours, factory, quads, batch, order, runs, &doubles), "Bfr double, kept");
            print(name, quads.faces(), work, bfr_times(ours, factory, quads, batch, order, runs, &floats), "Bfr float, kept");
            print(name, quads.faces(), work,
                  bfr_times<double>(ours, factory, quads, batch, order, std::min(runs, 3), nullptr), "Bfr double, fresh");
        }
    }
}

// A mesh of quads that all have an extraordinary vertex: the quads of a refined triangle mesh (two of them in each) or, of
// those refined again, the quads beside such vertices (one in each).
Quads refined_triangles(std::uint32_t n, int levels) {
    Quads triangles = torus(n, n);
    std::vector<std::uint32_t> vertices;
    for (std::size_t f = 0; f < triangles.faces(); ++f) {
        const std::uint32_t* v = &triangles.vertices[4 * f];
        for (std::uint32_t corner : {v[0], v[1], v[2], v[0], v[2], v[3]}) vertices.push_back(corner);
    }
    triangles.vertices = vertices;
    triangles.sizes.assign(vertices.size() / 3, 3);
    const WeltMesh mesh = build(triangles);
    welt_refinement* refinement = nullptr;
    check(welt_refinement_create(mesh.get(), levels, nullptr, &refinement, nullptr));
    const double* positions = nullptr;
    const std::uint32_t* faces = nullptr;
    check(welt_refinement_positions(refinement, levels, &positions, nullptr));
    check(welt_refinement_face_vertices(refinement, levels, &faces, nullptr));
    Quads quads;
    quads.positions.assign(positions, positions + 3 * welt_refinement_vertex_count(refinement, levels));
    quads.sizes.assign(welt_refinement_face_count(refinement, levels), 4);
    quads.vertices.assign(faces, faces + 4 * quads.sizes.size());
    welt_refinement_free(refinement);
    return quads;
}

void initialisation(const char* name, const Quads& quads, int runs) {
    const WeltMesh mesh = build(quads);
    const auto ours = [&] {
        WeltSurface surface;
        return seconds([&] { surface = freeze(mesh); }) / quads.faces();
    };
    const auto refiner = build_refiner(quads);
    const auto positions = positions_of<double>(quads);
    Bfr::Surface<double>::PointDescriptor const three(3);
    const auto bfr = [&](bool caching, bool kept) {
        return in_turns(runs, ours, [&] {
            Factory::Options options;
            options.EnableCaching(caching);
            const Factory factory(*refiner, options);
            if (kept) return seconds([&] { keep<double>(factory, quads); }) / quads.faces();
            std::vector<double> points;
            return seconds([&] {
                Bfr::Surface<double> surface;
                for (std::size_t face = 0; face < quads.faces(); ++face) {
                    factory.InitVertexSurface(static_cast<int>(face), &surface);
                    points.resize(3 * surface.GetNumPatchPoints());
                    surface.PreparePatchPoints(positions.data(), three, points.data(), three);
                }
            }) / quads.faces();
        });
    };
    print(name, quads.faces(), "initialisation", bfr(false, false), "Bfr, cold");
    print(name, quads.faces(), "initialisation", bfr(true, false), "Bfr, caching");
    print(name, quads.faces(), "initialisation", bfr(true, true), "Bfr, caching, kept");
    const Pair far = in_turns(std::min(runs, 3), ours, [&] {
        return seconds([&] {
            const auto adaptive = build_refiner(quads);
            Far::PatchTableFactory::Options options(6);
            options.SetEndCapType(Far::PatchTableFactory::Options::ENDCAP_GREGORY_BASIS);
            adaptive->RefineAdaptive(options.GetRefineAdaptiveOptions());
            const std::unique_ptr<Far::PatchTable> table(Far::PatchTableFactory::Create(*adaptive, options));
            const Far::PatchMap map(*table);
            std::vector<Point> values = points(quads);
            values.resize(adaptive->GetNumVerticesTotal() + table->GetNumLocalPoints());
            const Far::PrimvarRefinerReal<double> primvar(*adaptive);
            Point* from = values.data();
            for (int level = 1; level <= adaptive->GetMaxLevel(); ++level) {
                Point* to = from + adaptive->GetLevel(level - 1).GetNumVertices();
                primvar.Interpolate(level, from, to);
                from = to;
            }
        }) / quads.faces();
    });
    print(name, quads.faces(), "initialisation", far, "Far, adaptive level 6");
}

void queries(std::uint32_t n, std::uint32_t m, int runs) {
    const Quads quads = torus(n, m);
    const WeltMesh mesh = build(quads);
    const WeltSurface surface = freeze(mesh);
    constexpr std::size_t count = 4000;
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> across(-5, 5), up(-1.5, 1.5);
    std::vector<double> points, near, lines;
    for (std::size_t i = 0; i < count; ++i) {
        const double line[6] = {across(random), across(random), up(random), across(random), across(random), up(random)};
        points.insert(points.end(), line, line + 3);
        lines.insert(lines.end(), line, line + 6);
    }
    std::vector<welt_surface_point> found(count), again(count);
    const auto closest = [&](const std::vector<double>& from, const welt_surface_point* starts) {
        return seconds([&] {
            check(welt_surface_closest(surface.get(), from.data(), from.size() / 3, HUGE_VAL, starts, nullptr, again.data(), count, nullptr));
        });
    };
    const auto report = [&](const char* work, double time) {
        std::printf("| torus     | %8zu | %-28s | %7.2f |\n", quads.faces(), work, 1e6 * time / count);
        std::fflush(stdout);
    };
    // The first query makes the tree.
    std::printf("| torus     | %8zu | %-28s | %7.0f |\n", quads.faces(), "tree", 1e6 * closest({0, 0, 0}, nullptr));
    report("closest point, anywhere", median(runs, [&] { return closest(points, nullptr); }));
    found = again;
    report("closest point, with start", median(runs, [&] { return closest(points, found.data()); }));
    // A tenth of an edge beside the surface.
    for (const welt_surface_point& foot : found) {
        for (int i = 0; i < 3; ++i) near.push_back(foot.position[i] + 0.1 * 6.28 / n * foot.normal[i]);
    }
    report("closest point, near", median(runs, [&] { return closest(near, nullptr); }));
    report("first hit of a line", median(runs, [&] {
        return seconds([&] {
            check(welt_surface_first_hits(surface.get(), lines.data(), count, -HUGE_VAL, HUGE_VAL, nullptr, found.data(), count,
                                          nullptr));
        });
    }));
    std::vector<std::size_t> starts(count + 1);
    std::vector<welt_surface_point> hits(8 * count);
    report("all hits of a line", median(runs, [&] {
        return seconds([&] {
            check(welt_surface_all_hits(surface.get(), lines.data(), count, -HUGE_VAL, HUGE_VAL, nullptr, starts.data(), nullptr,
                                        hits.data(), hits.size(), nullptr));
        });
    }));
}

void beside_peers(bool large) {
    std::printf("| %-9s | %8s | %-28s | %7s | %-20s | %8s | %5s |\n", "mesh", "quads", "work", "welt, ns", "peer", "peer, ns",
                "ratio");
    std::printf("|---|---|---|---|---|---|---|\n");
    initialisation("torus", torus(100, 100), 5);
    initialisation("irregular", refined_triangles(40, 1), 5);
    initialisation("beside", refined_triangles(20, 2), 5);
    evaluation("torus", torus(100, 100), 5);
    evaluation("irregular", refined_triangles(40, 1), 5);
    if (large) evaluation("torus", torus(1000, 1000), 3);
}

}  // namespace

// "small" leaves the largest mesh out, "queries" everything beside peers.
int main(int argc, char** argv) {
    const std::string part = argc > 1 ? argv[1] : "";
    if (part != "queries") beside_peers(part != "small");
    std::printf("\n| mesh      |    quads | query                        | welt, us |\n|---|---|---|---|\n");
    queries(100, 200, 5);
    queries(200, 1000, 5);
}
