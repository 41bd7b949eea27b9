#include "bench/mechanics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>

#include "base/number.h"
#include "base/random.h"
#include "base/unit.h"
#include "bench/chain.h"
#include "bench/held.h"
#include "bench/runge_kutta.h"
#include "dynamics/world.h"
#include "haptics/finger.h"

namespace dihaptic::bench {
namespace mechanics {
namespace {

using dynamics::World;
using scene::JointKind;

constexpr double kGravity = 9.81;
constexpr double kSide = 0.04, kMass = 0.1, kArm = 0.25;  // of a pendulum's cube
constexpr double kInertia = kMass * kSide * kSide / 6;
constexpr double kAboutHinge = kInertia + kMass * kArm * kArm;

scene::Body box(const std::string& name, const Vec3& size, const Vec3& position, double mass) {
    scene::Body out;
    out.name = name;
    out.shape = scene::Shape::box(size);
    out.position = position;
    out.mass = mass;
    return out;
}

scene::Joint hinge(std::vector<std::string> between, const Vec3& position,
                   const Vec3& axis = -Vec3::UnitY()) {
    scene::Joint out;
    out.name = "hinge " + between.back();
    out.between = std::move(between);
    out.position = position;
    out.axis = axis;
    return out;
}

scene::Joint slider(const std::string& body, const Vec3& position, const Vec3& axis) {
    scene::Joint out = hinge({body}, position, axis);
    out.kind = JointKind::slider;
    return out;
}

/// Worlds with one solver, without sleeping.
class Bench {
  public:
    explicit Bench(contact::Solver solver) {
        settings_.solver = solver;
        settings_.sleeping = false;
    }
    World make(std::vector<scene::Body> bodies, std::vector<scene::Joint> joints = {},
               const Vec3& gravity = {0, 0, -kGravity}) const {
        scene::Scene scene;
        scene.gravity = gravity;
        scene.bodies = std::move(bodies);
        scene.joints = std::move(joints);
        World world(scene, settings_);
        world.activate();
        return world;
    }
    const frame::DynamicsSettings& settings() const { return settings_; }

