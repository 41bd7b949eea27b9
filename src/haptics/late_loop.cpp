#include "haptics/late_loop.h"

#include <algorithm>

namespace dihaptic::haptics {
namespace {

// A damper stronger than m / T removes more than a handle's momentum in a period T. Expressed as a
// multiple of the held stiffness, its limit is m / (2 kHeldShare b), with 75 g and 3 N*s/m, and
// likewise with a gimbal's inertia.
constexpr double kDamperTime = 0.075 / (2 * kHeldShare * 3);
constexpr double kTurnDamperTime = 1e-4 / (2 * kHeldShare * 0.02);

}  // namespace

frame::CouplingSettings softened(frame::CouplingSettings asked, double b, double lateness,
                                 double tick) noexcept {
    if (lateness <= 0) return asked;
    const double k = held_stiffness(b, lateness);
    asked.stiffness = std::min(asked.stiffness, k);
    asked.turn_stiffness = std::min(asked.turn_stiffness, kTurnHeld * k);
    if (asked.damping) asked.damping = std::min(*asked.damping, kDamperTime * k);
    if (asked.turn_damping)
        asked.turn_damping = std::min(*asked.turn_damping, kTurnDamperTime * kTurnHeld * k);
    // smoothing delays force by ticks, which are longer now: limit it to about one late tick
    asked.smoothing = std::max(asked.smoothing, lateness / (lateness + tick));
    return asked;
}

Vec3 bound_rise(const Vec3& asked, const Vec3& last, const Vec3& moved, double k,
                double creep) noexcept {
    const double size = asked.norm();
    if (!(size > 0)) return asked;
    const Vec3 along = asked / size;
    const double most = std::max(0.0, (last - k * moved).dot(along)) + creep;
    return most < size ? Vec3(most * along) : asked;
}

}  // namespace dihaptic::haptics
