// OpenSubdiv as an oracle: Catmull-Clark or Loop in double precision, with the tags of the polygons.
#pragma once

#include "obj.hpp"

#include <opensubdiv/far/primvarRefiner.h>
#include <opensubdiv/far/topologyDescriptor.h>

#include <memory>

namespace Far = OpenSubdiv::Far;
namespace Sdc = OpenSubdiv::Sdc;
using PrimvarRefiner = Far::PrimvarRefinerReal<double>;

inline std::unique_ptr<Far::TopologyRefiner> make_refiner(Polygons const& polygons, int depth,
                                                          Sdc::SchemeType scheme = Sdc::SCHEME_CATMARK) {
    using Factory = Far::TopologyRefinerFactory<Far::TopologyDescriptor>;
    std::vector<int> const sizes(polygons.sizes.begin(), polygons.sizes.end());
    std::vector<int> const vertices(polygons.vertices.begin(), polygons.vertices.end());
    Far::TopologyDescriptor descriptor;
    descriptor.numVertices = static_cast<int>(polygons.positions.size());
    descriptor.numFaces = static_cast<int>(sizes.size());
    descriptor.numVertsPerFace = sizes.data();
    descriptor.vertIndicesPerFace = vertices.data();
    Tags const& tags = polygons.tags;
    std::vector<int> const creases(tags.crease_vertices.begin(), tags.crease_vertices.end());
    std::vector<int> const corners(tags.corner_vertices.begin(), tags.corner_vertices.end());
    std::vector<int> const holes(tags.holes.begin(), tags.holes.end());
    descriptor.numCreases = static_cast<int>(creases.size() / 2);
    descriptor.creaseVertexIndexPairs = creases.data();
    descriptor.creaseWeights = tags.crease_sharpness.data();
    descriptor.numCorners = static_cast<int>(corners.size());
    descriptor.cornerVertexIndices = corners.data();
    descriptor.cornerWeights = tags.corner_sharpness.data();
    descriptor.numHoles = static_cast<int>(holes.size());
    descriptor.holeIndices = holes.data();
    Sdc::Options options;
    constexpr Sdc::Options::VtxBoundaryInterpolation boundaries[] = {Sdc::Options::VTX_BOUNDARY_NONE,
                                                                     Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER,
                                                                     Sdc::Options::VTX_BOUNDARY_EDGE_ONLY};
    options.SetVtxBoundaryInterpolation(boundaries[tags.boundary]);
    if (tags.chaikin) options.SetCreasingMethod(Sdc::Options::CREASE_CHAIKIN);
    std::unique_ptr<Far::TopologyRefiner> refiner(
        Factory::Create(descriptor, Factory::Options(scheme, options)));
    Far::TopologyRefiner::UniformOptions uniform(depth);
    uniform.fullTopologyInLastLevel = true;
    refiner->RefineUniform(uniform);
    return refiner;
}

// Positions of all levels, level 0 first.
inline std::vector<std::vector<Vector>> refine_positions(Far::TopologyRefiner const& refiner, Polygons const& polygons) {
    std::vector<std::vector<Vector>> levels = {polygons.positions};
    PrimvarRefiner const primvars(refiner);
    for (int level = 1; level <= refiner.GetMaxLevel(); ++level) {
        std::vector<Vector> next(refiner.GetLevel(level).GetNumVertices());
        primvars.Interpolate(level, levels.back(), next);
        levels.push_back(std::move(next));
    }
    return levels;
}

// The vertex of the last level that descends from vertex `v` of the control mesh.
inline int descendant(Far::TopologyRefiner const& refiner, int v) {
    for (int level = 0; level < refiner.GetMaxLevel(); ++level) v = refiner.GetLevel(level).GetVertexChildVertex(v);
    return v;
}
