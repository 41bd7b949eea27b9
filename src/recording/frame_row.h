// FrameRow is one item of a frame's list as numbers, in the order of session.nwb's columns:
// vectors are x, y, z, quaternions w, x, y, z. It is a visitor.
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
