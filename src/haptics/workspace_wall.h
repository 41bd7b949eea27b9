// A soft wall where a device's reach ends, so that a hand does not run into its mechanical stops.
// Along each axis of its box B, with e the edge, and only while the handle is outside,
//
//     f = -sign(p) max(0, k (|p| - e / 2) + c sign(p) v)
//
// with c = k h / 2 (README.md): it pushes inward, never outward.
#pragma once

#include <optional>

#include "base/geometry.h"

namespace dihaptic::haptics {

/// A box B that a handle is kept in.
struct WorkspaceBox {
    Pose X_WB;                  ///< of its middle
    Vec3 edges = Vec3::Zero();  ///< [m]
};

class WorkspaceWall {
  public:
    /// Without a box there is no wall; k [N/m], 0: none either. `tick`: h [s].
    WorkspaceWall(const std::optional<WorkspaceBox>& box, double stiffness, double tick)
        : box_(box), stiffness_(stiffness), damping_(stiffness * tick / 2) {}

    /// On the handle, in the world [N]; zero inside.
    Vec3 force(const Vec3& p_WH, const Vec3& v_WH) const noexcept;

  private:
    std::optional<WorkspaceBox> box_;
    double stiffness_;
    double damping_;
};

}  // namespace dihaptic::haptics
