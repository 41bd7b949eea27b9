// Scene shapes, poses and axes as Bullet has them.
#pragma once

#include <btBulletCollisionCommon.h>

#include <memory>

#include "dynamics/polyhedron.h"
#include "scene/scene.h"

namespace dihaptic::dynamics {

inline btVector3 to_bullet(const Vec3& v) {
    return {v.x(), v.y(), v.z()};
}
inline Vec3 from_bullet(const btVector3& v) {
    return {v.x(), v.y(), v.z()};
}
inline btTransform to_bullet(const Pose& X) {
    return btTransform(btQuaternion(X.R.x(), X.R.y(), X.R.z(), X.R.w()), to_bullet(X.p));
}
inline Pose from_bullet(const btTransform& X) {
    const btQuaternion q = X.getRotation();
    return {Quat(q.w(), q.x(), q.y(), q.z()), from_bullet(X.getOrigin())};
}

/// 1 for each axis, 0 for those that are not there.
inline btVector3 factors(scene::Axes axes) {
    return {contains(axes, 0) ? 1.0 : 0.0, contains(axes, 1) ? 1.0 : 0.0,
            contains(axes, 2) ? 1.0 : 0.0};
}

/// The shape, in the frame that Bullet moves: centre of mass and principal axes of inertia. `X_BM`
/// is the pose of that frame in the body's.
std::unique_ptr<btCollisionShape> bullet_shape(const scene::Shape& shape, const Pose& X_BM);

/// The shape as a polyhedron in the same frame; null when it is round, flat, or has too many edges.
std::unique_ptr<Polyhedron> polyhedron(const scene::Shape& shape, const Pose& X_BM);

}  // namespace dihaptic::dynamics
