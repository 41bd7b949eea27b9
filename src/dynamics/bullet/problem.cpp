#include "dynamics/bullet/problem.h"

#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <algorithm>

#include "dynamics/bullet/carried.h"
#include "dynamics/bullet/shape.h"

namespace dihaptic::dynamics {
namespace {

using contact::kFixed;

/// Velocity that allows a contact which has not touched to separate or approach at any speed after
/// the step [m/s].
constexpr double kFarApart = 1e6;

/// Maximum speed at which a body that starts inside another is pushed out, so that it is not hurled
/// away [m/s].
constexpr double kMostRecovery = 0.5;

const contact::ProblemBody kRests;

/// The columns are the normal and two tangents, which depend only on the normal.
Mat3 contact_frame(const Vec3& normal) {
    btVector3 first;
    btVector3 second;
    btPlaneSpace1(to_bullet(normal), first, second);
    Mat3 R;
    R.col(0) = normal;
    R.col(1) = from_bullet(first);
    R.col(2) = normal.cross(R.col(1));
    return R;
}

Vec3 middle(const btManifoldPoint& point) {
    return 0.5 *
           (from_bullet(point.getPositionWorldOnA()) + from_bullet(point.getPositionWorldOnB()));
}

/// Mean height of a patch's points along the normal of the first point. The points are moved by
/// micrometres onto one plane perpendicular to this normal: otherwise, closing gaps of different
/// sizes would require the distance between two points to change, which is impossible for rigid
/// bodies that stick at both points.
double mean_height(const btPersistentManifold& manifold) {
    double sum = 0;
    const Vec3 n_W = manifold.getNumContacts() > 0
                         ? from_bullet(manifold.getContactPoint(0).m_normalWorldOnB)
                         : Vec3::Zero();
    for (int i = 0; i < manifold.getNumContacts(); ++i)
        sum += n_W.dot(middle(manifold.getContactPoint(i)));
    return sum / std::max(1, manifold.getNumContacts());
}

/// A point, moved along n_W to a height in this direction.
Vec3 at_height(const Vec3& p_W, double height, const Vec3& n_W) {
    return p_W + (height - n_W.dot(p_W)) * n_W;
}

/// The distance of the points at which friction turns the two bodies. If they touch at one point,
/// each is turned at its own surface, where the other one arrives in the step, so that a ball that
/// lands gets its spin, whatever gap remains. Flat faces share a plane (mean_height).
double apart(const btPersistentManifold& manifold, double gap) {
    return manifold.getNumContacts() == 1 ? std::max(gap, 0.0) : 0;
}

/// Makes a contact soft: with x the gap, the spring k and the damper c hold at the end of the step,
///
///     r / h = -k (x + h u) - c u    or    u + gamma r + bias = 0,    gamma = 1 / (h (c + h k))
///
/// While the spring is slow, most of h k is unwanted damping; it is reduced to theta h k, with
/// theta = s / (1 + s) and s = h^2 k / m, where m is the mass that the contact moves.
void soften(contact::ProblemContact& contact, const contact::ContactProblem& problem,
            const ContactLaw& law, double gap, double h) {
    constexpr double kLeastShare = 0.05;
    const double s = h * h * law.stiffness * contact::normal_mobility(problem, contact);
    const double theta = std::max(kLeastShare, s / (1 + s));
    const double k = law.stiffness / law.sharing;
    const double c = law.damping / law.sharing;
    contact.compliance = 1 / (h * (c + theta * h * k));
    contact.bias = h * k * gap * contact.compliance;
}

const contact::ProblemBody& body_of(const contact::ContactProblem& problem, int i) {
    return i == kFixed ? kRests : problem.bodies[static_cast<size_t>(i)];
}

/// How much the points of the two bodies separate when they move along their arcs for a step, minus
/// the separation due to their velocities, as a speed [m/s].
Vec3 on_arcs(const contact::ContactProblem& problem, const contact::ProblemContact& contact,
             double h) {
    const auto off = [&](const contact::ProblemBody& one, const Vec3& r) {
        return Vec3((rotation_by(h * one.w_W) * r - r) / h - one.w_W.cross(r));
    };
    return off(body_of(problem, contact.b), contact.p_BC_W) -
           off(body_of(problem, contact.a), contact.p_AC_W);
}

/// The tangential part of on_arcs(). Bodies that turn together, or about the contact's normal, move
/// on arcs, and stay together if their points reach the ends of the same chord. If only velocities
/// were considered, a block on a turntable would creep outward by w^2 r h / 2, and a body that
/// swings between two pads would slip. Returns zero for bodies that roll on each other, whose
/// points do not stay together; meant for patches of contacts.
Eigen::Vector2d along_arcs(const contact::ContactProblem& problem,
                           const contact::ProblemContact& contact, double h) {
    constexpr double kRolls = 0.01;  // fraction of the angular velocity
    constexpr double kLeast = 1e-6;  // [m/s]
    const Vec3& w_A = body_of(problem, contact.a).w_W;
    const Vec3& w_B = body_of(problem, contact.b).w_W;
    const double speed = std::max(w_A.norm(), w_B.norm());
    const double arm = std::max(contact.p_AC_W.norm(), contact.p_BC_W.norm());
    if (speed * speed * arm * h < kLeast) return Eigen::Vector2d::Zero();
    const Mat3& R = contact.R_WC;
    const double most = kRolls * speed;
    if ((R.transpose() * (w_B - w_A)).tail<2>().norm() > most) return Eigen::Vector2d::Zero();
    return (R.transpose() * on_arcs(problem, contact, h)).tail<2>();
}

/// A rolling rim touches at a different point in the middle of the step, for which velocities are
/// defined. The impulse acts at the initial contact point, and must allow that point to move while
/// the later contact point is at rest. Returns this motion, in the contact frame [m/s]. Without it,
/// Euler's disc sinks from step to step and gains energy.
Vec3 by_rolling(const contact::ContactProblem& problem, const contact::ProblemContact& contact,
                const btManifoldPoint& point) {
    const Vec3 ahead = ahead_of(point);
    if (ahead.isZero(0) || carried(point).normal == 0) return Vec3::Zero();
    const Vec3 turns = body_of(problem, contact.b).w_W - body_of(problem, contact.a).w_W;
    return contact.R_WC.transpose() * turns.cross(ahead);
}

/// Normal velocity at which bodies separate, according to Newton's law e u, where u is the speed at
/// which they touch, at the fraction `when` of the step. `free` is the normal velocity without the
/// contact, in the middle of the step; loads changed it by `loads`, and will again in the next
/// step. Velocities are those in the middle of steps, so the part of `loads` between the middle and
/// the touch is taken into account. Returns zero for an impact so slow that the bodies would touch
/// again in the next step.
double rebound(double free, double when, double loads, double restitution) {
    const double leaves = restitution * (-free - loads * (when - 0.5));
    const double speed = leaves + std::clamp(loads, -leaves, leaves) / 2;
    return speed > std::abs(loads) ? speed - loads : 0;
}

}  // namespace

void ManifoldProblem::reserve(std::vector<double> torsion_radii, int contacts,
                              size_t joint_elements) {
    problem_.joints.reserve(joint_elements);
    joint_impulses_.reserve(joint_elements);
    torsion_radii_ = std::move(torsion_radii);
    problem_.bodies.reserve(torsion_radii_.size());
    problem_.contacts.reserve(static_cast<size_t>(contacts));
    impulses_.reserve(static_cast<size_t>(contacts));
    kept_impulses_.reserve(static_cast<size_t>(contacts));
    kept_joint_impulses_.reserve(joint_elements);
    leaves_.reserve(static_cast<size_t>(contacts));
    index_.assign(torsion_radii_.size(), kFixed);
}

void ManifoldProblem::build(std::span<btCollisionObject*> bodies,
                            std::span<const contact::Mat6> inverse_mass,
                            std::span<btPersistentManifold*> manifolds, double h, double recovery,
                            bool warm_start) noexcept {
    problem_.clear();
    joint_impulses_.clear();
    for (btCollisionObject* object : bodies) {
        const btRigidBody& body = *btRigidBody::upcast(object);
        const auto at = static_cast<size_t>(body.getUserIndex());
        index_[at] = static_cast<int>(problem_.bodies.size());
        contact::ProblemBody& out = problem_.bodies.emplace_back();
        out.inverse_mass = inverse_mass[at];
        out.v_W = from_bullet(body.getLinearVelocity());
        out.w_W = from_bullet(body.getAngularVelocity());
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
        const double torsion = std::max(torsion_radii_[static_cast<size_t>(a.getUserIndex())],
                                        torsion_radii_[static_cast<size_t>(b.getUserIndex())]);
        for (int i = 0; i < manifold->getNumContacts(); ++i) {
            btManifoldPoint& point = manifold->getContactPoint(i);
            contact::ProblemContact& out = problem_.contacts.emplace_back();
            out.a = index(a);
            out.b = index(b);
            const Vec3 n_W = from_bullet(point.m_normalWorldOnB);
            const Vec3 p_WC = at_height(middle(point), height, n_W);
            carried(point).acts_at_W = p_WC;
            const double gap = gap_of(point);
            out.R_WC = contact_frame(normal_of(point));
            carried(point).apart = apart(*manifold, gap);
            const Vec3 to_own = carried(point).apart / 2 * out.R_WC.col(0);
            out.p_AC_W = p_WC - to_own - from_bullet(a.getWorldTransform().getOrigin());
            out.p_BC_W = p_WC + to_own - from_bullet(b.getWorldTransform().getOrigin());
            out.bias = gap > 0 ? gap / h : std::max(recovery * gap / h, -kMostRecovery);

            out.friction = point.m_combinedFriction;
            out.torsion_radius = torsion;
            out.compliance = carried(point).law.compliance;
            if (manifold->getNumContacts() > 1) out.slip = along_arcs(problem_, out, h);
            const Vec3 rolling = by_rolling(problem_, out, point);
            out.bias += rolling[0];
            out.slip += rolling.tail<2>();
            if (carried(point).law.stiffness > 0) soften(out, problem_, carried(point).law, gap, h);
        }
    }
    impulses_.resize(problem_.contacts.size());
    if (warm_start) {
        read_impulses(manifolds);
    } else {
        for (contact::Impulse& impulse : impulses_) impulse.setZero();
    }
}

void ManifoldProblem::add_joints(Joints& joints, std::span<const size_t> which, double h,
                                 bool warm_start) noexcept {
    joints.add_rows(which, index_, h, problem_, joint_impulses_);
    if (warm_start) return;
    for (Vec3& impulse : joint_impulses_) impulse.setZero();
}

double ManifoldProblem::guess(Joints& joints, std::span<const size_t> which, double h,
                              std::span<const contact::Vec6> change) noexcept {
    return joints.guess(which, index_, h, change, problem_);
}

void ManifoldProblem::hold(Joints& joints, std::span<const size_t> which, double h) noexcept {
    joints.hold(which, h, problem_);
}

void ManifoldProblem::read_impulses(std::span<btPersistentManifold*> manifolds) noexcept {
    size_t j = 0;
    for (btPersistentManifold* manifold : manifolds) {
        for (int i = 0; i < manifold->getNumContacts(); ++i, ++j) {
            const Carried& last = carried(manifold->getContactPoint(i));
            const Mat3& R = problem_.contacts[j].R_WC;
            impulses_[j] << last.normal, R.col(1).dot(last.friction_W),
                R.col(2).dot(last.friction_W), last.moment;
        }
    }
}

bool ManifoldProblem::bounce(std::span<btPersistentManifold*> manifolds,
                             std::span<const contact::Vec6> by_loads) noexcept {
    leaves_.clear();
    bool bounces = false;
    for (const btPersistentManifold* manifold : manifolds) {
        const auto a = static_cast<size_t>(manifold->getBody1()->getUserIndex());
        const auto b = static_cast<size_t>(manifold->getBody0()->getUserIndex());
        for (int i = 0; i < manifold->getNumContacts(); ++i) {
            const contact::ProblemContact& contact = problem_.contacts[leaves_.size()];
            const double restitution = carried(manifold->getContactPoint(i)).law.restitution;
            const bool touched = impulses_[leaves_.size()][0] > 0;
            const double free = contact::normal_velocity(problem_, contact);
            const auto along = [&](size_t body, const Vec3& arm) {
                const contact::Vec6& change = by_loads[body];
                return contact.R_WC.col(0).dot(change.head<3>() + change.tail<3>().cross(arm));
            };
            const double loads = along(b, contact.p_BC_W) - along(a, contact.p_AC_W);
            double leaves = -contact.bias;
            if (restitution > 0 && !touched) {
                leaves = -kFarApart;
            } else if (restitution > 0) {
                const double when = std::clamp(contact.bias / -free, 0.0, 1.0);
                const double speed = free < 0 ? rebound(free, when, loads, restitution) : 0;
                bounces = bounces || speed > 0;
                // bodies pushed together by other bodies obey the same law
                leaves = free < 0 ? speed : -restitution * free;
            }
            leaves_.push_back(leaves);
        }
    }
    if (!bounces) return false;
    for (size_t j = 0; j < leaves_.size(); ++j) problem_.contacts[j].bias = -leaves_[j];
    return true;
}

void ManifoldProblem::keep() noexcept {
    kept_impulses_ = impulses_;
    kept_joint_impulses_ = joint_impulses_;
}

void ManifoldProblem::mix(double share) noexcept {
    if (share == 1) return;
    for (size_t j = 0; j < impulses_.size(); ++j)
        impulses_[j] = kept_impulses_[j] + share * (impulses_[j] - kept_impulses_[j]);
    for (size_t j = 0; j < joint_impulses_.size(); ++j)
        joint_impulses_[j] =
            kept_joint_impulses_[j] + share * (joint_impulses_[j] - kept_joint_impulses_[j]);
}

void ManifoldProblem::store(Joints& joints, std::span<const size_t> which,
                            std::span<const contact::Vec6> change, double h) const noexcept {
    joints.store(which, index_, change, joint_impulses_, h);
}

void ManifoldProblem::store(std::span<btPersistentManifold*> manifolds) const noexcept {
    size_t j = 0;
    for (btPersistentManifold* manifold : manifolds) {
        for (int i = 0; i < manifold->getNumContacts(); ++i, ++j) {
            Carried& now = carried(manifold->getContactPoint(i));
            const Mat3& R = problem_.contacts[j].R_WC;
            now.normal = impulses_[j][0];
            now.friction_W = impulses_[j][1] * R.col(1) + impulses_[j][2] * R.col(2);
            now.moment = impulses_[j][3];
        }
    }
}

void even_out(btPersistentManifold& manifold) noexcept {
    constexpr double kShare = 0.1;
    const int count = manifold.getNumContacts();
    double sum = 0;
    for (int i = 0; i < count; ++i) sum += carried(manifold.getContactPoint(i)).normal;
    for (int i = 0; i < count; ++i) {
        double& impulse = carried(manifold.getContactPoint(i)).normal;
        impulse += kShare * (sum / count - impulse);
    }
}

}  // namespace dihaptic::dynamics
