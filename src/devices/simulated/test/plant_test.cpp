#include "devices/simulated/plant.h"

#include <gtest/gtest.h>

#include <cmath>

#include "devices/device_group.h"

namespace dihaptic::devices::simulated {
namespace {

using std::chrono::milliseconds;

/// A hand whose target steps from 0 to `to` at time 0.
class StepDriver final : public hand::Driver {
  public:
    explicit StepDriver(const Vec3& to, const Vec3& v = Vec3::Zero()) : to_(to), v_(v) {}
    double duration() const override { return 1; }
    const std::vector<Phase>& phases() const override { return phases_; }

  private:
    hand::FingerTarget do_target(int, double t) const noexcept override {
        return t == 0 ? hand::FingerTarget{} : hand::FingerTarget{to_ + t * v_, v_};
    }
    Vec3 to_, v_;
    std::vector<Phase> phases_;
};

Plant plant(const Options& options, const hand::Impedance& impedance, const hand::Driver& driver) {
    Plant out(options, impedance, {}, 1, 0, driver);
    out.reset();
    return out;
}

TEST(Plant, SwingsAsTheDampedOscillatorThatItIs) {
    const StepDriver driver({0.01, 0, 0});
    Plant p = plant({}, {}, driver);
    const double k = 300, c = 3, m = 0.075;
    const double decay = c / (2 * m);
    const double w = std::sqrt(k / m - decay * decay);
    for (int i = 1; i < 300; ++i) {
        p.advance(milliseconds(i));
        const double t = i * 1e-3;
        const double expected =
            0.01 * (1 - std::exp(-decay * t) * (std::cos(w * t) + decay / w * std::sin(w * t)));
        EXPECT_NEAR(p.p_WH().x(), expected, 5e-5) << t;
    }
}

TEST(Plant, TracksASteadyTargetWithoutLag) {
    const StepDriver driver(Vec3::Zero(), {0, 0.1, 0});
    Plant p = plant({}, {}, driver);
    p.advance(milliseconds(2000));
    EXPECT_NEAR(p.p_WH().y(), 0.2, 1e-5);
    EXPECT_NEAR(p.v_WH().y(), 0.1, 1e-6);
}

TEST(Plant, YieldsToTheDevicesForceClampedToItsPeak) {
    const StepDriver driver(Vec3::Zero());
    Plant p = plant({}, {}, driver);
    EXPECT_FALSE(p.hold({0, 0, 3}));
    p.advance(milliseconds(2000));
    EXPECT_NEAR(p.p_WH().z(), 3.0 / 300, 1e-6);
    EXPECT_TRUE(p.hold({0, 0, 30}));
    p.advance(milliseconds(4000));
    EXPECT_NEAR(p.p_WH().z(), 8.5 / 300, 1e-6);
}

TEST(Plant, ForcesActAsManyTicksLateAsAsked) {
    Options options;
    options.delay_ticks = 2;
    const StepDriver driver(Vec3::Zero());
    Plant p = plant(options, {}, driver);
    p.hold({1, 0, 0});  // acts from the third advance on
    p.advance(milliseconds(1));
    EXPECT_EQ(p.v_WH().x(), 0);
    p.hold(Vec3::Zero());
    p.advance(milliseconds(2));
    EXPECT_EQ(p.v_WH().x(), 0);
    p.hold(Vec3::Zero());
    p.advance(milliseconds(3));
    EXPECT_GT(p.v_WH().x(), 0.9 * 1e-3 / 0.075);
    const double speed = p.v_WH().x();
    p.hold(Vec3::Zero());
    p.advance(milliseconds(4));
    EXPECT_LT(p.v_WH().x(), speed);
}

TEST(Plant, FrictionHoldsAgainstLessThanItself) {
    Options options;
    options.friction = 0.04;
    const StepDriver driver(Vec3::Zero());
    Plant p = plant(options, {}, driver);
    p.hold({0.039, 0, 0});
    p.advance(milliseconds(500));
    EXPECT_EQ(p.p_WH().x(), 0);
    p.hold({0.15, 0, 0});
    p.advance(milliseconds(3000));
    // it stops where spring and friction balance the force: within friction / stiffness of the
    // target
    EXPECT_NEAR(p.p_WH().x(), 0.15 / 300, 0.04 / 300 + 1e-6);
    EXPECT_EQ(p.v_WH().x(), 0);
}

TEST(Encoder, RoundsToItsStepsAndTakesVelocityFromThem) {
    Options options = Options::of(Preset::premium_1_0);
    Encoder encoder(options);
    Encoder::Measured measured{};
    for (int i = 0; i < 100; ++i)
        measured = encoder.measure(milliseconds(i), {0.1 * i * 1e-3, 0, 0}, {0.1, 0, 0});
    EXPECT_NEAR(std::remainder(measured.p.x(), 0.03e-3), 0, 1e-15);
    EXPECT_NEAR(measured.p.x(), 0.0099, 0.015e-3);
    EXPECT_NEAR(measured.v.x(), 0.1, 0.03e-3 / 8e-3);
    EXPECT_EQ(measured.v.y(), 0);
}

TEST(Options, OfThePremiumAreThoseOfItsDataSheetAndMayBeOverridden) {
    Options options;
    Diagnostics diagnostics;
    read_fields(options, parse_yaml("preset: premium_1_0\nfriction_N: 0.1\n", "rig.yaml"),
                diagnostics);
    EXPECT_FALSE(diagnostics.has_errors());
    EXPECT_EQ(options.position_step, 0.03e-3);
    EXPECT_EQ(options.peak_force, 8.5);
    EXPECT_EQ(options.continuous_force, 1.4);
    EXPECT_EQ(options.friction, 0.1);
    EXPECT_EQ(*options.workspace, Vec3(0.254, 0.178, 0.127));
}

TEST(SimulatedGroup, ReadsAndWritesInTheDevicesFrameAndMindsItsWorkspace) {
    const StepDriver driver({0, 0.5, 0});
    Context context;
    context.driver = &driver;
    const Pose X_WD{rotation_xyz({0.4, -0.2, 1.3}), {0.1, -0.2, 0.05}};
    const auto group =
        find_backend("simulated")
            ->make({{"thumb", X_WD,
                     parse_yaml("preset: premium_1_0\nfriction_N: 0\nposition_step_m: 0\n", "")}},
                   context);
    std::vector<Reading> readings(1);
    group->activate();
    group->read(Time(0), readings);
    EXPECT_LT((X_WD * readings[0].p_DH).norm(), 1e-15);
    const Vec3 f_W(0, 0, 2);
    const std::vector<Vec3> f_D{X_WD.R.conjugate() * f_W};
    for (int i = 1; i < 3000; ++i) {
        group->write(f_D);
        group->read(milliseconds(i), readings);
    }
    EXPECT_LT((X_WD * readings[0].p_DH - Vec3(0, 0.5, 2.0 / 300)).norm(), 1e-6);
    EXPECT_TRUE(readings[0].status & kOutsideWorkspace);
}

}  // namespace
}  // namespace dihaptic::devices::simulated
