#include "dynamics/bullet/point_contacts.h"

#include "dynamics/bullet/carried.h"
#include "dynamics/bullet/shape.h"
#include "dynamics/world.h"

namespace dihaptic::dynamics {

void PointContacts::reserve(int points) {
    // for both the last step and the coming step
    slots_.resize(2 * static_cast<size_t>(points) * kMostPointContacts);
    taken_.reserve(slots_.size());
    for (Slot& slot : slots_) {
        slot.manifold = std::make_unique<btPersistentManifold>();
        // Bullet's constructor does not set this threshold
        slot.manifold->setContactBreakingThreshold(BT_LARGE_FLOAT);
    }
}

void PointContacts::add(const Contact& contact) noexcept {
    Slot* to = nullptr;
    for (Slot& slot : slots_) {
        const bool in_use = slot.manifold->getNumContacts() > 0;
        const bool same = in_use && slot.part == contact.part && slot.face == contact.face &&
                          slot.manifold->getBody0() == contact.body &&
                          slot.manifold->getBody1() == contact.point;
        if (same) {
            to = &slot;
            break;
        }
        if (!in_use && to == nullptr) to = &slot;
    }
    if (to == nullptr) return;
    btPersistentManifold& manifold = *to->manifold;
    const btVector3 p_WC = contact.point->getWorldTransform().getOrigin();
    if (manifold.getNumContacts() == 0) {
        manifold.setBodies(contact.body, contact.point);
        const btVector3 zero(0, 0, 0);
        manifold.addManifoldPoint(btManifoldPoint(zero, zero, zero, 0));
    }
    to->part = contact.part;
    to->face = contact.face;
    to->fresh = true;
    // Bullet's normal points from its body 1 to its body 0
    btManifoldPoint& point = manifold.getContactPoint(0);
    point.m_normalWorldOnB = -to_bullet(contact.n_W);
    point.m_positionWorldOnB = p_WC;
    point.m_positionWorldOnA = p_WC - contact.gap * to_bullet(contact.n_W);
    point.m_distance1 = contact.gap;
    point.m_combinedFriction = contact.friction;
    point.m_contactMotion1 = contact.compliance;
}

void PointContacts::forget() noexcept {
    for (Slot& slot : slots_) {
        slot.manifold->clearManifold();
        slot.fresh = false;
    }
    taken_.clear();
}

void PointContacts::take(std::vector<btPersistentManifold*>& out) noexcept {
    taken_.clear();
    for (Slot& slot : slots_) {
        if (slot.fresh) {
            out.push_back(slot.manifold.get());
            taken_.push_back(slot.manifold.get());
        } else {
            slot.manifold->clearManifold();
        }
        slot.fresh = false;
    }
}

btVector3 PointContacts::bend(const btRigidBody& point, double h) const noexcept {
    btVector3 sum(0, 0, 0);
    btScalar pressed = 0;
    for (const btPersistentManifold* manifold : taken_) {
        const btManifoldPoint& contact = manifold->getContactPoint(0);
        const btRigidBody& body = *btRigidBody::upcast(manifold->getBody0());
        const btVector3& w = body.getAngularVelocity();
        const double impulse = carried(contact).normal;
        if (manifold->getBody1() != &point || impulse <= 0 || w.isZero()) continue;
        const btVector3 centre = body.getCenterOfMassPosition() - h * body.getLinearVelocity();
        const btVector3 arm = contact.m_positionWorldOnB - centre;
        const btQuaternion turn(w.normalized(), h * w.length());
        sum += impulse * (quatRotate(turn, arm) - arm - h * w.cross(arm));
        pressed += impulse;
    }
    return pressed > 0 ? sum / pressed : sum;
}

}  // namespace dihaptic::dynamics
