#include "devices/simulated/arm.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "devices/device_group.h"
#include "testing/allocation_guard.h"

namespace dihaptic::devices::simulated::arm_test {
namespace {

using std::chrono::milliseconds;

const auto kNobody = [](const Vec3&, const Vec3&) noexcept { return Vec3::Zero(); };

Options premium(double friction = 0, double step = 0) {
    Options options = Options::of(Preset::premium_1_0);
    options.arm = Mechanics::phantom;
    options.friction = friction;
    options.position_step = step;
    return options;
}

/// A spring that holds the endpoint near the middle of its range.
struct Spring {
    double k;
    Vec3 operator()(const Vec3& p_DH, const Vec3&) const noexcept { return -k * p_DH; }
    double energy(const Vec3& p_DH) const { return k / 2 * p_DH.squaredNorm(); }
};

TEST(Arm, KeepsItsEnergyWithoutFriction) {
    for (const double carried : {0.0, 0.02}) {
        Arm arm(premium(), carried);
        arm.reset({0.03, 0.02, -0.02});
        const Spring spring{30};
        const auto energy = [&] {
            return arm.energy() + spring.energy(arm.p_DH()) +
                   carried / 2 * arm.v_DH().squaredNorm();
        };
        const double begin = energy();
        double fastest = 0, drift = 0;
        for (int i = 0; i < 100000; ++i) {  // 10 s
            arm.move(1e-4, spring);
            fastest = std::max(fastest, arm.v_DH().norm());
            drift = std::max(drift, std::abs(energy() - begin));
        }
        EXPECT_GT(fastest, 0.5);
        EXPECT_LT(drift / begin, 1e-7) << carried;  // the requirement is 0.1 %
    }
}

TEST(Arm, YieldsToTheMotorsAndBeyondTheirTorqueNoMore) {
    Arm arm(premium(), 0);
    const auto held = [&](const Vec3& f_D) {
        arm.reset(Vec3::Zero());
        arm.drive(f_D);
        const auto firm = [](const Vec3& p, const Vec3& v) noexcept -> Vec3 {
            return -2000 * p - 30 * v;
        };
        for (int i = 0; i < 20000; ++i) arm.move(1e-4, firm);
        return Vec3(2000 * arm.p_DH());
    };
    const Vec3 sag = held(Vec3::Zero());  // gravity
    EXPECT_LT(sag.norm(), 0.2);
    EXPECT_LT((held({3, -2, 1}) - sag - Vec3(3, -2, 1)).norm(), 0.05);
    EXPECT_NEAR((held({20, 0, 0}) - sag).x(), 8.5, 0.1);
}

TEST(Arm, JointFrictionHoldsAgainstLessThanItself) {
    Arm arm(premium(0.04), 0);
    arm.reset(Vec3::Zero());
    arm.drive({0.03, 0, 0});
    for (int i = 0; i < 10000; ++i) arm.move(1e-4, kNobody);
    EXPECT_EQ(arm.q()[0], 0);
    arm.drive({0.2, 0, 0});
    for (int i = 0; i < 100; ++i) arm.move(1e-4, kNobody);
    EXPECT_GT(arm.q()[0], 0);
}

TEST(Arm, StopsWhereItsJointsEnd) {
    Arm arm(premium(), 0);
    arm.reset(Vec3::Zero());
    arm.drive({0, 5, 5});
    for (int i = 0; i < 30000; ++i) {
        arm.move(1e-4, kNobody);
        ASSERT_TRUE(model::phantom_allows(arm.q() - 1e-9 * arm.q()));
    }
    EXPECT_LT(arm.rate().norm(), 1e-9);
}

/// A simulated hand that moves.
class RoundDriver final : public hand::Driver {
  public:
    static Vec3 at(double t) {
        return {0.04 * std::sin(3 * t), 0.03 * std::cos(2 * t), -0.03 * std::sin(2.5 * t)};
    }
    double duration() const override { return 1; }
    const std::vector<Phase>& phases() const override { return phases_; }

