// SPDX-License-Identifier: GPL-3.0-or-later
// Which edges a feature crosses: from what is selected in the layer, or from selectors.
#pragma once

#include "polygons.hpp"

#include <algorithm>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>

enum Marks { SelectedVertices, SelectedFaces, SelectedEdges, SelectedRings, Selectors };

// The marked edges.
inline welt::Selection marks_of(welt::Mesh const& mesh, PolygonMesh const& polygons, RichParameterList const& parameters) {
    auto const list = [](std::set<std::uint32_t> const& vertices) {
        std::string text;
        for (std::uint32_t const vertex : vertices) text += (text.empty() ? "cut:" : ",") + std::to_string(vertex);
        return text;
    };
    std::string text;
    char const* what = "vertices";
    int const marks = parameters.getEnum("marks");
    switch (marks) {
        case SelectedVertices: text = list(polygons.selected); break;
        case SelectedFaces:
            text = list(polygons.of_selected_faces);
            what = "faces";
            break;
        case SelectedEdges:
        case SelectedRings: {
            what = "edges";
            std::set<std::pair<std::uint32_t, std::uint32_t>> covered;
            for (auto const& edge : polygons.selected_edges) {
                if (covered.count(edge)) continue;
                std::string const ends = std::to_string(edge.first) + "," + std::to_string(edge.second);
                if (marks == SelectedRings) {
                    auto const ring = mesh.select("ring:" + ends).edges(mesh).vertices;
                    for (std::size_t i = 0; i + 1 < ring.size(); i += 2) covered.insert(std::minmax(ring[i], ring[i + 1]));
                }
                text += (marks == SelectedRings ? " ring:" : " edge:") + ends;
            }
            break;
        }
        case Selectors:
            text = parameters.getString("selectors").trimmed().toStdString();
            if (text.empty()) throw std::runtime_error("selectors is empty: name edges, for example by ring:3,331");
            break;
        default: throw std::runtime_error("marks is a number from 0 to 4");
    }
    if (text.empty())
        throw std::runtime_error(std::string("no ") + what + " are selected: select some, or set marks to what is selected");
    return mesh.select(text);
}

// What is selected in a layer, which is what the user means.
inline Marks selected_in(CMeshO const& cm) {
    for (auto const& vertex : cm.vert)
        if (!vertex.IsD() && vertex.IsS()) return SelectedVertices;
    bool edges = false;
    for (auto const& face : cm.face) {
        if (face.IsD()) continue;
        if (face.IsS()) return SelectedFaces;
        edges = edges || face.IsFaceEdgeS(0) || face.IsFaceEdgeS(1) || face.IsFaceEdgeS(2);
    }
    return edges ? SelectedEdges : SelectedVertices;
}

inline void add_marks(MeshDocument const& document, RichParameterList& list) {
    list.addParam(RichEnum(
        "marks", document.mm() ? selected_in(document.mm()->cm) : SelectedVertices,
        QStringList{"edges that leave the selected vertices", "edges that leave the selected faces", "selected edges",
                    "rings through the selected edges", "selectors"},
        "Marks",
        "Which edges the feature crosses. It runs round the selected vertices or faces; or over the selected edges (Select "
        "Crease Edges selects some), or over all edges that a loop cut from them would cross; or over those that the "
        "selectors below name."));
    list.addParam(RichString("selectors", "", "Selectors",
                             "Where marks is set to selectors: edge:A,B ring:A,B path:A,B:C,D cut:V,V,... with numbers of "
                             "vertices, counted from 0 (Render, Show Labels shows them); several separated by blanks."));
}
