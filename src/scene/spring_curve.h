// The curve of a spring that does not obey Hooke's law: its resisting force at each
// stretch, given by straight lines between measured or drawn points.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace dihaptic::scene {

struct SpringCurve {
    std::vector<double> stretch;  ///< ascending [m] or [rad]
    std::vector<double>
        resistance;  ///< at these stretches; positive if it opposes a positive stretch [N] or [N*m]

    struct Point {
        double resistance = 0;
        double stiffness = 0;  ///< slope of the current segment [N/m] or [N*m/rad]
    };
    bool is_empty() const noexcept { return stretch.empty(); }
    /// Beyond its ends the curve continues along its first and last segments. It has two or more
    /// points, and as many stretches as resistances.
    Point at(double x) const noexcept {
        const auto next = std::upper_bound(stretch.begin() + 1, stretch.end() - 1, x);
        const auto i = static_cast<size_t>(next - stretch.begin());
        const double slope = (resistance[i] - resistance[i - 1]) / (stretch[i] - stretch[i - 1]);
        return {resistance[i - 1] + slope * (x - stretch[i - 1]), slope};
    }
    /// Work to stretch the spring from the curve's first point to x [J].
    double energy(double x) const noexcept {
        double out = 0;
        double from = stretch.front();
        for (size_t i = 1; i + 1 < stretch.size() && x > stretch[i]; ++i) {
            out += (stretch[i] - from) * (resistance[i - 1] + resistance[i]) / 2;
            from = stretch[i];
        }
        return out + (x - from) * (at(from).resistance + at(x).resistance) / 2;
    }
};

}  // namespace dihaptic::scene