  private:
    hand::FingerTarget do_target(int, double t) const noexcept override {
        constexpr double kStep = 1e-5;
        return {at(t), (at(t + kStep) - at(t - kStep)) / (2 * kStep)};
    }
    std::vector<Phase> phases_;
};

struct Held {
    RoundDriver driver;
    Pose X_WD{rotation_xyz({0.4, -0.2, 1.3}), {0.01, -0.02, 0.03}};
    std::unique_ptr<DeviceGroup> group;

    explicit Held(const std::string& options) {
        Context context;
        context.driver = &driver;
        context.impedance.stiffness = 3e4;
        context.impedance.damping = 60;
        group = find_backend("simulated")
                    ->make({{"thumb", X_WD,
                             parse_yaml("preset: premium_1_0\narm: phantom\n" + options, "")}},
                           context);
        group->activate();
    }
    std::vector<Reading> readings{1};
    std::vector<Wrench> none{1};
    const Reading& read(int ms) {
        group->read(milliseconds(ms), readings);
        group->write(none);
        return readings[0];
    }
};

TEST(SimulatedArm, FollowsTheHandInStepsOfItsEncoders) {
    Held held("");
    ASSERT_TRUE(held.group->info(0).arm);
    double worst = 0, worst_speed = 0;
    for (int i = 0; i < 2000; ++i) {
        const Reading& reading = held.read(i);
        EXPECT_LT((model::phantom_position({}, reading.joints) - reading.p_DH).norm(), 1e-15);
        EXPECT_NEAR(std::remainder(reading.joints[1], 0.03e-3 / 0.14), 0, 1e-12);
        worst = std::max(worst, (held.X_WD * reading.p_DH - RoundDriver::at(i * 1e-3)).norm());
        const Vec3 v = (RoundDriver::at(i * 1e-3) - RoundDriver::at((i - 8) * 1e-3)) / 8e-3;
        if (i > 50) worst_speed = std::max(worst_speed, (held.X_WD.R * reading.v_DH - v).norm());
    }
    EXPECT_LT(worst, 0.1e-3);
    EXPECT_LT(worst_speed, 0.015);
}

TEST(SimulatedArm, MayStandElsewhereAndHaveBeenResetElsewhere) {
    Held held(
        "joint_offset_deg: [1, -1, 0.5]\nmisplaced_by_mm: [1, 2, -2]\nmisplaced_turn_deg: [0, 2, "
        "0]\n"
        "position_step_mm: 0\nfriction_N: 0\n");
    const Reading& reading = held.read(0);
    const double degree = std::numbers::pi / 180;
    const Pose X_WT = held.X_WD * Pose{rotation_xyz({0, 2 * degree, 0}), {1e-3, 2e-3, -2e-3}};
    const Vec3 truth =
        X_WT * model::phantom_position({}, reading.joints + degree * Vec3(1, -1, 0.5));
    EXPECT_LT((truth - RoundDriver::at(0)).norm(), 1e-12);
    EXPECT_GT((held.X_WD * reading.p_DH - RoundDriver::at(0)).norm(), 2e-3);
}

TEST(SimulatedArm, AllocatesNothingInTheCycle) {
    DIHAPTIC_NEEDS_ALLOCATION_GUARD();
    Held held("");
    const testing::AllocationGuard guard;
    for (int i = 0; i < 20; ++i) held.read(i);
    EXPECT_EQ(guard.count(), 0u);
}

TEST(SimulatedArm, SaysThatAPointHasNoJoints) {
    Diagnostics diagnostics;
    find_backend("simulated")
        ->describe({{"thumb", {}, parse_yaml("joint_offset_deg: [1, 0, 0]\n", "rig.yaml")}}, {},
                   diagnostics);
    ASSERT_TRUE(diagnostics.has_errors());
    EXPECT_NE(diagnostics.problems()[0].text().find("Add arm: phantom"), std::string::npos);
}

}  // namespace
}  // namespace dihaptic::devices::simulated::arm_test
