// Converts scene shapes, poses and axes to their Bullet equivalents.
#pragma once

#include <btBulletCollisionCommon.h>

#include <cstdint>
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

    /// Whether its contacts with parts for which this is true, too, are found by our own code.
    bool is_own() const {
        return polyhedron || round || shape->getShapeType() == STATIC_PLANE_PROXYTYPE;
    }

    bool is_ball() const { return round && !round->has_rim() && round->half == 0; }

    /// Bounding sphere, in S.
    btVector3 centre{0, 0, 0};
    double radius = 0;

    /// The part's pose and largest speed due to turning, as Collision last found them: they are the
    /// same for all pairs of the part.
    btTransform placed_at;
    Pose X_WS_placed;
    int64_t placing = 0;  // number of the search for which the pose was computed
    /// No point of the part has moved further than the increase of this sum since an earlier search
    /// [m].
    double way = 0;
    double turning = 0;  // [m/s]
    int64_t timing = 0;  // number of the search for which the speed was computed

    btTransform X_WS() const {
        return moved ? body->getWorldTransform() * X_MS : body->getWorldTransform();
    }
    /// Computes the pose, unless the search with this number has already done so.
    void place(int64_t search);
    /// Computes the speed due to turning, unless the search with this number has already done so.
    void time(int64_t search);
    /// Largest speed of any of the part's points due to its body's rotation at the pose X_WS [m/s].
    double turning_at(const btTransform& X_WS) const;
};

/// Returns the part to which bounds belong.
inline CollisionPart& part_of(const btBroadphaseProxy* bounds) {
    return *static_cast<CollisionPart*>(bounds->m_clientObject);
}

/// Returns how much closer the surfaces of two body parts may come to each other in a step,
/// according to their velocities before contacts act. Parts that are farther apart than this cannot
/// touch in the step [m].
double approach(const CollisionPart& a, const CollisionPart& b, double h);

/// Returns the convex parts of a shape. `X_BM` is the pose of M in the body's frame.
std::vector<std::unique_ptr<CollisionPart>> collision_parts(const scene::Shape& shape,
                                                            const Pose& X_BM);

}  // namespace dihaptic::dynamics
