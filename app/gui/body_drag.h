// Moves the picked body of a scene, by dragging it in the picture or step by step with keys.
//
//     drag                         moves it in the plane of the table
//     drag with Shift              moves it up and down
//     drag with Ctrl               turns it about the vertical
//     arrows, Page Up and Down     move it 1 mm to each side, up and down; 10 mm with Shift
#pragma once

#include <QKeyEvent>
#include <QPointF>
#include <optional>

#include "view/pick.h"

namespace dihaptic::gui {

/// The displacement of a body in W [m], and its turn about z [rad].
struct BodyWay {
    Vec3 way = Vec3::Zero();
    double turn = 0;

    bool none() const { return way.isZero(0) && turn == 0; }
    Pose of(const Pose& X_WB) const;
};

class BodyDrag {
  public:
    /// Starts a drag of a body with the pose X_WB. The body is held at the point where the ray
    /// through the pointer meets it.
    BodyDrag(const view::Seen& held, const view::Ray& ray, const Pose& X_WB)
        : held_W_(held.p_W), ray_(ray), X_WB_first_(X_WB) {}

    /// Follows a pointer movement by `pixels`; `ray` is the new ray through the pointer.
    void follow(const view::Ray& ray, const QPointF& pixels, Qt::KeyboardModifiers keys);
    const BodyWay& way() const { return way_; }
    /// The pose to which the body has been dragged.
    Pose X_WB() const { return way_.of(X_WB_first_); }

  private:
    static constexpr double kTurn = 0.008;  // [rad/pixel]
    Vec3 held_W_;
    view::Ray ray_;  // ray through the pointer when the body last followed it
    Pose X_WB_first_;
    BodyWay way_;
};

/// The step that a key stands for, along the axes of W that are closest to the rightward and the
/// far direction in the camera's picture [m]; nullopt for any other key.
std::optional<Vec3> step_of(const QKeyEvent& event, const view::Camera& camera);

}  // namespace dihaptic::gui
