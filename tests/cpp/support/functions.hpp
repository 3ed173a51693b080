// Every function of the C ABI with arguments that fit, so that a test can spoil one of them, or strike while it runs.
#pragma once

#include <welt.h>

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

// A handle of each kind and what a call writes. Handles are made when they are first asked for.
class World {
public:
    World();
    ~World();
    World(World const&) = delete;
    World& operator=(World const&) = delete;

    // A bent sheet of quads; one that is bent otherwise; a tetrahedron.
    welt_mesh*& mesh();
    welt_mesh* second();
    welt_mesh* triangles();
    welt_selection*& selection();
    welt_rules*& rules();
    welt_surface*& surface();
    // Of the tetrahedron.
    welt_surface* closed();
    welt_patches*& patches();
    welt_refinement*& refinement();
    welt_report*& report();
    welt_error*& failure();
    welt_job*& job();
    welt_import_options* import_options();
    welt_feature_options* feature_options();
    welt_batch_options* batch_options();
    welt_patch_options* patch_options();

    // All that a call may have changed, as bytes; reports are left out, since they have times.
    std::string content() const { return handles() + buffers(); }
    std::string handles() const;
    std::string buffers() const;
    // Whether a call has written a handle.
    bool has_result() const;

    // Where calls write. The buffers are large enough for each of them.
    struct {
        welt_mesh* mesh = nullptr;
        welt_selection* selection = nullptr;
        welt_rules* rules = nullptr;
        welt_surface* surface = nullptr;
        welt_patches* patches = nullptr;
        welt_refinement* refinement = nullptr;
        welt_report* report = nullptr;
        welt_job* job = nullptr;
        welt_error* error = nullptr;
        double const* doubles_view = nullptr;
        std::uint32_t const* integers_view = nullptr;
        std::vector<double> doubles, more_doubles;
        std::vector<std::uint32_t> integers, more_integers;
        std::vector<std::size_t> places;
        std::vector<welt_surface_point> points;
        std::vector<char> text;
        welt_patch patch = {};
        // No part of the content: a call that has too little room writes it as well.
        std::size_t needed = 0;
    } out;

    // Arrays that calls read.
    std::vector<std::uint32_t> sizes, corners;
    std::vector<double> positions, moved;
    welt_surface_point starts[2] = {};

private:
    std::vector<welt_mesh*> meshes_;
    welt_selection* selection_ = nullptr;
    welt_rules* rules_ = nullptr;
    welt_surface* surface_ = nullptr;
    welt_surface* closed_ = nullptr;
    welt_patches* patches_ = nullptr;
    welt_refinement* refinement_ = nullptr;
    welt_report* report_ = nullptr;
    welt_error* failure_ = nullptr;
    welt_job* job_ = nullptr;
    welt_import_options import_options_;
    welt_feature_options feature_options_;
    welt_batch_options batch_options_;
    welt_patch_options patch_options_;
};

// How a call differs from one that succeeds.
struct Change {
    // Number of the pointer argument that becomes NULL, from 0.
    int null = -1;
    // Number of the integer argument that gets another value, and how it comes from the right one.
    int integer = -1;
    std::function<std::uint64_t(std::uint64_t right, std::uint64_t largest)> value;
    // Runs when the arguments are ready.
    std::function<void()> before;
};

struct Function {
    std::string name;
    // One character per pointer argument: r: required, o: optional, f: freed, which NULL may be, too.
    std::string pointers;
    int integers = 0;
    bool has_status = false, has_error = false, has_job = false;
    // Whether it reads or changes World::mesh().
    bool reads_mesh = false, changes_mesh = false;
    // The status; WELT_OK where there is none. Text that is NULL counts as WELT_ERROR_INTERNAL.
    std::function<std::int32_t(World&, Change const&)> call;
};

// One entry per function of the header.
std::vector<Function> const& functions();

// What the positions, faces and sharpness of a mesh say, as bytes; "poisoned" where it is.
std::string content_of(welt_mesh const* mesh);
