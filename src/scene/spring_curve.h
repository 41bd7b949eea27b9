// The curve of a spring that does not obey Hooke's law. It gives the resisting force at each
// stretch, by straight lines between measured or drawn points.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace dihaptic::scene {

struct SpringCurve {
    std::vector<double> stretch;  ///< in ascending order [m] or [rad]
    std::vector<double>
        resistance;  ///< at each stretch; positive if it opposes a positive stretch [N] or [N*m]

    struct Point {
        double resistance = 0;
        double stiffness = 0;  ///< slope of the current segment [N/m] or [N*m/rad]
    };
    bool is_empty() const noexcept { return stretch.empty(); }
    /// The resistance and stiffness at the stretch x. Beyond the ends of the curve, its first and
    /// last segments are continued. The curve must have at least two points, and as many
    /// resistances as stretches.
    Point at(double x) const noexcept {
        const auto next = std::upper_bound(stretch.begin() + 1, stretch.end() - 1, x);
        const auto i = static_cast<size_t>(next - stretch.begin());
        const double slope = (resistance[i] - resistance[i - 1]) / (stretch[i] - stretch[i - 1]);
        return {resistance[i - 1] + slope * (x - stretch[i - 1]), slope};
    }
    /// Work done in stretching the spring from the first point of the curve to x [J].
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
