// Tests lattices in a world against the theory of bars and beams: they are pulled, bent, twisted,
// pressed, and set swinging.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "dynamics/test/blocks.h"
#include "testing/allocation_guard.h"

namespace dihaptic::dynamics::lattice_test {
namespace {

constexpr double kLength = 0.2, kWide = 0.02, kHigh = 0.01, kYoung = 1e7;
constexpr double kArea = kWide * kHigh;
constexpr double kSecondMoment = kWide * kHigh * kHigh * kHigh / 12;  // for downward bending
constexpr int kBlocks = 10;
constexpr double kBlock = kLength / kBlocks;

scene::Lattice rod() {
    scene::Lattice out;
    out.name = "rod";
    out.size = {kLength, kWide, kHigh};
    out.parts = {kBlocks, 1, 1};
    out.mass = 0.05;
    out.young = kYoung;
    out.retardation = 0.08;
    out.glued = {{scene::Side::x_low, "", {}}};
    return out;
}

World make(const scene::Lattice& lattice, std::vector<scene::Body> bodies = {},
           const Vec3& gravity = Vec3::Zero()) {
    scene::Scene scene;
    scene.bodies = std::move(bodies);
    scene.gravity = gravity;
    scene.lattices = {lattice};
    Diagnostics diagnostics;
    scene::expand_lattices(scene, diagnostics);
    EXPECT_TRUE(diagnostics.problems().empty());
    World world(scene, awake());
    world.activate();
    return world;
}

/// Displacement of the rod's end, once it has come to rest under a force on the end and a torque on
/// the last block. All are in the rod's axes, which are turned by R.
Pose end_under(const Vec3& force, const Vec3& torque, const Quat& R = Quat::Identity()) {
    scene::Lattice lattice = rod();
    if (!R.isApprox(Quat::Identity())) lattice.rotation = {0.3, -0.4, 0.5};
    World world = make(lattice);
    constexpr int kLast = kBlocks - 1;
    const Vec3 end_B(kBlock / 2, 0, 0);
    const Pose start = world.states()[kLast].X_WB;
    for (int i = 0; i < 4000; ++i) {
        const Pose& X_WB = world.states()[kLast].X_WB;
        world.apply_at({kLast}, R * force, X_WB * end_B);
        world.apply({kLast}, Vec3::Zero(), R * torque);
        world.step(kStep);
    }
    const Pose& now = world.states()[kLast].X_WB;
    return {R.conjugate() * now.R * start.R.conjugate() * R,
            R.conjugate() * (now * end_B - start * end_B)};
}

TEST(Lattice, IsStretchedAsABar) {
    // the outer half of the last block is rigid
    const double expected = 3.0 * (kLength - kBlock / 2) / (kYoung * kArea);
    EXPECT_NEAR(end_under({3, 0, 0}, Vec3::Zero()).p.x() / expected, 1, 1e-5);
}

TEST(Lattice, BendsAsABeam) {
    constexpr double kForce = 0.01;
    const double expected = kForce * std::pow(kLength, 3) / (3 * kYoung * kSecondMoment);
    EXPECT_NEAR(end_under({0, 0, -kForce}, Vec3::Zero()).p.z() / -expected, 1, 0.01);
    // when bent across its broad side, the rod is stiffer by the square of the ratio of its sides
    const double stiffer = kWide * kWide / kHigh / kHigh;
    EXPECT_NEAR(end_under({0, kForce * stiffer, 0}, Vec3::Zero()).p.y() / expected, 1, 0.01);
}

TEST(Lattice, BendsAlikeHoweverItIsTurned) {
    const Vec3 force(0.1, 0.02, -0.01);
    const Vec3 straight = end_under(force, Vec3::Zero()).p;
    const Vec3 turned = end_under(force, Vec3::Zero(), rotation_xyz({0.3, -0.4, 0.5})).p;
    EXPECT_LT((turned - straight).norm(), 1e-6 * straight.norm());
}

TEST(Lattice, IsTwistedAsABar) {
    // Saint-Venant's constant of a 2 : 1 rectangle is 0.229 a b^3 (Timoshenko and Goodier)
    const double stiffness = kYoung / 2 * 0.229 * kWide * std::pow(kHigh, 3);
    constexpr double kTorque = 1e-3;
    const double expected = kTorque * (kLength - kBlock / 2) / stiffness;
    EXPECT_NEAR(rotation_vector(end_under(Vec3::Zero(), {kTorque, 0, 0}).R).x() / expected, 1,
                2e-3);
}

TEST(Lattice, SwingsAtTheFrequencyOfABeam) {
    scene::Lattice lattice = rod();
    lattice.retardation = 0;
    World world = make(lattice);
    constexpr int kLast = kBlocks - 1;
    const auto z = [&] { return world.states()[kLast].X_WB.p.z(); };
    for (int i = 0; i < 300; ++i) {  // push slowly, then release
        world.apply({kLast}, {0, 0, 0.01 * std::min(1.0, i / 250.0)}, Vec3::Zero());
        world.step(kStep);
    }
    std::vector<double> times;
    double before = z();
    for (int i = 0; i < 4000; ++i) {
        world.step(kStep);
        const double now = z();
        if (before < 0 && now >= 0) times.push_back(kStep * (i - now / (now - before)));
        before = now;
    }
    ASSERT_GT(times.size(), 10u);
    const double hertz = static_cast<double>(times.size() - 1) / (times.back() - times.front());
    const double root = 1.8751;  // first root of cos x cosh x = -1
    const double expected = root * root / (2 * std::numbers::pi) *
                            std::sqrt(kYoung * kSecondMoment / (0.05 * std::pow(kLength, 3)));
    EXPECT_NEAR(hertz / expected, 1, 0.02);
}

/// A sponge of 2 x 3 x 3 blocks between two plates.
scene::Lattice sponge() {
    scene::Lattice out;
    out.name = "sponge";
    out.size = {0.06, 0.04, 0.05};
    out.parts = {2, 3, 3};
    out.mass = 0.03;
    out.young = 2e4;
    out.retardation = 0.02;
    return out;
}

TEST(Lattice, IsPressedAsABlockOfItsMaterial) {
    scene::Lattice lattice = sponge();
    lattice.glued = {{scene::Side::x_low, "", {}}, {scene::Side::x_high, "plate", {}}};
    World world = make(lattice, {box("plate", {0.01, 0.05, 0.06}, {0.035, 0, 0}, 0.05)});
    for (int i = 0; i < 3000; ++i) {
        world.apply({0}, {-1, 0, 0}, Vec3::Zero());
        world.step(kStep);
    }
    const double stiffness = lattice.young * 0.04 * 0.05 / 0.06;
    EXPECT_NEAR((world.states()[0].X_WB.p.x() - 0.035) / (-1 / stiffness), 1, 1e-5);
    EXPECT_LT(world.states()[0].X_WB.p.tail<2>().norm(), 1e-7);
}

/// A cube of eight blocks, with two jaws next to it that are larger than its faces.
struct Squeezed {
    scene::Lattice lattice = sponge();
    World world;

