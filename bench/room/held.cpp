#include "bench/held.h"

#include <string>

#include "base/number.h"
#include "model/gravity.h"

namespace dihaptic::bench {
namespace {

constexpr double kSpringHeld = 200;  // stiffness of the spring [N/m]

measure::BenchSetup setup_of(contact::Solver solver, double k) {
    measure::BenchSetup out;
    out.settings.dynamics.solver = solver;
    out.settings.coupling.stiffness = k;
    out.fingering = measure::Fingering::offset;
    return out;
}

scene::Scene scene_of(Held held, const measure::BenchSetup& setup) {
    scene::Scene out = measure::grasp_scene(setup);
    if (held == Held::nothing) return out;
    const int count = held == Held::six_hinges ? 6 : 1;
    scene::Body& block = out.bodies[1];
    const double mass = setup.mass / (1 + count);
    block.mass = mass;
    constexpr double kHeight = 0.01;
    constexpr double kApart = 0.005;
    double top = measure::kBlockSize;
    for (int i = 0; i < count; ++i) {
        scene::Body part;
        part.name = "part " + number_text(i + 1);
        part.shape = scene::Shape::box({0.03, 0.03, kHeight});
        part.mass = mass;
        part.position = {0, 0, top + kApart + kHeight / 2};
        scene::Joint joint;
        joint.name = "joint " + number_text(i + 1);
        joint.kind = held == Held::hinge || held == Held::six_hinges ? scene::JointKind::hinge
                                                                     : scene::JointKind::slider;
        joint.between = {out.bodies.back().name, part.name};
        joint.position = {0, 0, top};
        joint.axis = held == Held::slider ? Vec3::UnitY() : Vec3::UnitZ();
        if (held == Held::spring) {
            joint.stiffness = kSpringHeld;
            joint.damping = 0.2;
            joint.rest = mass * model::kGravity / kSpringHeld;  // it starts at rest
        }
        top += kApart + kHeight;
        out.bodies.push_back(part);
        out.joints.push_back(joint);
    }
    return out;
}

}  // namespace

double calm_k(Held held, contact::Solver solver) {
    return measure::highest_calm([&](double k) {
        const measure::BenchSetup setup = setup_of(solver, k);
        return measure::calm_grasp(measure::measure_hold(setup, scene_of(held, setup)));
    });
}

double tick_p99(Held held, contact::Solver solver) {
    const measure::BenchSetup setup = setup_of(solver, 1000);
    measure::Bench bench(scene_of(held, setup), measure::grasp_hand(setup), setup);
    servo::TickTimes times;
    times.reserve(static_cast<size_t>(bench.driver().duration() * setup.settings.rate) + 1);
    bench.run([](const frame::Frame&) {}, {}, &times);
    return times.quantile(0.99);
}

}  // namespace dihaptic::bench
