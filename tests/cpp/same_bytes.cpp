// Prints a digest of every result: same_bytes THREADS MODEL... The output is the same on any number of threads, by every build
// of the library, each time: same_bytes.cmake compares.

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <welt.hpp>

namespace {

// FNV-1a, over bytes.
class Digest {
public:
    void bytes(void const* data, std::size_t size) {
        auto const* const byte = static_cast<unsigned char const*>(data);
        for (std::size_t i = 0; i < size; ++i) state_ = (state_ ^ byte[i]) * 0x100000001b3u;
    }
    template <class C>
    Digest& add(C const& values) {
        if (values.size() > 0) bytes(values.data(), values.size() * sizeof values.data()[0]);
        return *this;
    }
    std::uint64_t state() const { return state_; }

private:
    std::uint64_t state_ = 0xcbf29ce484222325u;
};

std::uint32_t threads = 1;

void tell(std::string const& name, Digest const& digest) {
    std::printf("%s %016llx\n", name.c_str(), static_cast<unsigned long long>(digest.state()));
}

void tell(std::string const& name, welt::Mesh const& mesh) {
    Digest digest;
    welt::Mesh::Faces const faces = mesh.faces();
    digest.add(mesh.positions()).add(faces.sizes).add(faces.vertices).add(mesh.edges());
    tell(name, digest);
    for (char const* file : {"out.obj", "out.ply"}) {
        mesh.export_file(file);
        std::ifstream stream(file, std::ios::binary);
        Digest written;
        tell(name + ", " + file, written.add(std::string(std::istreambuf_iterator<char>(stream), {})));
    }
}

// What a report says, up to the times of the stages, which come last.
Digest content(welt::Report const& report) {
    std::string_view const json = report.json();
    Digest digest;
    return digest.add(json.substr(0, json.find("\"times\"")));
}

// Of the members: what lies between is not written.
void add(Digest& digest, std::vector<welt_surface_point> const& points) {
    for (welt_surface_point const& p : points) {
        std::uint32_t const where[2] = {p.face, p.corner};
        double const values[9] = {p.u,         p.v,         p.position[0], p.position[1], p.position[2],
                                  p.normal[0], p.normal[1], p.normal[2],   p.distance};
        digest.bytes(where, sizeof where);
        digest.bytes(values, sizeof values);
    }
}

// Numbers in [0, 1) that are the same everywhere.
double number(std::uint32_t i) { return double(i * 2654435761u % 1000003u) / 1000003.0; }

constexpr std::uint32_t count = 200;

// Evaluation and queries, in batches long enough for several threads.
void surfaces(std::string const& name, welt::Mesh const& mesh) {
    welt::Surface const surface = mesh.freeze();
    welt::Vector low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};
    for (welt::Vector const& p : mesh.positions())
        for (int i = 0; i < 3; ++i) low[i] = std::min(low[i], p[i]), high[i] = std::max(high[i], p[i]);
    std::vector<std::uint32_t> faces;
    std::vector<welt::Parameter> places;
    std::vector<welt::Vector> points;
    std::vector<welt::Line> lines;
    for (std::uint32_t i = 0; i < count; ++i) {
        faces.push_back(std::uint32_t(number(i) * double(mesh.face_count())));
        places.push_back({number(7 * i + 1), number(11 * i + 2)});
        welt::Vector point, way;
        for (std::uint32_t k = 0; k < 3; ++k) {
            point[k] = low[k] + (1.4 * number(3 * i + k) - 0.2) * (high[k] - low[k]);
            way[k] = number(5 * i + k + 3) - 0.5;
        }
        points.push_back(point);
        lines.push_back({point, way});
    }
    Digest digest;
    tell(name + ", jets", digest.add(surface.evaluate<welt::Jet>(faces, {}, places, threads)));
    digest = {};
    add(digest, surface.closest(points, welt::Surface::infinity, {}, threads));
    tell(name + ", closest points", digest);
    digest = {};
    add(digest, surface.first_hits(lines, 0, welt::Surface::infinity, threads));
    welt::Hits const hits = surface.all_hits(lines, -welt::Surface::infinity, welt::Surface::infinity, threads);
    digest.add(hits.starts);
    add(digest, hits.points);
    tell(name + ", hits", digest);
    std::vector<double> distances(count);
    welt::BatchOptions const options(threads);
    if (welt_surface_signed_distances(surface.get(), points[0].data(), count, &options, distances.data(), count, nullptr) == WELT_OK)
        tell(name + ", signed distances", Digest().add(distances));
}

void refinements(std::string const& name, welt::Mesh const& mesh) {
    Digest digest;
    tell(name + ", limit", digest.add(mesh.limit_positions()).add(mesh.limit_normals()));
    welt::Refinement const refinement = mesh.refine(2);
    digest = {};
    tell(name + ", refined", digest.add(refinement.positions(2)).add(refinement.face_vertices(2)));
    welt::Patches const patches = mesh.patches();
    digest = {};
    for (std::size_t i = 0; i < patches.count(); ++i) {
        welt_patch const patch = patches[i];
        digest.bytes(patch.poles, 3 * sizeof(double) * patch.pole_count_u * patch.pole_count_v);
    }
    tell(name + ", patches", digest);
}

