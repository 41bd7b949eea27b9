#include "haptics/workspace_wall.h"

#include <algorithm>
#include <cmath>

namespace dihaptic::haptics {

Vec3 WorkspaceWall::force(const Vec3& p_DH, const Vec3& v_DH) const noexcept {
    Vec3 out = Vec3::Zero();
    if (!edges_) return out;
    for (int axis = 0; axis < 3; ++axis) {
        const double outward = p_DH[axis] < 0 ? -1 : 1;
        const double depth = std::abs(p_DH[axis]) - (*edges_)[axis] / 2;
        if (depth <= 0) continue;
        out[axis] = -outward * std::max(0.0, stiffness_ * depth + damping_ * outward * v_DH[axis]);
    }
    return out;
}

}  // namespace dihaptic::haptics
