// Converts scene shapes, poses and axes to their Bullet equivalents.
#pragma once

#include <btBulletCollisionCommon.h>

#include <memory>
#include <optional>

#include "dynamics/round.h"
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

inline Mat3 from_bullet(const btMatrix3x3& m) {
    Mat3 out;
    for (int i = 0; i < 3; ++i) out.row(i) = from_bullet(m[i]);
    return out;
}

/// Returns a vector with 1 for each axis in the set and 0 for the others.
inline Vec3 factors(scene::Axes axes) {
    return {contains(axes, 0) ? 1.0 : 0.0, contains(axes, 1) ? 1.0 : 0.0,
            contains(axes, 2) ? 1.0 : 0.0};
}

/// A convex part of a body, for collision detection. Bullet moves the frame M, whose origin is the
/// centre of mass and whose axes are the principal axes of inertia. S is the part's own frame.
struct CollisionPart {
    btCollisionObject* body = nullptr;
    std::unique_ptr<btCollisionShape> shape;  // the user pointer of this shape is the part
    std::unique_ptr<Polyhedron> polyhedron;   // null if round or flat, or with too many edges
    std::optional<Round> round;
    btTransform X_MS;
    double thickness = 0;                 // smallest extent [m]; huge for a plane
    bool moved = false;                   // whether X_MS is not the identity
    bool hidden = false;                  // whether the part currently has no contacts
    btBroadphaseProxy* bounds = nullptr;  // null until the part is added to a Collision

    btTransform X_WS() const {
        return moved ? body->getWorldTransform() * X_MS : body->getWorldTransform();
    }
};

/// Returns the convex parts of a shape. `X_BM` is the pose of M in the body's frame.
std::vector<std::unique_ptr<CollisionPart>> collision_parts(const scene::Shape& shape,
                                                            const Pose& X_BM);

}  // namespace dihaptic::dynamics
