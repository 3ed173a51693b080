// A reader of `v` and `f` lines, independent of the library under test. Tags (creases, corners, holes, ...) and
// everything else are left out.
#pragma once

#include "vector.hpp"

#include <cstdint>
#include <string>
#include <vector>

struct Polygons {
    std::vector<Vector> positions;
    std::vector<std::uint32_t> sizes;
    std::vector<std::uint32_t> vertices;
};

// Throws std::runtime_error when the file cannot be read.
Polygons read_obj(std::string const& path);
