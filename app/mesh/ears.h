// Cuts faces with many corners into triangles.
#pragma once

#include <array>
#include <cmath>
#include <vector>

namespace dihaptic::mesh {

using Corner = std::array<double, 3>;
using Indices = std::array<size_t, 3>;  ///< indices of three corners of a face

inline Corner cross(const Corner& o, const Corner& a, const Corner& b) {
    const Corner u{a[0] - o[0], a[1] - o[1], a[2] - o[2]};
    const Corner v{b[0] - o[0], b[1] - o[1], b[2] - o[2]};
    return {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
}

inline double dot(const Corner& a, const Corner& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// Cuts a face by ear clipping. An ear is a corner whose triangle has the same orientation as the
/// face and contains no other corner. Corners may be collinear. The widest ear is cut each time; if
/// there is no ear, the next corner is cut, so that the triangles of any face join along edges.
inline std::vector<Indices> ears(const std::vector<Corner>& face) {
    Corner normal{};
    for (size_t i = 1; i + 1 < face.size(); ++i) {
        const Corner n = cross(face[0], face[i], face[i + 1]);
        for (size_t k = 0; k < 3; ++k) normal[k] += n[k];
    }
    const auto turn = [&](size_t a, size_t b, size_t c) {
        return dot(normal, cross(face[a], face[b], face[c]));
    };
    std::vector<size_t> left;
    for (size_t i = 0; i < face.size(); ++i) left.push_back(i);
    std::vector<Indices> out;
    while (left.size() > 2) {
        size_t best = 1;
        double most = 0;
        for (size_t i = 0; i < left.size(); ++i) {
            const size_t a = left[(i + left.size() - 1) % left.size()];
            const size_t b = left[i];
            const size_t c = left[(i + 1) % left.size()];
            const double area = turn(a, b, c);
            if (area <= most) continue;
            bool is_ear = true;
            for (const size_t p : left) {
                const bool is_apart = p == a || p == b || p == c || turn(a, b, p) < 0 ||
                                      turn(b, c, p) < 0 || turn(c, a, p) <= 1e-12 * area;
                is_ear = is_ear && is_apart;
            }
            if (!is_ear) continue;
            best = i;
            most = area;
        }
        const size_t n = left.size();
        out.push_back({left[(best + n - 1) % n], left[best % n], left[(best + 1) % n]});
        left.erase(left.begin() + static_cast<std::ptrdiff_t>(best % n));
    }
    return out;
}

}  // namespace dihaptic::mesh
