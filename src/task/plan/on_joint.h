// Says where a joint has its second body when it is at a coordinate: trials may begin with a
// pendulum that is displaced, or a drawer that is open.
#pragma once

#include "scene/scene.h"

namespace dihaptic::task {

struct BodyPlace;

/// Velocity of a body's origin and angular velocity, in the world [m/s], [rad/s].
struct BodyMotion {
    Vec3 v = Vec3::Zero();
    Vec3 w = Vec3::Zero();
};

struct OnJoint {
    int first = -1;  ///< index of the joint's first body; -1: the world
    bool slides = false;
    Vec3 p_W = Vec3::Zero();      ///< joint's point, and its axis, in the scene
    Vec3 axis_W = Vec3::UnitZ();  ///< unit vector
    Pose X_WA;                    ///< the first body's pose in the scene
    Pose X_WB;                    ///< the second one's

    /// The second body's pose, with the first one's and the coordinate as they are then.
    Pose pose(const Pose& X_WA_then, double q) const noexcept;
    /// The second body's motion at that pose, with the first one's and the coordinate's rate.
    BodyMotion motion(const Pose& X_WA_then, const BodyMotion& of_a, const Pose& X_WB_then,
                      double rate) const noexcept;
};

OnJoint on_joint(const scene::Scene& scene, const scene::Joint& joint);

/// Checks a place that names a joint, and that others name a body and a position.
void check_joint(const BodyPlace& place, const scene::Scene& scene, Diagnostics& diagnostics);

}  // namespace dihaptic::task
