// Computes the pose of a joint's second body from the joint's coordinate, so that trials can begin
// with a displaced pendulum or an open drawer.
#pragma once

#include "scene/scene.h"

namespace dihaptic::task {

struct BodyPlace;

/// Velocity of a body's origin [m/s] and angular velocity of the body [rad/s], both in the world
/// frame.
struct BodyMotion {
    Vec3 v = Vec3::Zero();
    Vec3 w = Vec3::Zero();
};

struct OnJoint {
    int first = -1;  ///< index of the joint's first body; -1 for the world
    bool slides = false;
    Vec3 p_W = Vec3::Zero();      ///< position of the joint in the scene
    Vec3 axis_W = Vec3::UnitZ();  ///< axis of the joint in the scene, a unit vector
    Pose X_WA;                    ///< pose of the first body in the scene
    Pose X_WB;                    ///< pose of the second body in the scene

    /// Returns the pose of the second body, given the current pose of the first body and the
    /// coordinate.
    Pose pose(const Pose& X_WA_then, double q) const noexcept;
    /// Returns the motion of the second body at that pose, given the motion of the first body and
    /// the rate of the coordinate.
    BodyMotion motion(const Pose& X_WA_then, const BodyMotion& of_a, const Pose& X_WB_then,
                      double rate) const noexcept;
};

OnJoint on_joint(const scene::Scene& scene, const scene::Joint& joint);

/// Checks a placement that may use a joint; if it does not, it must have a body and a position.
void check_joint(const BodyPlace& place, const scene::Scene& scene, Diagnostics& diagnostics);

}  // namespace dihaptic::task
