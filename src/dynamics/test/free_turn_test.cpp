// Compares bodies that touch nothing with closed forms and conservation laws.
#include "dynamics/free_turn.h"

#include <gtest/gtest.h>

#include <boost/math/special_functions/jacobi_elliptic.hpp>

#include "dynamics/test/blocks.h"

namespace dihaptic::dynamics::free_turn_test {
namespace {

const Vec3 kBrick(0.1, 0.06, 0.02);  // [m]
constexpr double kMass = 0.2;        // [kg]

Vec3 moments(const Vec3& size, double mass) {
    const Vec3 squared = size.cwiseAbs2();
    return mass / 12 * (Vec3::Constant(squared.sum()) - squared);
}

/// Angular velocity at time t, in the body's axes, of a body that starts with (0, w_y, w_z) and has
/// ascending moments of inertia, from Jacobi's elliptic functions (Landau and Lifshitz, Mechanics,
/// 37).
Vec3 by_elliptic_functions(const Vec3& I, double w_y, double w_z, double t) {
    const double twice_energy = I.y() * w_y * w_y + I.z() * w_z * w_z;
    const double momentum = std::pow(I.y() * w_y, 2) + std::pow(I.z() * w_z, 2);
    const double above = I.z() * twice_energy - momentum;
    const double below = momentum - I.x() * twice_energy;
    if (below <= 0 || momentum < twice_energy * I.y()) throw std::logic_error("another case");
    const double rate = std::sqrt((I.z() - I.y()) * below / (I.x() * I.y() * I.z()));
    const double k = std::sqrt((I.y() - I.x()) * above / ((I.z() - I.y()) * below));
    double cn, dn;
    // the motion starts a quarter period later, where sn is 1
    const double quarter = std::comp_ellint_1(k);
    const double sn = boost::math::jacobi_elliptic(k, rate * t + quarter, &cn, &dn);
    return {std::sqrt(above / (I.x() * (I.z() - I.x()))) * cn,
            std::sqrt(above / (I.y() * (I.z() - I.y()))) * sn,
            std::sqrt(below / (I.z() * (I.z() - I.x()))) * dn};
}

/// A world with a brick in space that starts to turn.
World turning(const Vec3& size, const Vec3& w) {
    scene::Scene scene;
    scene.gravity = Vec3::Zero();
    scene.bodies = {box("brick", size, {0, 0, 0.5}, kMass)};
    World world(scene, awake());
    world.activate();
    world.set_motion({0}, Vec3::Zero(), w);
    return world;
}

Vec3 in_body(const World& world) {
    return world.state({0}).X_WB.R.conjugate() * world.state({0}).w_WB;
}

Vec3 momentum(const World& world, const Vec3& I) {
    return world.state({0}).X_WB.R * Vec3(I.cwiseProduct(in_body(world)));
}

double energy(const World& world, const Vec3& I) {
    return in_body(world).dot(I.cwiseProduct(in_body(world))) / 2;
}

TEST(FreeTurn, FollowsEllipticFunctions) {
    const Vec3 I = moments(kBrick, kMass);
    ASSERT_LT(I.x(), I.y());
    ASSERT_LT(I.y(), I.z());
    const double w_y = 8, w_z = 6;
    World world = turning(kBrick, {0, w_y, w_z});
    for (int i = 1; i <= 20000; ++i) {
        world.step(kStep);
        ASSERT_LT((in_body(world) - by_elliptic_functions(I, w_y, w_z, kStep * i)).norm(), 1e-8)
            << i;
    }
}

TEST(FreeTurn, KeepsMomentumAndEnergy) {
    const Vec3 I = moments(kBrick, kMass);
    for (const double w : {10.0, 30.0, 200.0, 600.0}) {
        for (int axis = 0; axis < 3; ++axis) {
            Vec3 begins = Vec3::Constant(0.01 * w);
            begins[axis] = w;
            World world = turning(kBrick, begins);
            const Vec3 L = momentum(world, I);
            const double E = energy(world, I);
            for (int i = 0; i < 5000; ++i) {
                world.step(kStep);
                ASSERT_LT((momentum(world, I) - L).norm(), 1e-11 * L.norm()) << w << axis << i;
                ASSERT_NEAR(energy(world, I), E, 1e-10 * E) << w << axis << i;
            }
        }
    }
}

TEST(FreeTurn, GetsToTheSamePlaceWhateverTheStep) {
    // also checks the angle about the angular momentum, which does not follow from the velocities
    const Vec3 w(3, 20, -7);
    World coarse = turning(kBrick, w);
    World fine = turning(kBrick, w);
    for (int i = 0; i < 5000; ++i) coarse.step(kStep);
    for (int i = 0; i < 20000; ++i) fine.step(kStep / 4);
    const Quat off = coarse.state({0}).X_WB.R.conjugate() * fine.state({0}).X_WB.R;
    EXPECT_LT(rotation_vector(off).norm(), 1e-9);
}

TEST(FreeTurn, OfNeedlesAndCoinsIsExactToo) {
    for (const Vec3& size : {Vec3(1e-3, 1e-3, 0.2), Vec3(0.1, 0.1, 1e-3), Vec3(0.1, 0.05, 1e-3)}) {
        const Vec3 I = moments(size, kMass);
        const Vec3 w(50, 300, 400);
        World world = turning(size, w);
        const double E = energy(world, I);
        const Vec3 L = momentum(world, I);
        for (int i = 0; i < 2000; ++i) world.step(kStep);
        EXPECT_NEAR(energy(world, I), E, 1e-10 * E);
        EXPECT_LT((momentum(world, I) - L).norm(), 1e-10 * L.norm());
    }
}

TEST(FreeTurn, OfEqualMomentsStaysAsItIs) {
    const Vec3 w(1, 2, 3);
    EXPECT_EQ(mean_velocity(Quat::Identity(), Vec3::Constant(1e-4), w, kStep), w);
    EXPECT_EQ(mean_velocity(Quat::Identity(), {1e-4, 2e-4, 3e-4}, Vec3::Zero(), kStep),
              Vec3::Zero());
}

/// A disc on a light spindle that stands on its tip and precesses steadily, given its tilt and its
/// rate of precession.
struct Top {
    static constexpr double kRadius = 0.03, kHeight = 0.01, kTilt = 0.35;
    double spin, arm;
    double turning = kMass * kRadius * kRadius / 2;
    double across = kMass * (3 * kRadius * kRadius + kHeight * kHeight) / 12 + kMass * arm * arm;
    /// The slow precession rate W, a root of (I_1 cos t) W^2 - I_3 s W + m g l = 0.
    double precession() const {
        const double a = across * std::cos(kTilt), b = turning * spin, c = kMass * kGravity * arm;
        return (b - std::sqrt(b * b - 4 * a * c)) / (2 * a);
    }
};

TEST(Joints, LetATopPrecessSteadily) {
    for (const Top& top : {Top{60, 0.01}, Top{150, 0.03}, Top{250, 0.04}, Top{400, 0.04}}) {
        scene::Body body;
        body.name = "top";
        body.shape.kind = scene::ShapeKind::cylinder;
        body.shape.radius = Top::kRadius;
        body.shape.length = Top::kHeight;
        body.mass = kMass;
        body.position = {0, 0, top.arm};
        scene::Scene scene;
        scene.gravity = {0, 0, -kGravity};
        scene.bodies = {body};
        scene.joints = {joint(scene::JointKind::ball, {"top"}, Vec3::Zero())};
        World world(scene, awake());
        world.activate();
        const Vec3 axis(std::sin(Top::kTilt), 0, std::cos(Top::kTilt));
        const double W = top.precession();
        const Vec3 w = W * Vec3::UnitZ() + (top.spin - W * axis.z()) * axis;
        world.set_pose({0}, {rotation_by(Top::kTilt * Vec3::UnitY()), top.arm * axis});
        world.set_motion({0}, w.cross(top.arm * axis), w);
        double turned = 0, last = 0;
        for (int i = 0; i < 10000; ++i) {
            world.step(kStep);
            const Vec3 n = world.state({0}).X_WB.R * Vec3::UnitZ();
            ASSERT_NEAR(std::acos(n.z()), Top::kTilt, 0.0025) << top.spin << " " << i;
            const double now = std::atan2(n.y(), n.x());
            turned += std::remainder(now - last, 2 * std::numbers::pi);
            last = now;
        }
        EXPECT_NEAR(turned, 10 * W, 0.5 * std::numbers::pi / 180) << top.spin;
    }
}

}  // namespace
}  // namespace dihaptic::dynamics::free_turn_test
