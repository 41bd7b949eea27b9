#include "devices/device_group.h"

#include <algorithm>

namespace dihaptic::devices {
namespace {

/// Fraction by which rounding may make a limited force exceed its limit.
constexpr double kRounding = 1e-9;

/// Limits the length of `v` to `most`. Returns whether `v` had to be reduced.
bool clamp(Vec3& v, double most) noexcept {
    if (!v.allFinite()) v.setZero();
    const double size = v.norm();
    if (size <= most * (1 + kRounding)) return false;
    v *= most / size;
    return true;
}

}  // namespace

DeviceGroup::DeviceGroup(std::vector<frame::DeviceInfo> infos)
    : infos_(std::move(infos)), told_(infos_.size()) {
    for (const frame::DeviceInfo& info : infos_)
        outputs_.push_back({info.peak_force, info.peak_torque});
}

void DeviceGroup::write(std::span<const Wrench> wrenches_D) noexcept {
    assert(active_ && wrenches_D.size() == infos_.size());
    for (size_t i = 0; i < told_.size(); ++i) {
        told_[i] = wrenches_D[i];
        const bool force = clamp(told_[i].force, outputs_[i].most_force);
        const bool torque = clamp(told_[i].torque, outputs_[i].most_torque);
        outputs_[i].clamped = force || torque;
    }
    do_write(told_);
}

void DeviceGroup::limit(int device, double force, double torque) noexcept {
    const frame::DeviceInfo& info = infos_[static_cast<size_t>(device)];
    Output& output = outputs_[static_cast<size_t>(device)];
    output.most_force = std::min(force, info.peak_force);
    output.most_torque = std::min(torque, info.peak_torque);
    do_limit(device, force, torque);
}

std::string in_words(const Error& error) {
    const Problem& first = error.problems().front();
    return first.what + ". " + first.remedy;
}

const Backend* find_backend(const std::string& name) {
    for (const Backend& backend : backends()) {
        if (name == backend.name) return &backend;
    }
    return nullptr;
}

}  // namespace dihaptic::devices
