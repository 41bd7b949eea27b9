// Tests surfaces in a world against closed forms: soft contacts, bounces, friction that decreases
// with speed, and viscous films.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/number.h"
#include "base/random.h"
#include "dynamics/test/blocks.h"

namespace dihaptic::dynamics::surfaces_test {
namespace {

/// A world with a table, whose top is at z = 0, and one body on it.
struct OnTable {
    scene::Body table = dynamics::table();
    scene::Body body;
    frame::DynamicsSettings settings = awake();

    explicit OnTable(scene::Body what) : body(std::move(what)) {}
    World make() const { return dynamics::make({table, body}, settings); }
};

const BodyIndex kBody{1};

class OfEach : public ::testing::TestWithParam<contact::Solver> {};
INSTANTIATE_TEST_SUITE_P(
    Surfaces, OfEach,
    ::testing::Values(contact::Solver::newton, contact::Solver::staggered_projections,
                      contact::Solver::stewart_trinkle, contact::Solver::sequential_impulse),
    [](const auto& which) {
        return std::string(enum_names(contact::Solver{})[static_cast<size_t>(which.param)]);
    });

TEST_P(OfEach, AreAsSoftAsTheySay) {
    constexpr double kMass = 0.2;
    for (const double k : {200.0, 1000.0, 20'000.0}) {
        for (const bool series : {false, true}) {
            OnTable on(box("block", {0.05, 0.05, 0.04}, {0, 0, 0.02}, kMass));
            on.settings.solver = GetParam();
            on.body.surface.stiffness = series ? 2 * k : k;
            on.body.surface.damping = 2 * std::sqrt(k * kMass);
            if (series) on.table.surface = on.body.surface;
            World world = on.make();
            for (int i = 0; i < 3000; ++i) world.step(kStep);
            const double depth = 0.02 - world.state(kBody).X_WB.p.z();
            EXPECT_NEAR(depth / (kMass * kGravity / k), 1, 1e-6) << k << " " << series;
            double force = 0;
            for (const contact::Contact& c : world.contacts()) force += c.normal_force;
            EXPECT_NEAR(force, kMass * kGravity, 1e-6 * kMass * kGravity);
        }
    }
}

TEST(SoftSurfaces, SwingAtTheirFrequencyAndLoseLittle) {
    // a block pressed into a surface by less than its weight oscillates like a mass on a spring
    constexpr double kMass = 0.2;
    for (const double hz : {3.0, 8.0, 15.0}) {
        const double omega = 2 * std::numbers::pi * hz;
        const double k = kMass * omega * omega;
        const double sunk = kMass * kGravity / k;
        OnTable on(box("block", {0.05, 0.05, 0.2}, {0, 0, 0.1 - 0.6 * sunk}, kMass));
        on.body.turns = scene::Axes::none;  // otherwise the body would fall over
        on.body.surface.stiffness = k;
        World world = on.make();
        std::vector<double> passes;
        double before = -1;
        double lowest_of_first = 0;
        double lowest_of_last = 0;
        constexpr int kSwings = 10;
        for (int i = 1; passes.size() <= kSwings && i < 20'000; ++i) {
            world.step(kStep);
            const double x = world.state(kBody).X_WB.p.z() - 0.1 + sunk;
            if (before > 0 && x <= 0) passes.push_back(kStep * (i - x / (x - before)));
            if (passes.size() == 1) lowest_of_first = std::min(lowest_of_first, x);
            if (passes.size() == kSwings) lowest_of_last = std::min(lowest_of_last, x);
            before = x;
        }
        ASSERT_GT(passes.size(), kSwings);
        EXPECT_NEAR(hz * (passes[kSwings] - passes[0]) / kSwings, 1, 2e-3) << hz;
        EXPECT_GT(lowest_of_last / lowest_of_first, 1 - 0.012 * hz) << hz;
        EXPECT_LT(lowest_of_last / lowest_of_first, 1.001) << hz;
    }
}

TEST(SoftSurfaces, DampAsTheySay) {
    // x = e^(-d t) cos(w t) with d = c / 2m, provided that the step's own contribution is small
    constexpr double kMass = 0.2, k = 400, c = 1.5;
    const double sunk = kMass * kGravity / k;
    OnTable on(box("block", {0.05, 0.05, 0.2}, {0, 0, 0.1 - 0.6 * sunk}, kMass));
    on.body.surface.stiffness = k;
    on.body.surface.damping = c;
    World world = on.make();
    const double d = c / (2 * kMass);
    const double w = std::sqrt(k / kMass - d * d);
    for (int i = 1; i <= 400; ++i) {
        world.step(kStep);
        const double t = i * kStep;
        const double x =
            0.4 * sunk * std::exp(-d * t) * (std::cos(w * t) + d / w * std::sin(w * t));
        EXPECT_NEAR(world.state(kBody).X_WB.p.z() - 0.1 + sunk, x, 0.02 * sunk) << i;
    }
}

scene::Body ball(double height, double restitution) {
    scene::Body out;
    out.name = "ball";
    out.shape = scene::Shape::sphere(0.02);
    out.mass = 0.05;
    out.position = {0, 0, 0.02 + height};
    out.surface.restitution = restitution;
    return out;
}

/// Height of the next apex above the table [m].
double apex(World& world) {
    double last = world.state(kBody).v_WB.z();
    for (int i = 0; i < 5000; ++i) {
        world.step(kStep);
        const double v = world.state(kBody).v_WB.z();
        // velocities are those in the middle of a step
        if (last > 0 && v <= 0) return world.state(kBody).X_WB.p.z() - 0.02 - kStep * v;
        last = v;
    }
    return 0;
}

TEST_P(OfEach, BounceByNewtonsLaw) {
    Random random(7, "bounce");
    for (const double e : {0.0, 0.2, 0.5, 0.8, 1.0}) {
        double sum = 0;
        constexpr int kHeights = 40;
        for (int i = 0; i < kHeights; ++i) {
            const double height = random.uniform(0.19, 0.21);
            OnTable on(ball(height, e));
            on.settings.solver = GetParam();
            World world = on.make();
            const double share = apex(world) / height;
            EXPECT_NEAR(share, e * e, 1e-2 * e * e + 1e-9) << e << " " << height;
            sum += share - e * e;
        }
        EXPECT_NEAR(sum / kHeights, 0, 2e-3 * e * e + 1e-9) << e;
    }
}

TEST(BouncingSurfaces, ComeToRestAndNeverGainHeight) {
    OnTable on(ball(0.2, 0.7));
    World world = on.make();
    double before = 0.2;
    for (int bounce = 0; bounce < 6; ++bounce) {
        const double now = apex(world);
        EXPECT_LT(now, 0.51 * before);
        before = now;
    }
    // the ball lies still after 2 v / g (1 + e + e^2 + ...) = 1.1 s
    for (int i = 0; i < 2000; ++i) world.step(kStep);
    EXPECT_NEAR(world.state(kBody).X_WB.p.z(), 0.02, 1e-6);
    EXPECT_NEAR(world.state(kBody).v_WB.z(), 0, 1e-9);
}

/// A world with a frictionless ball on ridges 0.2 mm high and one centimetre apart. The ball starts
/// between two of them.
World on_ridges(double speed) {
    scene::Body table = box("table", {2, 0.4, 0.1}, {0, 0, -0.05}, 0);
    table.fixed = true;
    table.friction = 0;
    table.surface.texture = scene::Texture{};
    table.surface.texture->wavelength = 0.01;
    table.surface.texture->height = 2e-4;
    scene::Body ball;
    ball.name = "ball";
    ball.shape = scene::Shape::sphere(0.01);
    ball.position = {-0.505, 0, 0.01};
    ball.mass = 0.05;
    ball.friction = 0;
    scene::Scene scene;
    scene.bodies = {table, ball};
    World world(scene, awake());
    world.activate();
    world.set_velocity({1}, {speed, 0, 0});
    return world;
}

TEST(Ridges, SlowDownWhatClimbsThemAndGiveItBack) {
    // on top of a ridge, the square of the speed is smaller by 2 g h
    const double over = 2 * kGravity * 2e-4;
    World world = on_ridges(0.15);
    double slowest = 1, fastest = 0, last = 0;
    for (int i = 0; i < 4000; ++i) {
        world.step(kStep);
        const double v = world.states()[1].v_WB.norm();
        if (i < 2000) slowest = std::min(slowest, v);
        fastest = std::max(fastest, v);
        if (i >= 3000) last = std::max(last, v);
    }
    EXPECT_NEAR(slowest, std::sqrt(0.15 * 0.15 - over), 2e-3);
    EXPECT_LT(fastest, 0.151);
    EXPECT_GT(last, 0.145);
}

TEST(Ridges, HoldWhatIsTooSlowForThem) {
    World world = on_ridges(0.05);
    double most = 0, first = 0, last = 0;
    for (int i = 0; i < 4000; ++i) {
        world.step(kStep);
        const double way = std::abs(world.states()[1].X_WB.p.x() + 0.505);
        most = std::max(most, way);
        if (i < 1000) first = std::max(first, way);
        if (i >= 3000) last = std::max(last, way);
    }
    // the ball turns back at a height of v^2 / 2 g
    const double turns =
        0.01 / (2 * std::numbers::pi) * std::acos(1 - 2 * (0.05 * 0.05 / (2 * kGravity)) / 2e-4);
    EXPECT_NEAR(first, turns, 1e-4);
    EXPECT_LT(most, 0.005);
    EXPECT_GT(last, 0.9 * first);
    EXPECT_LT(last, 1.05 * first);
}

TEST(BouncingSurfaces, KeepTheirEnergyWithoutLoss) {
    OnTable on(ball(0.2, 1));
    World world = on.make();
    double last = 0.2;
    for (int bounce = 0; bounce < 40; ++bounce) last = apex(world);
    EXPECT_NEAR(last, 0.2, 0.02 * 0.2);
}

TEST(BouncingSurfaces, ThrowABlockBackFromAllItsCornersWithoutTurningIt) {
    OnTable on(box("block", {0.05, 0.05, 0.04}, {0, 0, 0.12}, 0.2));
    on.body.surface.restitution = 0.6;
    World world = on.make();
    double highest = 0;
    for (int i = 0; i < 330; ++i) {
        world.step(kStep);
        if (i > 200) highest = std::max(highest, world.state(kBody).X_WB.p.z() - 0.02);
    }
    EXPECT_NEAR(highest, 0.36 * 0.1, 0.02 * 0.036);
    EXPECT_LT(world.state(kBody).w_WB.norm(), 1e-6);
}

TEST(BouncingSurfaces, TakeWhatASpringGivesMeanwhile) {
    // a paddle on a spring is released at -x0 and hits a ball at rest at -x0 / 2
    constexpr double kMass = 0.1, kRate = 400, kStretch = 0.01;
    scene::Scene scene;
    scene.gravity.setZero();
    scene::Body paddle = box("paddle", Vec3::Constant(0.04), {-kStretch, 0, 0}, kMass);
    scene::Body thrown = ball(0, 1);
    thrown.mass = 0.01;
    thrown.position = {0.04 - kStretch / 2, 0, 0};
    scene.bodies = {paddle, thrown};
    scene::Joint slider = joint(scene::JointKind::slider, {"paddle"}, Vec3::Zero(), Vec3::UnitX());
    slider.stiffness = kMass * kRate * kRate;
    slider.rest = kStretch;
    scene.joints = {slider};
    World world(scene, awake());
    world.activate();
    for (int i = 0; i < 60; ++i) world.step(1e-4);
    const double hits = kRate * kStretch * std::sqrt(0.75);
    EXPECT_NEAR(world.state({1}).v_WB.x(), 2 * kMass / (kMass + 0.01) * hits, 0.03 * hits);
}

TEST(BouncingSurfaces, GiveADoublePendulumThatStrikesATableNoEnergy) {
    // Kane and Levinson (1985): if there is friction, Newton's law alone would add energy
    Random random(11, "strikes");
    for (int i = 0; i < 300; ++i) {
        const double a = random.uniform(5, 60) * kDegree;  // angle from the vertical
        const double b = random.uniform(5, 75) * kDegree;
        constexpr double kLength = 0.1;
        const Vec3 elbow = kLength * Vec3(std::sin(a), 0, -std::cos(a));
        const Vec3 arm = kLength * Vec3(std::sin(b), 0, -std::cos(b));
        const Vec3 shoulder(0, 0, 0.012 - (elbow + arm).z());
        scene::Scene scene;
        scene.gravity.setZero();
        const double friction = random.uniform(0.2, 2);
        scene.bodies = {box("upper", {0.004, 0.004, kLength}, shoulder + elbow / 2, 0.05),
                        box("lower", {0.004, 0.004, kLength}, shoulder + elbow + arm / 2,
                            random.uniform(0.02, 0.1), friction),
                        table(friction)};
        scene.bodies[0].rotation = {0, -a, 0};
        scene.bodies[1].rotation = {0, -b, 0};
        scene.bodies[1].surface.restitution = random.uniform(0.2, 1);
        scene::Joint joint;
        joint.axis = Vec3::UnitY();
        joint.name = "shoulder";
        joint.between = {"upper"};
        joint.position = shoulder;
        scene.joints.push_back(joint);
        joint.name = "elbow";
        joint.between = {"upper", "lower"};
        joint.position = shoulder + elbow;
        scene.joints.push_back(joint);
        World world(scene, awake());
        world.activate();
        const Vec3 turn(0, random.uniform(-20, 20), 0);
        const Vec3 turn_lower(0, random.uniform(-20, 20), 0);
        world.set_motion({0}, turn.cross(elbow / 2), turn);
        world.set_motion({1}, turn.cross(elbow) + turn_lower.cross(arm / 2), turn_lower);
        world.step(kStep);
        double before = world.balance().kinetic;
        for (int step = 0; step < 60; ++step) {
            world.step(kStep);
            const double now = world.balance().kinetic;
            EXPECT_LT(now, 1.005 * before) << i << " " << step;
            before = now;
        }
    }
}

TEST(BouncingSurfaces, ExchangeTheVelocitiesOfEqualBalls) {
    scene::Scene scene;
    scene.gravity.setZero();
    scene.bodies = {ball(0, 1), ball(0, 1)};
    scene.bodies[0].name = "still";
    scene.bodies[0].position = Vec3::Zero();
    scene.bodies[1].position = {-0.1, 0, 0};
    World world(scene, awake());
    world.activate();
    world.set_velocity({1}, {0.7, 0, 0});
    for (int i = 0; i < 300; ++i) world.step(kStep);
    EXPECT_NEAR(world.state({0}).v_WB.x(), 0.7, 1e-6);
    EXPECT_NEAR(world.state({1}).v_WB.x(), 0, 1e-6);
}

TEST_P(OfEach, KeepTheEnergyOfARowOfBallsWhateverItsGaps) {
    for (const double gap : {0.0, 1e-4, 5e-4, 1e-3, 5e-3}) {
        scene::Scene scene;
        scene.gravity.setZero();
        for (int i = 0; i < 5; ++i) {
            scene.bodies.push_back(ball(0, 1));
            scene.bodies.back().name = "ball" + number_text(i);
            const double radius = scene.bodies.back().shape.radius;
            scene.bodies.back().position = {(2 * radius + gap) * i - (i == 0 ? 0.02 : 0), 0, 0};
        }
        frame::DynamicsSettings settings = awake();
        settings.solver = GetParam();
        World world(scene, settings);
        world.activate();
        const double speed = 0.6;
        world.set_velocity({0}, {speed, 0, 0});
        double momentum = 0, energy = 0;
        for (int i = 0; i < 400; ++i) {
            world.step(kStep);
            momentum = energy = 0;
            for (int k = 0; k < 5; ++k) {
                const double v = world.state({k}).v_WB.x();
                momentum += v / speed;
                energy += v * v / (speed * speed);
            }
            if (i > 50) {
                EXPECT_NEAR(energy, 1, 0.01) << gap << " " << i;
            }
            EXPECT_NEAR(momentum, 1, 1e-3) << gap << " " << i;
        }
        // each ball in turn passes on all of its momentum
        if (gap >= 5e-4) {
            EXPECT_NEAR(world.state({4}).v_WB.x(), speed, 0.01 * speed) << gap;
        }
    }
}

TEST(BouncingSurfaces, AreFeltByTheJointsOfWhatIsHit) {
    // a ball that returns at its initial speed has transferred twice its momentum to the joint
    scene::Scene scene;
    scene.gravity.setZero();
    scene.bodies = {ball(0, 1), ball(0, 1)};
    scene.bodies[0].name = "held";
    scene.bodies[0].position = Vec3::Zero();
    scene.bodies[1].position = {-0.1, 0, 0};
    scene.joints = {joint(scene::JointKind::fixed, {"held"}, Vec3::Zero())};
    World world(scene, awake());
    world.activate();
    const double speed = 0.7;
    world.set_velocity({1}, {speed, 0, 0});
    Vec3 impulse = Vec3::Zero();
    for (int i = 0; i < 300; ++i) {
        world.step(kStep);
        impulse += kStep * world.joints()[0].force_W;
    }
    EXPECT_NEAR(world.state({1}).v_WB.x(), -speed, 1e-3);
    EXPECT_NEAR(std::abs(impulse.x()), 2 * scene::mass(scene.bodies[1]) * speed, 1e-3);
}

/// Position and speed of a block on a table after some time during which a force along x [N] pushed
/// it.
struct Slid {
    double x = 0;
    double v = 0;
};
Slid slides(const OnTable& on, double speed, double force, double duration) {
    World world = on.make();
    for (int i = 0; i < 20; ++i) world.step(kStep);
    world.set_velocity(kBody, {speed, 0, 0});
    const double from = world.state(kBody).X_WB.p.x();
    for (int i = 0; i * kStep < duration; ++i) {
        world.apply(kBody, {force, 0, 0}, Vec3::Zero());
        world.step(kStep);
    }
    return {world.state(kBody).X_WB.p.x() - from, world.state(kBody).v_WB.x()};
}

/// Computes the same from the block's equation of motion, in steps of 10 us. In the world, the
/// initial speed is the speed half a step after the start.
Slid slides(const scene::PairSurface& surface, double mass, double speed, double force,
            double duration) {
    constexpr double kFine = 1e-5;
    Slid out{-speed * kStep / 2, speed};
    for (int i = 0; i * kFine < duration; ++i) {
        const double before = out.v;
        const double friction = kGravity * surface.friction_at(out.v, mass * kGravity);
        out.v = std::max(0.0, out.v + kFine * (force / mass - friction));
        out.x += kFine * (before + out.v) / 2;
    }
    return out;
}

constexpr double kMass = 0.2;
OnTable plate() {
    OnTable out(box("plate", {0.05, 0.05, 0.02}, {0, 0, 0.01}, kMass, 0.5));
    out.table.friction = 0.5;
    return out;
}

TEST(SlidingSurfaces, FollowStribecksCurve) {
    OnTable on = plate();
    on.body.surface.dynamic_friction = on.table.surface.dynamic_friction = 0.2;
    on.body.surface.stribeck_speed = 0.2;
    scene::PairSurface surface;
    surface.friction = 0.5;
    surface.dynamic_friction = 0.2;
    surface.stribeck_speed = 0.2;
    for (const double speed : {0.1, 0.3, 0.8})
        EXPECT_NEAR(slides(on, speed, 0, 2).x / slides(surface, kMass, speed, 0, 2).x, 1, 0.01)
            << speed;
}

TEST(SlidingSurfaces, HoldWithTheStaticCoefficientUntilTheySlide) {
    OnTable on = plate();
    on.body.surface.dynamic_friction = on.table.surface.dynamic_friction = 0.2;
    scene::PairSurface surface;
    surface.friction = 0.5;
    surface.dynamic_friction = 0.2;
    const double weight = kMass * kGravity;
    EXPECT_LT(slides(on, 0, 0.499 * weight, 0.5).x, 1e-9);
    const Slid exact = slides(surface, kMass, 0, 0.51 * weight, 0.5);
    const Slid slid = slides(on, 0, 0.51 * weight, 0.5);
    EXPECT_NEAR(slid.v / exact.v, 1, 0.01);
    EXPECT_NEAR(slid.x / exact.x, 1, 0.01);
}

TEST(SlidingSurfaces, HaveTheDragOfAFilm) {
    for (const double friction : {0.0, 0.1}) {
        OnTable on = plate();
        on.body.friction = on.table.friction = friction;
        on.body.surface.film = 0.8;
        scene::PairSurface surface;
        surface.friction = surface.dynamic_friction = friction;
        surface.film = 0.8;
        EXPECT_NEAR(slides(on, 0.5, 0, 2).x / slides(surface, kMass, 0.5, 0, 2).x, 1, 0.01)
            << friction;
    }
}

}  // namespace
}  // namespace dihaptic::dynamics::surfaces_test
