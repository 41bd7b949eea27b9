#ifdef DIHAPTIC_PEERS
#include "bench/simbody_model.h"

#include <Simbody.h>

namespace dihaptic::bench::simbody {
namespace {

SimTK::Vec3 to_simbody(const Vec3& v) {
    return {v.x(), v.y(), v.z()};
}

SimTK::Transform to_simbody(const Pose& X) {
    const SimTK::Quaternion q(X.R.w(), X.R.x(), X.R.y(), X.R.z());
    return {SimTK::Rotation(q), to_simbody(X.p)};
}

Pose from_simbody(const SimTK::Transform& X) {
    const SimTK::Quaternion q = X.R().convertRotationToQuaternion();
    return {Quat(q[0], q[1], q[2], q[3]), Vec3(X.p()[0], X.p()[1], X.p()[2])};
}

}  // namespace

struct Model::Parts {
    SimTK::MultibodySystem system;
    SimTK::SimbodyMatterSubsystem matter{system};
    SimTK::GeneralForceSubsystem forces{system};
    std::vector<SimTK::MobilizedBodyIndex> bodies;
    std::unique_ptr<SimTK::Integrator> integrator;
};

Model::Model(const std::vector<Link>& links, const Vec3& gravity, Steps steps)
    : parts_(std::make_unique<Parts>()) {
    Parts& p = *parts_;
    SimTK::Force::Gravity(p.forces, p.matter, to_simbody(gravity));
    for (const Link& link : links) {
        const SimTK::Body::Rigid body(SimTK::MassProperties(
            link.mass, SimTK::Vec3(0), SimTK::Inertia(to_simbody(link.inertia))));
        SimTK::MobilizedBody& parent =
            link.parent < 0 ? p.matter.updGround()
                            : p.matter.updMobilizedBody(p.bodies[static_cast<size_t>(link.parent)]);
        const SimTK::MobilizedBody::Pin pin(parent, to_simbody(link.X_PJ), body,
                                            to_simbody(link.X_BJ));
        p.bodies.push_back(pin.getMobilizedBodyIndex());
    }
    const SimTK::State state = p.system.realizeTopology();
    if (steps == Steps::chosen) {
        p.integrator = std::make_unique<SimTK::RungeKuttaMersonIntegrator>(p.system);
    } else {
        constexpr double kStep = 1e-3;
        p.integrator = std::make_unique<SimTK::SemiExplicitEulerIntegrator>(p.system, kStep);
    }
    p.integrator->initialize(state);
}

Model::~Model() = default;

void Model::step_to(double time, std::vector<Pose>& X_WB) {
    Parts& p = *parts_;
    constexpr double kRounding = 1e-9;
    while (p.integrator->getTime() < time - kRounding) p.integrator->stepTo(time, time);
    const SimTK::State& state = p.integrator->getState();
    p.system.realize(state, SimTK::Stage::Position);
    for (size_t i = 0; i < X_WB.size(); ++i)
        X_WB[i] = from_simbody(p.matter.getMobilizedBody(p.bodies[i]).getBodyTransform(state));
}

}  // namespace dihaptic::bench::simbody
#endif
