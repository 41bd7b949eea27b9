// Heating limits the time during which more than the continuous force of a device may be requested.
//
// Motors warm with the square of their current, which is proportional to the force, and cool toward
// room temperature with a time constant tau. In units of force squared,
//
//     tau dq/dt = |f|^2 - q,        q = 0 when cold,
//
// and q = f_c^2 is the temperature that the continuous force f_c maintains. The largest force
// allowed falls as q rises, from the peak force f_p when cold:
//
//     f_max^2 = f_c^2 + (f_p^2 - f_c^2) max(0, 1 - q / f_c^2)
//
// Therefore, q never exceeds f_c^2: at the largest allowed force, tau dq/dt = (f_c^2 - q) f_p^2 /
// f_c^2, which tends to this limit. The force falls smoothly, and a force below f_c is never
// reduced.
#pragma once

#include "base/geometry.h"

namespace dihaptic::haptics {

class Heating {
  public:
    /// Creates an object for a device that can sustain its peak force.
    Heating() = default;
    /// Peak and continuous force [N], time constant [s]. If the continuous force is not finite, or
    /// not below the peak force, nothing is limited.
    Heating(double peak, double continuous, double time);

    /// The largest force that is currently allowed [N]; infinite if unlimited.
    double most_force() const noexcept;
    /// Adds the effect of a force held for h [s].
    void add(const Vec3& force, double h) noexcept;
    /// q [N^2].
    double mean_square() const { return mean_square_; }

  private:
    bool limits_ = false;
    double peak_ = 0;
    double continuous_ = 0;
    double time_ = 1;
    double mean_square_ = 0;
};

}  // namespace dihaptic::haptics
