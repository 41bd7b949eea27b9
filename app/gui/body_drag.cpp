#include "body_drag.h"

#include <Eigen/Dense>
#include <cmath>

namespace dihaptic::gui {
namespace {

Quat about_z(double angle) {
    return Quat(Eigen::AngleAxisd(angle, Vec3::UnitZ()));
}

}  // namespace

Pose BodyWay::of(const Pose& X_WB) const {
    return {about_z(turn) * X_WB.R, X_WB.p + way};
}

void BodyDrag::follow(const view::Ray& ray, const QPointF& pixels, Qt::KeyboardModifiers keys) {
    if (keys.testFlag(Qt::ControlModifier)) {
        way_.turn += kTurn * pixels.x();
        ray_ = ray;
        return;
    }
    const auto step =
        view::dragged(held_W_ + way_.way, ray_, ray, keys.testFlag(Qt::ShiftModifier));
    if (!step) return;  // the body stays in place until the pointer returns
    way_.way += *step;
    ray_ = ray;
}

std::optional<Vec3> step_of(const QKeyEvent& event, const view::Camera& camera) {
    Vec3 step = Vec3::Zero();
    switch (event.key()) {
        case Qt::Key_Left:
            step.x() = -1;
            break;
        case Qt::Key_Right:
            step.x() = 1;
            break;
        case Qt::Key_Up:
            step.y() = 1;
            break;
        case Qt::Key_Down:
            step.y() = -1;
            break;
        case Qt::Key_PageUp:
            step.z() = 1;
            break;
        case Qt::Key_PageDown:
            step.z() = -1;
            break;
        default:
            return {};
    }
    constexpr double kQuarter = M_PI / 2;
    const double turn = kQuarter * std::round(view::azimuth(camera) / kQuarter);
    const double length = event.modifiers().testFlag(Qt::ShiftModifier) ? 0.010 : 0.001;
    // exactly along an axis, so that the other coordinates in the file stay unchanged
    return length * (about_z(turn) * step).array().round().matrix();
}

}  // namespace dihaptic::gui
