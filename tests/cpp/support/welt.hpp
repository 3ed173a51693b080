// Owning handles of the C ABI, and arrays in place of pointers and counts.
#pragma once

#include "obj.hpp"

#include <welt.h>

#include <memory>
#include <stdexcept>

struct Free {
    void operator()(welt_mesh* mesh) const { welt_mesh_free(mesh); }
    void operator()(welt_surface* surface) const { welt_surface_free(surface); }
    void operator()(welt_refinement* refinement) const { welt_refinement_free(refinement); }
};
using Surface = std::unique_ptr<welt_surface, Free>;
using Mesh = std::unique_ptr<welt_mesh, Free>;
using Refinement = std::unique_ptr<welt_refinement, Free>;

// The polygons are no surface.
struct Refused : std::runtime_error {
    using std::runtime_error::runtime_error;
};

// One level of a refinement.
struct Level {
    std::vector<Vector> positions;
    std::vector<std::uint32_t> face_vertices;
    // Face of the level before and its corner, per face; empty on level 0.
    std::vector<std::uint32_t> parent_faces, parent_corners;
};

// A point of the limit surface and its derivatives.
struct Jet {
    Vector position, du, dv, duu, duv, dvv;
};

// Throws Refused for WELT_ERROR_MESH, std::runtime_error for every other failure, as do the functions below.
Mesh make_mesh(Polygons const& polygons);
std::vector<Level> refine(Mesh const& mesh, unsigned depth);
// One level of Loop subdivision.
Mesh refine_loop(Mesh const& mesh);
// Positions of the vertices, and the two vertices of each edge.
std::vector<Vector> positions_of(Mesh const& mesh);
std::vector<std::uint32_t> edges_of(Mesh const& mesh);
struct LoopLimit {
    std::vector<Vector> positions, normals;
};
LoopLimit loop_limit(Mesh const& mesh);
// Parameters are two per point.
std::vector<Jet> evaluate(Mesh const& mesh, std::vector<std::uint32_t> const& faces,
                          std::vector<std::uint32_t> const& corners, std::vector<double> const& parameters);
// The same on the Loop surface of a triangle mesh.
std::vector<Jet> evaluate_loop(Mesh const& mesh, std::vector<std::uint32_t> const& faces,
                               std::vector<double> const& parameters);
std::vector<Vector> limit_positions(Mesh const& mesh);
std::vector<Vector> limit_normals(Mesh const& mesh);
