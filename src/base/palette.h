// Colours that have one meaning everywhere: in the window, in pictures and in reports. They can be
// distinguished with any type of colour vision (Okabe and Ito, "Color Universal Design", 2008).
#pragma once

#include <array>
#include <cstddef>

namespace dihaptic::palette {

inline constexpr const char* kGrip = "#d55e00";
inline constexpr const char* kLoad = "#0072b2";

/// The fingers' colours, in scene order: from thumb to little finger in a scene with all five
/// fingers.
inline constexpr std::array kFingers{"#e69f00", "#009e73", "#cc79a7", "#f0e442", "#d55e00"};

constexpr const char* finger(size_t index) {
    return kFingers[index % kFingers.size()];
}

}  // namespace dihaptic::palette
