// Computes how deep two boxes overlap from their shapes alone, to check collision detection.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/geometry.h"

namespace dihaptic {

/// Overlap of two boxes, each given by half its size: the smallest over their 15 separating axes;
/// negative: apart [m].
inline double box_overlap(const Vec3& half_a, const Pose& X_WA, const Vec3& half_b,
                          const Pose& X_WB) {
    const Mat3 A = X_WA.R.toRotationMatrix();
    const Mat3 B = X_WB.R.toRotationMatrix();
    const Vec3 apart = X_WB.p - X_WA.p;
    double least = std::numeric_limits<double>::infinity();
    const auto along = [&](const Vec3& axis) {
        const double length = axis.norm();
        if (length < 1e-6) return;
        const Vec3 n = axis / length;
        const double reach =
            half_a.dot((A.transpose() * n).cwiseAbs()) + half_b.dot((B.transpose() * n).cwiseAbs());
        least = std::min(least, reach - std::abs(apart.dot(n)));
    };
    for (int i = 0; i < 3; ++i) {
        along(A.col(i));
        along(B.col(i));
        for (int j = 0; j < 3; ++j) along(A.col(i).cross(B.col(j)));
    }
    return least;
}

}  // namespace dihaptic
