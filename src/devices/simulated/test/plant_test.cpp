#include "devices/simulated/plant.h"

#include <gtest/gtest.h>

#include <cmath>

#include "devices/device_group.h"
#include "testing/bounds.h"

namespace dihaptic::devices::simulated::plant_test {
namespace {

using std::chrono::milliseconds;

/// A simulated hand whose target jumps from 0 to `to` at time 0.
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
    out.begin(Time(0));
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
    EXPECT_FALSE(p.hold({Vec3(0, 0, 3)}));
    p.advance(milliseconds(2000));
    EXPECT_NEAR(p.p_WH().z(), 3.0 / 300, 1e-6);
    EXPECT_TRUE(p.hold({Vec3(0, 0, 30)}));
    p.advance(milliseconds(4000));
    EXPECT_NEAR(p.p_WH().z(), 8.5 / 300, 1e-6);
}

TEST(Plant, ForcesActAsManyTicksLateAsAsked) {
    Options options;
    options.delay_ticks = 2;
    const StepDriver driver(Vec3::Zero());
    Plant p = plant(options, {}, driver);
    p.hold({Vec3(1, 0, 0)});  // acts from the third call of advance() onwards
    p.advance(milliseconds(1));
    EXPECT_EQ(p.v_WH().x(), 0);
    p.hold({});
    p.advance(milliseconds(2));
    EXPECT_EQ(p.v_WH().x(), 0);
    p.hold({});
    p.advance(milliseconds(3));
    EXPECT_GT(p.v_WH().x(), 0.9 * 1e-3 / 0.075);
    const double speed = p.v_WH().x();
    p.hold({});
    p.advance(milliseconds(4));
    EXPECT_LT(p.v_WH().x(), speed);
}

/// A simulated hand whose target turns at time 0.
class TurnDriver final : public hand::Driver {
  public:
    explicit TurnDriver(const Vec3& to) : to_(to) {}
    double duration() const override { return 1; }
    const std::vector<Phase>& phases() const override { return phases_; }

  private:
    hand::FingerTarget do_target(int, double t) const noexcept override {
        hand::FingerTarget out;
        if (t > 0) out.R_WT = rotation_by(to_);
        return out;
    }
    Vec3 to_;
    std::vector<Phase> phases_;
};

Options turning() {
    Options options;
    options.orientation = true;
    options.peak_torque = 0.2;
    return options;
}

TEST(Plant, TurnsAsTheDampedOscillatorThatItIs) {
    const Vec3 axis = Vec3(1, 2, -1).normalized();
    const TurnDriver driver(0.2 * axis);
    hand::Impedance impedance;
    impedance.turn_damping = 0.005;
    Plant p = plant(turning(), impedance, driver);
    const double k = 1, c = 0.005, I = 1e-4;
    const double decay = c / (2 * I);
    const double w = std::sqrt(k / I - decay * decay);
    for (int i = 1; i < 300; ++i) {
        p.advance(milliseconds(i));
        const double t = i * 1e-3;
        const double expected =
            0.2 * (1 - std::exp(-decay * t) * (std::cos(w * t) + decay / w * std::sin(w * t)));
        // 0.1 ms late, because the target moves only after the first step
        EXPECT_NEAR(rotation_vector(p.R_WH()).dot(axis), expected, 2.5e-3) << t;
        EXPECT_LT(rotation_vector(p.R_WH()).cross(axis).norm(), 1e-9);
    }
    EXPECT_EQ(p.p_WH(), Vec3::Zero());
}

TEST(Plant, YieldsToTheDevicesTorqueClampedToItsPeak) {
    const StepDriver driver(Vec3::Zero());
    Plant p = plant(turning(), {}, driver);
    EXPECT_FALSE(p.hold({Vec3::Zero(), {0, 0, 0.1}}));
    p.advance(milliseconds(2000));
    EXPECT_NEAR(rotation_vector(p.R_WH()).z(), 0.1, 1e-9);
    EXPECT_TRUE(p.hold({Vec3::Zero(), {0, 0, 3}}));
    p.advance(milliseconds(4000));
    EXPECT_NEAR(rotation_vector(p.R_WH()).z(), 0.2, 1e-9);
}

TEST(Gimbal, RoundsToItsStepsAndTakesVelocityFromThem) {
    Options options = turning();
    options.angle_step = 1e-3;
    Gimbal gimbal(options);
    Gimbal::Measured measured{};
    for (int i = 0; i < 100; ++i)
        measured = gimbal.measure(milliseconds(i), rotation_xyz({0.0102, 0, 2e-3 * i}), {0, 0, 2});
    EXPECT_LT((angles_xyz(measured.R) - Vec3(0.01, 0, 0.198)).norm(), 1e-12);
    EXPECT_LT((measured.w - Vec3(0, 0, 2)).norm(), 1e-3 / 8e-3);
}

TEST(Plant, FrictionHoldsAgainstLessThanItself) {
    Options options;
    options.friction = 0.04;
    const StepDriver driver(Vec3::Zero());
    Plant p = plant(options, {}, driver);
    p.hold({Vec3(0.039, 0, 0)});
    p.advance(milliseconds(500));
    EXPECT_EQ(p.p_WH().x(), 0);
    p.hold({Vec3(0.15, 0, 0)});
    p.advance(milliseconds(3000));
    // the endpoint stops where spring and friction balance the force, i.e. within friction /
    // stiffness of the target
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
    const std::vector<Wrench> f_D{{X_WD.R.conjugate() * f_W, Vec3::Zero()}};
    for (int i = 1; i < 3000; ++i) {
        group->write(f_D);
        group->read(milliseconds(i), readings);
    }
    EXPECT_LT((X_WD * readings[0].p_DH - Vec3(0, 0.5, 2.0 / 300)).norm(), 1e-6);
    EXPECT_TRUE(readings[0].status & kOutsideWorkspace);
}

TEST(SimulatedGroup, ReadsOrientationAndWritesTorqueInTheDevicesFrame) {
    const StepDriver driver(Vec3::Zero());
    Context context;
    context.driver = &driver;
    const Pose X_WD{rotation_xyz({0.4, -0.2, 1.3}), {0.1, -0.2, 0.05}};
    const auto group =
        find_backend("simulated")
            ->make({{"hand", X_WD, parse_yaml("preset: sigma_7\nangle_step_rad: 0\n", "")}},
                   context);
    EXPECT_TRUE(group->info(0).measures_orientation);
    EXPECT_EQ(group->info(0).peak_torque, 0.2);
    std::vector<Reading> readings(1);
    group->activate();
    const Vec3 t_W(0.05, 0, 0.1);
    const std::vector<Wrench> told{{Vec3::Zero(), X_WD.R.conjugate() * t_W}};
    for (int i = 0; i < 3000; ++i) {
        group->read(milliseconds(i), readings);
        group->write(told);
    }
    // the torque acts against a stiffness of 1 N*m/rad
    EXPECT_LT((X_WD.R * rotation_vector(readings[0].R_DH) - t_W).norm(), 1e-6);
}

TEST(SimulatedOptions, HaveBounds) {
    testing::expect_bounds<Options>();
}

}  // namespace
}  // namespace dihaptic::devices::simulated::plant_test
