// Comparison of two sets of points without numbering in common.
#pragma once

#include "vector.hpp"

// The largest distance from a point of one set to the nearest of the other, both ways; infinity where some point has
// none within `reach`.
double set_distance(std::vector<Vector> const& a, std::vector<Vector> const& b, double reach);
