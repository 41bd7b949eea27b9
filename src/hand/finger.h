// Mechanics of one simulated finger: equilibrium-point control (Feldman 1986),
//
//     f = (k + k_f |f_felt|) (x_target - x) + c (v_target - v)
//
// and, on a handle that can turn, a torque. With r the rotation vector from the handle to the
// target,
//
//     t = k_r r + c_r (w_target - w)
//
// Here x is the position of the handle that the finger holds. |f_felt| follows the device's force
// with the time constant kFeelTime, as in a muscle, so that stiffening does not add a fast feedback
// loop.
#pragma once

#include <vector>

#include "base/random.h"
#include "hand/driver.h"
#include "hand/spec.h"

namespace dihaptic::hand {

class Finger {
  public:
    explicit Finger(const Impedance& impedance) : impedance_(impedance) {}

    /// Returns the force that the finger exerts on the handle [N] over h seconds while the device
    /// pushes with f_device_W [N].
    Vec3 pull(const FingerTarget& target, const Vec3& p_WH, const Vec3& v_WH,
              const Vec3& f_device_W, double h) noexcept {
        felt_ += (f_device_W.norm() - felt_) * h / kFeelTime;
        const double k = impedance_.stiffness + impedance_.stiffness_per_force * felt_;
        return k * (target.p_WT - p_WH) + impedance_.damping * (target.v_WT - v_WH);
    }
    /// Returns the torque that the finger exerts on the handle [N*m].
    Vec3 turn(const FingerTarget& target, const Quat& R_WH, const Vec3& w_WH) const noexcept {
        return impedance_.turn_stiffness * rotation_vector(target.R_WT * R_WH.conjugate()) +
               impedance_.turn_damping * (target.w_WT - w_WH);
    }
    double mass() const { return impedance_.mass; }

  private:
    static constexpr double kFeelTime = 0.05;  // [s]
    Impedance impedance_;
    double felt_ = 0;  // [N]
};

/// Physiological tremor of the target of one finger.
class Tremor {
  public:
    Tremor(const TremorSpec& spec, uint64_t seed, int finger);
    /// Adds the tremor at time t to the target.
    void add(FingerTarget& target, double t) const noexcept;

  private:
    double amplitude_;
    Vec3 angular_frequency_;  // one per axis [rad/s]
    Vec3 phase_;              // [rad]
};

}  // namespace dihaptic::hand
