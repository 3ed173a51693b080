// OpenSubdiv as an oracle: Catmull-Clark in double precision, boundary "edge only", no creases.
#pragma once

#include "obj.hpp"

#include <opensubdiv/far/primvarRefiner.h>
#include <opensubdiv/far/topologyDescriptor.h>

#include <memory>

namespace Far = OpenSubdiv::Far;
namespace Sdc = OpenSubdiv::Sdc;
using PrimvarRefiner = Far::PrimvarRefinerReal<double>;

inline std::unique_ptr<Far::TopologyRefiner> make_refiner(Polygons const& polygons, int depth) {
    using Factory = Far::TopologyRefinerFactory<Far::TopologyDescriptor>;
    std::vector<int> const sizes(polygons.sizes.begin(), polygons.sizes.end());
    std::vector<int> const vertices(polygons.vertices.begin(), polygons.vertices.end());
    Far::TopologyDescriptor descriptor;
    descriptor.numVertices = static_cast<int>(polygons.positions.size());
    descriptor.numFaces = static_cast<int>(sizes.size());
    descriptor.numVertsPerFace = sizes.data();
    descriptor.vertIndicesPerFace = vertices.data();
    Sdc::Options options;
    options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
    std::unique_ptr<Far::TopologyRefiner> refiner(
        Factory::Create(descriptor, Factory::Options(Sdc::SCHEME_CATMARK, options)));
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
