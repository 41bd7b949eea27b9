// Computes the pose of a joint's second body from the joint's coordinate: trials can begin with a
// displaced pendulum or an open drawer.
#pragma once

#include "scene/scene.h"

namespace dihaptic::task {

struct BodyPlace;

/// Velocity of a body's origin and its angular velocity, in the world [m/s], [rad/s].
struct BodyMotion {
    Vec3 v = Vec3::Zero();
    Vec3 w = Vec3::Zero();
};

struct OnJoint {
    int first = -1;  ///< index of the joint's first body; -1: the world
    bool slides = false;
    Vec3 p_W = Vec3::Zero();      ///< point of the joint in the scene
    Vec3 axis_W = Vec3::UnitZ();  ///< axis of the joint in the scene; unit vector
    Pose X_WA;                    ///< the first body's pose in the scene
    Pose X_WB;                    ///< the second body's pose in the scene

    /// The second body's pose, from the current pose of the first body and the coordinate.
    Pose pose(const Pose& X_WA_then, double q) const noexcept;
    /// The second body's motion at that pose, from the first body's motion and the rate of the
    /// coordinate.
    BodyMotion motion(const Pose& X_WA_then, const BodyMotion& of_a, const Pose& X_WB_then,
                      double rate) const noexcept;
};

OnJoint on_joint(const scene::Scene& scene, const scene::Joint& joint);

/// Checks a placement by a joint; other placements must have a body and a position.
void check_joint(const BodyPlace& place, const scene::Scene& scene, Diagnostics& diagnostics);

}  // namespace dihaptic::task
