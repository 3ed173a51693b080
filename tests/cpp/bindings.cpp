// The C++ header: what goes in comes out, without copies where it says so; errors, jobs and ownership.

#include "check.hpp"

#include <welt.hpp>

#include <cmath>
#include <cstdio>
#include <thread>
#include <type_traits>

namespace {

using check::that;

constexpr std::uint32_t side = 6;

struct Sheet {
    std::vector<std::uint32_t> sizes, corners;
    std::vector<welt::Vector> positions;
};

// A flat sheet of unit squares.
Sheet sheet() {
    Sheet sheet;
    for (std::uint32_t y = 0; y <= side; ++y)
        for (std::uint32_t x = 0; x <= side; ++x) sheet.positions.push_back({double(x), double(y), 0.0});
    for (std::uint32_t y = 0; y < side; ++y)
        for (std::uint32_t x = 0; x < side; ++x) {
            std::uint32_t const a = x + (side + 1) * y;
            sheet.sizes.push_back(4);
            for (std::uint32_t v : {a, a + 1, a + side + 2, a + side + 1}) sheet.corners.push_back(v);
        }
    return sheet;
}

welt::Mesh make_sheet() {
    Sheet const data = sheet();
    return welt::Mesh(data.sizes, data.corners, data.positions);
}

template <class Call>
welt::Error failure(std::int32_t code, Call const& call) {
    try {
        call();
    } catch (welt::Error const& error) {
        that(error.code() == code, std::string("another code: ") + error.what());
        return error;
    }
    that(false, "a call that must fail succeeds");
    return {WELT_OK, ""};
}

static_assert(std::is_nothrow_move_constructible_v<welt::Mesh> && !std::is_copy_constructible_v<welt::Mesh>);
static_assert(std::is_nothrow_move_assignable_v<welt::Job> && !std::is_copy_assignable_v<welt::Surface>);

void meshes_come_back_as_they_were_given() {
    Sheet const data = sheet();
    welt::Mesh mesh(data.sizes, data.corners, data.positions);
    welt::View<welt::Vector> const view = mesh.positions();
    that(std::equal(view.begin(), view.end(), data.positions.begin(), data.positions.end()), "positions");
    that(view.data() == mesh.positions().data(), "a view is no copy");
    that(mesh.faces().sizes == data.sizes && mesh.faces().vertices == data.corners, "faces");
    that(mesh.edges().size() == 2 * mesh.edge_count() && mesh.edge_count() == 2 * side * (side + 1), "edges");
    that(mesh.face_count() == side * side, "faces are counted");

    struct Padded {
        double x, y, z, weight;
    };
    std::vector<Padded> padded;
    for (welt::Vector const& p : data.positions) padded.push_back({p[0], p[1], 5.0, NAN});
    mesh.set_positions({&padded[0].x, padded.size(), sizeof(Padded)});
    that(mesh.positions()[3] == welt::Vector{3.0, 0.0, 5.0}, "points with a stride");

    welt::Mesh const copy = mesh.copy();
    mesh.set_positions(data.positions);
    that(copy.positions()[3] == welt::Vector{3.0, 0.0, 5.0} && copy.faces().vertices == data.corners, "a copy stays as it is");

    welt::Mesh moved = std::move(mesh);
    that(mesh.get() == nullptr && moved.vertex_count() == data.positions.size(), "a mesh is moved");
    welt::Error const error = failure(WELT_ERROR_ARGUMENT, [&] { mesh.positions(); });
    that(error.what() == std::string("mesh is NULL"), "what was moved from is empty");
}

void errors_have_places() {
    welt::Error const syntax = failure(
        WELT_ERROR_SYNTAX, [] { welt::Mesh::import_memory("v 0 0 0\nv 1 0 zero\n", WELT_FORMAT_OBJ, "cage.obj"); });
    that(syntax.places().size() == 1, "one place");
    welt::Place const& place = syntax.places().at(0);
    that(place.file == "cage.obj" && place.line == 2 && place.column == 7, "file, line and column");
    std::uint32_t const sizes[] = {3, 3}, corners[] = {0, 1, 2, 0, 1, 3};
    welt::Vector const positions[] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}};
    welt::Error const mesh =
        failure(WELT_ERROR_MESH, [&] { welt::Mesh(sizes, corners, welt::View<welt::Vector>(positions)); });
    that(mesh.places().at(0).kind == WELT_PLACE_EDGE && mesh.places().at(0).ids == std::array<std::uint32_t, 2>{0, 1},
         "the edge that is inside out");
    failure(WELT_ERROR_ARGUMENT, [] { make_sheet().displace(std::array<std::uint32_t, 2>{1, 2}, std::array<double, 1>{1}); });
}

