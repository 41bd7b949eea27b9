// Runs bodies on hinges in the Open Dynamics Engine, as a peer of our own solvers.
#include "bench/simulator.h"

#ifdef DIHAPTIC_PEERS
#include <ode/ode.h>

#include <memory>

#include "bench/hinges.h"
#include "scene/solid.h"
#endif

namespace dihaptic::bench {

#ifdef DIHAPTIC_PEERS

namespace {

using Step = int (*)(dWorldID, dReal);

struct DeleteOde {
    void operator()(dxWorld* world) const { dWorldDestroy(world); }
};

dBodyID make_body(dWorldID world, const scene::Body& body, const scene::Solid& solid) {
    const Pose X_WM = body.pose() * solid.X_BM;
    const dQuaternion q{X_WM.R.w(), X_WM.R.x(), X_WM.R.y(), X_WM.R.z()};
    dMass mass;
    dMassSetParameters(&mass, solid.mass, 0, 0, 0, solid.inertia.x(), solid.inertia.y(),
                       solid.inertia.z(), 0, 0, 0);
    const dBodyID out = dBodyCreate(world);
    dBodySetMass(out, &mass);
    dBodySetPosition(out, X_WM.p.x(), X_WM.p.y(), X_WM.p.z());
    dBodySetQuaternion(out, q);
    return out;
}

void run(Step step, const Trial& trial, int steps, const Watch& watch) {
    const std::unique_ptr<dxWorld, DeleteOde> world(dWorldCreate());
    const Vec3& g = trial.scene.gravity;
    dWorldSetGravity(world.get(), g.x(), g.y(), g.z());
    std::vector<dBodyID> bodies;
    std::vector<Pose> X_BM;
    for (const scene::Body& body : trial.scene.bodies) {
        const scene::Solid solid = scene::solid_of(body.shape, scene::mass(body));
        X_BM.push_back(solid.X_BM);
        bodies.push_back(make_body(world.get(), body, solid));
    }
    for (const Hinge& hinge : hinges_of(trial.scene)) {
        const dJointID joint = dJointCreateHinge(world.get(), nullptr);
        dJointAttach(joint, bodies[hinge.body], hinge.parent ? bodies[*hinge.parent] : nullptr);
        dJointSetHingeAnchor(joint, hinge.p_W.x(), hinge.p_W.y(), hinge.p_W.z());
        dJointSetHingeAxis(joint, hinge.axis_W.x(), hinge.axis_W.y(), hinge.axis_W.z());
    }
    std::vector<Pose> X_WB(bodies.size());
    for (int i = 0; i < steps; ++i) {
        for (const Trial::Push& push : trial.pushes)
            dBodyAddForce(bodies[push.body], push.force_W.x(), push.force_W.y(), push.force_W.z());
        step(world.get(), kStep);
        for (size_t b = 0; b < bodies.size(); ++b) {
            const dReal* const p = dBodyGetPosition(bodies[b]);
            const dReal* const q = dBodyGetQuaternion(bodies[b]);
            X_WB[b] =
                Pose{Quat(q[0], q[1], q[2], q[3]), Vec3(p[0], p[1], p[2])} * X_BM[b].inverse();
        }
        if (!watch(X_WB)) return;
    }
}

Simulator simulator(const std::string& name, Step step) {
    return {name, [step](const Trial& trial, int steps, const Watch& watch) {
                dInitODE2(0);
                run(step, trial, steps, watch);
                dCloseODE();
            }};
}

}  // namespace

std::vector<Simulator> ode_simulators() {
    return {simulator("ode", dWorldStep), simulator("ode_quick", dWorldQuickStep)};
}

#else

std::vector<Simulator> ode_simulators() {
    return {};
}

#endif

}  // namespace dihaptic::bench
