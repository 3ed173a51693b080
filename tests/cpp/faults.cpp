// A panic or a cancellation at the places of every function, in the library with fault injection: the documented error,
// what was being changed is as it was before or poisoned, and everything else can still be used. Cancellations come at every
// place, panics at the first hundred and then at every sixteenth part further; `faults all` takes every one.

#include "check.hpp"
#include "functions.hpp"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <set>

// See src/ffi/fault.rs.
extern "C" std::int32_t welt_fault_arm(std::uint32_t kind, std::uint64_t n);

namespace {

constexpr std::uint32_t panic = 1, cancel = 2;

// The call's arguments are ready when the fault is armed, so that it strikes in the call alone.
struct Strike {
    std::int32_t status = 0;
    bool struck = false;
    std::string handles, buffers;
    std::string before() const { return handles + buffers; }
};

Strike strike(Function const& function, World& world, std::uint32_t kind, std::uint64_t n) {
    Strike result;
    world.second();
    Change change;
    change.before = [&] {
        result.handles = world.handles();
        result.buffers = world.buffers();
        welt_fault_arm(kind, n);
    };
    result.status = function.call(world, change);
    result.struck = welt_fault_arm(0, 0) == 0;
    return result;
}

// What the call leaves when nothing strikes.
struct Reference {
    std::string handles, buffers;
    bool operator==(World const& world) const { return world.handles() == handles && world.buffers() == buffers; }
};

Reference reference(Function const& function) {
    World world;
    world.second();
    function.call(world, {});
    return {world.handles(), world.buffers()};
}

// Not after every place: it costs as much as the call.
bool tries_again(std::uint64_t n) { return n < 16 || n % 16 == 0; }

// Places one by one, then in growing steps: what comes often, comes in loops. Few of them where a checker of memory watches.
enum class Places { few, sample, all } places = Places::sample;
std::uint64_t next(std::uint64_t n) {
    switch (places) {
    case Places::few: return 2 * n + n / 2;
    case Places::sample: return n < 100 ? n + 1 : n + n / 16;
    default: return n + 1;
    }
}

// Each byte is as it was before, or as a call that succeeds writes it.
bool written_in_part(std::string const& now, std::string const& before, std::string const& expected) {
    for (std::size_t i = 0; i < now.size(); ++i)
        if (now[i] != before[i] && now[i] != expected[i]) return false;
    return true;
}

void other_handles_work(World& world, std::string const& what) {
    static std::string const expected = content_of(World().second());
    check::that(content_of(world.second()) == expected, what + ": another mesh");
    welt_rules* rules = nullptr;
    check::that(welt_rules_linear(&rules, nullptr) == WELT_OK, what + ": a new handle");
    welt_rules_free(rules);
}

// A poisoned mesh says so whatever it is asked, and can be freed: the world does.
void is_poisoned(welt_mesh* mesh, std::string const& what) {
    double positions[3] = {0, 0, 0};
    double const* view = nullptr;
    check::that(welt_mesh_positions(mesh, &view, nullptr) == WELT_ERROR_POISONED && !view, what + ": it is not read");
    check::that(welt_mesh_set_positions(mesh, positions, 1, 0, nullptr) == WELT_ERROR_POISONED, what + ": nor changed");
    check::that(welt_mesh_vertex_count(mesh) == 0, what + ": it has no size");
}

std::set<std::string> stages;
std::map<std::string, int> outcomes;

// Panics at the n-th place; false when the call has fewer.
bool panics(Function const& function, Reference const& expected, std::uint64_t n) {
    std::string const what = function.name + ", place " + std::to_string(n);
    World world;
    Strike const call = strike(function, world, panic, n);
    if (!call.struck) {
        check::that(call.status == WELT_OK && expected == world, what + ": the call succeeds at last");
        return false;
    }
    ++outcomes["panics"];
    if (!function.has_status) return true;
    check::that(call.status == WELT_ERROR_INTERNAL, what + ": status " + std::to_string(call.status));
    if (function.has_error) {
        std::string const message = welt_error_message(world.out.error);
        std::string const head = "internal error: injected fault in stage ";
        check::that(message.compare(0, head.size(), head) == 0, what + ": " + message);
        stages.insert(message.substr(head.size(), message.find(';') - head.size()));
    }
    check::that(!world.has_result(), what + ": a result was written");
    other_handles_work(world, what);
    if (function.changes_mesh && content_of(world.mesh()) == "poisoned") {
        ++outcomes["poisoned"];
        is_poisoned(world.mesh(), what);
        return true;
    }
    check::that(world.handles() == call.handles, what + ": something was changed");
    check::that(written_in_part(world.buffers(), call.buffers, expected.buffers), what + ": a buffer was spoilt");
    if (world.buffers() != call.buffers) ++outcomes["in part"];
    if (function.changes_mesh) ++outcomes["as before"];
    welt_error_free(world.out.error);
    world.out.error = nullptr;
    // Once more, undisturbed.
    if (!tries_again(n)) return true;
    check::that(function.call(world, {}) == WELT_OK && expected == world, what + ": it works again");
    return true;
}

void a_panic_at_every_place() {
    for (Function const& function : functions()) {
        Reference const expected = reference(function);
        std::uint64_t n = 1;
        while (panics(function, expected, n)) n = next(n);
        if (places == Places::all) {
            std::printf("  %s: %ld places\n", function.name.c_str(), long(n - 1));
            std::fflush(stdout);
        }
    }
    std::printf("%d panics; meshes: %d poisoned, %d as before; buffers: %d written in part\n", outcomes["panics"],
                outcomes["poisoned"], outcomes["as before"], outcomes["in part"]);
    if (places == Places::few) return;
    check::that(outcomes["poisoned"] > 50 && outcomes["as before"] > 5, "both outcomes occur");
    check::that(outcomes["in part"] > 0, "some calls write as they go");
    for (char const* stage : {"entry", "read", "build", "refine", "limit", "freeze", "evaluate", "query", "mark", "rules", "fit",
                              "displace", "deviation", "report", "write", "positions", "sharpness", "holes"})
        check::that(stages.count(stage) == 1, std::string("no panic in stage ") + stage);
    for (std::string const& stage : stages) std::printf("  %s\n", stage.c_str());
}

// Closest points are looked for where surfaces are far apart.
void a_panic_at_a_closest_point() {
    World world;
    welt_mesh const* const mesh = world.mesh();
    welt_mesh const* const far = world.triangles();
    std::string message;
    for (std::uint64_t n = 1; message.find("stage closest") == std::string::npos; ++n) {
        double values[3] = {-1, -1, -1};
        welt_error* error = nullptr;
        welt_fault_arm(panic, n);
        std::int32_t const status = welt_mesh_deviation(mesh, far, 1, values, nullptr, &error);
        bool const struck = welt_fault_arm(0, 0) == 0;
        message = welt_error_message(error);
        welt_error_free(error);
        check::that(struck && status == WELT_ERROR_INTERNAL && values[0] == -1, "a panic at a closest point");
        if (!struck) return;
    }
}

void a_cancellation_at_every_poll() {
    int with_job = 0;
    for (Function const& function : functions()) {
        if (!function.has_job) continue;
        ++with_job;
        Reference const expected = reference(function);
        std::uint64_t n = 1;
        for (;; n = places == Places::few ? next(n) : n + 1) {
            std::string const what = function.name + ", poll " + std::to_string(n);
            World world;
            Strike const call = strike(function, world, cancel, n);
            if (!call.struck) {
                check::that(call.status == WELT_OK && expected == world, what + ": the call succeeds at last");
                break;
            }
            check::that(call.status == WELT_ERROR_CANCELLED, what + ": status " + std::to_string(call.status));
            check::that(world.content() == call.before() && !world.has_result(), what + ": something was changed");
            welt_error_free(world.out.error);
            world.out.error = nullptr;
            if (!tries_again(n)) continue;
            // With a new job.
            welt_job_free(world.job());
            world.job() = nullptr;
            check::that(function.call(world, {}) == WELT_OK && expected == world, what + ": it works again");
        }
        std::printf("  %s: %ld polls\n", function.name.c_str(), long(n - 1));
        check::that(n > 2, function.name + " looks at its job");
    }
    check::that(with_job >= 6, "functions with a job");
}

// Every function that takes a mesh, with one that is poisoned: the sheet, or the triangles where Loop's rules ask for them.
void poisoned_handles_are_refused() {
    int refused = 0;
    for (Function const& function : functions()) {
        if (!function.reads_mesh && !function.changes_mesh) continue;
        World world;
        Change change;
        change.before = [&] {
            for (welt_mesh* mesh : {world.mesh(), world.triangles()}) {
                welt_fault_arm(panic, 2);
                welt_mesh_set_subdivision(mesh, WELT_BOUNDARY_NONE, WELT_CREASING_UNIFORM, nullptr);
                welt_fault_arm(0, 0);
            }
        };
        std::int32_t const status = function.call(world, change);
        if (function.has_status) {
            ++refused;
            check::that(status == WELT_ERROR_POISONED, function.name + " and a poisoned mesh: " + std::to_string(status));
            check::that(!world.has_result(), function.name + " and a poisoned mesh: a result was written");
        }
        if (function.pointers != "f") is_poisoned(world.mesh(), function.name);
        is_poisoned(world.triangles(), function.name);
    }
    check::that(refused >= 20, "functions that take a mesh");
}

std::string text_of(std::filesystem::path const& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

// A file is as it was before, and no other one lies beside it.
void a_panic_while_writing() {
    namespace fs = std::filesystem;
    fs::path const folder = "faults.folder";
    for (char const* name : {"out.obj", "out.ply"}) {
        std::uint64_t n = 1;
        for (;; ++n) {
            World world;
            fs::remove_all(folder);
            fs::create_directory(folder);
            fs::path const path = folder / name;
            std::ofstream(path) << "before";
            welt_mesh const* const mesh = world.mesh();
            welt_fault_arm(panic, n);
            std::int32_t const status = welt_mesh_export_file(mesh, path.string().c_str(), SIZE_MAX, nullptr);
            if (welt_fault_arm(0, 0) == 1) break;
            check::that(status == WELT_ERROR_INTERNAL, "a panic while writing");
            check::that(text_of(path) == "before", "the file is as it was before");
            check::that(std::distance(fs::directory_iterator(folder), {}) == 1, "no temporary file is left");
        }
        check::that(n > 2 && text_of(folder / name).size() > 100, "the file is written at last");
    }
    fs::remove_all(folder);
}

}  // namespace

// "few" tries few of the places, "all" every one, which takes long.
int main(int argc, char** argv) {
    std::string const wish = argc > 1 ? argv[1] : "";
    places = wish == "few" ? Places::few : wish == "all" ? Places::all : Places::sample;
    a_panic_at_every_place();
    a_panic_at_a_closest_point();
    a_cancellation_at_every_poll();
    poisoned_handles_are_refused();
    a_panic_while_writing();
    return check::result();
}
