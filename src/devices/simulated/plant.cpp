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
    }
    return options;
}

Plant::Plant(const Options& options, const hand::Impedance& impedance,
             const hand::TremorSpec& tremor, uint64_t seed, int finger, const hand::Driver& driver)
    : options_(options),
      finger_(impedance),
      tremor_(tremor, seed, finger),
      index_(finger),
      driver_(driver),
      pending_(static_cast<size_t>(options.delay_ticks) + 1, Vec3::Zero()) {}

bool Plant::holds(const Options& options, const hand::Impedance& impedance) {
    const double h = seconds(kStep);
    const double mass = options.mass + impedance.mass;
    const double k = impedance.stiffness + impedance.stiffness_per_force * options.peak_force;
    return k * h * h + 2 * impedance.damping * h < 4 * mass;
}

void Plant::reset() {
    time_ = Time(0);
    hand::FingerTarget target = driver_.target(index_, 0);
    tremor_.add(target, 0);
    p_ = target.p_WT;
    v_.setZero();
    release();
}

void Plant::release() noexcept {
    std::fill(pending_.begin(), pending_.end(), Vec3::Zero());
}

bool Plant::hold(const Vec3& f_W) noexcept {
    const double size = f_W.norm();
    const bool clamped = size > options_.peak_force;
    newest_ = (newest_ + 1) % pending_.size();
    pending_[newest_] = clamped ? Vec3(f_W * (options_.peak_force / size)) : f_W;
    return clamped;
}

void Plant::advance(Time now) noexcept {
    const Vec3& f_device = pending_[(newest_ + 1) % pending_.size()];
    const double mass = options_.mass + finger_.mass();
    while (time_ < now) {
        const Time step = std::min(kStep, now - time_);
        const double h = seconds(step);
        hand::FingerTarget target = driver_.target(index_, seconds(time_));
        tremor_.add(target, seconds(time_));
        v_ += h / mass * (finger_.pull(target, p_, v_, f_device, h) + f_device);
        if (options_.friction > 0) {
            const double most = h / mass * options_.friction;
            const double speed = v_.norm();
            v_ *= speed > most ? 1 - most / speed : 0;
        }
        p_ += h * v_;
        time_ += step;
    }
}

Encoder::Measured Encoder::measure(Time now, const Vec3& p, const Vec3& v) noexcept {
    if (step_ <= 0) return {p, v};
    const Vec3 stepped = (p / step_).array().round().matrix() * step_;
    const auto size = static_cast<int>(past_.size());
    past_[static_cast<size_t>(count_ % size)] = {now, stepped};
    const int back = std::min(window_, count_);
    const Sample& old = past_[static_cast<size_t>((count_ - back) % size)];
    ++count_;
    if (back == 0) return {stepped, Vec3::Zero()};
    return {stepped, (stepped - old.p) / seconds(now - old.time)};
}

}  // namespace dihaptic::devices::simulated
