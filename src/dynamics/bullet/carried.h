// The data that a contact point passes on to the next step as a starting value. The data is stored
// as the user data of Bullet's contact points, which Bullet keeps as long as it recognises the
// point.
#pragma once

#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>

#include <cmath>
#include <deque>
#include <vector>

#include "base/geometry.h"

namespace dihaptic::dynamics {

/// The contact law of two surfaces, except for friction, which is stored in Bullet's own contact
/// point.
struct ContactLaw {
    double restitution = 0;
    double stiffness = 0;         ///< 0 for a rigid contact [N/m]
    double damping = 0;           ///< [N*s/m]
    int sharing = 1;              ///< number of contacts that share the stiffness of a face
    double compliance = 0;        ///< for a point proxy, set by its owner [m/s per N*s]
    double height = 0;            ///< height of textures above the faces [m]
    Vec3 slope_W = Vec3::Zero();  ///< gradient of height, along the face of Bullet's body 1
};

/// The impulses of a contact on Bullet's body 0, towards which the contact's normal points.
struct Carried {
    double normal = 0;               ///< [N*s]
    Vec3 friction_W = Vec3::Zero();  ///< [N*s]
    double moment = 0;               ///< moment about the normal [N*m*s]
    Vec3 acts_at_W = Vec3::Zero();   ///< point of action, between the two surfaces
    double apart = 0;  ///< distance of the two bodies' points of action, along the normal [m]
    ContactLaw law;
    double sunk = 0;  ///< energy taken while the bodies entered each other, not yet returned [J]
    bool in_use = false;
};

/// The record that CarriedPool assigned to a contact point.
inline Carried& carried(const btManifoldPoint& point) {
    return *static_cast<Carried*>(point.m_userPersistentData);
}

/// The normal for body 0, including the slope of textures.
inline Vec3 normal_of(const btManifoldPoint& point) {
    const Vec3 n_W(point.m_normalWorldOnB.x(), point.m_normalWorldOnB.y(),
                   point.m_normalWorldOnB.z());
    const Vec3& slope_W = carried(point).law.slope_W;
    return slope_W.isZero(0) ? n_W : (n_W - slope_W).normalized();
}

/// The gap along normal_of(), including the height of textures [m].
inline double gap_of(const btManifoldPoint& point) {
    const ContactLaw& law = carried(point).law;
    return (point.getDistance() - law.height) / std::sqrt(1 + law.slope_W.squaredNorm());
}

/// Marks points on rolling rims. The vector to their future contact point (ContactPoint::ahead_W)
/// is stored in a field that Bullet uses for something else in its own points.
constexpr int kRolls = 1 << 16;
inline void roll_ahead(btManifoldPoint& point, const Vec3& ahead_W) {
    if (ahead_W.isZero(0)) return;
    point.m_contactPointFlags |= kRolls;
    point.m_lateralFrictionDir1 = btVector3(ahead_W.x(), ahead_W.y(), ahead_W.z());
}
inline Vec3 ahead_of(const btManifoldPoint& point) {
    if ((point.m_contactPointFlags & kRolls) == 0) return Vec3::Zero();
    const btVector3& ahead = point.m_lateralFrictionDir1;
    return {ahead.x(), ahead.y(), ahead.z()};
}

/// A pool of Carried records. Bullet does not report when a contact point disappears, so unused
/// records are collected only when the pool is empty.
class CarriedPool {
  public:
    void reserve(size_t points) {
        free_.reserve(points);
        for (size_t i = 0; i < points; ++i) free_.push_back(&all_.emplace_back());
    }

    /// Assigns records to those points of a manifold that do not have one yet. Returns false if too
    /// few records are left.
    bool give(const btPersistentManifold& manifold) {
        for (int i = 0; i < manifold.getNumContacts(); ++i) {
            const btManifoldPoint& point = manifold.getContactPoint(i);
            if (point.m_userPersistentData != nullptr) continue;
            if (free_.empty()) return false;
            *free_.back() = {};
            point.m_userPersistentData = free_.back();
            free_.pop_back();
        }
        return true;
    }

    /// Collects unused records. `each` must call its argument with every manifold. Allocates memory
    /// if all records are in use.
    template <class Each>
    void take_back(const Each& each) {
        for (Carried& one : all_) one.in_use = false;
        each([](const btPersistentManifold& manifold) {
            for (int i = 0; i < manifold.getNumContacts(); ++i) {
                const btManifoldPoint& point = manifold.getContactPoint(i);
                if (point.m_userPersistentData != nullptr) carried(point).in_use = true;
            }
        });
        free_.clear();
        for (Carried& one : all_) {
            if (!one.in_use) free_.push_back(&one);
        }
        while (free_.size() < MANIFOLD_CACHE_SIZE) free_.push_back(&all_.emplace_back());
    }

  private:
    std::deque<Carried> all_;  // a deque, whose elements keep their addresses
    std::vector<Carried*> free_;
};

}  // namespace dihaptic::dynamics
