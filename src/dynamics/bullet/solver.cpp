#include "dynamics/bullet/solver.h"

#include <algorithm>

namespace dihaptic::dynamics {

void SequentialImpulse::reserve(int bodies, int contacts) {
    m_tmpSolverBodyPool.reserve(bodies + 1);
    m_tmpSolverContactConstraintPool.reserve(contacts);
    m_tmpSolverContactFrictionConstraintPool.reserve(2 * contacts);
    m_orderTmpConstraintPool.reserve(contacts);
    m_orderFrictionConstraintPool.reserve(2 * contacts);
    last_friction_.reserve(static_cast<size_t>(contacts));
}

int SequentialImpulse::solve(std::span<btCollisionObject*> bodies,
                             std::span<btPersistentManifold*> manifolds, const Settings& settings,
                             double h, btDispatcher& dispatcher) {
    btContactSolverInfo info;
    // Two friction directions, along the slip and across: with one, a gripped block can pitch.
    // Directions are not kept from step to step, as that would make the cone a pyramid.
    info.m_solverMode = SOLVER_USE_2_FRICTION_DIRECTIONS;
    if (settings.warm_start) info.m_solverMode |= SOLVER_USE_WARMSTARTING;
    info.m_warmstartingFactor = 1;
    info.m_numIterations = settings.iterations;
    info.m_leastSquaresResidualThreshold = settings.tolerance * settings.tolerance;
    info.m_erp2 = settings.penetration_recovery;
    info.m_timeStep = h;
    info.m_splitImpulse = 0;

    iterations_ = 0;
    solveGroup(bodies.data(), static_cast<int>(bodies.size()), manifolds.data(),
               static_cast<int>(manifolds.size()), nullptr, 0, info, nullptr, &dispatcher);
    return iterations_;
}

void SequentialImpulse::convertContacts(btPersistentManifold** manifolds, int manifold_count,
                                        const btContactSolverInfo& info) {
    // Bullet starts normal impulses from the last step's, but friction from zero: a hold that only
    // friction carries would have to be found anew in every step. Directions change from step to
    // step, so the last impulse is kept as a vector and resolved along the new ones.
    last_friction_.clear();
    for (int m = 0; m < manifold_count; ++m) {
        for (int i = 0; i < manifolds[m]->getNumContacts(); ++i) {
            const btManifoldPoint& point = manifolds[m]->getContactPoint(i);
            last_friction_.push_back(point.m_appliedImpulseLateral1 * point.m_lateralFrictionDir1 +
                                     point.m_appliedImpulseLateral2 * point.m_lateralFrictionDir2);
        }
    }
    btSequentialImpulseConstraintSolver::convertContacts(manifolds, manifold_count, info);
    if ((info.m_solverMode & SOLVER_USE_WARMSTARTING) == 0) return;

    size_t contact = 0;
    int row = 0;
    for (int m = 0; m < manifold_count; ++m) {
        for (int i = 0; i < manifolds[m]->getNumContacts(); ++i, ++contact) {
            if (row >= m_tmpSolverContactConstraintPool.size()) return;
            const btSolverConstraint& normal = m_tmpSolverContactConstraintPool[row];
            if (normal.m_originalContactPoint != &manifolds[m]->getContactPoint(i))
                continue;  // left out by Bullet
            ++row;
            for (int direction = 0; direction < 2; ++direction) {
                btSolverConstraint& friction =
                    m_tmpSolverContactFrictionConstraintPool[normal.m_frictionIndex + direction];
                const btScalar limit = friction.m_friction * normal.m_appliedImpulse;
                const btScalar impulse = std::clamp(
                    last_friction_[contact].dot(friction.m_contactNormal1), -limit, limit);
                friction.m_appliedImpulse = impulse;
                apply(friction, impulse);
            }
        }
    }
}

btScalar SequentialImpulse::solveSingleIteration(
    int iteration, btCollisionObject** bodies, int body_count, btPersistentManifold** manifolds,
    int manifold_count, btTypedConstraint** constraints, int constraint_count,
    const btContactSolverInfo& info, btIDebugDraw* draw) {
    iterations_ = iteration + 1;
    const btScalar residual = btSequentialImpulseConstraintSolver::solveSingleIteration(
        iteration, bodies, body_count, manifolds, manifold_count, constraints, constraint_count,
        info, draw);
    return std::max(residual, release_friction());
}

btScalar SequentialImpulse::release_friction() {
    // Bullet leaves friction alone where the normal impulse has become zero, as its friction begins
    // at zero. Here it begins at the last step's, and would push on contacts that open.
    btScalar most = 0;
    for (int i = 0; i < m_tmpSolverContactFrictionConstraintPool.size(); ++i) {
        btSolverConstraint& friction = m_tmpSolverContactFrictionConstraintPool[i];
        const btScalar impulse = friction.m_appliedImpulse;
        if (impulse == 0 ||
            m_tmpSolverContactConstraintPool[friction.m_frictionIndex].m_appliedImpulse > 0)
            continue;
        apply(friction, -impulse);
        friction.m_appliedImpulse = 0;
        const btScalar change = impulse / friction.m_jacDiagABInv;
        most = std::max(most, change * change);
    }
    return most;
}

void SequentialImpulse::apply(const btSolverConstraint& row, btScalar impulse) {
    btSolverBody& a = m_tmpSolverBodyPool[row.m_solverBodyIdA];
    btSolverBody& b = m_tmpSolverBodyPool[row.m_solverBodyIdB];
    a.internalApplyImpulse(row.m_contactNormal1 * a.internalGetInvMass(), row.m_angularComponentA,
                           impulse);
    b.internalApplyImpulse(row.m_contactNormal2 * b.internalGetInvMass(), row.m_angularComponentB,
                           impulse);
}

}  // namespace dihaptic::dynamics
