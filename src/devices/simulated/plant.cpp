#include "devices/simulated/plant.h"

#include <algorithm>
#include <cmath>

namespace dihaptic::devices::simulated {

Options Options::of(Preset preset) {
    Options options;
    options.preset = preset;
    if (preset == Preset::premium_1_0) {
        options.mass = 0.075;
        options.peak_force = 8.5;
        options.continuous_force = 1.4;
        options.position_step = 0.03e-3;
        options.friction = 0.04;
        options.workspace = Vec3(0.254, 0.178, 0.127);
        options.max_stiffness = 1000;
        options.max_damping = 8;
    }
    if (preset == Preset::touch) {
        options.mass = 0.045;
        options.peak_force = 3.3;
        options.continuous_force = 0.88;
        options.position_step = 0.055e-3;
        options.friction = 0.26;
        options.workspace = Vec3(0.16, 0.12, 0.07);
        options.max_stiffness = 400;
        options.max_damping = 4;
        options.orientation = true;
        options.angle_step = 1.5e-3;
    }
    if (preset == Preset::sigma_7) {
        options.mass = 0.2;
        options.peak_force = 12;
        options.position_step = 1.5e-6;
        options.workspace = Vec3(0.15, 0.15, 0.15);
        options.max_stiffness = 4000;
        options.max_damping = 30;
        options.orientation = true;
        options.peak_torque = 0.2;
        options.inertia = 2e-4;
        options.angle_step = 2.3e-4;
    }
    return options;
}

Plant::Plant(const Options& options, const hand::Impedance& impedance,
             const hand::TremorSpec& tremor, uint64_t seed, int finger, const hand::Driver& driver,
             const Pose& X_WD)
    : options_(options),
      X_WD_(X_WD),
      finger_(impedance),
      tremor_(tremor, seed, finger),
      index_(finger),
      driver_(driver),
      pending_(static_cast<size_t>(options.delay_ticks) + 1) {
    if (options.arm == Mechanics::phantom) arm_.emplace(options, impedance.mass);
}

bool Plant::holds(const Options& options, const hand::Impedance& impedance) {
    const double h = seconds(kStep);
    const double own = options.arm == Mechanics::phantom ? Arm::least_mass(options) : options.mass;
    const double mass = own + impedance.mass;
    const double k = impedance.stiffness + impedance.stiffness_per_force * options.peak_force;
    const bool turns =
        !options.orientation ||
        impedance.turn_stiffness * h * h + 2 * impedance.turn_damping * h < 4 * options.inertia;
    return turns && k * h * h + 2 * impedance.damping * h < 4 * mass;
}

void Plant::begin(Time now) noexcept {
    time_ = now;
    hand::FingerTarget target = driver_.target(index_, seconds(now));
    tremor_.add(target, seconds(now));
    p_ = target.p_WT;
    v_.setZero();
    R_ = target.R_WT;
    w_.setZero();
    if (arm_) p_ = X_WD_ * arm_->reset(X_WD_.inverse() * p_);
    release();
}

void Plant::release() noexcept {
    std::fill(pending_.begin(), pending_.end(), Wrench{});
}

bool Plant::hold(const Wrench& wrench_W) noexcept {
    newest_ = (newest_ + 1) % pending_.size();
    Wrench& out = pending_[newest_];
    out = wrench_W;
    const double force = out.force.norm();
    const double torque = out.torque.norm();
    if (force > options_.peak_force) out.force *= options_.peak_force / force;
    if (torque > options_.peak_torque) out.torque *= options_.peak_torque / torque;
    return force > options_.peak_force || torque > options_.peak_torque;
}

void Plant::advance(Time now) noexcept {
    const Wrench& device = pending_[(newest_ + 1) % pending_.size()];
    if (arm_) arm_->drive(X_WD_.R.conjugate() * device.force);
    while (time_ < now) {
        const Time step = std::min(kStep, now - time_);
        const double h = seconds(step);
        hand::FingerTarget target = driver_.target(index_, seconds(time_));
        tremor_.add(target, seconds(time_));
        if (arm_) {
            move_arm(target, device.force, h);
        } else {
            move_point(target, device.force, h);
        }
        if (options_.orientation) {
            w_ += h / options_.inertia * (finger_.turn(target, R_, w_) + device.torque);
            R_ = (rotation_by(h * w_) * R_).normalized();
        }
        time_ += step;
    }
}

void Plant::move_point(const hand::FingerTarget& target, const Vec3& f_device, double h) noexcept {
    const double mass = options_.mass + finger_.mass();
    v_ += h / mass * (finger_.pull(target, p_, v_, f_device, h) + f_device);
    if (options_.friction > 0) {
        const double most = h / mass * options_.friction;
        const double speed = v_.norm();
        v_ *= speed > most ? 1 - most / speed : 0;
    }
    p_ += h * v_;
}

void Plant::move_arm(const hand::FingerTarget& target, const Vec3& f_device, double h) noexcept {
    // the call with h advances the finger's own state, once per step; the calls with 0 only compute
    // its pull
    finger_.pull(target, p_, v_, f_device, h);
    arm_->move(h, [&](const Vec3& p_DH, const Vec3& v_DH) noexcept -> Vec3 {
        return X_WD_.R.conjugate() *
               finger_.pull(target, X_WD_ * p_DH, X_WD_.R * v_DH, f_device, 0);
    });
    p_ = X_WD_ * arm_->p_DH();
    v_ = X_WD_.R * arm_->v_DH();
}

Encoder::Measured Encoder::measure(Time now, const Vec3& p, const Vec3& v) noexcept {
    if (step_ <= 0) return {p, v};
    const Vec3 stepped = (p / step_).array().round().matrix() * step_;
    const auto* old = past_.exchange(now, stepped);
    if (old == nullptr) return {stepped, Vec3::Zero()};
    return {stepped, (stepped - old->value) / seconds(now - old->time)};
}

Encoder::Measured JointEncoder::measure(Time now, const Arm& arm) noexcept {
    const Vec3 q = arm.reported();
    Vec3 rate = arm.rate();
    if (arm.has_steps()) {
        const auto* old = past_.exchange(now, q);
        rate = old == nullptr ? Vec3::Zero() : Vec3((q - old->value) / seconds(now - old->time));
    }
    return {model::phantom_position(arm.links(), q),
            model::phantom_jacobian(arm.links(), q) * rate};
}

Gimbal::Measured Gimbal::measure(Time now, const Quat& R, const Vec3& w) noexcept {
    if (step_ <= 0) return {R, w};
    const Vec3 angles = angles_xyz(R);
    const Quat stepped = rotation_xyz((angles / step_).array().round().matrix() * step_);
    const auto* old = past_.exchange(now, stepped);
    if (old == nullptr) return {stepped, Vec3::Zero()};
    return {stepped, rotation_vector(stepped * old->value.conjugate()) / seconds(now - old->time)};
}

}  // namespace dihaptic::devices::simulated
