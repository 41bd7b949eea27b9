// Tests joints in a world against closed forms: pendulums, springs, reaction forces, stops, and
// mechanisms with redundant joints.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "base/unit.h"
#include "dynamics/test/blocks.h"
#include "testing/allocation_guard.h"

namespace dihaptic::dynamics::joints_test {
namespace {

using scene::JointKind;

World make(std::vector<scene::Body> bodies, std::vector<scene::Joint> joints,
           const frame::DynamicsSettings& settings = awake()) {
    scene::Scene scene;
    scene.bodies = std::move(bodies);
    scene.joints = std::move(joints);
    World world(scene, settings);
    world.activate();
    return world;
}

constexpr double kSide = 0.04, kMass = 0.1, kArm = 0.25;
constexpr double kInertia = kMass * kSide * kSide / 6;

/// A cube that hangs from a hinge about y at the origin, turned by `angle` from its rest position.
World pendulum(double angle, double friction = 0) {
    scene::Body bob =
        box("bob", Vec3::Constant(kSide), kArm * Vec3(std::sin(angle), 0, -std::cos(angle)), kMass);
    bob.rotation = {0, -angle, 0};
    scene::Joint hinge = joint(JointKind::hinge, {"bob"}, Vec3::Zero(), -Vec3::UnitY());
    hinge.friction = friction;
    return make({bob}, {hinge});
}

/// Times at which the coordinate passes `middle` upwards, by interpolation [s].
std::vector<double> passes(World& world, double middle, double duration) {
    std::vector<double> out;
    double before = world.joints()[0].position - middle;
    for (int i = 1; i * kStep < duration; ++i) {
        world.step(kStep);
        const double now = world.joints()[0].position - middle;
        if (before < 0 && now >= 0) out.push_back(kStep * (i - now / (now - before)));
        before = now;
    }
    return out;
}

TEST(Pendulum, HasThePeriodOfTheCompleteEllipticIntegral) {
    const double about_hinge = kInertia + kMass * kArm * kArm;
    for (const double degrees : {5.0, 45.0, 90.0, 135.0, 170.0}) {
        const double angle = degrees * kDegree;
        World world = pendulum(angle);
        const std::vector<double> times = passes(world, -angle, 12);
        ASSERT_GE(times.size(), 3u) << degrees;
        const double period =
            (times.back() - times.front()) / static_cast<double>(times.size() - 1);
        const double exact = 4 * std::sqrt(about_hinge / (kMass * kGravity * kArm)) *
                             std::comp_ellint_1(std::sin(angle / 2));
        EXPECT_NEAR(period / exact, 1, degrees <= 90 ? 1e-4 : 1e-3) << degrees;
    }
}

TEST(Pendulum, NeitherDriftsFromItsHingeNorGainsOrLosesEnergyInAMinute) {
    World world = pendulum(120 * kDegree);
    double first = 0, last = 0, apart = 0;
    const double start = kMass * kGravity * kArm * (1 - std::cos(120 * kDegree));
    for (int i = 0; i < 60000; ++i) {
        world.step(kStep);
        const BodyState& bob = world.states()[0];
        apart = std::max(apart, std::abs(bob.X_WB.p.norm() - kArm));
        const double energy = kMass * kGravity * (kArm + bob.X_WB.p.z()) +
                              kMass * bob.v_WB.squaredNorm() / 2 +
                              kInertia * bob.w_WB.squaredNorm() / 2;
        if (i < 10000) first += energy / 10000;
        if (i >= 50000) last += energy / 10000;
        EXPECT_LT(energy, 1.01 * start);
    }
    EXPECT_LT(apart, 1e-6);
    EXPECT_NEAR(last / first, 1, 1e-3);
}

TEST(Pendulum, CarriesItsWeightAndItsTurn) {
    // at the lowest point of a swing from the horizontal, the hinge would carry three times the
    // weight of a point mass; the cube's inertia adds to this
    World world = pendulum(90 * kDegree);
    const double about_hinge = kInertia + kMass * kArm * kArm;
    double most = 0;
    for (int i = 0; i < 3000; ++i) {
        world.step(kStep);
        most = std::max(most, world.joints()[0].force_W.z());
    }
    const double turn_squared = 2 * kMass * kGravity * kArm / about_hinge;
    EXPECT_NEAR(most, kMass * (kGravity + turn_squared * kArm), 2e-3 * most);
    // at rest
    World still = pendulum(0);
    for (int i = 0; i < 5; ++i) still.step(kStep);
    EXPECT_NEAR(still.joints()[0].force_W.z(), kMass * kGravity, 1e-9);
    EXPECT_LT(still.joints()[0].force_W.head<2>().norm(), 1e-9);
}

TEST(Pendulum, OfTwoArmsMovesAsItsEquationsSay) {
    // two equal cubes; their angles from the vertical are integrated with the Runge-Kutta method
    const double m = kMass, l = kArm, about = kInertia;
    const auto accelerations = [&](const Eigen::Vector4d& s) {
        const double a = s[0], b = s[1], da = s[2], db = s[3];
        Eigen::Matrix2d M;
        M << about + 2 * m * l * l, m * l * l * std::cos(a - b), m * l * l * std::cos(a - b),
            about + m * l * l;
        const Eigen::Vector2d f(
            -m * l * l * std::sin(a - b) * db * db - 2 * m * kGravity * l * std::sin(a),
            m * l * l * std::sin(a - b) * da * da - m * kGravity * l * std::sin(b));
        const Eigen::Vector2d dd = M.inverse() * f;
        return Eigen::Vector4d(da, db, dd[0], dd[1]);
    };
    double error[2];
    for (int half = 0; half < 2; ++half) {
        const double h = half ? kStep / 2 : kStep;
        Eigen::Vector4d s(90 * kDegree, 60 * kDegree, 0, 0);
        // velocities in a step are those of its middle: a body that starts at rest was at rest half
        // a step earlier
        s.tail<2>() = h / 2 * accelerations(s).tail<2>();
        const auto at = [&](double a, double b) -> std::pair<Vec3, Vec3> {
            const Vec3 first = l * Vec3(std::sin(a), 0, -std::cos(a));
            return {first, first + l * Vec3(std::sin(b), 0, -std::cos(b))};
        };
        const auto [p, q] = at(s[0], s[1]);
        scene::Body first = box("first", Vec3::Constant(kSide), p, m);
        first.rotation = {0, -s[0], 0};
        scene::Body second = box("second", Vec3::Constant(kSide), q, m);
        second.rotation = {0, -s[1], 0};
        World world = make({first, second}, {joint(JointKind::hinge, {"first"}, Vec3::Zero()),
                                             joint(JointKind::hinge, {"first", "second"}, p)});
        error[half] = 0;
        const int parts = 10;
        const int steps = static_cast<int>(std::round(2 / h));
        for (int i = 0; i < steps; ++i) {
            for (int k = 0; k < parts; ++k) {
                const double d = h / parts;
                const Eigen::Vector4d k1 = accelerations(s), k2 = accelerations(s + d / 2 * k1),
                                      k3 = accelerations(s + d / 2 * k2),
                                      k4 = accelerations(s + d * k3);
                s += d / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
            }
            world.step(h);
            error[half] =
                std::max(error[half], (world.states()[1].X_WB.p - at(s[0], s[1]).second).norm());
        }
    }
    EXPECT_LT(error[0], 4e-5);
    EXPECT_LT(error[1], 0.3 * error[0]) << error[0];
}

TEST(Spring, HoldsAWeightWhereHookeSays) {
    for (const double k : {10.0, 1e3, 1e5}) {
        scene::Joint slider = joint(JointKind::slider, {"block"}, Vec3::Zero(), Vec3::UnitZ());
        slider.stiffness = k;
        slider.damping = 2 * std::sqrt(k * kMass);
        World world = make({block({0, 0, 0.2})}, {slider});
        for (int i = 0; i < 4000; ++i) world.step(kStep);
        EXPECT_NEAR(world.joints()[0].position, -kMass * kGravity / k, 1e-6 * kMass * kGravity / k)
            << k;
        EXPECT_NEAR(world.joints()[0].force_W.z(), kMass * kGravity, 1e-6);
    }
}

TEST(Spring, SwingsAndLosesAmplitudeAsItsDiscretisationSays) {
    // the matrix that advances (q, h u) by a step has the determinant D and the trace T below:
    // amplitudes fall by sqrt(D) per step, and the phase grows by acos(T / 2 / sqrt(D))
    for (const double hertz : {1.0, 5.0, 15.0, 40.0, 100.0}) {
        const double w = 2 * std::numbers::pi * hertz;
        scene::Joint slider = joint(JointKind::slider, {"block"}, {0, 0, 0.2}, Vec3::UnitX());
        slider.stiffness = kMass * w * w;
        slider.rest = 0.01;
        World world = make({block({0, 0, 0.2})}, {slider});
        const double s = kStep * kStep * w * w;
        const double delta = s / (1 + s);
        const double theta = (1 + 3 * delta) / 4;
        const double D = (1 + theta * s * (1 - delta)) / (1 + theta * s);
        const double T = 1 + D - s / (1 + theta * s);
        const double phase = std::acos(T / 2 / std::sqrt(D));
        // q_n = A D^(n/2) cos(phase n + c), where A and c follow from two values of q
        const auto q = [&] { return world.joints()[0].position - slider.rest; };
        const double q0 = q();
        world.step(kStep);
        const double q1 = q();
        const double root = std::sqrt(D);
        const double sine = (q0 * std::cos(phase) - q1 / root) / std::sin(phase);
        for (int n = 2; n < 400; ++n) {
            world.step(kStep);
            const double expected =
                std::pow(root, n) * (q0 * std::cos(n * phase) - sine * std::sin(n * phase));
            EXPECT_NEAR(q(), expected, 1e-3 * std::pow(root, n) * std::abs(q0))
                << hertz << " " << n;
        }
        if (hertz <= 15) {
            EXPECT_NEAR(phase / (w * kStep), 1, 1e-3) << hertz;
        }
        if (hertz <= 5) {
            EXPECT_GT(std::pow(root, 2 * std::numbers::pi / phase), 0.999) << hertz;
        }
    }
}

TEST(Spring, ThatIsStiffOnAGramComesToRest) {
    for (const double k : {1e3, 1e5, 1e7}) {
        scene::Joint slider = joint(JointKind::slider, {"gram"}, Vec3::Zero(), Vec3::UnitX());
        slider.stiffness = k;
        slider.rest = 0.001;
        World world = make({box("gram", Vec3::Constant(0.01), {0, 0, 0.2}, 1e-3)}, {slider});
        for (int i = 0; i < 200; ++i) {
            world.step(kStep);
            EXPECT_LT(std::abs(world.joints()[0].position - slider.rest), 1.5e-3) << k << " " << i;
        }
        EXPECT_NEAR(world.joints()[0].position, slider.rest, 1e-6) << k;
        EXPECT_NEAR(world.joints()[0].velocity, 0, 1e-4) << k;
    }
}

/// A block of kMass on a slider along x, along which gravity does not act, with a spring that has a
/// curve.
World on_a_curve(const scene::SpringCurve& curve, double rest, double damping) {
    scene::Joint slider = joint(JointKind::slider, {"block"}, {0, 0, 0.2}, Vec3::UnitX());
    slider.curve = curve;
    slider.rest = rest;
    slider.damping = damping;
    return make({block({0, 0, 0.2})}, {slider});
}

TEST(SpringWithACurve, SwingsAsItsClosedFormSays) {
    // no force within +-d, and 40 N/m beyond: half a period of a spring at each end, and the gap
    // twice, at the highest speed w (A - d)
    constexpr double kGap = 0.005, kAmplitude = 0.02, kStiff = 40;
    World world = on_a_curve(
        {{-1, -kGap, kGap, 1}, {-kStiff * (1 - kGap), 0, 0, kStiff * (1 - kGap)}}, -kAmplitude, 0);
    const double w = std::sqrt(kStiff / kMass);
    const std::vector<double> times = passes(world, -kAmplitude, 20);
    ASSERT_GE(times.size(), 10u);
    const double period = (times.back() - times.front()) / static_cast<double>(times.size() - 1);
    const double exact = 2 * std::numbers::pi / w + 4 * kGap / (w * (kAmplitude - kGap));
    EXPECT_NEAR(period / exact, 1, 2e-3);
}

TEST(SpringWithACurve, GivesWayBeyondItsPeakAndHoldsBeforeIt) {
    // like a clicking key: 2 N at 5 mm, 0.5 N at 6 mm, and 3 N at 16 mm
    const scene::SpringCurve key{{0, 0.005, 0.006, 0.016}, {0, 2, 0.5, 3}};
    for (const auto& [force, rests_at] : {std::pair{1.9, 0.00475}, {2.1, 0.0124}, {0.4, 0.001}}) {
        World world = on_a_curve(key, 0, 30);
        for (int i = 0; i < 3000; ++i) {
            world.apply({0}, {force, 0, 0}, Vec3::Zero());
            world.step(kStep);
        }
        EXPECT_NEAR(world.joints()[0].position, rests_at, 1e-8) << force;
        EXPECT_NEAR(world.joints()[0].force_W.x(), -force, 1e-7) << force;
    }
}

TEST(Fixed, JointsCarryForceAndTorqueAndDoNotMove) {
    scene::Body arm = box("arm", {0.2, 0.02, 0.02}, {0.1, 0, 0.5}, 0.3);
    World world = make({arm}, {joint(JointKind::fixed, {"arm"}, {0, 0, 0.5})});
    for (int i = 0; i < 1000; ++i) world.step(kStep);
    EXPECT_LT((world.states()[0].X_WB.p - arm.position).norm(), 1e-8);  // steel yields
    EXPECT_NEAR(world.joints()[0].force_W.z(), 0.3 * kGravity, 1e-9);
    EXPECT_NEAR(world.joints()[0].torque_W.y(), -0.3 * kGravity * 0.1, 1e-9);
}

TEST(Slider, FallsFreelyAlongItsAxisAndTurnsNowhere) {
    const Vec3 axis(1, 0, -1);
    scene::Body bead = box("bead", {0.03, 0.05, 0.02}, {0.1, 0.2, 0.5}, 0.2);
    bead.rotation = {0.3, 0.2, 0.1};
    World world = make({bead}, {joint(JointKind::slider, {"bead"}, {0, 0.3, 0.5}, axis)});
    for (int i = 0; i < 300; ++i) world.step(kStep);
    const double way = kGravity / std::sqrt(2) * kStep * kStep * 300 * 301 / 2;
    EXPECT_NEAR(world.joints()[0].position, way, 1e-9);
    EXPECT_LT((world.states()[0].X_WB.p - bead.position - way * axis.normalized()).norm(), 1e-8);
    EXPECT_LT(world.states()[0].X_WB.R.angularDistance(bead.pose().R), 1e-7);
}

TEST(Hinge, StopsAndRubs) {
    scene::Joint hinge = joint(JointKind::hinge, {"bob"}, Vec3::Zero(), -Vec3::UnitY());
    hinge.low = -0.5;
    scene::Body bob = box("bob", Vec3::Constant(kSide), {kArm, 0, 0}, kMass);
    World world = make({bob}, {hinge});
    double least = 0;
    for (int i = 0; i < 2000; ++i) {
        world.step(kStep);
        least = std::min(least, world.joints()[0].position);
    }
    EXPECT_NEAR(least, -0.5, 1e-6);
    EXPECT_NEAR(world.joints()[0].position, -0.5, 1e-6);
    EXPECT_NEAR(world.joints()[0].torque_W.y(), -kMass * kGravity * kArm * std::cos(0.5), 1e-6);
    // dry friction larger than the moment of the weight holds the pendulum; with less friction, it
    // falls by the difference
    World held = pendulum(90 * kDegree, 1.01 * kMass * kGravity * kArm);
    for (int i = 0; i < 500; ++i) held.step(kStep);
    EXPECT_NEAR(held.joints()[0].position, 0, 1e-9);
    World falls = pendulum(90 * kDegree, 0.5 * kMass * kGravity * kArm);
    falls.step(kStep);
    const double about_hinge = kInertia + kMass * kArm * kArm;
    EXPECT_NEAR(falls.joints()[0].velocity, -kStep * 0.5 * kMass * kGravity * kArm / about_hinge,
                1e-5);
}

/// A ball at `place` that hangs from the origin on a distance joint.
World hanging(const Vec3& place, const std::function<void(scene::Joint&)>& change = {}) {
    scene::Body ball;
    ball.name = "ball";
    ball.shape.kind = scene::ShapeKind::sphere;
    ball.shape.radius = 0.01;
    ball.mass = kMass;
    ball.position = place;
    scene::Joint string = joint(JointKind::distance, {"ball"}, Vec3::Zero());
    string.second_position = place;
    if (change) change(string);
    return make({ball}, {string});
}

/// A conical pendulum: at w^2 = g / (l cos theta), it stays at the same height, and the rod carries
/// m g / cos theta.
TEST(Distance, IsARodThatABallCirclesOn) {
    const double theta = 30 * kDegree;
    const double omega = std::sqrt(kGravity / (kArm * std::cos(theta)));
    World world = hanging(kArm * Vec3(std::sin(theta), 0, -std::cos(theta)));
    // velocities are those in the middle of a step, here of the previous step
    const double before = omega * kStep;
    world.set_velocity(
        {0}, kArm * std::sin(theta) / kStep * Vec3(1 - std::cos(before), std::sin(before), 0));
    const double height = -kArm * std::cos(theta);
    double turned = 0;
    double last = 0;
    constexpr int kSteps = 10000;
    for (int i = 0; i < kSteps; ++i) {
        world.step(kStep);
        const Vec3 p = world.state({0}).X_WB.p;
        EXPECT_NEAR(p.norm(), kArm, 1e-7);
        EXPECT_NEAR(p.z(), height, 1e-6);
        const double angle = std::atan2(p.y(), p.x());
        turned += std::remainder(angle - last, 2 * std::numbers::pi);
        last = angle;
        EXPECT_NEAR(world.joints()[0].force_W.norm(), kMass * kGravity / std::cos(theta), 2e-3);
    }
    EXPECT_NEAR(turned / (omega * kStep * kSteps), 1, 1e-4);
}

TEST(Distance, IsARopeThatPullsOnceItIsTaut) {
    const Vec3 start(0, 0, -0.05);
    World world = hanging(start, [](scene::Joint& rope) { rope.high = kArm; });
    const double fall = std::sqrt(2 * (kArm - 0.05) / kGravity);
    for (int i = 1; i < 2000; ++i) {
        world.step(kStep);
        const double t = i * kStep;
        const scene::JointKind kind = world.joints()[0].kind;
        EXPECT_EQ(kind, JointKind::distance);
        if (t < fall - kStep) {
            EXPECT_EQ(world.joints()[0].force_W.norm(), 0);
            EXPECT_NEAR(world.state({0}).X_WB.p.z(), -0.05 - kGravity * t * t / 2,
                        kGravity * t * kStep);
        } else if (t > fall + 2 * kStep) {
            EXPECT_NEAR(world.joints()[0].position, kArm, 1e-6);
            EXPECT_NEAR(world.joints()[0].force_W.z(), kMass * kGravity, 1e-6);
        }
    }
    world.set_velocity({0}, Vec3(0, 0, 1));  // the rod never pushes
    world.step(kStep);
    EXPECT_EQ(world.joints()[0].force_W.norm(), 0);
}

TEST(Distance, IsAnElasticBandOfItsOwnFrequency) {
    constexpr double kBand = 20;  // [N/m]
    const double stretched = kMass * kGravity / kBand;
    World world = hanging(Vec3(0, 0, -0.1 - stretched - 0.02), [](scene::Joint& band) {
        band.stiffness = kBand;
        band.rest = 0.1;
    });
    const std::vector<double> times = passes(world, 0.1 + stretched, 5);
    ASSERT_GE(times.size(), 3u);
    const double period = (times.back() - times.front()) / static_cast<double>(times.size() - 1);
    EXPECT_NEAR(period / (2 * std::numbers::pi * std::sqrt(kMass / kBand)), 1, 1e-3);
}

/// Two balls joined by a rod, and held only by each other, spin about their midpoint, which stays
/// in place.
TEST(Distance, JoinsTwoThatFly) {
    std::vector<scene::Body> balls;
    for (const double side : {-1.0, 1.0}) {
        scene::Body& ball = balls.emplace_back();
        ball.name = side < 0 ? "left" : "right";
        ball.shape.kind = scene::ShapeKind::sphere;
        ball.shape.radius = 0.01;
        ball.mass = kMass;
        ball.position = Vec3(side * kArm / 2, 0, 0);
    }
    scene::Joint rod = joint(JointKind::distance, {"left", "right"}, balls[0].position);
    rod.second_position = balls[1].position;
    World world = make(balls, {rod});
    world.set_velocity({0}, Vec3(0, -1, 0));
    world.set_velocity({1}, Vec3(0, 1, 0));
    for (int i = 1; i <= 1000; ++i) {
        world.step(kStep);
        const Vec3 a = world.state({0}).X_WB.p;
        const Vec3 b = world.state({1}).X_WB.p;
        EXPECT_NEAR((b - a).norm(), kArm, 1e-7);
        const double t = i * kStep;
        EXPECT_LT((a + b).head<2>().norm(), 1e-9);
        EXPECT_NEAR((a + b).z() / 2, -kGravity * t * (t + kStep) / 2, 1e-6);
    }
}

TEST(Universal, TurnsAboutTwoAxesAndCarriesTorqueAboutTheThird) {
    scene::Joint cardan = joint(JointKind::universal, {"rod"}, Vec3::Zero(), Vec3::UnitX());
    cardan.second_axis = Vec3::UnitY();
    scene::Body rod = box("rod", {0.02, 0.03, 0.2}, {0, 0, -0.1}, 0.1);
    World world = make({rod}, {cardan});
    for (int i = 0; i < 300; ++i) {
        world.apply({0}, Vec3::Zero(), {0.02, 0.01, 0.03});
        world.step(kStep);
    }
    EXPECT_NEAR((world.states()[0].X_WB.R * Vec3::UnitY()).x(), 0, 1e-6);
    EXPECT_GT(world.states()[0].w_WB.norm(), 0.1);
}

TEST(Joints, MoreThanAreNeededDoNotFightEachOther) {
    // a door on three hinges, and a four-bar linkage, are swung for ten seconds
    scene::Body door = box("door", {0.4, 0.02, 0.8}, {0.2, 0, 0.5}, 2);
    std::vector<scene::Joint> hinges;
    for (const double z : {0.2, 0.5, 0.8})
        hinges.push_back(joint(JointKind::hinge, {"door"}, {0, 0, z}, Vec3::UnitZ()));
    World world = make({door}, hinges);
    world.apply({0}, {0, 200, 0}, Vec3::Zero());
    Vec3 sum = Vec3::Zero();
    for (int i = 0; i < 10000; ++i) {
        world.step(kStep);
        sum.setZero();
        for (const JointState& state : world.joints()) {
            sum += state.force_W;
            EXPECT_LT(state.force_W.norm(), 60) << i;
        }
    }
    EXPECT_NEAR(sum.z(), 2 * kGravity, 1e-6);
    EXPECT_NEAR(world.joints()[0].position, world.joints()[2].position, 1e-9);

    scene::Body left = box("left", {0.02, 0.02, 0.2}, {0, 0, 0.1}, 0.1);
    scene::Body top = box("top", {0.3, 0.02, 0.02}, {0.15, 0, 0.2}, 0.2);
    scene::Body right = box("right", {0.02, 0.02, 0.2}, {0.3, 0, 0.1}, 0.1);
    World four = make({left, top, right}, {joint(JointKind::hinge, {"left"}, {0, 0, 0}),
                                           joint(JointKind::hinge, {"left", "top"}, {0, 0, 0.2}),
                                           joint(JointKind::hinge, {"top", "right"}, {0.3, 0, 0.2}),
                                           joint(JointKind::hinge, {"right"}, {0.3, 0, 0})});
    four.apply({1}, {5, 0, 0}, Vec3::Zero());
    for (int i = 0; i < 5000; ++i) {
        four.step(kStep);
        // in a parallelogram, the top's midpoint moves on a circle about the base's midpoint
        EXPECT_NEAR((four.states()[1].X_WB.p - Vec3(0.15, 0, 0)).norm(), 0.2, 1e-5) << i;
    }
}

TEST(Joints, KeepJoinedBodiesFromMeetingUnlessTheyCollide) {
    for (const bool collide : {false, true}) {
        scene::Joint hinge = joint(JointKind::hinge, {"table", "block"}, {0, 0, 0.02});
        hinge.collide = collide;
        World world = make({table(), block({0, 0, 0.02})}, {hinge});
        world.step(kStep);
        EXPECT_EQ(world.contacts().empty(), !collide);
    }
}

TEST(Joints, SleepAndWakeWithWhatTheyJoin) {
    scene::Joint rod = joint(JointKind::ball, {"block", "other"}, {0.1, 0, 0.02});
    scene::Body other = box("other", Vec3::Constant(0.04), {0.2, 0, 0.02}, 0.1);
    World world = make({table(), block({0, 0, 0.02}), other}, {rod}, {});
    for (int i = 0; i < 1500; ++i) world.step(kStep);
    EXPECT_FALSE(world.states()[1].awake);
    EXPECT_FALSE(world.states()[2].awake);
    world.apply({1}, {0, 0, 0.5}, Vec3::Zero());
    world.step(kStep);
    EXPECT_TRUE(world.states()[2].awake);
}

TEST(Joints, TakeBodiesThatSpinFasterThanAStepCanFollow) {
    // a light arm on a ball joint is accelerated without end
    scene::Body arm = box("arm", {0.05, 0.005, 0.005}, {0.025, 0, 0}, 1e-3);
    World world = make({arm}, {joint(JointKind::ball, {"arm"}, Vec3::Zero())});
    const double fastest = std::numbers::pi / 4 / kStep;
    for (int i = 0; i < 2000; ++i) {
        world.apply({0}, Vec3::Zero(), {0, 0, 0.05});
        ASSERT_EQ(world.step(kStep), StepStatus::ok) << i;
        const BodyState& state = world.states()[0];
        ASSERT_LE(state.w_WB.norm(), 1.0001 * fastest) << i;
        ASSERT_LT(state.v_WB.norm(), 0.03 * fastest) << i;
        ASSERT_NEAR(state.X_WB.p.norm(), 0.025, 2e-3) << i;
    }
}

TEST(Distance, WithAStiffSpringOnALightBodyThatSpinsGivesItNoEnergy) {
    scene::Scene scene;
    scene.gravity = Vec3::Zero();
    scene.bodies = {box("bead", {0.03, 0.05, 0.04}, {0, 0, 0.3}, 0.0055)};
    scene::Joint band = joint(scene::JointKind::distance, {"bead"}, {0.01, 0.02, 0.31});
    band.second_position = Vec3(0.01, 0.02, 0.41);
    band.stiffness = 4100;
    band.damping = 0.28;
    band.rest = 0.1;
    scene.joints = {band};
    World world(scene, awake());
    world.activate();
    const double fastest = 0.04 * std::numbers::pi / 4 / kStep;  // for all points of the bead
    for (int i = 0; i < 3000; ++i) {
        if (i < 500) world.apply({0}, Vec3::Zero(), {2e-3, 3e-3, 2.5e-3});
        ASSERT_EQ(world.step(kStep), StepStatus::ok) << i;
        ASSERT_LT(world.state({0}).v_WB.norm(), fastest) << i;
    }
}

TEST(Joints, StepWithoutAllocating) {
    DIHAPTIC_NEEDS_ALLOCATION_GUARD();
    scene::Joint slider = joint(JointKind::slider, {"first"}, Vec3::Zero(), Vec3::UnitX());
    slider.stiffness = 100;
    slider.low = -0.01;
    scene::Body first = block({0, 0, 0.02});
    first.name = "first";
    scene::Body second = box("second", Vec3::Constant(0.03), {0.1, 0, 0.1}, 0.05);
    World world = make({table(), first, second},
                       {slider, joint(JointKind::ball, {"first", "second"}, {0, 0, 0.04})});
    const testing::AllocationGuard guard;
    for (int i = 0; i < 2000; ++i) world.step(kStep);
    EXPECT_EQ(guard.count(), 0u);
}

}  // namespace
}  // namespace dihaptic::dynamics::joints_test