void options_and_files() {
    welt::ImportOptions options;
    that(options.struct_size == sizeof(welt_import_options) && options.weld == -1.0, "defaults");
    options.weld = 0.0;
    welt::Report report;
    std::string const soup = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nvn 0 0 1\nf 1 2 3\nf 4 6 5\n";
    welt::Mesh const mesh = welt::Mesh::import_memory(soup, WELT_FORMAT_OBJ, "soup.obj", options, &report);
    that(mesh.edge_count() == 5, "two triangles are welded");
    that(report.json().find("normals") != std::string_view::npos, "the report");
    mesh.export_file("bindings.ply");
    that(welt::Mesh::import_file("bindings.ply").edge_count() == 5, "written and read");
}

// Figures are those of welt.h and of the subdivision rules.
void surfaces() {
    welt::Mesh mesh = make_sheet();
    welt::Refinement const refinement = mesh.refine(2);
    that(refinement.face_count(2) == 16 * mesh.face_count() && refinement.edge_count(0) == mesh.edge_count(), "levels");
    that(refinement.face_vertices(0).size() == 4 * mesh.face_count(), "corners of level 0");
    that(refinement.face_vertices(2).size() == 64 * mesh.face_count(), "corners of level 2");
    that(refinement.positions(1).size() == refinement.vertex_count(1), "positions of a level");
    that(refinement.face_parents(1).faces.back() == side * side - 1, "the last face comes of the last");
    that(refinement.vertex_parents(1).kinds.back() == WELT_PARENT_FACE, "points of faces come last");

    // In the middle of a flat sheet the surface is the sheet.
    std::array<std::uint32_t, 1> const face{side * (side / 2) + side / 2};
    std::array<std::array<double, 2>, 1> const middle{{{0.5, 0.5}}};
    welt::Jet const jet = mesh.freeze().evaluate(face, {}, middle).at(0);
    that(std::abs(jet.position[0] - 3.5) < 1e-14 && std::abs(jet.du[0] - 1.0) < 1e-14, "evaluation");
    that(std::isnan(mesh.freeze(std::array<std::uint32_t, 1>{0}).evaluate(face, {}, middle)[0].position[0]),
         "a face that was not frozen");
    std::vector<welt::Vector> const positions = mesh.freeze().evaluate<welt::Vector>(face, {}, middle);
    that(positions.at(0) == jet.position, "positions alone");
    that(mesh.freeze().evaluate<welt::Tangents>(face, {}, middle, 2).at(0).dv == jet.dv, "first derivatives");
    welt::Curvature const flat = mesh.freeze().curvature(face, {}, middle).at(0);
    that(flat.greater == 0.0 && flat.gaussian == 0.0 && flat.greater_direction[2] == 0.0, "a plane is not curved");
    that(refinement.mesh(1).edges().size() == 2 * refinement.edge_count(1), "a level is a mesh");
    that(mesh.limit_normals()[10] == welt::Vector{0, 0, 1} && mesh.limit_positions()[10][2] == 0.0, "limit");
    std::uint32_t const corner[] = {0};
    float const infinite[] = {10.0f};
    mesh.set_vertex_sharpness(corner, infinite);
    that(mesh.limit_positions()[0] == welt::Vector{0, 0, 0}, "a sharp vertex stays");
    mesh.set_edge_sharpness(std::array<std::uint32_t, 2>{8, 9}, infinite);
    mesh.set_subdivision(WELT_BOUNDARY_EDGE_AND_CORNER, WELT_CREASING_CHAIKIN);
    mesh.set_holes(std::array<std::uint32_t, 1>{0});

    welt::Mesh const triangle(std::array<std::uint32_t, 1>{3}, std::array<std::uint32_t, 3>{0, 1, 2},
                              std::array<welt::Vector, 3>{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}});
    that(triangle.refine_loop(2).face_count() == 16, "Loop");
    that(triangle.loop_limit().normals[0] == welt::Vector{0, 0, 1}, "normals of Loop");
    std::array<std::uint32_t, 1> const only{0};
    std::array<welt::Parameter, 1> const third{{{1.0 / 3.0, 1.0 / 3.0}}};
    that(triangle.loop_evaluate<welt::Vector>(only, third)[0][2] == 0.0 &&
             std::abs(triangle.loop_evaluate(only, third)[0].position[0] - 1.0 / 3.0) < 1e-14,
         "the middle of a triangle");
}

