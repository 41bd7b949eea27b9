// Mechanics of a simulated Premium with all its joints (model/phantom_arm.h) and a finger of mass m
// at its endpoint:
//
//     (M + m J^T J) q'' + C + m J^T dJ/dt q' + G + b q' = J^T f_finger + torques + friction
//
// integrated with the classical Runge-Kutta method. The motor torques J^T f_device are computed
// from the angles reported by the encoders; the resolution of an encoder corresponds to
// `position_step` at the endpoint in the reset pose. Each motor's torque is limited to the value
// that the peak force requires in that pose. Coulomb friction in each joint removes momentum, and
// holds the joint if it can; an end stop removes all of the joint's momentum. Gravity is included:
// the weight of a Premium's motors balances its arm, and the remaining imbalance can be felt.
#pragma once

#include "devices/simulated/options.h"

namespace dihaptic::devices::simulated {

class Arm {
  public:
    /// `carried` is the mass m of the finger [kg].
    Arm(const Options& options, double carried);

    /// Smallest apparent mass of the endpoint in any direction, in the reset pose [kg].
    static double least_mass(const Options& options);

    /// Puts the endpoint, at rest, as close to p_DH as possible, and returns its actual position.
    Vec3 reset(const Vec3& p_DH);
    /// Sets the motor torques that produce this force [N]. They are held until the next call.
    void drive(const Vec3& f_device_D) noexcept;
    /// Integrates over a time h [s]; pull(p_DH, v_DH) returns the finger's force [N].
    template <class Pull>
    void move(double h, const Pull& pull) noexcept {
        const auto rates = [&](const State& s) noexcept -> State {
            const Vec3 p_DH = model::phantom_position(links_, s.q);
            const Mat3 J = model::phantom_jacobian(links_, s.q);
            return {s.rate, acceleration(s, J, pull(p_DH, J * s.rate))};
        };
        const State k1 = rates(state_);
        const State k2 = rates(state_.after(h / 2, k1));
        const State k3 = rates(state_.after(h / 2, k2));
        const State k4 = rates(state_.after(h, k3));
        end_step(
            h, {k1.q + 2 * k2.q + 2 * k3.q + k4.q, k1.rate + 2 * k2.rate + 2 * k3.rate + k4.rate});
    }

    const model::PhantomLinks& links() const { return links_; }
    const Vec3& q() const { return state_.q; }
    const Vec3& rate() const { return state_.rate; }
    Vec3 p_DH() const noexcept { return model::phantom_position(links_, state_.q); }
    Vec3 v_DH() const noexcept { return model::phantom_jacobian(links_, state_.q) * state_.rate; }
    /// The joint angles as reported by the encoders [rad].
    Vec3 reported() const noexcept;
    bool has_steps() const { return step_.x() > 0; }
    /// Kinetic and potential energy of the arm alone [J].
    double energy() const noexcept {
        return model::phantom_energy(dynamics_, state_.q, state_.rate);
    }

  private:
    struct State {
        Vec3 q = Vec3::Zero();     // [rad]
        Vec3 rate = Vec3::Zero();  // [rad/s]

        State after(double h, const State& change) const noexcept {
            return {q + h * change.q, rate + h * change.rate};
        }
    };

    Mat3 mass_matrix(const Vec3& q, const Mat3& J) const noexcept;
    Vec3 acceleration(const State& state, const Mat3& J, const Vec3& f_finger) const noexcept;
    void end_step(double h, const State& sum) noexcept;
    void stop_at_limits() noexcept;

    model::PhantomLinks links_;
    model::PhantomDynamics dynamics_;
    double carried_;
    Vec3 offset_;    // true angles minus reported angles [rad]
    Vec3 step_;      // resolution of the encoders [rad]
    Vec3 peak_;      // limits of the motor torques [N*m]
    Vec3 friction_;  // [N*m]
    Vec3 torques_ = Vec3::Zero();
    State state_;
};

}  // namespace dihaptic::devices::simulated
