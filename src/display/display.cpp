#include "display/display.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/unit.h"

namespace dihaptic::display {
namespace {

constexpr double kSmallest = 0.02, kLargest = 20;  // edges [m]
constexpr double kNearest = 0.02;        // minimum distance between an eye and the plane [m]
constexpr double kSkewed = 3 * kDegree;  // largest deviation of a corner from a right angle

bool has_edges(const Display& display, Diagnostics& diagnostics) {
    for (const auto& [edge, key] :
         {std::pair{display.right(), "lower_right"}, std::pair{display.up(), "upper_left"}}) {
        if (edge.norm() >= kSmallest && edge.norm() <= kLargest) continue;
        diagnostics.error(
            display.place, key,
            fmt::format("is {:.3g} mm from lower_left, but screens measure {:g} to {:g}",
                        1e3 * edge.norm(), 1e3 * kSmallest, 1e3 * kLargest),
            "Measure the corners of the picture that the person sees.");
        return false;
    }
    return true;
}

}  // namespace

bool Display::faces(const Eyes& seen_by) const {
    return before(seen_by.left()) >= kNearest && before(seen_by.right()) >= kNearest;
}

double Display::before(const Vec3& eye) const {
    return right().cross(up()).normalized().dot(eye - lower_left);
}

void Display::move(const Vec3& by) {
    for (Vec3* p : {&lower_left, &lower_right, &upper_left, &eyes.position}) *p += by;
}

void Display::set(const Registration& found) {
    registered = found;
    lower_left = found.lower_left;
    lower_right = found.lower_right;
    upper_left = found.upper_left;
}

void check(const Display& display, Diagnostics& diagnostics) {
    // the name is used as part of a file name
    if (display.name.starts_with('.') || display.name.find_first_of("/\\\n\t") != std::string::npos)
        diagnostics.error(display.place, "name", fmt::format("'{}' cannot be a name", display.name),
                          "Use letters, digits, blanks, '-' and '_'.");
    if (!has_edges(display, diagnostics)) return;
    const Vec3 right = display.right().normalized(), up = display.up().normalized();
    const double skew = std::asin(std::clamp(right.dot(up), -1.0, 1.0));
    if (std::abs(skew) > kSkewed) {
        diagnostics.error(display.place, "upper_left",
                          fmt::format("makes an angle of {:.1f} degrees at lower_left, but screens "
                                      "have right angles",
                                      90 - skew / kDegree),
                          "Measure the corners again, or register the display.");
        return;
    }
    if (display.eyes.along.norm() < 1e-9) {
        diagnostics.error(display.eyes.place, "along", "has no direction",
                          "Write e.g. along: [1, 0, 0].");
        return;
    }
    for (const Vec3& eye : {display.eyes.left(), display.eyes.right()}) {
        const double before = display.before(eye);
        if (before >= kNearest) continue;
        diagnostics.error(
            display.eyes.place, "position",
            before < 0 ? "is behind the screen"
                       : fmt::format("is {:.3g} mm in front of the screen's plane", 1e3 * before),
            before < 0 ? "Exchange the left and the right corners; the key 'mirrored' describes "
                         "the reversal by a mirror."
                       : "Measure the position of the eyes.");
        return;
    }
}

}  // namespace dihaptic::display