// On a flat sheet at height 0, and in and out of the surface of a cube.
void queries() {
    welt::Surface const sheet = make_sheet().freeze();
    struct Padded {
        double x, y, z, weight;
    };
    Padded const padded[] = {{2.5, 3.5, 2, NAN}, {4.25, 1.5, -1, NAN}};
    welt::Points const points(&padded[0].x, 2, sizeof(Padded));
    std::vector<welt_surface_point> const feet = sheet.closest(points);
    that(std::abs(feet.at(0).distance - 2.0) < 1e-12 && std::abs(feet.at(1).position[0] - 4.25) < 1e-12, "closest points");
    that(sheet.closest(points, 1.5, feet).at(0).face == WELT_NONE, "too far");
    failure(WELT_ERROR_ARGUMENT, [&] { sheet.closest(points, 9.0, welt::View<welt_surface_point>(feet.data(), 1)); });
    welt::Line const lines[] = {{{2.5, 3.5, 4}, {0, 0, -2}}, {{0, 0, 1}, {1, 0, 0}}};
    that(sheet.first_hits(lines).at(0).distance == 2.0 && sheet.first_hits(lines)[1].face == WELT_NONE, "first hits");
    failure(WELT_ERROR_ARGUMENT, [&] { sheet.signed_distances(points); });

    std::vector<std::uint32_t> const corners{0, 2, 3, 1, 4, 5, 7, 6, 0, 1, 5, 4, 2, 6, 7, 3, 0, 4, 6, 2, 1, 3, 7, 5};
    std::vector<welt::Vector> cage;
    for (int i = 0; i < 8; ++i) cage.push_back({i % 2 * 2.0 - 1, i / 2 % 2 * 2.0 - 1, i / 4 * 2.0 - 1});
    welt::Surface const cube = welt::Mesh(std::vector<std::uint32_t>(6, 4), corners, cage).freeze();
    std::array<welt::Vector, 2> const places{{{0, 0, 0}, {0, 0, 3}}};
    std::vector<double> const distances = cube.signed_distances(places);
    that(distances.at(0) < -0.4 && distances.at(1) > 2.0, "inside is negative");
    // Two hits where room for one is tried first.
    std::array<welt::Line, 1> const through{{{{0.1, 0.2, 5}, {0, 0, -1}}}};
    welt::Hits const hits = cube.all_hits(through);
    that(hits.starts == std::vector<std::size_t>{0, 2} && hits.points.size() == 2, "in and out");
    that(hits.points.at(0).distance < hits.points.at(1).distance && hits.points[0].normal[2] > 0.5, "in order");
}

