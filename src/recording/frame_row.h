// FrameRow is a visitor that turns one item of a frame's list into numbers, in the order of the
// columns in session.nwb: vectors as x, y, z; quaternions as w, x, y, z.
#pragma once

#include <type_traits>
#include <vector>

#include "base/geometry.h"
#include "frame/term.h"

namespace dihaptic::recording {

class FrameRow {
  public:
    template <class T>
    void operator()(const T& value, const frame::Term&) {
        if constexpr (std::is_same_v<T, Vec3>) {
            numbers.insert(numbers.end(), value.data(), value.data() + 3);
        } else if constexpr (std::is_same_v<T, Quat>) {
            numbers.insert(numbers.end(), {value.w(), value.x(), value.y(), value.z()});
        } else {
            numbers.push_back(static_cast<double>(value));
        }
    }
    std::vector<double> numbers;
};

}  // namespace dihaptic::recording
