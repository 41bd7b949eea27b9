// Tests Euler's disc, i.e. a thin disc that rolls around on its edge.
#include <gtest/gtest.h>

#include <numbers>
#include <vector>

#include "dynamics/test/blocks.h"

namespace dihaptic::dynamics::disc_test {
namespace {

constexpr double kRadius = 0.0375;    // [m]
constexpr double kThickness = 0.001;  // [m]
constexpr double kHalf = kThickness / 2;
const double kAcross = kRadius * kRadius / 4 + kThickness * kThickness / 12;  // per unit mass
const double kAlong = kRadius * kRadius / 2;

/// The angular velocity W about the vertical of a rolling disc that is tilted by `tilt` and whose
/// centre is at rest. The disc turns about the line through its centre and its contact point, and
/// its angular momentum L is turned by the moment of the contact force: W x L = c x m g. For a thin
/// disc L = m r^2 / 4 W sin(tilt) along its radius, and W^2 = 4 g / (r sin(tilt)) (Moffatt 2000).
double steady(double tilt) {
    const double c = std::cos(tilt), s = std::sin(tilt);
    return std::sqrt(kGravity * (kRadius * c - kHalf * s) /
                     (s * (kAcross * c - kAlong * kHalf / kRadius * s)));
}

World spun(double tilt) {
    scene::Body disc;
    disc.name = "disc";
    disc.shape.kind = scene::ShapeKind::cylinder;
    disc.shape.radius = kRadius;
    disc.shape.length = kThickness;
    disc.mass = 0.1;
    disc.friction = 1;
    World world = make({plane(1), disc}, awake());
    const Quat R = rotation_by(tilt * Vec3::UnitX());
    world.set_pose({1}, {R, {0, 0, kRadius * std::sin(tilt) + kHalf * std::cos(tilt)}});
    const Vec3 along_radius = R * Vec3(0, 1, kHalf / kRadius);
    world.set_motion({1}, Vec3::Zero(), steady(tilt) * std::sin(tilt) * along_radius);
    return world;
}

double tilt_of(const BodyState& now) {
    return std::acos((now.X_WB.R * Vec3::UnitZ()).z());
}

/// Energy per unit mass [J/kg].
double energy(const BodyState& now) {
    const Vec3 w = now.X_WB.R.conjugate() * now.w_WB;
    return now.v_WB.squaredNorm() / 2 + w.cwiseAbs2().dot(Vec3(kAcross, kAcross, kAlong)) / 2 +
           kGravity * now.X_WB.p.z();
}

struct Spun {
    double rate = 0;    ///< mean angular velocity about the vertical, relative to steady()
    double tilted = 0;  ///< largest relative change in tilt
    double gained = 0;  ///< relative gain in energy
    bool told = false;  ///< whether unexplained energy was reported
};

Spun roll(double tilt, double time, double step) {
    World world = spun(tilt);
    const double first = energy(world.state({1}));
    double last = first;
    double turned = 0, before = -std::numbers::pi / 2;
    Spun out;
    const int steps = static_cast<int>(std::lround(time / step));
    for (int i = 0; i < steps; ++i) {
        world.step(step);
        const BodyState now = world.state({1});
        const Vec3 axis = now.X_WB.R * Vec3::UnitZ();
        const double azimuth = std::atan2(axis.y(), axis.x());
        turned += std::remainder(azimuth - before, 2 * std::numbers::pi);
        before = azimuth;
        out.tilted = std::max(out.tilted, std::abs(tilt_of(now) / tilt - 1));
        last = energy(now);
        out.told = out.told || world.balance().unbalanced;
    }
    out.rate = turned / (steady(tilt) * time);
    out.gained = last / first - 1;
    return out;
}

const std::vector<double> kTilts{0.1, 0.2, 0.3, 0.6, 1.0};

TEST(EulersDisc, RollsAroundTheFasterTheFlatterItLies) {
    for (const double tilt : kTilts) {
        const Spun coarse = roll(tilt, 1, kStep);
        EXPECT_NEAR(coarse.rate, 1, 1e-3) << tilt;
        EXPECT_LT(coarse.tilted, 0.02) << tilt;
        const Spun fine = roll(tilt, 1, kStep / 4);
        EXPECT_NEAR(fine.rate, 1, 2e-4) << tilt;
        EXPECT_LT(fine.tilted, 0.004) << tilt;
    }
}

/// The contact point moves along the edge of the disc by up to a tenth of a radian in a step. If it
/// were assumed to be fixed, the disc would gain 6 % of energy in a second.
TEST(EulersDisc, KeepsItsEnergy) {
    for (const double tilt : kTilts) {
        const Spun coarse = roll(tilt, 1, kStep);
        EXPECT_NEAR(coarse.gained, 0, 1.5e-3) << tilt;
        EXPECT_FALSE(coarse.told) << tilt;
        const Spun fine = roll(tilt, 1, kStep / 4);
        EXPECT_NEAR(fine.gained, 0, 1e-4) << tilt;
        EXPECT_FALSE(fine.told) << tilt;
    }
}

}  // namespace
}  // namespace dihaptic::dynamics::disc_test