    explicit Squeezed(const Vec3& gravity) : world(build(gravity)) {}
    void squeeze(double force, double lift, int steps) {
        for (int i = 0; i < steps; ++i) {
            world.apply({1}, {force, 0, 0.1 * kGravity + lift / 2}, Vec3::Zero());
            world.apply({2}, {-force, 0, 0.1 * kGravity + lift / 2}, Vec3::Zero());
            world.step(kStep);
            ASSERT_EQ(world.solve_stats().missed, 0) << i;
        }
    }
    double apart() const {
        return world.states()[2].X_WB.p.x() - world.states()[1].X_WB.p.x() - 0.02;
    }
    double lowest() const {
        double out = 1;
        for (size_t i = 3; i < world.states().size(); ++i)
            out = std::min(out, world.states()[i].X_WB.p.z());
        return out;
    }

  private:
    World build(const Vec3& gravity) {
        lattice.size = Vec3::Constant(0.04);
        lattice.parts = {2, 2, 2};
        lattice.position = {0, 0, 0.02};
        std::vector<scene::Body> bodies{table(),
                                        box("left", {0.02, 0.05, 0.05}, {-0.0301, 0, 0.026}, 0.1),
                                        box("right", {0.02, 0.05, 0.05}, {0.0301, 0, 0.026}, 0.1)};
        for (size_t i : {1u, 2u}) {
            bodies[i].moves = scene::Axes::xz;
            bodies[i].turns = scene::Axes::none;
        }
        return make(lattice, bodies, gravity);
    }
};

TEST(Lattice, IsSqueezedFromOutsideAsABlockOfItsMaterial) {
    Squeezed squeezed(Vec3::Zero());
    // there is no gravity, so the force that would hold the jaws' weight lifts them
    for (int i = 0; i < 2000; ++i) {
        squeezed.world.apply({1}, {1, 0, 0}, Vec3::Zero());
        squeezed.world.apply({2}, {-1, 0, 0}, Vec3::Zero());
        squeezed.world.step(kStep);
    }
    const double give = 1 / (squeezed.lattice.young * 0.04);
    EXPECT_NEAR(squeezed.apart(), 0.04 - give, 0.02 * give);
}

TEST(Lattice, IsLiftedBySqueezing) {
    Squeezed squeezed({0, 0, -kGravity});
    squeezed.squeeze(1, 0, 800);
    squeezed.squeeze(1, 0.35, 400);  // the cube weighs 0.29 N
    EXPECT_GT(squeezed.lowest(), 0.02);
    squeezed.squeeze(-1, 0, 500);
    EXPECT_LT(squeezed.lowest(), 0.012);
}

TEST(Lattice, StepsWithoutAllocating) {
    DIHAPTIC_NEEDS_ALLOCATION_GUARD();
    World world = make(sponge(), {}, {0, 0, -1});
    const testing::AllocationGuard guard;
    for (int i = 0; i < 100; ++i) world.step(kStep);
    EXPECT_EQ(guard.count(), 0u);
}

}  // namespace
}  // namespace dihaptic::dynamics::lattice_test
