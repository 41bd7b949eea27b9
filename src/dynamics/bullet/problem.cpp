#include "dynamics/bullet/problem.h"

#include <BulletDynamics/Dynamics/btRigidBody.h>

#include "dynamics/bullet/shape.h"

namespace dihaptic::dynamics {
namespace {

using contact::kFixed;

Mat3 from_bullet(const btMatrix3x3& m) {
    Mat3 out;
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) out(i, j) = m[i][j];
    }
    return out;
}

/// Columns: the normal and two tangents, which depend on the normal only.
Mat3 contact_frame(const Vec3& normal) {
    btVector3 first;
    btVector3 second;
    btPlaneSpace1(to_bullet(normal), first, second);
    Mat3 R;
    R.col(0) = normal;
    R.col(1) = dynamics::from_bullet(first);
    R.col(2) = normal.cross(R.col(1));
    return R;
}

Vec3 middle(const btManifoldPoint& point) {
    return 0.5 * (dynamics::from_bullet(point.getPositionWorldOnA()) +
                  dynamics::from_bullet(point.getPositionWorldOnB()));
}

/// Mean height of a patch's points along the first normal. The points are moved by micrometres onto
/// one plane perpendicular to it: otherwise closing gaps of different size would require the
/// distance between two points to change, which rigid bodies that stick at both cannot do.
double mean_height(const btPersistentManifold& manifold) {
    double sum = 0;
    const Vec3 n_W = manifold.getNumContacts() > 0
                         ? dynamics::from_bullet(manifold.getContactPoint(0).m_normalWorldOnB)
                         : Vec3::Zero();
    for (int i = 0; i < manifold.getNumContacts(); ++i)
        sum += n_W.dot(middle(manifold.getContactPoint(i)));
    return sum / std::max(1, manifold.getNumContacts());
}

}  // namespace

void ManifoldProblem::reserve(int bodies, int contacts) {
    problem_.bodies.reserve(static_cast<size_t>(bodies));
    problem_.contacts.reserve(static_cast<size_t>(contacts));
    impulses_.reserve(static_cast<size_t>(contacts));
    index_.assign(static_cast<size_t>(bodies), kFixed);
    scratch_.reserve(static_cast<size_t>(bodies));
}

void ManifoldProblem::build(std::span<btCollisionObject*> bodies,
                            std::span<btPersistentManifold*> manifolds, double h, double recovery,
                            bool warm_start) noexcept {
    problem_.clear();
    for (btCollisionObject* object : bodies) {
        const btRigidBody& body = *btRigidBody::upcast(object);
        index_[static_cast<size_t>(body.getUserIndex())] = static_cast<int>(problem_.bodies.size());
        contact::ProblemBody& out = problem_.bodies.emplace_back();
        const Vec3 moves = dynamics::from_bullet(body.getLinearFactor());
        const Vec3 turns = dynamics::from_bullet(body.getAngularFactor());
        out.inverse_mass = (body.getInvMass() * moves).asDiagonal();
        out.inverse_inertia =
            turns.asDiagonal() * from_bullet(body.getInvInertiaTensorWorld()) * turns.asDiagonal();
        out.v_W = dynamics::from_bullet(body.getLinearVelocity());
        out.w_W = dynamics::from_bullet(body.getAngularVelocity());
    }
    const auto index = [&](const btCollisionObject& object) {
        return object.isStaticObject() ? kFixed
                                       : index_[static_cast<size_t>(object.getUserIndex())];
    };
    for (btPersistentManifold* manifold : manifolds) {
        // Bullet's normal points from its body 1 to its body 0
        const btCollisionObject& a = *manifold->getBody1();
        const btCollisionObject& b = *manifold->getBody0();
        const double height = mean_height(*manifold);
        for (int i = 0; i < manifold->getNumContacts(); ++i) {
            btManifoldPoint& point = manifold->getContactPoint(i);
            contact::ProblemContact& out = problem_.contacts.emplace_back();
            out.a = index(a);
            out.b = index(b);
            const Vec3 n_W = dynamics::from_bullet(point.m_normalWorldOnB);
            Vec3 p_WC = middle(point);
            p_WC += (height - n_W.dot(p_WC)) * n_W;
            out.p_AC_W = p_WC - dynamics::from_bullet(a.getWorldTransform().getOrigin());
            out.p_BC_W = p_WC - dynamics::from_bullet(b.getWorldTransform().getOrigin());
            out.R_WC = contact_frame(dynamics::from_bullet(point.m_normalWorldOnB));
            const double gap = point.getDistance();
            out.bias = (gap > 0 ? 1 : recovery) * gap / h;
            out.friction = point.m_combinedFriction;
            out.torsion_radius = torsion_radius(point);
        }
    }
    impulses_.resize(problem_.contacts.size());
    if (warm_start) {
        read_impulses(manifolds);
    } else {
        for (contact::Impulse& impulse : impulses_) impulse.setZero();
    }
}

void ManifoldProblem::read_impulses(std::span<btPersistentManifold*> manifolds) noexcept {
    size_t j = 0;
    for (btPersistentManifold* manifold : manifolds) {
        for (int i = 0; i < manifold->getNumContacts(); ++i, ++j) {
            btManifoldPoint& point = manifold->getContactPoint(i);
            const Mat3& R = problem_.contacts[j].R_WC;
            Vec3 first = dynamics::from_bullet(point.m_lateralFrictionDir1);
            Vec3 second = dynamics::from_bullet(point.m_lateralFrictionDir2);
            if (first.isZero()) {  // Bullet replaced the point: it keeps impulses, not directions
                first = R.col(1);
                second = R.col(2);
            }
            const Vec3 friction_W =
                point.m_appliedImpulseLateral1 * first + point.m_appliedImpulseLateral2 * second;
            impulses_[j] << point.m_appliedImpulse, R.col(1).dot(friction_W),
                R.col(2).dot(friction_W),
                problem_.contacts[j].torsion_radius > 0 ? torsion_impulse(point) : 0;
        }
    }
}

void ManifoldProblem::store(std::span<btPersistentManifold*> manifolds) const noexcept {
    size_t j = 0;
    for (btPersistentManifold* manifold : manifolds) {
        for (int i = 0; i < manifold->getNumContacts(); ++i, ++j) {
            btManifoldPoint& point = manifold->getContactPoint(i);
            const Mat3& R = problem_.contacts[j].R_WC;
            point.m_appliedImpulse = impulses_[j][0];
            point.m_lateralFrictionDir1 = to_bullet(Vec3(R.col(1)));
            point.m_lateralFrictionDir2 = to_bullet(Vec3(R.col(2)));
            point.m_appliedImpulseLateral1 = impulses_[j][1];
            point.m_appliedImpulseLateral2 = impulses_[j][2];
            torsion_impulse(point) = impulses_[j][3];
        }
    }
}

double ManifoldProblem::judge(std::span<btPersistentManifold*> manifolds) noexcept {
    read_impulses(manifolds);
    scratch_.resize(problem_.bodies.size());
    return contact::natural_map_residual(problem_, impulses_, scratch_);
}

void even_out(btPersistentManifold& manifold) noexcept {
    constexpr double kShare = 0.1;
    const int count = manifold.getNumContacts();
    btScalar sum = 0;
    for (int i = 0; i < count; ++i) sum += manifold.getContactPoint(i).m_appliedImpulse;
    for (int i = 0; i < count; ++i) {
        btScalar& impulse = manifold.getContactPoint(i).m_appliedImpulse;
        impulse += kShare * (sum / count - impulse);
    }
}

}  // namespace dihaptic::dynamics
