// SPDX-License-Identifier: GPL-3.0-or-later
// MeshLab keeps a polygon as triangles whose common sides are "faux". Here they become polygons for the library, and back.
#pragma once

#include "host.hpp"

#include <welt.hpp>

#include <vcg/complex/algorithms/update/bounding.h>
#include <vcg/complex/algorithms/update/normal.h>
#include <vcg/complex/algorithms/update/selection.h>

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <set>
#include <stdexcept>
#include <unordered_map>
#include <utility>
#include <vector>

struct PolygonMesh {
    std::vector<std::uint32_t> sizes, vertices;
    std::vector<welt::Vector> positions;
    // What is selected: vertices, vertices of selected faces, and edges by their vertices.
    std::set<std::uint32_t> selected, of_selected_faces;
    std::set<std::pair<std::uint32_t, std::uint32_t>> selected_edges;
};

namespace detail {

// The sides of all triangles by the vertices they run between, from the lesser number to the greater.
using Sides = std::unordered_map<std::uint64_t, std::vector<std::pair<std::uint32_t, int>>>;

inline std::uint64_t key(std::uint32_t a, std::uint32_t b) {
    return std::uint64_t(std::min(a, b)) << 32 | std::max(a, b);
}

inline std::uint32_t root(std::vector<std::uint32_t>& parents, std::uint32_t i) {
    while (parents[i] != i) i = parents[i] = parents[parents[i]];
    return i;
}

// Walks round the outer sides of a group of triangles, from the first vertex of its first triangle.
inline void append_polygon(PolygonMesh& mesh, std::vector<std::pair<std::uint32_t, std::uint32_t>> const& outer,
                           std::size_t triangles, std::uint32_t start, std::size_t first_triangle) {
    std::unordered_map<std::uint32_t, std::uint32_t> next(outer.begin(), outer.end());
    std::size_t const begin = mesh.vertices.size();
    std::uint32_t vertex = start;
    do {
        mesh.vertices.push_back(vertex);
        auto const side = next.find(vertex);
        if (side == next.end()) break;
        vertex = side->second;
        next.erase(side);
    } while (vertex != start);
    std::size_t const size = mesh.vertices.size() - begin;
    // Of a polygon without holes and without vertices inside.
    if (size != outer.size() || size != triangles + 2 || vertex != start)
        throw std::runtime_error("the triangles that faux edges join to triangle " + std::to_string(first_triangle) +
                                 " are no polygon; run 'Turn into a Pure-Triangular mesh' first, or mend the faces there");
    mesh.sizes.push_back(std::uint32_t(size));
}

}  // namespace detail

