// The data that a contact point passes to the next step as a start. It is the user data
// of Bullet's points, which Bullet passes on as long as it identifies the point.
#pragma once

#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>

#include <cmath>
#include <deque>
#include <vector>

#include "base/geometry.h"

namespace dihaptic::dynamics {

/// The surfaces' law at a contact, apart from friction, which is stored in Bullet's own point.
struct ContactLaw {
    double restitution = 0;
    double stiffness = 0;         ///< 0: rigid [N/m]
    double damping = 0;           ///< [N*s/m]
    int sharing = 1;              ///< number of contacts that share the stiffness of a face
    double compliance = 0;        ///< for a point proxy, from its owner [m/s per N*s]
    double height = 0;            ///< of textures above the faces [m]
    Vec3 slope_W = Vec3::Zero();  ///< gradient of height, along the face of Bullet's body 1
};

/// Impulses on Bullet's body 0, towards which the contact's normal points.
struct Carried {
    double normal = 0;               ///< [N*s]
    Vec3 friction_W = Vec3::Zero();  ///< [N*s]
    double moment = 0;               ///< about the normal [N*m*s]
    Vec3 acts_at_W = Vec3::Zero();   ///< point of action, between both surfaces
    ContactLaw law;
    bool in_use = false;
};

/// The record that CarriedPool has given to a point.
inline Carried& carried(const btManifoldPoint& point) {
    return *static_cast<Carried*>(point.m_userPersistentData);
}

/// The normal for body 0, with the slope of textures.
inline Vec3 normal_of(const btManifoldPoint& point) {
    const Vec3 n_W(point.m_normalWorldOnB.x(), point.m_normalWorldOnB.y(),
                   point.m_normalWorldOnB.z());
    const Vec3& slope_W = carried(point).law.slope_W;
    return slope_W.isZero(0) ? n_W : (n_W - slope_W).normalized();
}

/// The gap along normal_of(), with the height of textures [m].
inline double gap_of(const btManifoldPoint& point) {
    const ContactLaw& law = carried(point).law;
    return (point.getDistance() - law.height) / std::sqrt(1 + law.slope_W.squaredNorm());
}

/// For points on rolling rims: their future contact point (ContactPoint::ahead_W), in a field that
/// Bullet's own points use for something else.
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

/// A pool of Carried records. Bullet does not report when a contact point disappears; unused
/// records are collected only when the pool is empty.
class CarriedPool {
  public:
    void reserve(size_t points) {
        free_.reserve(points);
        for (size_t i = 0; i < points; ++i) free_.push_back(&all_.emplace_back());
    }

    /// Gives records to those points of a manifold that have none yet. False if too few are left.
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

    /// Collects unused records; `each` calls its argument with every manifold. Allocates if all
    /// records are in use.
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
    std::deque<Carried> all_;  // addresses are stable
    std::vector<Carried*> free_;
};

}  // namespace dihaptic::dynamics
