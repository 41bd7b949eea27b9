#include "recording/frame_check.h"

#include <algorithm>

#include "contact/route.h"

namespace dihaptic::recording {
namespace {

/// Whether i is an index below `count`, or -1, which means none.
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

/// Returns the index to which an item refers.
template <class Item>
int32_t index_of(const Item& item) noexcept {
    if constexpr (requires { item.body; })
        return item.body;
    else if constexpr (requires { item.joint; })
        return item.joint;
    else if constexpr (requires { item.object; })
        return item.object;
    else
        return -1;
}

size_t count(frame::Names what, const Layout& layout) noexcept {
    switch (what) {
        case frame::Names::bodies:
            return layout.bodies;
        case frame::Names::bodies_and_proxies:
            return layout.bodies + layout.fingers;
        case frame::Names::joints:
            return layout.joints;
        case frame::Names::nothing:
            break;
    }
    return 0;
}

bool is_possible(const frame::TaskFrame& task, const Layout& layout) noexcept {
    bool possible = true;
    frame::TaskFrame::visit_lists(task, [&](const auto& list, const frame::TaskList& is) {
        possible = possible && (is.names == frame::Names::nothing ||
                                std::all_of(list.begin(), list.end(), [&](const auto& item) {
                                    return is_index(index_of(item), count(is.names, layout));
                                }));
    });
    return possible;
}

}  // namespace

bool is_possible(const frame::Frame& frame, const Layout& layout) noexcept {
    // no session is longer than this, so sums and differences of such times cannot overflow
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
