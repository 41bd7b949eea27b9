#include "devices/simulated/arm.h"

#include <algorithm>
#include <cmath>

namespace dihaptic::devices::simulated {
namespace {

/// Viscous friction of each joint of a Premium, a value tuned by others [N*m*s].
constexpr double kDamping = 0.0005;

/// Displacement of the endpoint per radian of rotation of each joint, in the reset pose [m].
Vec3 levers(const model::PhantomLinks& links) {
    return {links.thigh, links.thigh, links.shin};
}

}  // namespace

Arm::Arm(const Options& options, double carried)
    : links_(options.links),
      dynamics_(model::PhantomDynamics::scaled(options.links)),
      carried_(carried),
      offset_(options.joint_offset),
      step_(options.position_step * levers(links_).cwiseInverse()),
      peak_(options.peak_force * levers(links_)),
      friction_(options.friction * levers(links_)) {
    // `friction: 0` also turns off viscous friction
    dynamics_.damping = options.friction > 0 ? kDamping : 0;
}

double Arm::least_mass(const Options& options) {
    const auto dynamics = model::PhantomDynamics::scaled(options.links);
    const Vec3 apparent =
        model::phantom_mass_matrix(dynamics, Vec3::Zero())
            .diagonal()
            .cwiseQuotient(levers(options.links).cwiseProduct(levers(options.links)));
    return apparent.minCoeff();
}

Vec3 Arm::reset(const Vec3& p_DH) {
    state_ = {model::phantom_joints(links_, p_DH), Vec3::Zero()};
    torques_.setZero();
    stop_at_limits();
    return model::phantom_position(links_, state_.q);
}

void Arm::drive(const Vec3& f_device_D) noexcept {
    torques_ = model::phantom_jacobian(links_, reported()).transpose() * f_device_D;
    torques_ = torques_.cwiseMin(peak_).cwiseMax(-peak_);
}

Vec3 Arm::reported() const noexcept {
    Vec3 q = state_.q - offset_;
    if (has_steps()) q = q.cwiseQuotient(step_).array().round().matrix().cwiseProduct(step_);
    return q;
}

Mat3 Arm::mass_matrix(const Vec3& q, const Mat3& J) const noexcept {
    return model::phantom_mass_matrix(dynamics_, q) + carried_ * J.transpose() * J;
}

Vec3 Arm::acceleration(const State& state, const Mat3& J, const Vec3& f_finger) const noexcept {
    const Vec3 inertial =
        carried_ * model::phantom_steady_acceleration(links_, state.q, state.rate);
    const Vec3 torques = torques_ + J.transpose() * (f_finger - inertial) -
                         model::phantom_coriolis(dynamics_, state.q, state.rate) -
                         model::phantom_gravity(dynamics_, state.q) -
                         dynamics_.damping * state.rate;
    return mass_matrix(state.q, J).inverse() * torques;
}

void Arm::end_step(double h, const State& sum) noexcept {
    const State old = state_;
    state_ = old.after(h / 6, sum);
    const Mat3 M = mass_matrix(state_.q, model::phantom_jacobian(links_, state_.q));
    for (int i = 0; i < 3; ++i) {
        if (friction_[i] == 0) continue;
        const double most = h * friction_[i] / M(i, i);
        double& rate = state_.rate[i];
        if (std::abs(rate) > most) {
            rate -= std::copysign(most, rate);
            continue;
        }
        rate = 0;
        // a joint held by friction stays where it was, so its movement within this step is undone
        if (old.rate[i] == 0) state_.q[i] = old.q[i];
    }
    stop_at_limits();
}

void Arm::stop_at_limits() noexcept {
    const model::PhantomLimits& limits = model::phantom_limits();
    const auto stop = [](double& angle, double& rate, double low, double high) {
        if (angle < low || angle > high)
            rate = angle < low ? std::max(rate, 0.0) : std::min(rate, 0.0);
        angle = std::clamp(angle, low, high);
    };
    for (int i = 0; i < 3; ++i) stop(state_.q[i], state_.rate[i], limits.low[i], limits.high[i]);
    // at the limit of the bend, the shin yields because it is lighter than the thigh
    double bend = state_.q[1] - state_.q[2];
    double bending = state_.rate[1] - state_.rate[2];
    stop(bend, bending, limits.bend_low, limits.bend_high);
    state_.q[2] = state_.q[1] - bend;
    state_.rate[2] = state_.rate[1] - bending;
}

}  // namespace dihaptic::devices::simulated
