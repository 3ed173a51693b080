// A reader of `v`, `f` and `t` lines, independent of the library under test. Everything else is left out.
#pragma once

#include "vector.hpp"

#include <cstdint>
#include <string>
#include <vector>

// What the `t` lines say: creases, corners, holes and options. Edits and face-varying rules are left out.
struct Tags {
    std::vector<std::uint32_t> crease_vertices;  // two per edge
    std::vector<float> crease_sharpness;
    std::vector<std::uint32_t> corner_vertices;
    std::vector<float> corner_sharpness;
    std::vector<std::uint32_t> holes;
    int boundary = 2;  // 0 none, 1 edge and corner, 2 edge only
    bool chaikin = false;
};
bool operator==(Tags const& a, Tags const& b);

struct Polygons {
    std::vector<Vector> positions;
    std::vector<std::uint32_t> sizes;
    std::vector<std::uint32_t> vertices;
    Tags tags;
};

// Throws std::runtime_error when the file cannot be read. Without `with_tags` the tags stay as for a file that has none.
Polygons read_obj(std::string const& path, bool with_tags = false);
