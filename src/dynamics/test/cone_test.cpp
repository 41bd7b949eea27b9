// Compares cones that stand, tip over, slide and roll with closed forms.
#include <gtest/gtest.h>

#include <numbers>

#include "dynamics/test/blocks.h"

namespace dihaptic::dynamics::cone_test {
namespace {

struct Size {
    double radius, height;
    double lean() const {
        return std::atan(radius / height);
    }  ///< inclination of the side, half the opening angle
};

scene::Body cone(const Size& size, double friction = 0.8) {
    scene::Body out;
    out.name = "cone";
    out.shape.kind = scene::ShapeKind::cone;
    out.shape.radius = size.radius;
    out.shape.length = size.height;
    out.position = {0, 0, size.height / 2};
    out.density = 1000;
    out.friction = friction;
    return out;
}

/// The pose of a cone that lies on its side, with its tip at the origin and its base towards x.
Pose on_its_side(const Size& size) {
    Pose out;
    out.R = rotation_by(-(std::numbers::pi / 2 + size.lean()) * Vec3::UnitY());
    out.p = out.R * Vec3(0, 0, -size.height / 2);
    return out;
}

/// A cone that rolls on its side about its tip, which stays at the origin. It turns about the line
/// on which it lies. If W is its angular velocity about the vertical, the one along this line is w
/// = -W cot(a): the middle of its base, at h cos(a) from the vertical through the tip and at h
/// sin(a) above the line, moves at the speed W h cos(a) = w h sin(a).
struct Roll {
    Size size;
    double rate;  ///< W [rad/s]
    Vec3 turns{-rate / std::tan(size.lean()), 0, 0};

