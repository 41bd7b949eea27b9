#include "frame/device_info.h"

#include <gtest/gtest.h>

#include "base/field_reader.h"
#include "base/field_writer.h"

namespace dihaptic::frame::device_info_test {
namespace {

DeviceInfo written_and_read(const DeviceInfo& info) {
    Diagnostics diagnostics;
    DeviceInfo out;
    read_fields(out, parse_yaml(to_yaml(write_fields(info)), "session.yaml"), diagnostics);
    diagnostics.throw_if_errors();
    return out;
}

TEST(DeviceInfo, IsReadAsItWasWrittenWithWhatIsNotKnown) {
    DeviceInfo info;
    EXPECT_EQ(written_and_read(info), info);
    info.model = "omega.7, serial 101";
    info.serial = "101";
    info.simulated = true;
    info.peak_force = 12.1;
    info.continuous_force = 1.0 / 3;
    info.workspace = Vec3(0.1, 0.2, 0.3);
    info.measures_orientation = true;
    info.peak_torque = 0.4;
    info.continuous_torque = 0.188;
    info.scale = 2.5;
    info.delay = 1e-3;
    info.max_stiffness = 1400;
    info.max_damping = 8;
    info.arm = model::PhantomLinks{0.215, 0.170};
    info.damping = 3;
    info.mass = 0.075;
    info.turn_damping = 0.02;
    info.inertia = 1e-4;
    EXPECT_EQ(written_and_read(info), info);
}

TEST(DeviceInfo, OfAScaledWorldHasForcesAndReachInItsMeasure) {
    DeviceInfo info;
    info.peak_force = 8;
    info.workspace = Vec3(0.1, 0.2, 0.3);
    info.peak_torque = 0.5;
    info.max_stiffness = 1000;
    const DeviceInfo scaled = info.scaled(2);
    EXPECT_EQ(scaled.scale, 2);
    EXPECT_EQ(scaled.peak_force, 16);
    EXPECT_TRUE(std::isinf(scaled.continuous_force));
    EXPECT_EQ(*scaled.workspace, Vec3(0.2, 0.4, 0.6));
    EXPECT_EQ(scaled.peak_torque, 0.5);
    EXPECT_EQ(scaled.max_stiffness, 1000);
}

}  // namespace
}  // namespace dihaptic::frame::device_info_test
