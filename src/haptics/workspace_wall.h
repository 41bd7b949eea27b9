// WorkspaceWall is a soft wall at the limit of a device's workspace that keeps the hand from
// running into the device's mechanical stops. Along each axis of its box B, with edge length e, and
// only while the handle is outside,
//
//     f = -sign(p) max(0, k (|p| - e / 2) + c sign(p) v)
//
// with c = k h / 2 (README.md). The wall pushes inward, never outward.
#pragma once

#include <optional>

#include "base/geometry.h"

namespace dihaptic::haptics {

/// A box B in which a handle should stay.
struct WorkspaceBox {
    Pose X_WB;                  ///< pose of the box centre
    Vec3 edges = Vec3::Zero();  ///< [m]
};

class WorkspaceWall {
  public:
    /// If there is no box, or if the stiffness k is 0 [N/m], there is no wall. `tick` is the
    /// duration h [s].
    WorkspaceWall(const std::optional<WorkspaceBox>& box, double stiffness, double tick)
        : box_(box), stiffness_(stiffness), damping_(stiffness * tick / 2) {}

    /// Force on the handle, in the world frame [N]; zero inside the box.
    Vec3 force(const Vec3& p_WH, const Vec3& v_WH) const noexcept;

  private:
    std::optional<WorkspaceBox> box_;
    double stiffness_;
    double damping_;
};

}  // namespace dihaptic::haptics
