// The library under test in the terms of the tests: their polygons and vectors in, those out. All throw welt::Error.
#pragma once

#include "obj.hpp"

#include <welt.hpp>

using welt::Mesh;

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