  private:
    frame::DynamicsSettings settings_;
};

Vec3 hanging(double angle, double length) {
    return length * Vec3(std::sin(angle), 0, -std::cos(angle));
}

World pendulum(const Bench& bench, double angle) {
    scene::Body bob = box("bob", Vec3::Constant(kSide), hanging(angle, kArm), kMass);
    bob.rotation = {0, -angle, 0};
    return bench.make({bob}, {hinge({"bob"}, Vec3::Zero())});
}

/// Relative error of the period, from passes through the lowest point within 12 s.
double period_error(const Bench& bench, double angle) {
    World world = pendulum(bench, angle);
    std::vector<double> passes;
    double before = world.joints()[0].position + angle;
    for (int i = 1; i < 12000; ++i) {
        world.step(kStep);
        const double now = world.joints()[0].position + angle;
        if (before < 0 && now >= 0) passes.push_back(kStep * (i - now / (now - before)));
        before = now;
    }
    if (passes.size() < 2) return 1;
    const double period = (passes.back() - passes.front()) / static_cast<double>(passes.size() - 1);
    const double exact = 4 * std::sqrt(kAboutHinge / (kMass * kGravity * kArm)) *
                         std::comp_ellint_1(std::sin(angle / 2));
    return std::abs(period / exact - 1);
}

void measure_pendulum(const Bench& bench, MechanicsFigures& out) {
    for (const double degrees : {5.0, 45.0, 90.0})
        out.pendulum_period = std::max(out.pendulum_period, period_error(bench, degrees * kDegree));
    for (const double degrees : {135.0, 170.0})
        out.pendulum_period_170 =
            std::max(out.pendulum_period_170, period_error(bench, degrees * kDegree));
    World world = pendulum(bench, 120 * kDegree);
    for (int i = 0; i < 60000; ++i) {
        world.step(kStep);
        out.pendulum_drift_mm =
            std::max(out.pendulum_drift_mm, 1e3 * std::abs(world.states()[0].X_WB.p.norm() - kArm));
    }
    World still = pendulum(bench, 0);
    for (int i = 0; i < 100; ++i) still.step(kStep);
    out.reaction =
        (still.joints()[0].force_W - Vec3(0, 0, kMass * kGravity)).norm() / (kMass * kGravity);
}

/// Largest distance of the second of two cubes from the solution of its equations, in 2 s [m].
double double_pendulum_error(const Bench& bench, double h) {
    using State = Eigen::Vector4d;  // both angles from the vertical, and their rates
    const double m = kMass, l = kArm;
    const auto rate = [&](const State& s) -> State {
        const double a = s[0], b = s[1];
        Eigen::Matrix2d M;
        M << kInertia + 2 * m * l * l, m * l * l * std::cos(a - b), m * l * l * std::cos(a - b),
            kInertia + m * l * l;
        const double turn = m * l * l * std::sin(a - b);
        const Eigen::Vector2d f(-turn * s[3] * s[3] - 2 * m * kGravity * l * std::sin(a),
                                turn * s[2] * s[2] - m * kGravity * l * std::sin(b));
        const Eigen::Vector2d acceleration = M.inverse() * f;
        return {s[2], s[3], acceleration[0], acceleration[1]};
    };
    State s(90 * kDegree, 60 * kDegree, 0, 0);
    const Vec3 p = hanging(s[0], l);
    const Vec3 q = p + hanging(s[1], l);
    scene::Body first = box("first", Vec3::Constant(kSide), p, m);
    first.rotation = {0, -s[0], 0};
    scene::Body second = box("second", Vec3::Constant(kSide), q, m);
    second.rotation = {0, -s[1], 0};
    World world = bench.make({first, second},
                             {hinge({"first"}, Vec3::Zero()), hinge({"first", "second"}, p)});
    // a step's velocities are those at its middle: a body that starts at rest was at rest half a
    // step before
    s.tail<2>() = h / 2 * rate(s).tail<2>();
    double worst = 0;
    constexpr int kParts = 10;
    for (int i = 0; i * h < 2; ++i) {
        for (int k = 0; k < kParts; ++k) s = runge_kutta(s, h / kParts, rate);
        world.step(h);
        const Vec3 exact = hanging(s[0], l) + hanging(s[1], l);
        worst = std::max(worst, (world.states()[1].X_WB.p - exact).norm());
    }
    return worst;
}

/// The cup of coffee: a cart of 2.4 kg that moves to and fro, with a bob of 0.6 kg and 10 mm
/// radius. Largest distance of the bob from the solution of its equation, in 5 s [m].
double cart_pendulum_error(const Bench& bench) {
    constexpr double kLength = 0.25, kRadius = 0.01, kAmplitude = 0.05, kHertz = 0.9;
    constexpr double kAbout = kLength * kLength + 0.4 * kRadius * kRadius;  // by mass
    constexpr double kOmega = 2 * std::numbers::pi * kHertz;
    const auto cart_at = [](double t) { return kAmplitude * (1 - std::cos(kOmega * t)); };
    scene::Body cart = box("cart", {0.1, 0.1, 0.05}, Vec3::Zero(), 2.4);
    scene::Body bob;
    bob.name = "bob";
    bob.shape = scene::Shape::sphere(kRadius);
    bob.mass = 0.6;
    bob.position = {0, 0, -kLength};
    World world = bench.make({cart, bob}, {hinge({"cart", "bob"}, Vec3::Zero())});
    using State = Eigen::Vector3d;  // angle, its rate, time
    const auto rate = [&](const State& s) -> State {
        const double cart_acceleration = kAmplitude * kOmega * kOmega * std::cos(kOmega * s[2]);
        return {
            s[1],
            -kLength * (kGravity * std::sin(s[0]) + cart_acceleration * std::cos(s[0])) / kAbout,
            1};
    };
    State s = State::Zero();  // cart and bob are at rest, also half a step before
    double worst = 0;
    for (int i = 1; i <= 5000; ++i) {
        for (int k = 0; k < 10; ++k) s = runge_kutta(s, kStep / 10, rate);
        world.drive({0}, {Quat::Identity(), {cart_at(i * kStep), 0, 0}});
        world.step(kStep);
        const Vec3 exact = Vec3(cart_at(i * kStep), 0, 0) + hanging(s[0], kLength);
        worst = std::max(worst, (world.states()[1].X_WB.p - exact).norm());
    }
    return worst;
}

/// Change of an undamped spring of a given frequency in a step (src/dynamics/README.md).
struct SpringForm {
    double root;   ///< factor on amplitudes
    double phase;  ///< [rad]

