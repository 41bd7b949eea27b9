#include "mouse_hand.h"

#include <algorithm>
#include <cmath>

namespace dihaptic::gui {
namespace {

/// The box that contains the positions of a hand at a desk [m].
const Vec3 kLeast(-0.3, -0.25, 0.005);
const Vec3 kFarthest(0.3, 0.25, 0.4);
constexpr double kBeyond = 0.5;    // how far beyond that box the pointer may go [m]
constexpr double kWidest = 0.16;   // largest aperture [m]
constexpr double kStrongest = 16;  // grip force of a strong hand [N]
constexpr double kQuickly = 3;     // factor on the opening speed while an object is held
constexpr double kHeld = 0.5;      // grip force above which an object is held [N]

}  // namespace

void MouseHand::move(const QPointF& pixels, const scene::Camera& camera, int height,
                     bool in_depth) {
    const Vec3 sight = (camera.look_at - camera.position).normalized();
    // looking straight down does not define left and right; then the world's axes are used
    Vec3 away(sight.x(), sight.y(), 0);
    away = away.norm() > 1e-6 ? Vec3(away.normalized()) : Vec3(0, 1, 0);
    const Vec3 right = away.cross(Vec3::UnitZ());
    const double distance = std::max(0.01, (pointer_ - camera.position).dot(sight));
    const double scale = 2 * distance * std::tan(camera.field_of_view / 2) / std::max(1, height);
    const Vec3 up = in_depth ? away : Vec3::UnitZ();
    pointer_ += scale * (pixels.x() * right - pixels.y() * up);
    const Vec3 beyond = Vec3::Constant(kBeyond);
    pointer_ = pointer_.cwiseMax(kLeast - beyond).cwiseMin(kFarthest + beyond);
    goal_.centre = pointer_.cwiseMax(kLeast).cwiseMin(kFarthest);
}

void MouseHand::turn(const QPointF& pixels) {
    goal_.yaw += kTurn * pixels.x();
    goal_.roll = std::clamp(goal_.roll + kTurn * pixels.y(), -M_PI / 2, M_PI / 2);
}

void MouseHand::set_grip(double grip) {
    grip_ = grip;
    // the object is no longer held, and the fingers must not cross
    if (!(grip > kHeld)) goal_.aperture = std::max(0.0, goal_.aperture);
}

void MouseHand::go_back() {
    pointer_ = goal_.centre = start_.centre;
    goal_.yaw = start_.yaw;
    goal_.roll = start_.roll;
}

double MouseHand::grip_of(double peak_force) {
    return std::min(peak_force / 2, kStrongest);
}

void MouseHand::wheel(double notches) {
    close(notches * kNotch);
}

void MouseHand::squeeze(Squeeze keys, double h) {
    if (keys == Squeeze::close) close(h * kKeySpeed);
    if (keys == Squeeze::open) close(-h * kKeySpeed);
}

void MouseHand::close(double way) {
    if (way > 0 && grip_ > most_grip_) return;  // closing further would delay the release
    const bool held = grip_ > kHeld;
    if (way < 0 && held) way *= kQuickly;
    goal_.aperture =
        std::clamp(goal_.aperture - way, held ? hand::MouseDriver::kTightest : 0.0, kWidest);
}

}  // namespace dihaptic::gui