// Pole k along a side, counter-clockwise.
double const* side_pole(welt_patch const& patch, std::uint32_t edge, std::uint32_t k) {
    std::size_t const m = patch.pole_count_u, n = patch.pole_count_v;
    std::size_t const places[] = {k, k * m + m - 1, n * m - 1 - k, (n - 1 - k) * m};
    return patch.poles + 3 * places[edge];
}

// The limit of a flat sheet is the sheet: poles lie at the means of three successive knots.
void patches() {
    welt::Mesh const mesh = make_sheet();
    std::vector<std::uint32_t> const middle = {14, 15, 20, 21};
    welt::Patches const found = mesh.patches(middle);
    that(found.count() == 1, "a rectangle of regular faces is one patch");
    welt_patch const patch = found[0];
    that(patch.face_count == 4 && std::equal(middle.begin(), middle.end(), patch.faces), "faces");
    that(patch.degree_u == 3 && patch.degree_v == 3 && patch.pole_count_u == 5 && patch.pole_count_v == 5, "counts");
    double const knots[] = {0, 0, 0, 0, 1, 2, 2, 2, 2};
    that(std::equal(knots, knots + 9, patch.knots_u) && std::equal(knots, knots + 9, patch.knots_v), "knots");
    for (std::uint32_t j = 0; j < 5; ++j)
        for (std::uint32_t i = 0; i < 5; ++i) {
            double const* const pole = patch.poles + 3 * (5 * j + i);
            double const x = (knots[i + 1] + knots[i + 2] + knots[i + 3]) / 3;
            double const y = (knots[j + 1] + knots[j + 2] + knots[j + 3]) / 3;
            that(std::abs(pole[0] - 2 - x) < 1e-14 && std::abs(pole[1] - 2 - y) < 1e-14 && pole[2] == 0, "poles");
        }
    for (std::uint32_t edge = 0; edge < 4; ++edge)
        that(patch.neighbours[edge] == WELT_NONE && patch.irregular[edge] == 0, "nothing lies beyond");
    that(patch.deviation == 0, "it is exact");
    that(found.report().json().find("\"exact\":1,") != std::string_view::npos, "report");

    welt::PatchOptions options;
    options.most_faces = 3;
    welt::Patches const four = mesh.patches(options);
    that(four.count() == 4, "long rectangles are cut");
    std::size_t shared = 0;
    for (std::size_t number = 0; number < four.count(); ++number)
        for (std::uint32_t edge = 0; edge < 4; ++edge) {
            std::uint32_t const beyond = four[number].neighbours[edge];
            if (beyond == WELT_NONE) continue;
            ++shared;
            welt_patch const other = four[beyond];
            std::uint32_t const there = four[number].neighbour_sides[edge];
            that(other.neighbours[there] == number, "neighbours know each other");
            std::uint32_t const count = edge % 2 ? four[number].pole_count_v : four[number].pole_count_u;
            that(count == (there % 2 ? other.pole_count_v : other.pole_count_u), "as many poles");
            for (std::uint32_t k = 0; k < count; ++k) {
                double const* const own = side_pole(four[number], edge, k);
                that(std::equal(own, own + 3, side_pole(other, there, count - 1 - k)), "the same poles");
            }
        }
    that(shared == 8, "each patch has two neighbours");
    failure(WELT_ERROR_ARGUMENT, [&] { four[4]; });
    options.most_faces = 0;
    failure(WELT_ERROR_ARGUMENT, [&] { mesh.patches(options); });
    options.most_faces = 1;
    options.tolerance = std::nan("");
    failure(WELT_ERROR_ARGUMENT, [&] { mesh.patches(options); });
}

