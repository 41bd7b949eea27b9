// Tests a tippe top, i.e. a ball whose centre of mass is below its middle, which turns over if it
// spins fast enough.
#include <gtest/gtest.h>

#include "dynamics/test/blocks.h"

namespace dihaptic::dynamics::tippe_test {
namespace {

constexpr double kRadius = 0.015;  // [m]

/// A ball with a smaller ball inside it, which doubles the density of the smaller volume.
scene::Body top() {
    scene::Body out;
    out.name = "top";
    out.shape.kind = scene::ShapeKind::compound;
    out.shape.parts.resize(2);
    out.shape.parts[0].shape = scene::Shape::sphere(kRadius);
    out.shape.parts[1].shape = scene::Shape::sphere(0.01);
    out.shape.parts[1].position.z() = -0.004;
    out.density = 1000;
    out.friction = 0.3;
    return out;
}

/// Quantities of the top, per unit mass.
struct Has {
    double up;       ///< cosine of the tilt
    double jellett;  ///< - L . c / r, with c from the centre of mass to the contact point [m^2/s]
    double energy;   ///< [J/kg]
};

Has look(const BodyState& now) {
    static const scene::VolumeIntegrals whole = scene::integrate(top().shape);
    const Mat3 inertia = whole.inertia / whole.volume;
    const Vec3 to_mass = now.X_WB.R * whole.centre;
    const Vec3 w = now.X_WB.R.conjugate() * now.w_WB;
    const Vec3 L = now.X_WB.R * Vec3(inertia * w);
    const Vec3 v = now.v_WB + now.w_WB.cross(to_mass);
    return {(now.X_WB.R * Vec3::UnitZ()).z(), L.dot(to_mass + kRadius * Vec3::UnitZ()) / kRadius,
            v.squaredNorm() / 2 + now.w_WB.dot(L) / 2 + kGravity * (now.X_WB.p + to_mass).z()};
}

World spinning(double rate, contact::Solver solver) {
    frame::DynamicsSettings settings = awake();
    settings.solver = solver;
    World world = make({plane(0.3), top()}, settings);
    world.set_pose({1}, {rotation_by(0.1 * Vec3::UnitX()), {0, 0, kRadius}});
    world.set_motion({1}, Vec3::Zero(), {0, 0, rate});
    return world;
}

/// Whatever the friction at the contact point of a ball, - L . c is constant (Jellett 1872): the
/// top turns upside down with C w (1 - a) = C w' (1 + a), where a is the offset of its centre of
/// mass in radii.
TEST(TippeTop, TurnsOverAndKeepsJellettsInvariant) {
    for (const contact::Solver solver :
         {contact::Solver::newton, contact::Solver::staggered_projections,
          contact::Solver::stewart_trinkle, contact::Solver::sequential_impulse}) {
        for (const double rate : {200.0, 250.0, 300.0}) {
            SCOPED_TRACE(::testing::Message() << static_cast<int>(solver) << " " << rate);
            World world = spinning(rate, solver);
            const Has first = look(world.state({1}));
            double last = first.energy;
            for (int i = 0; i < 8000; ++i) {
                world.step(kStep);
                const Has now = look(world.state({1}));
                ASSERT_NEAR(now.jellett / first.jellett, 1, 1e-4) << i;
                ASSERT_LT(now.energy, last * (1 + 1e-6)) << i;
                last = now.energy;
            }
            const scene::VolumeIntegrals whole = scene::integrate(top().shape);
            const double off = -whole.centre.z() / kRadius;
            const double spin = first.jellett / (1 + off) * whole.volume / whole.inertia(2, 2);
            EXPECT_LT(look(world.state({1})).up, -0.99);
            EXPECT_NEAR(world.state({1}).w_WB.norm() / spin, 1, 1e-3);
        }
    }
}

TEST(TippeTop, StaysUpIfItSpinsSlowly) {
    World world = spinning(30, contact::Solver::newton);
    for (int i = 0; i < 8000; ++i) world.step(kStep);
    EXPECT_GT(look(world.state({1})).up, 0.99);
}

}  // namespace
}  // namespace dihaptic::dynamics::tippe_test