    explicit SpringForm(double omega) {
        const double s = kStep * kStep * omega * omega;
        const double delta = s / (1 + s);
        const double theta = (1 + 3 * delta) / 4;
        const double D = (1 + theta * s * (1 - delta)) / (1 + theta * s);
        const double T = 1 + D - s / (1 + theta * s);
        root = std::sqrt(D);
        phase = std::acos(T / 2 / root);
    }
};

void measure_springs(const Bench& bench, MechanicsFigures& out) {
    for (const double k : {10.0, 100.0, 1e3, 1e4, 1e5}) {
        scene::Joint spring = slider("block", Vec3::Zero(), Vec3::UnitZ());
        spring.stiffness = k;
        spring.damping = 2 * std::sqrt(k * kMass);
        World world =
            bench.make({box("block", Vec3::Constant(kSide), Vec3::Zero(), kMass)}, {spring});
        for (int i = 0; i < 5000; ++i) world.step(kStep);
        const double expected = -kMass * kGravity / k;
        out.spring_deflection =
            std::max(out.spring_deflection, std::abs(world.joints()[0].position / expected - 1));
    }
    for (const double hertz : {1.0, 5.0, 10.0, 15.0, 30.0, 60.0, 100.0}) {
        const double omega = 2 * std::numbers::pi * hertz;
        const SpringForm form(omega);
        scene::Joint spring = slider("block", Vec3::Zero(), Vec3::UnitX());
        spring.stiffness = kMass * omega * omega;
        spring.rest = 0.01;
        World world = bench.make({box("block", Vec3::Constant(kSide), Vec3::Zero(), kMass)},
                                 {spring}, Vec3::Zero());
        const auto stretch = [&] { return world.joints()[0].position - spring.rest; };
        const double q0 = stretch();
        world.step(kStep);
        const double sine =
            (q0 * std::cos(form.phase) - stretch() / form.root) / std::sin(form.phase);
        for (int n = 2; n < 400; ++n) {
            world.step(kStep);
            const double amplitude = std::pow(form.root, n);
            const double expected =
                amplitude * (q0 * std::cos(n * form.phase) - sine * std::sin(n * form.phase));
            out.spring_form = std::max(out.spring_form,
                                       std::abs(stretch() - expected) / (amplitude * std::abs(q0)));
        }
        if (hertz <= 15)
            out.spring_hz = std::max(out.spring_hz, std::abs(form.phase / (omega * kStep) - 1));
    }
}

/// Joint of coupler and rocker of a four-bar linkage, from the crank's angle: the upper
/// intersection of two circles.
struct FourBar {
    static constexpr double kCrank = 0.06, kCoupler = 0.15, kRocker = 0.12, kBase = 0.15;