void features() {
    welt::Mesh mesh = make_sheet();
    welt::Selection const marks = mesh.select("ring:2,3");
    that(marks.count() == side + 1 && marks.edges(mesh).vertices.size() == 2 * (side + 1), "marks");
    that(marks.edges(mesh).places[0] == 0.5, "places");
    welt::FeatureOptions options;
    options.fit = WELT_FIT_LOOP;
    welt::Report const report = mesh.apply(marks, "groove", "width=0.3 depth=0.1", options);
    that(report.json().find("\"loop\"") != std::string_view::npos, "options arrive");
    that(mesh.vertex_count() == (side + 1) * (side + 1) + 3 * (side + 1), "three lines of vertices");
    welt::Mesh const flat = make_sheet();
    welt::Mesh::Deviation const deviation = mesh.deviation(flat, 4);
    that(std::abs(deviation.largest - 0.1) < 0.01 && deviation.root_mean_square < 0.1, "as deep as it was asked");
    welt::Mesh::Comparison const compared = mesh.compare(flat, 4, 2);
    that(compared.deviation.largest == deviation.largest && compared.degrees > 5 && compared.degrees < 90, "normals turn");
    that(compared.curvature_largest >= compared.curvature_root_mean_square, "curvature changes");

    welt::Mesh other = make_sheet();
    other.mark(marks);
    welt::Rules const rules = welt::Rules::load(RULES);
    std::vector<welt::Rules::Parameter> const parameters = rules.parameters();
    that(parameters.back().name == "height" && parameters.back().high == 10.0, "parameters");
    that(welt::Rules::linear().parameters().size() + 1 == parameters.size(), "the rules that come with the library");
    other.apply(other.select("ring:2,3"), rules);
    that(welt::feature_list().json().find("groove") != std::string_view::npos, "features");

    welt::Mesh raised = make_sheet();
    raised.displace(std::array<std::uint32_t, 1>{24}, std::array<double, 1>{0.5});
    that(std::abs(raised.limit_positions()[24][2] - 0.5) < 1e-12, "a vertex rises");
    raised.fit(flat.freeze(), WELT_FIT_SOLVE);
    that(std::abs(raised.limit_positions()[24][2]) < 1e-9, "and is fitted back");
    raised.fit(std::array<std::uint32_t, 0>{}, flat.freeze(), WELT_FIT_NONE);
}

void jobs() {
    welt::Mesh mesh = make_sheet();
    welt::Selection const marks = mesh.select("ring:2,3");
    double last = -1.0;
    std::thread::id thread;
    std::vector<std::string> stages;
    welt::Job watched([&](double progress, std::string_view stage) {
        last = progress;
        thread = std::this_thread::get_id();
        stages.emplace_back(stage);
    });
    // An observer stays with its job.
    welt::Job const job = std::move(watched);
    mesh.refine(2, &job);
    that(last == 1.0 && stages.size() == 4 && stages[0] == "refine", "progress");
    that(thread == std::this_thread::get_id(), "the observer is called by the thread that made the call");
    that(job.progress() == 1.0 && job.stage() == "refine", "what the job says");

    std::size_t const before = mesh.vertex_count();
    welt::Job const cancelled;
    cancelled.cancel();
    failure(WELT_ERROR_CANCELLED, [&] { mesh.apply(marks, "groove", "width=0.3 depth=0.1", {}, &cancelled); });
    struct Enough {};
    welt::Job const thrown([](double, std::string_view stage) {
        if (stage == "displace") throw Enough();
    });
    bool caught = false;
    try {
        mesh.apply(marks, "groove", "width=0.3 depth=0.1", {}, &thrown);
    } catch (Enough const&) {
        caught = true;
    }
    that(caught && mesh.vertex_count() == before, "what an observer throws cancels the call and comes out of it");
}

}  // namespace

int main() {
    that(welt::is_compatible() && welt::version() >= WELT_VERSION && welt::version_string() == "0.1.0", "version");
    meshes_come_back_as_they_were_given();
    errors_have_places();
    options_and_files();
    surfaces();
    queries();
    patches();
    features();
    jobs();
    return check::result();
}
