// WorkspaceWall is a soft wall at the limit of a device's reach, so that a hand does not run into
// its mechanical stops. Along each axis of its box B, with edge length e, and only while the handle
// is outside,
//
//     f = -sign(p) max(0, k (|p| - e / 2) + c sign(p) v)
//
// with c = k h / 2 (README.md): it pushes inward, never outward.
#pragma once

#include <optional>

#include "base/geometry.h"

namespace dihaptic::haptics {

/// A box B in which a handle is kept.
struct WorkspaceBox {
    Pose X_WB;                  ///< pose of its centre
    Vec3 edges = Vec3::Zero();  ///< [m]
};

class WorkspaceWall {
  public:
    /// There is no wall without a box or with a stiffness k of 0 [N/m]. `tick`: h [s].
    WorkspaceWall(const std::optional<WorkspaceBox>& box, double stiffness, double tick)
        : box_(box), stiffness_(stiffness), damping_(stiffness * tick / 2) {}

    /// Force on the handle, in the world; zero inside the box [N].
    Vec3 force(const Vec3& p_WH, const Vec3& v_WH) const noexcept;

  private:
    std::optional<WorkspaceBox> box_;
    double stiffness_;
    double damping_;
};

}  // namespace dihaptic::haptics
