// A host with little memory: the same work in processes whose address space is bounded, more and more. Each ends with the result,
// with WELT_ERROR_MEMORY, or, where the Rust runtime finds none for a small list, by its abort (docs/trust.md). A file that was
// there is as it was, or whole.

#include "check.hpp"

#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#include <welt.hpp>

namespace {

namespace fs = std::filesystem;

constexpr char const* folder = "memory.folder";
constexpr char const* path = "memory.folder/out.obj";

welt::Mesh sheet(std::uint32_t side) {
    std::vector<welt::Vector> positions;
    std::vector<std::uint32_t> vertices;
    for (std::uint32_t i = 0; i < (side + 1) * (side + 1); ++i)
        positions.push_back({double(i % (side + 1)), double(i / (side + 1)), double(i % 7) / 7});
    for (std::uint32_t i = 0; i < side * side; ++i) {
        std::uint32_t const a = i % side + (side + 1) * (i / side);
        for (std::uint32_t v : {a, a + 1, a + side + 2, a + side + 1}) vertices.push_back(v);
    }
    return welt::Mesh(std::vector<std::uint32_t>(side * side, 4), vertices, positions);
}

// In steps, so that each meets the bound somewhere. The number of the one that found no memory; 0 for none.
int work(char const** message) {
    static char text[256];
    int step = 1;
    try {
        welt::Mesh mesh = welt::Mesh::import_file("memory.obj");
        ++step;
        welt::Mesh const copy = mesh.copy();
        ++step;
        {
            welt::Surface const surface = mesh.freeze();
            ++step;
            std::vector<welt::Vector> const points(100, {3, 4, 5});
            surface.closest(points);
        }
        ++step;
        mesh.apply(mesh.select("ring:30,31"), "groove", "width=0.3 depth=0.1");
        ++step;
        mesh.export_file("memory.folder/mesh.obj");
        ++step;
        mesh.deviation(copy, 2);
        ++step;
        welt::Refinement const refinement = mesh.refine(2);
        ++step;
        refinement.mesh(2).export_file(path);
        return 0;
    } catch (welt::Error const& error) {
        std::snprintf(text, sizeof text, "%s", error.what());
        *message = text;
        return error.code() == WELT_ERROR_MEMORY ? step : 100;
    } catch (std::bad_alloc const&) {
        return 99;  // The program's own.
    }
}

std::string content() {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

// Does something in another process, so that no memory which it frees is left to those after it. How that ends: an exit code, or
// 1000 and the signal.
template <class Work>
int apart(Work const& work) {
    std::fflush(stdout);
    pid_t const child = fork();
    if (child == 0) _exit(work());
    int status = 0;
    waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
}

// How a process with so many bytes of address space ends.
int bounded(rlim_t bytes) {
    return apart([&] {
        // The runtime says there what it could not get.
        if (!std::freopen("memory.folder/runtime.log", "a", stderr)) return 98;
        rlimit const limit = {bytes, bytes}, no_core = {0, 0};
        setrlimit(RLIMIT_CORE, &no_core);
        setrlimit(RLIMIT_AS, &limit);
        char const* message = "";
        int const code = work(&message);
        bool const told = std::strstr(message, "no memory for a list of ") && std::strstr(message, "ask for less, or free memory");
        return code > 0 && code < 90 && !told ? 97 : code;
    });
}

// Bytes of address space that the process has now.
rlim_t used() {
    std::ifstream statm("/proc/self/statm");
    rlim_t pages = 0;
    statm >> pages;
    return pages * rlim_t(sysconf(_SC_PAGESIZE));
}

}  // namespace

int main() {
    if (used() == 0) {
        std::printf("skipped: /proc is absent\n");
        return 77;
    }
    fs::remove_all(folder);
    fs::create_directory(folder);
    apart([] {
        sheet(60).export_file("memory.obj");
        return 0;
    });
    check::that(bounded(RLIM_INFINITY) == 0, "without a bound the work is done");
    std::string const whole = content();
    int done = 0, ended = 0;
    std::map<int, int> told;
    // From 128 KiB to 60 MiB more than there is, each an eighth more than the last.
    for (rlim_t bytes = rlim_t(1) << 17; bytes < rlim_t(60) << 20; bytes += bytes / 8) {
        std::ofstream(path) << "before";
        int const code = bounded(used() + bytes);
        std::string const now = content(), what = std::to_string(bytes >> 10) + " KiB: " + std::to_string(code);
        if (code == 0) {
            ++done;
            check::that(now == whole, what + ": the file is whole");
        } else if (code < 90) {
            ++told[code];
            check::that(now == "before", what + ": the file is as it was");
        } else {
            ++ended;
            check::that(code == 1000 + SIGABRT || code == 99, what);
            check::that(now == "before", what + ": the file is as it was");
        }
    }
    for (auto const& entry : fs::directory_iterator(folder)) {
        std::string const name = entry.path().filename().string();
        bool const left = ended > 0 && name.find(".tmp") != std::string::npos;
        check::that(name == "out.obj" || name == "mesh.obj" || name == "runtime.log" || left, name);
    }
    char const* const steps[] = {"",          "reading", "a copy",      "a surface",    "a query",
                                 "a feature", "writing", "a deviation", "a refinement", "a level as a file"};
    int errors = 0;
    for (auto const& [step, count] : told) {
        errors += count;
        std::printf("  %s: %d times WELT_ERROR_MEMORY\n", steps[step], count);
    }
    std::printf("%d runs: %d done, %d times WELT_ERROR_MEMORY, %d aborted\n", done + errors + ended, done, errors, ended);
    check::that(done > 0 && errors > 5 && told.size() > 2, "bounds of all kinds were met");
    fs::remove_all(folder);
    return check::result();
}
