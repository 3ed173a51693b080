// Puts a groove on a mesh that OpenMesh holds, gives it back to OpenMesh, and shows its surface to OpenSubdiv.
//
//   c++ -std=c++17 exchange.cpp -lwelt -lOpenMeshCore -losdCPU -o exchange
//   ./exchange chair.obj seam.obj 3 331 "width=1.6 depth=0.6"
//
// The groove crosses the ring of edges through the edge 3-331, which is found and selected in OpenMesh, as a host would do
// with its own tools. Copy what you need: to_welt, from_welt, selectors_of, limit_of.
#include <welt.hpp>

#include <OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh>
#include <opensubdiv/far/primvarRefiner.h>
#include <opensubdiv/far/topologyDescriptor.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

using HostMesh = OpenMesh::PolyMesh_ArrayKernelT<OpenMesh::DefaultTraitsDouble>;

// --- OpenMesh ----------------------------------------------------------------------------------------------------------

// Vertices and faces keep their numbers. The mesh must have no deleted elements: call garbage_collection() first.
static welt::Mesh to_welt(HostMesh const& host) {
    std::vector<std::uint32_t> sizes, vertices;
    for (auto const face : host.faces()) {
        sizes.push_back(host.valence(face));
        for (auto const vertex : host.fv_range(face)) vertices.push_back(std::uint32_t(vertex.idx()));
    }
    // The points lie one after the other, three doubles each: the library reads them where they are.
    return welt::Mesh(sizes, vertices, welt::Points(host.points()->data(), host.n_vertices()));
}

static HostMesh from_welt(welt::Mesh const& mesh) {
    HostMesh host;
    for (welt::Vector const& p : mesh.positions()) host.add_vertex({p[0], p[1], p[2]});
    welt::Mesh::Faces const faces = mesh.faces();
    std::uint32_t const* next = faces.vertices.data();
    for (std::uint32_t const size : faces.sizes) {
        std::vector<OpenMesh::VertexHandle> corners;
        for (std::uint32_t const* const end = next + size; next != end; ++next) corners.emplace_back(int(*next));
        host.add_face(corners);
    }
    return host;
}

// Selects the edges that a loop cut through an edge would cross, both ways, until the loop closes or meets no quad.
static void select_ring(HostMesh& host, int a, int b) {
    auto const first = host.find_halfedge(host.vertex_handle(unsigned(a)), host.vertex_handle(unsigned(b)));
    if (!first.is_valid()) throw std::runtime_error("there is no edge between these vertices: name two neighbours");
    for (auto halfedge : {first, first.opp()}) {
        do {
            host.status(halfedge.edge()).set_selected(true);
            if (halfedge.is_boundary() || halfedge.face().valence() != 4) break;
            halfedge = halfedge.next().next().opp();
        } while (!host.status(halfedge.edge()).selected());
    }
}

// The selected edges as marks.
static std::string selectors_of(HostMesh const& host) {
    std::string text;
    for (auto const edge : host.edges())
        if (host.status(edge).selected())
            text += " edge:" + std::to_string(edge.v0().idx()) + "," + std::to_string(edge.v1().idx());
    return text;
}

// --- OpenSubdiv --------------------------------------------------------------------------------------------------------

namespace Far = OpenSubdiv::Far;
namespace Sdc = OpenSubdiv::Sdc;

// What OpenSubdiv asks of a type that it interpolates.
struct Point {
    welt::Vector at{};
    void Clear(void* = nullptr) { at = {}; }
    void AddWithWeight(Point const& other, double weight) {
        for (int i = 0; i < 3; ++i) at[i] += weight * other.at[i];
    }
};

// Where the vertices end up on the limit surface, by OpenSubdiv.
static std::vector<welt::Vector> limit_of(welt::Mesh const& mesh) {
    welt::Mesh::Faces const faces = mesh.faces();
    std::vector<int> const sizes(faces.sizes.begin(), faces.sizes.end());
    std::vector<int> const vertices(faces.vertices.begin(), faces.vertices.end());
    Far::TopologyDescriptor descriptor;
    descriptor.numVertices = int(mesh.vertex_count());
    descriptor.numFaces = int(sizes.size());
    descriptor.numVertsPerFace = sizes.data();
    descriptor.vertIndicesPerFace = vertices.data();
    Sdc::Options options;  // The boundary rule of the library unless it is told another.
    options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
    using Factory = Far::TopologyRefinerFactory<Far::TopologyDescriptor>;
    std::unique_ptr<Far::TopologyRefiner> const refiner(
        Factory::Create(descriptor, Factory::Options(Sdc::SCHEME_CATMARK, options)));
    Far::TopologyRefiner::UniformOptions uniform(1);
    uniform.fullTopologyInLastLevel = true;
    refiner->RefineUniform(uniform);

    Far::PrimvarRefinerReal<double> const refine(*refiner);
    std::vector<Point> control(mesh.vertex_count()), refined(std::size_t(refiner->GetLevel(1).GetNumVertices()));
    for (std::size_t i = 0; i < control.size(); ++i) control[i].at = mesh.positions()[i];
    refine.Interpolate(1, control, refined);
    std::vector<Point> limit(refined.size());
    refine.Limit(refined, limit);
    std::vector<welt::Vector> of_vertices;
    for (std::size_t i = 0; i < control.size(); ++i)
        of_vertices.push_back(limit[std::size_t(refiner->GetLevel(0).GetVertexChildVertex(int(i)))].at);
    return of_vertices;
}

// --- The program -------------------------------------------------------------------------------------------------------

int main(int count, char** arguments) {
    if (count != 6) {
        std::fprintf(stderr, "usage: exchange IN.obj OUT.obj VERTEX VERTEX SETTINGS\n");
        return 2;
    }
    try {
        HostMesh host = from_welt(welt::Mesh::import_file(arguments[1]));
        host.request_edge_status();
        int const a = std::atoi(arguments[3]), b = std::atoi(arguments[4]);
        if (a < 0 || b < 0 || a >= int(host.n_vertices()) || b >= int(host.n_vertices()))
            throw std::runtime_error("there is no such vertex: vertices are numbered from 0 to " +
                                     std::to_string(host.n_vertices() - 1));
        select_ring(host, a, b);

        welt::Mesh mesh = to_welt(host);
        welt::Selection const marks = mesh.select(selectors_of(host));
        mesh.apply(marks, "groove", arguments[5]);
        host = from_welt(mesh);
        to_welt(host).export_file(arguments[2]);
        std::printf("%zu edges marked; OpenMesh has %zu vertices and %zu faces\n", marks.count(), host.n_vertices(),
                    host.n_faces());

        std::vector<welt::Vector> const ours = mesh.limit_positions(), theirs = limit_of(mesh);
        double largest = 0;
        for (std::size_t i = 0; i < ours.size(); ++i)
            for (std::size_t k = 0; k < 3; ++k) largest = std::max(largest, std::abs(ours[i][k] - theirs[i][k]));
        std::printf("limit points of welt and OpenSubdiv differ by at most %.3g\n", largest);
    } catch (std::exception const& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
}
