// Steps of scales that people read easily.
#pragma once

#include <cmath>

namespace dihaptic::gui {

/// The smallest of ..., 1, 2, 5, 10, ... that is not below `least`.
inline double round_step(double least) {
    const double power = std::pow(10, std::floor(std::log10(least)));
    for (const double factor : {1.0, 2.0, 5.0}) {
        if (factor * power >= least) return factor * power;
    }
    return 10 * power;
}

}  // namespace dihaptic::gui