    /// The W at which the cone lifts its tip. The moment of its weight and of the contact force, at
    /// x along the line of length h / cos(a), turns its angular momentum about the tip: m g (x -
    /// 3/4 h cos(a)) = W^2 cot(a) (I cos(a)^2 + J sin(a)^2), where x is at most the length of the
    /// line.
    static double lifting(const Size& size) {
        const double r = size.radius, h = size.height;
        const double c = std::cos(size.lean()), s = std::sin(size.lean());
        const double along = 0.3 * r * r, across = 0.15 * r * r + 0.6 * h * h;  // per unit mass
        return std::sqrt(kGravity * (h / c - 0.75 * h * c) /
                         (c / s * (along * c * c + across * s * s)));
    }
    World start(const scene::Body& ground,
                const frame::DynamicsSettings& settings = awake()) const {
        World world = make({ground, cone(size, ground.friction)}, settings);
        const Pose X = on_its_side(size);
        world.set_pose({1}, X);
        world.set_motion({1}, turns.cross(X.p), turns);
        return world;
    }
    /// Kinetic and potential energy per unit mass [J/kg].
    double energy(const BodyState& now) const {
        const double r = size.radius, h = size.height;
        const Vec3 arm = now.X_WB.R * Vec3(0, 0, -h / 4);
        const Vec3 w = now.X_WB.R.conjugate() * now.w_WB;
        const double across = 0.15 * r * r + 3.0 / 80 * h * h;
        return (now.v_WB + now.w_WB.cross(arm)).squaredNorm() / 2 +
               w.cwiseAbs2().dot(Vec3(across, across, 0.3 * r * r)) / 2 +
               kGravity * (now.X_WB.p + arm).z();
    }
};

const std::vector<Size> kSizes{{0.003, 0.01}, {0.005, 0.02}, {0.01, 0.01}, {0.01, 0.1},
                               {0.02, 0.02},  {0.02, 0.06},  {0.03, 0.03}, {0.05, 0.02},
                               {0.05, 0.2},   {0.1, 0.1},    {0.1, 0.05}};
const std::vector<contact::Solver> kSolvers{
    contact::Solver::newton, contact::Solver::staggered_projections,
    contact::Solver::stewart_trinkle, contact::Solver::sequential_impulse};

frame::DynamicsSettings awake_with(contact::Solver solver) {
    frame::DynamicsSettings settings = awake();
    settings.solver = solver;
    return settings;
}

/// Rolls for a second, and checks that the cone follows a circle.
void expect_circle(const Roll& roll, World& world) {
    const double radius = on_its_side(roll.size).p.head<2>().norm();
    double last = roll.energy(world.state({1}));
    for (int i = 0; i < 1000; ++i) {
        world.step(kStep);
        const BodyState now = world.state({1});
        const double energy = roll.energy(now);
        ASSERT_LT(energy, last * (1 + 1e-6)) << i;
        last = energy;
        ASSERT_NEAR(now.w_WB.norm() / roll.turns.norm(), 1, 1e-4) << i;
        ASSERT_NEAR(now.X_WB.p.head<2>().norm() / radius, 1, 1e-3) << i;
        const Vec3 tip = now.X_WB * Vec3(0, 0, roll.size.height / 2);
        ASSERT_LT(tip.norm(), 1e-3 * roll.size.height) << i;
    }
    const Vec3 at = world.state({1}).X_WB.p;
    const double behind = std::atan2(at.y(), at.x()) - roll.rate;
    EXPECT_NEAR(std::remainder(behind, 2 * std::numbers::pi), 0, 1e-3 * roll.rate);
}

TEST(Cone, RollsOnItsSideInACircleAboutItsTip) {
    for (const contact::Solver solver : kSolvers) {
        for (const Size& size : kSizes) {
            for (const scene::Body& ground : {plane(), table()}) {
                SCOPED_TRACE(::testing::Message() << size.radius << " x " << size.height << " "
                                                  << ground.name << static_cast<int>(solver));
                const Roll roll{size, 0.1 * Roll::lifting(size)};
                World world = roll.start(ground, awake_with(solver));
                expect_circle(roll, world);
            }
        }
    }
}

TEST(Cone, LiftsItsTipWhereItRollsFasterThanItsWeightHolds) {
    constexpr double kGrip = 5;
    scene::Body ground = plane();
    ground.friction = kGrip;
    for (const Size& size : kSizes) {
        for (const double share : {0.9, 1.1}) {
            const Roll roll{size, share * Roll::lifting(size)};
            World world = roll.start(ground);
            double highest = 0;
            for (int i = 0; i < 100; ++i) {
                world.step(kStep);
                const Vec3 tip = world.state({1}).X_WB * Vec3(0, 0, size.height / 2);
                highest = std::max(highest, tip.z() / size.height);
            }
            EXPECT_EQ(highest > 0.01, share > 1)
                << size.radius << " x " << size.height << " " << share << ": " << highest;
        }
    }
}

/// Sum of the vertical forces that the ground exerts on the bodies on it.
double held_up(const World& world) {
    double out = 0;
    for (const contact::Contact& c : world.contacts()) out += std::abs(c.f_B_W.z());
    return out;
}

TEST(Cone, StandsOnItsBaseWhichCarriesItsWeight) {
    for (const contact::Solver solver : kSolvers) {
        for (const Size& size : kSizes) {
            for (const scene::Body& ground : {plane(), table()}) {
                World world = make({ground, cone(size)}, awake_with(solver));
                for (int i = 0; i < 500; ++i) world.step(kStep);
                const double volume =
                    std::numbers::pi * size.radius * size.radius * size.height / 3;
                const double weight = 1000 * volume * kGravity;
                EXPECT_NEAR(held_up(world) / weight, 1, 1e-6) << size.radius;
                const BodyState now = world.state({1});
                EXPECT_NEAR(now.X_WB.p.z(), size.height / 2, 1e-8);
                EXPECT_LT(now.X_WB.p.head<2>().norm(), 1e-7);
            }
        }
    }
}

TEST(Cone, StandsAndLiesOnAHullOfManyEdges) {
    std::vector<Vec3> corners;
    for (int i = 0; i < 40; ++i) {
        const double angle = 2 * std::numbers::pi * i / 40;
        for (const double z : {-0.02, 0.0})
            corners.emplace_back(0.1 * std::cos(angle), 0.1 * std::sin(angle), z);
    }
    scene::Body drum = table();
    drum.shape.kind = scene::ShapeKind::mesh;
    drum.shape.hull = scene::convex_hull(corners);
    drum.position.setZero();
    const Size size{0.02, 0.05};
    const Pose stands{Quat::Identity(), {0, 0, size.height / 2}};
    for (const Pose& X : {stands, on_its_side(size)}) {
        World world = make({drum, cone(size)}, awake());
        world.set_pose({1}, X);
        for (int i = 0; i < 2000; ++i) world.step(kStep);
        const BodyState now = world.state({1});
        EXPECT_NEAR(now.X_WB.p.z(), X.p.z(), 2e-4);
    }
}

TEST(Cone, ThatIsTiltedFallsBackOrOverByWhereItsCentreIs) {
    // a cone's centre of mass is a quarter of its height above its base
    for (const Size& size : {Size{0.02, 0.06}, {0.03, 0.06}, {0.01, 0.06}}) {
        const double limit = std::atan(4 * size.radius / size.height);
        for (const Vec3& way : {Vec3(0, 1, 0), Vec3(1, 1, 0), Vec3(0.3, 1, 0)}) {
            for (const double share : {0.97, 1.03}) {
                World world = make({plane(), cone(size)}, awake());
                Pose X{rotation_by(share * limit * way.normalized()), {}};
                X.p.z() = std::cos(share * limit) * size.height / 2 +
                          std::sin(share * limit) * size.radius;
                world.set_pose({1}, X);
                for (int i = 0; i < 3000; ++i) world.step(kStep);
                const double upright = (world.state({1}).X_WB.R * Vec3::UnitZ()).z();
                EXPECT_EQ(upright > 0.99, share < 1) << share << " " << upright;
            }
        }
    }
}

/// A slope that falls towards x.
scene::Body slope(double angle, bool is_plane, double friction) {
    scene::Body out = is_plane ? plane() : table(friction);
    out.friction = friction;
    out.rotation.y() = angle;
    if (!is_plane) out.position = rotation_xyz({0, angle, 0}) * Vec3(0, 0, -0.05);
    return out;
}

TEST(Cone, TipsOverOnASlopeOnlyBeyondTheAngleOfItsCentreAndRim) {
    const Size size{0.01, 0.06};
    const double limit = std::atan(4 * size.radius / size.height);
    for (const bool on_plane : {true, false}) {
        for (const double share : {0.97, 1.03}) {
            const double angle = share * limit;
            World world = make({slope(angle, on_plane, 2), cone(size, 2)}, awake());
            const Quat R = rotation_xyz({0, angle, 0});
            world.set_pose({1}, {R, R * Vec3(0, 0, size.height / 2)});
            for (int i = 0; i < 1000; ++i) world.step(kStep);
            const double turned = world.state({1}).X_WB.R.angularDistance(R);
            EXPECT_EQ(turned > 0.1, share > 1) << share << " " << turned;
        }
    }
}

TEST(Cone, SlidesDownASlopeAsCoulombSays) {
    const Size size{0.03, 0.04};
    for (const double degrees : {20.0, 30.0, 40.0}) {
        for (const bool on_plane : {true, false}) {
            for (const bool lies : {false, true}) {
                const double angle = degrees * std::numbers::pi / 180;
                const double mu = 0.3;
                World world = make({slope(angle, on_plane, mu), cone(size, mu)}, awake());
                const Quat R = rotation_xyz({0, angle, 0});
                const Pose stands{Quat::Identity(), {0, 0, size.height / 2}};
                const Pose on = lies ? on_its_side(size) : stands;
                world.set_pose({1}, {R * on.R, R * on.p});
                const int ticks = 500;
                for (int i = 0; i < ticks; ++i) world.step(kStep);
                const double a = kGravity * (std::sin(angle) - mu * std::cos(angle));
                const Vec3 v = R.conjugate() * world.state({1}).v_WB;
                EXPECT_NEAR(v.x() / (a * ticks * kStep), 1, 1e-6) << degrees << lies;
                EXPECT_LT(std::abs(v.y()) + std::abs(v.z()), 1e-6) << degrees << lies;
            }
        }
    }
}

}  // namespace
}  // namespace dihaptic::dynamics::cone_test
