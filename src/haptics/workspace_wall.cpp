#include "haptics/workspace_wall.h"

#include <algorithm>
#include <cmath>

namespace dihaptic::haptics {

Vec3 WorkspaceWall::force(const Vec3& p_WH, const Vec3& v_WH) const noexcept {
    if (!box_) return Vec3::Zero();
    const Mat3 R_BW = box_->X_WB.R.conjugate().toRotationMatrix();
    const Vec3 p_BH = R_BW * (p_WH - box_->X_WB.p);
    const Vec3 v_BH = R_BW * v_WH;
    Vec3 f_B = Vec3::Zero();
    for (int axis = 0; axis < 3; ++axis) {
        const double outward = p_BH[axis] < 0 ? -1 : 1;
        const double depth = std::abs(p_BH[axis]) - box_->edges[axis] / 2;
        if (depth <= 0) continue;
        f_B[axis] = -outward * std::max(0.0, stiffness_ * depth + damping_ * outward * v_BH[axis]);
    }
    return R_BW.transpose() * f_B;
}

}  // namespace dihaptic::haptics
