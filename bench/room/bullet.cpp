// Runs a scene in Bullet with its default settings, as a peer of our own solvers.
#include <btBulletDynamicsCommon.h>

#include <memory>

#include "bench/hinges.h"
#include "bench/simulator.h"
#include "dynamics/bullet/shape.h"
#include "scene/solid.h"

namespace dihaptic::bench {
namespace {

using dynamics::factors;
using dynamics::from_bullet;
using dynamics::to_bullet;

struct Body {
    Pose X_MB;
    std::vector<std::unique_ptr<dynamics::CollisionPart>>
        parts;  // a single part: the benches' bodies are convex
    std::unique_ptr<btRigidBody> body;
};

Body make_body(const scene::Body& body) {
    const bool moves = body.moves_at_all();
    const scene::Solid solid = scene::solid_of(body.shape, moves ? scene::mass(body) : 0);
    Body out;
    out.X_MB = solid.X_BM.inverse();
    out.parts = dynamics::collision_parts(body.shape, solid.X_BM);
    btRigidBody::btRigidBodyConstructionInfo info(
        solid.mass, nullptr, out.parts.front()->shape.get(), to_bullet(solid.inertia));
    info.m_startWorldTransform = to_bullet(body.pose() * solid.X_BM);
    info.m_friction = std::sqrt(body.friction);  // Bullet multiplies the two coefficients of a pair
    out.body = std::make_unique<btRigidBody>(info);
    if (moves) {
        out.body->setLinearFactor(to_bullet(factors(body.moves)));
        out.body->setAngularFactor(to_bullet(factors(body.turns)));
        out.body->setActivationState(DISABLE_DEACTIVATION);
    }
    return out;
}

std::vector<std::unique_ptr<btHingeConstraint>> make_hinges(const scene::Scene& scene,
                                                            std::span<const Body> bodies) {
    std::vector<std::unique_ptr<btHingeConstraint>> out;
    for (const Hinge& hinge : hinges_of(scene)) {
        const auto place = [&](const btRigidBody& of, btVector3& pivot, btVector3& axis) {
            const btTransform to_body = of.getWorldTransform().inverse();
            pivot = to_body * to_bullet(hinge.p_W);
            axis = to_body.getBasis() * to_bullet(hinge.axis_W);
        };
        btVector3 p_A, p_B, axis_A, axis_B;
        btRigidBody& b = *bodies[hinge.body].body;
        place(b, p_B, axis_B);
        if (!hinge.parent) {
            out.push_back(std::make_unique<btHingeConstraint>(b, p_B, axis_B));
            continue;
        }
        btRigidBody& a = *bodies[*hinge.parent].body;
        place(a, p_A, axis_A);
        out.push_back(std::make_unique<btHingeConstraint>(a, b, p_A, p_B, axis_A, axis_B));
    }
    return out;
}

void run(const Trial& trial, int steps, const Watch& watch) {
    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher(&configuration);
    btDbvtBroadphase broadphase;
    btSequentialImpulseConstraintSolver solver;
    btDiscreteDynamicsWorld world(&dispatcher, &broadphase, &solver, &configuration);
    world.setGravity(to_bullet(trial.scene.gravity));
    std::vector<Body> bodies;
    for (const scene::Body& body : trial.scene.bodies) {
        bodies.push_back(make_body(body));
        world.addRigidBody(bodies.back().body.get());
    }
    const std::vector<std::unique_ptr<btHingeConstraint>> hinges = make_hinges(trial.scene, bodies);
    for (const auto& hinge : hinges) world.addConstraint(hinge.get(), true);
    std::vector<Pose> X_WB(bodies.size());
    for (int i = 0; i < steps; ++i) {
        trial.push(i, [&](const Trial::Push& push) {
            bodies[push.body].body->applyCentralForce(to_bullet(push.force_W));
        });
        world.stepSimulation(kStep, 0);
        for (size_t b = 0; b < bodies.size(); ++b)
            X_WB[b] = from_bullet(bodies[b].body->getWorldTransform()) * bodies[b].X_MB;
        if (!watch(X_WB)) break;
    }
    for (const auto& hinge : hinges) world.removeConstraint(hinge.get());
    for (const Body& body : bodies) world.removeRigidBody(body.body.get());
}

}  // namespace

Simulator bullet_simulator() {
    return {"bullet_default", run};
}

}  // namespace dihaptic::bench
