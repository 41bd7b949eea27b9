// Easily readable steps for scales.
#pragma once

#include <algorithm>
#include <cmath>

namespace dihaptic::gui {

/// The smallest number among ..., 1, 2, 5, 10, ... that is not below `least`.
inline double round_step(double least) {
    const double power = std::pow(10, std::floor(std::log10(least)));
    for (const double factor : {1.0, 2.0, 5.0}) {
        if (factor * power >= least) return factor * power;
    }
    return 10 * power;
}

/// The lowest and the highest line of a scale, and the step between lines.
struct Scale {
    double low, high, step;
};

/// The scale for values from low to high, with about this many steps.
inline Scale scale_of(double low, double high, double lines) {
    const double step = round_step((high - low) / std::max(1.0, lines));
    // a value that is practically on a line does not open a further step
    return {std::floor(low / step + 0.05) * step, std::ceil(high / step - 0.05) * step, step};
}

}  // namespace dihaptic::gui
