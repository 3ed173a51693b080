// Times welt (through its C ABI) beside OpenSubdiv and OpenMesh, in one run and on the same meshes: tori of quads.
// Medians of runs in turns. Memory is fresh in every run, as it is for a program that does the work once, but for refinement
// with reused memory: there malloc keeps what was freed, for both, and the first run is not counted.

#include "common.hpp"

#include <OpenMesh/Core/IO/MeshIO.hh>
#include <OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh>
#include <OpenMesh/Core/Mesh/Traits.hh>

#include <sstream>
#include <string>

#include <malloc.h>

namespace {

struct DoubleTraits : OpenMesh::DefaultTraits {
    using Point = OpenMesh::Vec3d;
};
using OpenMeshPolygons = OpenMesh::PolyMesh_ArrayKernelT<DoubleTraits>;

OpenMeshPolygons build_open_mesh(const Quads& quads) {
    OpenMeshPolygons mesh;
    mesh.reserve(quads.points(), 2 * quads.faces(), quads.faces());
    std::vector<OpenMeshPolygons::VertexHandle> handles;
    handles.reserve(quads.points());
    for (std::size_t i = 0; i < quads.points(); ++i) {
        handles.push_back(mesh.add_vertex(
            {quads.positions[3 * i], quads.positions[3 * i + 1], quads.positions[3 * i + 2]}));
    }
    std::vector<OpenMeshPolygons::VertexHandle> face(4);
    for (std::size_t f = 0; f < quads.faces(); ++f) {
        for (std::size_t k = 0; k < 4; ++k) face[k] = handles[quads.vertices[4 * f + k]];
        mesh.add_face(face);
    }
    return mesh;
}

// Whether malloc keeps large arrays that were freed, or gives them back and has new pages for each.
void keep_memory(bool keep) {
    constexpr int small = 64 << 10;
    mallopt(M_MMAP_THRESHOLD, keep ? INT32_MAX : small);
    mallopt(M_TRIM_THRESHOLD, keep ? INT32_MAX : small);
    malloc_trim(0);
}

void row(const char* work, std::size_t faces, Pair times, const char* peer) {
    std::printf("| %-48s | %8zu | %9.2f | %-22s | %9.2f | %5.1f |\n", work, faces, 1e3 * times.ours, peer,
                1e3 * times.theirs, times.theirs / times.ours);
    std::fflush(stdout);
}

void half_edges(const Quads& quads, int runs) {
    const auto ours = [&] {
        WeltMesh mesh;
        return seconds([&] { mesh = build(quads); });
    };
    const auto open_mesh = [&] {
        OpenMeshPolygons mesh;
        return seconds([&] { mesh = build_open_mesh(quads); });
    };
    const auto osd = [&] {
        std::unique_ptr<Far::TopologyRefiner> refiner;
        return seconds([&] { refiner = build_refiner(quads); });
    };
    row("half-edges from face lists", quads.faces(), in_turns(runs, ours, open_mesh), "OpenMesh add_face");
    row("half-edges from face lists", quads.faces(), in_turns(runs, ours, osd), "OpenSubdiv refiner");
}

void reading(const Quads& quads, int runs) {
    std::ostringstream text;
    text.precision(17);
    for (std::size_t i = 0; i < quads.points(); ++i) {
        text << "v " << quads.positions[3 * i] << ' ' << quads.positions[3 * i + 1] << ' ' << quads.positions[3 * i + 2]
             << '\n';
    }
    for (std::size_t f = 0; f < quads.faces(); ++f) {
        text << 'f';
        for (std::size_t k = 0; k < 4; ++k) text << ' ' << quads.vertices[4 * f + k] + 1;
        text << '\n';
    }
    const std::string obj = text.str();
    const auto ours = [&] {
        WeltMesh mesh;
        return seconds([&] {
            welt_mesh* handle = nullptr;
            check(welt_mesh_import_memory("torus.obj", SIZE_MAX, WELT_FORMAT_OBJ,
                                          reinterpret_cast<const std::uint8_t*>(obj.data()), obj.size(), nullptr,
                                          &handle, nullptr, nullptr));
            mesh.reset(handle);
        });
    };
    const auto open_mesh = [&] {
        std::istringstream in(obj);
        OpenMeshPolygons mesh;
        return seconds([&] {
            OpenMesh::IO::Options options;
            if (!OpenMesh::IO::read_mesh(mesh, in, ".obj", options)) std::exit(1);
        });
    };
    row("OBJ text in memory to half-edges", quads.faces(), in_turns(runs, ours, open_mesh), "OpenMesh read_mesh");
}

void refining(const Quads& quads, int levels, int runs) {
    const WeltMesh mesh = build(quads);
    const auto ours = [&] {
        welt_refinement* refinement = nullptr;
        const double time = seconds([&] {
            check(welt_refinement_create(mesh.get(), levels, nullptr, &refinement, nullptr));
        });
        welt_refinement_free(refinement);
        return time;
    };
    const std::vector<Point> control = points(quads);
    const auto osd = [&] {
        auto refiner = build_refiner(quads);
        return seconds([&] {
            refiner->RefineUniform(Far::TopologyRefiner::UniformOptions(levels));
            const Far::PrimvarRefinerReal<double> primvar(*refiner);
            std::vector<Point> from = control;
            for (int level = 1; level <= levels; ++level) {
                std::vector<Point> to(refiner->GetLevel(level).GetNumVertices());
                primvar.Interpolate(level, from, to);
                from.swap(to);
            }
        });
    };
    row("refinement to level 3, memory fresh", quads.faces(), in_turns(runs, ours, osd), "OpenSubdiv");
    keep_memory(true);
    in_turns(1, ours, osd);
    row("refinement to level 3, memory reused", quads.faces(), in_turns(runs, ours, osd), "OpenSubdiv");
    keep_memory(false);
}

void limits(const Quads& quads, int runs) {
    const WeltMesh mesh = build(quads);
    std::vector<double> positions(quads.positions.size()), normals(quads.positions.size());
    const auto ours = [&] {
        return seconds([&] {
            check(welt_mesh_limit_positions(mesh.get(), positions.data(), positions.size(), nullptr));
            check(welt_mesh_limit_normals(mesh.get(), normals.data(), normals.size(), nullptr));
        });
    };
    auto refiner = build_refiner(quads);
    Far::TopologyRefiner::UniformOptions options(1);
    options.fullTopologyInLastLevel = true;
    refiner->RefineUniform(options);
    const Far::PrimvarRefinerReal<double> primvar(*refiner);
    const std::vector<Point> control = points(quads);
    std::vector<Point> level1(refiner->GetLevel(1).GetNumVertices());
    primvar.Interpolate(1, control, level1);
    std::vector<Point> limit(level1.size()), du(level1.size()), dv(level1.size());
    // OpenSubdiv gives limits on the last level only, which has four times the vertices.
    const auto osd = [&] { return seconds([&] { primvar.Limit(level1, limit, du, dv); }) / 4; };
    row("limit points and normals at vertices", quads.faces(), in_turns(runs, ours, osd), "OpenSubdiv Limit / 4");
}

}  // namespace

int main() {
    keep_memory(false);
    std::printf("| %-48s | %8s | %9s | %-22s | %9s | %5s |\n", "work", "quads", "welt, ms", "peer", "peer, ms", "ratio");
    std::printf("|---|---|---|---|---|---|\n");
    struct Size {
        std::uint32_t n, m;
        int runs;
    };
    for (const Size size : {Size{100, 100, 15}, Size{200, 500, 9}, Size{200, 5000, 5}}) {
        const Quads quads = torus(size.n, size.m);
        half_edges(quads, size.runs);
        reading(quads, size.runs);
        limits(quads, size.runs);
        if (quads.faces() <= 100000) refining(quads, 3, size.runs);
    }
}
