#include "rig/corrected_devices.h"

#include <gtest/gtest.h>

#include <cmath>

#include "testing/allocation_guard.h"

namespace dihaptic::rig::corrected_devices_test {
namespace {

using std::chrono::milliseconds;
const model::PhantomLinks kLinks;

/// An arm that moves by itself and stores the wrenches that are sent to it.
class MovingArm final : public devices::DeviceGroup {
  public:
    static Vec3 joints(double t) {
        return {0.4 * std::sin(2 * t), 0.2 + 0.3 * std::cos(3 * t), 0.3 * std::sin(t)};
    }
    explicit MovingArm(Wrench& told) : DeviceGroup({info()}), told_(told) {}

  private:
    static frame::DeviceInfo info() {
        frame::DeviceInfo out;
        out.peak_force = 8;
        out.continuous_force = 2;
        out.workspace = Vec3(0.1, 0.2, 0.3);
        out.arm = kLinks;
        return out;
    }
    void do_activate() override {}
    void do_deactivate() override {}
    void do_read(Time now, std::span<devices::Reading> readings) noexcept override {
        const double t = seconds(now);
        constexpr double kStep = 1e-6;
        readings[0] = {};
        readings[0].joints = joints(t);
        readings[0].p_DH = model::phantom_position(kLinks, readings[0].joints);
        readings[0].v_DH = model::phantom_jacobian(kLinks, readings[0].joints) *
                           ((joints(t + kStep) - joints(t - kStep)) / (2 * kStep));
    }
    void do_write(std::span<const Wrench> wrenches) noexcept override { told_ = wrenches[0]; }

    Wrench& told_;
};

Adjustment some_adjustment(double scale) {
    Adjustment out;
    out.scale = scale;
    out.correction.arm = kLinks;
    out.correction.X = {rotation_by({0.1, -0.2, 0.05}), {0.01, 0.02, 0.03}};
    out.correction.joint_offset = {0, 0.03, -0.05};
    return out;
}

TEST(CorrectedDevices, VelocityIsThatOfThePositionAndPowerThatOfTheHand) {
    Wrench told;
    const auto group = make_corrected(std::make_unique<MovingArm>(told), {some_adjustment(3)});
    group->activate();
    std::vector<devices::Reading> before(1), now(1), after(1);
    MovingArm alone(told);
    alone.activate();
    for (int i = 1; i < 2000; i += 37) {
        const Time t = milliseconds(i);
        const Time step = std::chrono::microseconds(1);
        std::vector<devices::Reading> raw(1);
        alone.read(t, raw);
        group->read(t - step, before);
        group->read(t + step, after);
        group->read(t, now);
        const Vec3 slope = (after[0].p_DH - before[0].p_DH) / (2 * seconds(step));
        EXPECT_LT((now[0].v_DH - slope).norm(), 1e-6);
        // force and speed are 3 times as large in the world as at the hand, so power is 9 times as
        // large
        const Vec3 f(1, -2, 0.5);
        group->write(std::vector<Wrench>{{f, Vec3::Zero()}});
        EXPECT_NEAR(told.force.dot(raw[0].v_DH), f.dot(now[0].v_DH) / 9, 1e-12);
    }
}

TEST(CorrectedDevices, TellWhatTheyCanDoInTheWorldsMeasure) {
    Wrench told;
    const auto group = make_corrected(std::make_unique<MovingArm>(told), {some_adjustment(3)});
    EXPECT_EQ(group->info(0).scale, 3);
    EXPECT_EQ(group->info(0).peak_force, 24);
    EXPECT_EQ(group->info(0).continuous_force, 6);
    EXPECT_EQ(*group->info(0).workspace, 3 * Vec3(0.1, 0.2, 0.3));
}

TEST(CorrectedDevices, NoStretchMakesAForceLargerThanTheDevicesLimit) {
    for (const double scale : {1.0, 3.0}) {
        Adjustment stretched;
        stretched.scale = scale;
        stretched.correction.X.R = rotation_by({0.3, 0, 0});
        stretched.correction.stretch.diagonal() = Vec3(0.5, -0.5, 0.5);
        Wrench told;
        const auto group = make_corrected(std::make_unique<MovingArm>(told), {stretched});
        group->activate();
        std::vector<devices::Reading> readings(1);
        const double peak = group->info(0).peak_force;  // in world units
        for (const double limit : {1e3, 8.0 * scale, 2.0 * scale}) {
            group->limit(0, limit, 0);
            const double most = std::min(limit, peak);
            double largest = 0;
            for (int i = 0; i < 100; ++i) {
                const Vec3 along(std::cos(0.7 * i), std::sin(1.3 * i), std::cos(2.1 * i));
                group->read(milliseconds(i), readings);
                group->write(std::vector<Wrench>{{most * along.normalized(), Vec3::Zero()}});
                largest = std::max(largest, told.force.norm());
                EXPECT_LE(told.force.norm(), most / scale * (1 + 1e-9));
            }
            EXPECT_NEAR(largest, most / scale, 1e-9);
            // a force far below the limit is changed by the stretch
            group->write(std::vector<Wrench>{{0.1 * Vec3::UnitX(), Vec3::Zero()}});
            EXPECT_NEAR(told.force.norm(), 0.15 / scale, 1e-12);
        }
    }
}

TEST(CorrectedDevices, AllocateNothingInTheCycle) {
    DIHAPTIC_NEEDS_ALLOCATION_GUARD();
    Wrench told;
    const auto group = make_corrected(std::make_unique<MovingArm>(told), {some_adjustment(2)});
    group->activate();
    std::vector<devices::Reading> readings(1);
    const std::vector<Wrench> forces(1, {Vec3(1, 0, 0), Vec3::Zero()});
    const testing::AllocationGuard guard;
    for (int i = 0; i < 100; ++i) {
        group->read(milliseconds(i), readings);
        group->write(forces);
    }
    EXPECT_EQ(guard.count(), 0U);
}

}  // namespace
}  // namespace dihaptic::rig::corrected_devices_test
