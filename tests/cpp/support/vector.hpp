// Three doubles, in the form in which OpenSubdiv combines values.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

struct Vector {
    double x = 0, y = 0, z = 0;

    void Clear(void* = nullptr) { *this = Vector(); }
    void AddWithWeight(Vector const& other, double weight) {
        x += weight * other.x;
        y += weight * other.y;
        z += weight * other.z;
    }
};

inline Vector operator-(Vector a, Vector b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vector operator+(Vector a, Vector b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vector operator*(Vector a, double d) { return {a.x * d, a.y * d, a.z * d}; }
inline double dot(Vector a, Vector b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vector operator/(Vector a, double d) { return {a.x / d, a.y / d, a.z / d}; }
inline Vector cross(Vector a, Vector b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double length(Vector a) { return std::sqrt(a.x * a.x + a.y * a.y + a.z * a.z); }
inline double distance(Vector a, Vector b) { return length(a - b); }

// Diagonal of the bounding box.
inline double size_of(std::vector<Vector> const& points) {
    if (points.empty()) return 0;
    Vector low = points[0], high = points[0];
    for (Vector p : points) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    return distance(low, high);
}
