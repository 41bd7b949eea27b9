#include "bench/bullet_problem.h"

#include <cassert>

#include "bench/simulator.h"
#include "dynamics/bullet/shape.h"

namespace dihaptic::bench {
namespace {

using dynamics::from_bullet;
using dynamics::to_bullet;

/// Inverse of a value; 0 for a value that is about 0, since for Bullet 0 means infinite.
double inverse(double value, double largest) {
    return value > 1e-12 * largest ? 1 / value : 0;
}

std::unique_ptr<btRigidBody> bullet_body(const contact::ProblemBody& body) {
    // a body in Bullet has one mass, and a factor for each axis
    const Vec3 lightness = body.inverse_mass.diagonal().head<3>();
    const double largest = lightness.maxCoeff();
    assert((body.inverse_mass.topLeftCorner<3, 3>().isDiagonal()));
    const Eigen::SelfAdjointEigenSolver<Mat3> axes(body.inverse_mass.bottomRightCorner<3, 3>());
    Mat3 R = axes.eigenvectors();
    if (R.determinant() < 0) R.col(0) *= -1;
    Vec3 inertia;
    for (int i = 0; i < 3; ++i)
        inertia[i] = inverse(axes.eigenvalues()[i], axes.eigenvalues().maxCoeff());
    btRigidBody::btRigidBodyConstructionInfo info(inverse(largest, largest), nullptr, nullptr,
                                                  to_bullet(inertia));
    const Quat q(R);
    info.m_startWorldTransform.setIdentity();
    info.m_startWorldTransform.setRotation({q.x(), q.y(), q.z(), q.w()});
    auto out = std::make_unique<btRigidBody>(info);
    out->setFlags(0);
    out->setLinearFactor(
        {lightness[0] > 0 ? 1.0 : 0.0, lightness[1] > 0 ? 1.0 : 0.0, lightness[2] > 0 ? 1.0 : 0.0});
    return out;
}

}  // namespace

BulletProblem::BulletProblem(const contact::ContactProblem& problem,
                             std::span<const contact::Impulse> start)
    : problem_(problem), start_(start.begin(), start.end()) {
    for (const contact::ProblemBody& body : problem.bodies) {
        bodies_.push_back(bullet_body(body));
        moving_.push_back(bodies_.back().get());
    }
    bodies_.push_back(std::make_unique<btRigidBody>(
        btRigidBody::btRigidBodyConstructionInfo(0, nullptr, nullptr)));
    const auto body = [&](int index) {
        return bodies_[index == contact::kFixed ? problem.bodies.size()
                                                : static_cast<size_t>(index)]
            .get();
    };
    for (const contact::ProblemContact& contact : problem.contacts) {
        // Bullet's normal points from its body 1 to its body 0
        btRigidBody* const a = body(contact.b);
        btRigidBody* const b = body(contact.a);
        btPersistentManifold* manifold = manifold_list_.empty() ? nullptr : manifold_list_.back();
        if (manifold == nullptr || manifold->getBody0() != a || manifold->getBody1() != b ||
            manifold->getNumContacts() == MANIFOLD_CACHE_SIZE) {
            manifolds_.push_back(
                std::make_unique<btPersistentManifold>(a, b, 0, BT_LARGE_FLOAT, BT_LARGE_FLOAT));
            manifold = manifolds_.back().get();
            manifold_list_.push_back(manifold);
        }
        btManifoldPoint point;
        point.m_positionWorldOnA = to_bullet(contact.p_BC_W);
        point.m_positionWorldOnB = to_bullet(contact.p_AC_W);
        point.m_normalWorldOnB = to_bullet(contact.R_WC.col(0));
        point.m_distance1 = contact.bias * kStep;
        point.m_combinedFriction = contact.friction;
        manifold->addManifoldPoint(point);
    }
    reset();
}

void BulletProblem::reset() {
    for (size_t i = 0; i < problem_.bodies.size(); ++i) {
        bodies_[i]->setLinearVelocity(to_bullet(problem_.bodies[i].v_W));
        bodies_[i]->setAngularVelocity(to_bullet(problem_.bodies[i].w_W));
    }
    size_t j = 0;
    for (btPersistentManifold* manifold : manifold_list_) {
        for (int i = 0; i < manifold->getNumContacts(); ++i, ++j) {
            btManifoldPoint& point = manifold->getContactPoint(i);
            point.m_appliedImpulse = start_[j][0];
            point.m_appliedImpulseLateral1 = point.m_appliedImpulseLateral2 = 0;
        }
    }
}

void BulletProblem::solve(btSequentialImpulseConstraintSolver& solver, int iterations) {
    btContactSolverInfo info;
    info.m_solverMode = SOLVER_USE_2_FRICTION_DIRECTIONS | SOLVER_USE_WARMSTARTING;
    info.m_warmstartingFactor = 1;
    info.m_numIterations = iterations;
    info.m_leastSquaresResidualThreshold = 0;
    info.m_erp2 = 1;  // the problem's bias already includes error reduction
    info.m_timeStep = kStep;
    info.m_splitImpulse = 0;
    solver.solveGroup(moving_.data(), static_cast<int>(moving_.size()), manifold_list_.data(),
                      static_cast<int>(manifold_list_.size()), nullptr, 0, info, nullptr, nullptr);
}

std::vector<contact::Impulse> BulletProblem::impulses() const {
    std::vector<contact::Impulse> out;
    for (const btPersistentManifold* manifold : manifold_list_) {
        for (int i = 0; i < manifold->getNumContacts(); ++i) {
            const btManifoldPoint& point = manifold->getContactPoint(i);
            const Vec3 friction_W =
                from_bullet(point.m_appliedImpulseLateral1 * point.m_lateralFrictionDir1 +
                            point.m_appliedImpulseLateral2 * point.m_lateralFrictionDir2);
            const Mat3& R = problem_.contacts[out.size()].R_WC;
            out.emplace_back(point.m_appliedImpulse, R.col(1).dot(friction_W),
                             R.col(2).dot(friction_W), 0);
        }
    }
    return out;
}

}  // namespace dihaptic::bench