    static Vec3 crank_end(double angle) {
        return kCrank * Vec3(std::cos(angle), 0, std::sin(angle));
    }
    static Vec3 rocker_end(double angle) {
        const Vec3 from = crank_end(angle);
        const Vec3 way = Vec3(kBase, 0, 0) - from;
        const double d = way.norm();
        const double along = (kCoupler * kCoupler - kRocker * kRocker + d * d) / (2 * d);
        const double up = std::sqrt(kCoupler * kCoupler - along * along);
        const Vec3 u = way / d;
        return from + along * u + up * Vec3(-u.z(), 0, u.x());
    }
};

scene::Body bar(const std::string& name, const Vec3& from, const Vec3& to, double mass) {
    const Vec3 way = to - from;
    scene::Body out = box(name, {way.norm(), 0.01, 0.01}, (from + to) / 2, mass);
    out.rotation = {0, -std::atan2(way.z(), way.x()), 0};
    return out;
}

/// Largest distance of the coupler's end from its position according to the crank's angle, in 5 s
/// [m].
double four_bar_error(const Bench& bench) {
    constexpr double kStart = 60 * kDegree;
    const Vec3 a = FourBar::crank_end(kStart);
    const Vec3 b = FourBar::rocker_end(kStart);
    const Vec3 end(FourBar::kBase, 0, 0);
    World world = bench.make(
        {bar("crank", Vec3::Zero(), a, 0.1), bar("coupler", a, b, 0.2), bar("rocker", end, b, 0.1)},
        {hinge({"crank"}, Vec3::Zero()), hinge({"crank", "coupler"}, a),
         hinge({"coupler", "rocker"}, b), hinge({"rocker"}, end)});
    world.apply({0}, Vec3::Zero(), {0, -2, 0});  // starts the rotation
    double worst = 0;
    for (int i = 0; i < 5000; ++i) {
        world.step(kStep);
        const Pose& crank = world.states()[0].X_WB;
        const Vec3 tip = crank * Vec3(FourBar::kCrank / 2, 0, 0);
        const double angle = std::atan2(tip.z(), tip.x());
        const Vec3 coupler_end = world.states()[1].X_WB * Vec3(FourBar::kCoupler / 2, 0, 0);
        worst = std::max(worst, (coupler_end - FourBar::rocker_end(angle)).norm());
    }
    return worst;
}

/// Growth of the hinge forces of a door on three hinges that is pushed and then swings for 60 s.
double door_force_growth(const Bench& bench) {
    std::vector<scene::Joint> hinges;
    for (const double z : {0.2, 0.5, 0.8}) {
        hinges.push_back(hinge({"door"}, {0, 0, z}, Vec3::UnitZ()));
        hinges.back().name += number_text(z);
    }
    World world = bench.make({box("door", {0.4, 0.02, 0.8}, {0.2, 0, 0.5}, 2)}, hinges);
    world.apply({0}, {0, 200, 0}, Vec3::Zero());
    double first = 0, last = 0;
    for (int i = 0; i < 60000; ++i) {
        world.step(kStep);
        if (i == 0) continue;  // the push
        for (const dynamics::JointState& state : world.joints()) {
            if (i < 5000) first = std::max(first, state.force_W.norm());
            if (i >= 55000) last = std::max(last, state.force_W.norm());
        }
    }
    return last / first;
}

scene::Body table() {
    scene::Body out = box("table", {1, 1, 0.1}, {0, 0, -0.05}, 1);
    out.mass.reset();
    out.fixed = true;
    return out;
}

void measure_bounces(const Bench& bench, MechanicsFigures& out) {
    Random random(3, "bench bounce");
    constexpr double kRadius = 0.02;
    constexpr int kHeights = 30;
    for (const double e : {0.1, 0.3, 0.5, 0.7, 0.9, 1.0}) {
        double sum = 0;
        for (int i = 0; i < kHeights; ++i) {
            const double height = random.uniform(0.19, 0.21);
            scene::Body ball;
            ball.name = "ball";
            ball.shape = scene::Shape::sphere(kRadius);
            ball.mass = 0.05;
            ball.position = {0, 0, kRadius + height};
            ball.surface.restitution = e;
            World world = bench.make({table(), ball});
            double last = 0;
            double highest = 0;
            for (int n = 0; n < 1000 && highest == 0; ++n) {
                world.step(kStep);
                const double v = world.states()[1].v_WB.z();
                if (last > 0 && v <= 0)
                    highest = world.states()[1].X_WB.p.z() - kRadius - kStep * v;
                last = v;
            }
            const double error = highest / (e * e * height) - 1;
            out.bounce = std::max(out.bounce, std::abs(error));
            sum += error;
        }
        out.bounce_bias = std::max(out.bounce_bias, std::abs(sum / kHeights));
    }
}

/// Two fingers squeeze a soft block, each by 3 mm: relative error of the felt force, compared
/// with springs in series.
double soft_error(const Bench& bench, double stiffness) {
    constexpr double kCoupling = 1000, kHalf = 0.02, kPad = 0.0025, kPress = 0.003;
    scene::Scene scene;
    scene.gravity.setZero();
    scene.bodies = {box("block", Vec3::Constant(2 * kHalf), Vec3::Zero(), 0.1)};
    scene.bodies[0].surface.stiffness = stiffness;
    scene.bodies[0].surface.damping = 2;
    World world(scene, bench.settings());
    scene::Finger pad;
    pad.shape = scene::Shape::box({2 * kPad, 0.02, 0.02});
    frame::CouplingSettings coupling;
    coupling.stiffness = kCoupling;
    std::vector<haptics::Finger> fingers;
    std::vector<frame::Handle> handles;
    for (const double side : {-1.0, 1.0}) {
        pad.name = side < 0 ? "thumb" : "index";
        const Vec3 at(side * (kHalf + kPad + 0.002), 0, 0);
        handles.push_back({at, Vec3::Zero()});
        fingers.emplace_back(pad, world.add_proxy(pad, at), coupling, 50);
    }
    world.activate();
    for (size_t i = 0; i < 2; ++i) fingers[i].place(world, handles[i]);
    double felt = 0;
    for (int n = 1; n <= 3000; ++n) {
        const double share = std::min(1.0, n / 1000.0);
        for (size_t i = 0; i < 2; ++i) {
            const double side = i == 0 ? -1 : 1;
            const Vec3 to(side * (kHalf + kPad + 0.002 - share * (kPress + 0.002)), 0, 0);
            handles[i].v_WH = (to - handles[i].p_WH) / kStep;
            handles[i].p_WH = to;
            fingers[i].begin_tick(world, handles[i], kStep);
            fingers[i].before_step(world, handles[i], kStep);
        }
        world.step(kStep);
        felt = 0;
        for (size_t i = 0; i < 2; ++i) {
            fingers[i].after_step(world, handles[i]);
            felt += fingers[i].force(world, handles[i], kStep).norm() / 2;
        }
    }
    const double expected = kPress * stiffness * kCoupling / (stiffness + kCoupling);
    return std::abs(felt / expected - 1);
}

struct Energy {
    double change = 0;  ///< relative change of the mean from the first to the last 10 s
    double above = 0;   ///< largest excess over the start, as a fraction
};

/// A chain of ten links, released stretched out at an angle from the vertical, for 60 s. Its energy
/// is zero when it hangs straight down.
Energy energy_of_chain(const Bench& bench, double angle) {
    constexpr int kLinks = 10;
    const scene::Scene scene = chain(kLinks, angle);
    World world = bench.make(scene.bodies, scene.joints);
    const double level = energy_of_chain_at(kLinks, 90 * kDegree);
    double first = 0, last = 0, most = 0;
    for (int i = 0; i < 60000; ++i) {
        world.step(kStep);
        double energy = level;
        for (const dynamics::BodyState& s : world.states()) {
            // velocities, and here also heights, are those of the middle of the step
            energy += energy_of_link(s.X_WB.p.z() - kStep / 2 * s.v_WB.z(), s.v_WB,
                                     s.X_WB.R.conjugate() * s.w_WB);
        }
        most = std::max(most, energy);
        if (i < 10000) first += energy / 10000;
        if (i >= 50000) last += energy / 10000;
    }
    const double start = energy_of_chain_at(kLinks, angle);
    return {std::abs(last / first - 1), most / start - 1};
}

/// A rod of ten blocks, glued to the world at one end and pushed at the other: error of its
/// deflection, which is a hundredth of its length, compared with beam theory.
double cantilever_error(const Bench& bench) {
    constexpr double kLength = 0.2, kWide = 0.02, kHigh = 0.01, kYoung = 1e7, kForce = 0.0125;
    constexpr int kBlocks = 10;
    scene::Scene scene;
    scene.gravity.setZero();
    scene::Lattice rod;
    rod.name = "rod";
    rod.size = {kLength, kWide, kHigh};
    rod.parts = {kBlocks, 1, 1};
    rod.mass = 0.05;
    rod.young = kYoung;
    rod.retardation = 0.08;
    rod.glued = {{scene::Side::x_low, "", {}}};
    scene.lattices = {rod};
    Diagnostics diagnostics;
    scene::expand_lattices(scene, diagnostics);
    World world(scene, bench.settings());
    world.activate();
    const auto tip = [&] {
        return Vec3(world.states()[kBlocks - 1].X_WB * Vec3(kLength / kBlocks / 2, 0, 0));
    };
    for (int i = 0; i < 4000; ++i) {
        world.apply_at({kBlocks - 1}, {0, 0, -kForce}, tip());
        world.step(kStep);
    }
    const double second_moment = kWide * std::pow(kHigh, 3) / 12;
    const double expected = kForce * std::pow(kLength, 3) / (3 * kYoung * second_moment);
    return std::abs(-tip().z() / expected - 1);
}

}  // namespace
}  // namespace mechanics

bool MechanicsFigures::within_bars() const {
    struct Bar {
        double figure;
        double most;
    };
    const std::array bars{Bar{pendulum_period, 1e-4},
                          Bar{pendulum_period_170, 1e-3},
                          Bar{pendulum_drift_mm, 1e-3},
                          Bar{double_pendulum_mm, 1},
                          Bar{cart_pendulum_mm, 0.5},
                          Bar{spring_deflection, 1e-6},
                          Bar{spring_hz, 1e-3},
                          Bar{spring_form, 1e-3},
                          Bar{four_bar_mm, 0.01},
                          Bar{door_force_growth, 1.001},
                          Bar{bounce, 1e-2},
                          Bar{soft_k, 5e-3},
                          Bar{energy, 1e-3},
                          Bar{energy_above, 1e-2},
                          Bar{reaction, 1e-6},
                          Bar{lattice, 3e-2}};
    return std::all_of(bars.begin(), bars.end(),
                       [](const Bar& bar) { return bar.figure <= bar.most; }) &&
           std::min({calm_k_hinge, calm_k_slider, calm_k_spring}) >= calm_k_rigid;
}

MechanicsFigures bench_mechanics(contact::Solver solver, const measure::Progress& progress) {
    using namespace mechanics;
    const Bench bench(solver);
    MechanicsFigures out;
    out.solver = enum_name(solver);
    progress("pendulums", 0);
    measure_pendulum(bench, out);
    const double whole = double_pendulum_error(bench, kStep);
    out.double_pendulum_mm = 1e3 * whole;
    out.double_pendulum_order = std::log2(whole / double_pendulum_error(bench, kStep / 2));
    out.cart_pendulum_mm = 1e3 * cart_pendulum_error(bench);
    progress("springs", 0.3);
    measure_springs(bench, out);
    progress("linkages", 0.4);
    out.four_bar_mm = 1e3 * four_bar_error(bench);
    out.door_force_growth = door_force_growth(bench);
    progress("bounces", 0.5);
    measure_bounces(bench, out);
    for (const double k : {50.0, 200.0, 1000.0, 5000.0})
        out.soft_k = std::max(out.soft_k, soft_error(bench, k));
    progress("energy", 0.6);
    const Energy swing = energy_of_chain(bench, 45 * kDegree);
    out.energy = swing.change;
    out.energy_above = swing.above;
    const Energy whip = energy_of_chain(bench, 90 * kDegree);
    out.whip_energy = whip.change;
    out.whip_energy_above = whip.above;
    progress("soft rods", 0.7);
    out.lattice = cantilever_error(bench);
    progress("held objects", 0.75);
    out.calm_k_rigid = calm_k(Held::nothing, solver);
    out.calm_k_hinge = calm_k(Held::hinge, solver);
    out.calm_k_slider = calm_k(Held::slider, solver);
    out.calm_k_spring = calm_k(Held::spring, solver);
    out.tick_us = tick_p99(Held::nothing, solver);
    out.tick_six_us = tick_p99(Held::six_hinges, solver);
    return out;
}

}  // namespace dihaptic::bench
