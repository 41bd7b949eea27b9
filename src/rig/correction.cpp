#include "rig/correction.h"

#include <cmath>

namespace dihaptic::rig {

Mat3 Correction::slope(const Vec3& joints) const noexcept {
    const Mat3 R = X.R.toRotationMatrix();
    if (!arm) return R * (Mat3::Identity() + stretch);
    // a twentieth of the determinant in the reset pose, which is only reached far beyond the stops
    // of the joints
    const double least = 0.05 * arm->thigh * arm->thigh * arm->shin;
    if (std::abs(model::phantom_determinant(*arm, joints)) < least) return R;
    return R * model::phantom_jacobian(*arm, joints + joint_offset) *
           model::phantom_jacobian(*arm, joints).inverse();
}

}  // namespace dihaptic::rig
