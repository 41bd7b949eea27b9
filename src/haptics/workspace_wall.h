// A soft wall where a device's reach ends, so that a hand does not run into its mechanical stops.
// Along each axis of D, with e the edge of the workspace box, and only while the handle is outside,
//
//     f = -sign(p) max(0, k (|p| - e / 2) + c sign(p) v)
//
// with c = k h / 2 (README.md): it pushes inward, never outward.
#pragma once

#include <optional>

#include "base/geometry.h"

namespace dihaptic::haptics {

class WorkspaceWall {
  public:
    /// Edges of the box around D's origin [m], without which there is no wall; k [N/m], 0: none
    /// either. `tick`: h [s].
    WorkspaceWall(const std::optional<Vec3>& edges, double stiffness, double tick)
        : edges_(edges), stiffness_(stiffness), damping_(stiffness * tick / 2) {}

    /// On the handle, in D [N]; zero inside.
    Vec3 force(const Vec3& p_DH, const Vec3& v_DH) const noexcept;

  private:
    std::optional<Vec3> edges_;
    double stiffness_;
    double damping_;
};

}  // namespace dihaptic::haptics