// Features with every fit, and their reports; one with deviations, which take most of the time.
void feature(std::string const& name, welt::Mesh const& mesh, std::string_view marks, std::string_view features,
             std::string_view settings, std::uint32_t fit = WELT_FIT_SOLVE) {
    welt::Mesh changed = mesh.copy();
    welt::FeatureOptions options;
    options.fit = fit;
    options.deviation = name == "ridge";
    try {
        tell(name + ", report", content(changed.apply(changed.select(marks), features, settings, options)));
    } catch (welt::Error const& error) {
        std::printf("%s: %s\n", name.c_str(), error.what());
        return;
    }
    tell(name, changed);
    welt::Mesh::Deviation const deviation = mesh.deviation(changed, 1);
    double const values[3] = {deviation.largest, deviation.root_mean_square, deviation.percentile_95};
    Digest digest;
    digest.bytes(values, sizeof values);
    tell(name + ", deviation", digest);
}

// A wavy sheet with a hole, a crease that ends and a corner.
welt::Mesh sheet() {
    constexpr std::uint32_t side = 8;
    std::vector<welt::Vector> positions;
    std::vector<std::uint32_t> vertices;
    for (std::uint32_t i = 0; i < (side + 1) * (side + 1); ++i) {
        double const x = i % (side + 1), y = i / (side + 1);
        // No sine: it is the system's, not the library's.
        positions.push_back({x, y, 0.05 * x * (8 - x) * (0.3 + 0.1 * y)});
    }
    for (std::uint32_t i = 0; i < side * side; ++i) {
        std::uint32_t const a = i % side + (side + 1) * (i / side);
        for (std::uint32_t v : {a, a + 1, a + side + 2, a + side + 1}) vertices.push_back(v);
    }
    welt::Mesh mesh(std::vector<std::uint32_t>(side * side, 4), vertices, positions);
    std::uint32_t const edges[] = {30, 31, 31, 32}, corner[] = {70}, hole[] = {0};
    float const sharpness[] = {2.5f, 11}, sharp[] = {11};
    mesh.set_edge_sharpness(edges, sharpness);
    mesh.set_vertex_sharpness(corner, sharp);
    mesh.set_holes(hole);
    return mesh;
}

void triangles() {
    // An octahedron, once refined.
    std::vector<welt::Vector> const positions = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    std::vector<std::uint32_t> const vertices = {0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5};
    welt::Mesh const mesh = welt::Mesh(std::vector<std::uint32_t>(8, 3), vertices, positions).refine_loop(2);
    tell("octahedron", mesh);
    welt::Mesh::LoopLimit const limit = mesh.loop_limit();
    Digest digest;
    tell("octahedron, limit", digest.add(limit.positions).add(limit.normals));
    std::vector<std::uint32_t> faces;
    std::vector<welt::Parameter> places;
    for (std::uint32_t i = 0; i < count; ++i) {
        faces.push_back(i % std::uint32_t(mesh.face_count()));
        places.push_back({0.5 * number(i), 0.5 * number(3 * i + 1)});
    }
    digest = {};
    tell("octahedron, jets", digest.add(mesh.loop_evaluate<welt::Jet>(faces, places, threads)));
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 2) return 2;
    threads = std::uint32_t(std::atoi(argv[1]));
    triangles();
    welt::Mesh const wavy = sheet();
    refinements("sheet", wavy);
    surfaces("sheet", wavy);
    char const* const fits[] = {"none", "loop", "solve", "surface", "slide"};
    for (std::uint32_t fit = WELT_FIT_NONE; fit <= WELT_FIT_SURFACE_SLIDE; ++fit)
        feature(std::string("groove, ") + fits[fit], wavy, "ring:4,5", "groove", "width=0.3 depth=0.1", fit);
    for (char const* name : {"ridge", "piping", "step", "bead", "dent", "loop"})
        feature(name, wavy, "ring:38,47", name, "");
    feature("crossing", wavy, "ring:4,5#groove ring:38,47#piping", "groove=groove\npiping=piping", "");
    feature("polyline", wavy, "polyline:1.2,2.2,0.5;5.1,2.9,0.5;6.2,6.3,0.5", "groove", "width=0.2 depth=0.1");
    feature("spline", wavy, "spline:1.2,2.2,0.5;5.1,2.9,0.5;6.2,6.3,0.5", "ridge", "");
    welt::Mesh ruled = wavy.copy();
    tell("rules, report", content(ruled.apply(ruled.select("ring:4,5"), welt::Rules::linear())));
    tell("rules", ruled);
    for (int i = 2; i < argc; ++i) {
        std::string const name = std::string(argv[i]).substr(std::string(argv[i]).rfind('/') + 1);
        welt::Mesh const mesh = welt::Mesh::import_file(argv[i]);
        refinements(name, mesh);
        surfaces(name, mesh);
        std::vector<std::uint32_t> const edges = mesh.edges();
        std::size_t const middle = edges.size() / 4;
        feature(name + ", a ring", mesh,
                "ring:" + std::to_string(edges[2 * middle]) + "," + std::to_string(edges[2 * middle + 1]), "groove",
                "width=20% depth=10%");
    }
    return 0;
}
