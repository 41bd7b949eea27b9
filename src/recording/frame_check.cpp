#include "recording/frame_check.h"

#include <algorithm>

#include "contact/route.h"

namespace dihaptic::recording {
namespace {

/// Whether i is an index below `count`, or -1, which stands for none.
bool is_index(int32_t i, size_t count) noexcept {
    return i >= -1 && i < static_cast<int64_t>(count);
}

template <class Enum>
bool names(int32_t value) noexcept {
    return value >= 0 && static_cast<size_t>(value) < enum_names(Enum{}).size();
}

bool is_possible(const frame::Knobs& knobs) noexcept {
    bool possible = true;
    frame::Knobs::visit([&]<class T>(T frame::Knobs::*knob, const frame::Knob&) {
        if constexpr (NamedEnum<T>)
            possible = possible && names<T>(static_cast<int32_t>(knobs.*knob));
    });
    return possible;
}

bool is_possible(const frame::ContactFrame& contact, size_t all) noexcept {
    const bool both = contact.a >= 0 && contact.b >= 0;
    return (both || contact.normal_force == 0) && is_index(contact.a, all) &&
           is_index(contact.b, all);
}

bool is_possible(const frame::TaskFrame& task, const Layout& layout) noexcept {
    const size_t bodies = layout.bodies;
    const size_t all = layout.bodies + layout.fingers;
    const auto each = [](const auto& list, size_t count) {
        return std::all_of(list.begin(), list.end(),
                           [count](const auto& item) { return is_index(item.body, count); });
    };
    const auto of_joints = [&](const auto& list) {
        return std::all_of(list.begin(), list.end(),
                           [&](const auto& item) { return is_index(item.joint, layout.joints); });
    };
    return each(task.properties, all) && each(task.loads, all) && each(task.placements, bodies) &&
           each(task.drives, bodies) && each(task.looks, all) && each(task.displaced, all) &&
           of_joints(task.joint_properties) && of_joints(task.motors) &&
           std::all_of(task.visual.begin(), task.visual.end(),
                       [&](const frame::VisualMap& map) { return is_index(map.object, bodies); });
}

}  // namespace

bool is_possible(const frame::Frame& frame, const Layout& layout) noexcept {
    // no session is longer than this; sums and differences of such times cannot overflow
    constexpr Time kLongest = std::chrono::hours(1000);
    constexpr int64_t kMostTicks = int64_t{1} << 40;
    const size_t all = layout.bodies + layout.fingers;
    return frame.sequence >= 0 && frame.sequence < kMostTicks && frame.time >= Time{0} &&
           frame.time < kLongest && frame.trial >= 0 && frame.phase >= -1 &&
           is_possible(static_cast<const frame::Knobs&>(frame)) &&
           names<contact::Route>(frame.solver_route) && is_possible(frame.task, layout) &&
           std::all_of(
               frame.contacts.begin(), frame.contacts.end(),
               [&](const frame::ContactFrame& contact) { return is_possible(contact, all); });
}

}  // namespace dihaptic::recording