// Reads a layer. Vertices and faces that were deleted leave it for good; polygons are in the order of their first triangles.
// A side that is faux on both of exactly two triangles joins them, every other one is an edge.
inline PolygonMesh polygons_of(CMeshO& cm) {
    vcg::tri::Allocator<CMeshO>::CompactEveryVector(cm);
    PolygonMesh mesh;
    for (std::size_t i = 0; i < cm.vert.size(); ++i) {
        auto const& p = cm.vert[i].cP();
        mesh.positions.push_back({double(p[0]), double(p[1]), double(p[2])});
        if (cm.vert[i].IsS()) mesh.selected.insert(std::uint32_t(i));
    }

    auto const corner = [&](std::size_t face, int i) { return std::uint32_t(vcg::tri::Index(cm, cm.face[face].V(i % 3))); };
    detail::Sides sides;
    for (std::size_t f = 0; f < cm.face.size(); ++f)
        for (int i = 0; i < 3; ++i) sides[detail::key(corner(f, i), corner(f, i + 1))].push_back({std::uint32_t(f), i});
    std::vector<std::uint32_t> parents(cm.face.size());
    std::iota(parents.begin(), parents.end(), 0);
    auto const joins = [&](std::vector<std::pair<std::uint32_t, int>> const& side) {
        return side.size() == 2 && cm.face[side[0].first].IsF(side[0].second) && cm.face[side[1].first].IsF(side[1].second) &&
               corner(side[0].first, side[0].second) == corner(side[1].first, side[1].second + 1);
    };
    for (auto const& entry : sides)
        if (joins(entry.second)) {
            std::uint32_t const a = detail::root(parents, entry.second[0].first);
            std::uint32_t const b = detail::root(parents, entry.second[1].first);
            parents[std::max(a, b)] = std::min(a, b);
        }

    // A group's root is its first triangle.
    std::vector<std::vector<std::uint32_t>> groups(cm.face.size());
    for (std::size_t f = 0; f < cm.face.size(); ++f) groups[detail::root(parents, std::uint32_t(f))].push_back(std::uint32_t(f));
    for (std::size_t f = 0; f < groups.size(); ++f) {
        if (groups[f].empty()) continue;
        std::vector<std::pair<std::uint32_t, std::uint32_t>> outer;
        bool selected = false;
        for (std::uint32_t const triangle : groups[f]) {
            selected = selected || cm.face[triangle].IsS();
            for (int i = 0; i < 3; ++i) {
                std::uint32_t const a = corner(triangle, i), b = corner(triangle, i + 1);
                if (joins(sides[detail::key(a, b)])) continue;
                outer.push_back({a, b});
                if (cm.face[triangle].IsFaceEdgeS(i)) mesh.selected_edges.insert({std::min(a, b), std::max(a, b)});
            }
        }
        std::size_t const begin = mesh.vertices.size();
        if (groups[f].size() == 1)
            for (int i = 0; i < 3; ++i) mesh.vertices.push_back(corner(f, i));
        if (groups[f].size() == 1)
            mesh.sizes.push_back(3);
        else
            detail::append_polygon(mesh, outer, groups[f].size(), corner(f, 0), f);
        if (selected) mesh.of_selected_faces.insert(mesh.vertices.begin() + std::ptrdiff_t(begin), mesh.vertices.end());
    }
    return mesh;
}

// Gives a layer other faces and positions. Its vertices keep their numbers and what is stored on them, new ones follow;
// what is stored on faces is gone with the faces. edges: whether MeshLab shows the edges of the polygons.
inline void write_back(MeshModel& layer, welt::View<welt::Vector> positions, welt::View<std::uint32_t> sizes,
                       welt::View<std::uint32_t> vertices, bool edges) {
    using Allocator = vcg::tri::Allocator<CMeshO>;
    CMeshO& cm = layer.cm;
    layer.clearDataMask(MeshModel::MM_FACEFACETOPO | MeshModel::MM_VERTFACETOPO | MeshModel::MM_WEDGTEXCOORD |
                        MeshModel::MM_FACECOLOR | MeshModel::MM_FACEQUALITY | MeshModel::MM_FACECURVDIR);
    for (auto& face : cm.face) Allocator::DeleteFace(cm, face);
    Allocator::CompactFaceVector(cm);
    vcg::tri::UpdateSelection<CMeshO>::VertexClear(cm);
    if (positions.size() > cm.vert.size()) Allocator::AddVertices(cm, positions.size() - cm.vert.size());
    for (std::size_t i = 0; i < positions.size(); ++i)
        cm.vert[i].P() = CMeshO::CoordType(CMeshO::ScalarType(positions[i][0]), CMeshO::ScalarType(positions[i][1]),
                                           CMeshO::ScalarType(positions[i][2]));

    std::uint32_t const* v = vertices.begin();
    for (std::uint32_t const size : sizes) {
        auto const triangle = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) -> CMeshO::FaceType& {
            return *Allocator::AddFace(cm, v[a], v[b], v[c]);
        };
        if (size == 4) {
            // The two triangles that MeshLab takes for a quad.
            triangle(0, 1, 2).SetF(2);
            triangle(2, 3, 0).SetF(2);
        } else {
            for (std::uint32_t i = 1; i + 1 < size; ++i) {
                auto& face = triangle(0, i, i + 1);
                if (i > 1) face.SetF(0);
                if (i + 2 < size) face.SetF(2);
            }
        }
        v += size;
    }
    if (edges) layer.updateDataMask(MeshModel::MM_POLYGONAL);
    vcg::tri::UpdateBounding<CMeshO>::Box(cm);
    vcg::tri::UpdateNormal<CMeshO>::PerFaceNormalized(cm);
    vcg::tri::UpdateNormal<CMeshO>::PerVertexAngleWeighted(cm);
}
