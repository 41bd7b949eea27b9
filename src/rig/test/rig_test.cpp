#include "rig/rig.h"

#include <gtest/gtest.h>

#include "base/field_writer.h"
#include "testing/files.h"

namespace dihaptic::rig::rig_test {
namespace {

std::string problems_of(const std::string& yaml) {
    const testing::TemporaryFolder folder;
    Diagnostics diagnostics;
    read_rig(folder.write("rig.yaml", yaml), diagnostics);
    std::string all;
    for (const Problem& p : diagnostics.problems()) all += p.text() + "\n";
    return all;
}

TEST(RigFile, PlacesDevices) {
    const testing::TemporaryFolder folder;
    Diagnostics diagnostics;
    const Rig rig = read_rig(folder.write("rig.yaml",
                                          "devices:\n  - {finger: thumb, backend: simulated}\n"
                                          "  - {finger: index, backend: simulated, position_mm: "
                                          "[10, 0, 0], rotation_deg: [90, 0, 90]}\n"),
                             diagnostics);
    ASSERT_FALSE(diagnostics.has_errors());
    const auto X_WD = poses(rig, {"index", "thumb"});
    EXPECT_LT((X_WD[0] * Vec3(0, 1, 0) - Vec3(0.01, 0, 1)).norm(),
              1e-15);  // up is the same direction for a Premium as in the world
    EXPECT_LT((X_WD[1] * Vec3(0, 1, 0) - Vec3(0, 1, 0)).norm(), 1e-15);
}

TEST(RigFile, OriginPutsTheWorldIntoItsFrame) {
    Diagnostics diagnostics;
    testing::TemporaryFolder folder;
    const Rig rig =
        read_rig(folder.write("rig.yaml",
                              "origin_mm: [0, 20, -30]\ndevices:\n"
                              "  - {finger: thumb, backend: simulated, position_mm: [10, 20, 70]}\n"
                              "wall: {centre_mm: [0, 20, 30], size_mm: [200, 160, 120]}\n"
                              "jig: [{name: post, position_mm: [0, 0, 0]}]\n"),
                 diagnostics);
    diagnostics.throw_if_errors();
    EXPECT_EQ(rig.devices[0].position, Vec3(0.01, 0, 0.1));
    EXPECT_EQ(rig.jig[0].position, Vec3(0, -0.02, 0.03));
    EXPECT_EQ(wall_box(rig)->center(), Vec3(0, 0, 0.06));
    EXPECT_EQ(rig.moved_by, Vec3(0, 0.02, -0.03));
    // the rig file that a session stores gives the same world
    const Rig again = read_rig(folder.write("again.yaml", to_yaml(write_fields(rig))), diagnostics);
    EXPECT_EQ(again.devices[0].position, rig.devices[0].position);
    EXPECT_EQ(wall_box(again)->sizes(), Vec3(0.2, 0.16, 0.12));
}

TEST(RigFile, PlacesAHeadset) {
    Diagnostics diagnostics;
    testing::TemporaryFolder folder;
    const std::string devices = "devices: [{finger: index, backend: simulated}]\n";
    const Rig rig =
        read_rig(folder.write("rig.yaml",
                              devices + "origin_mm: [0, 20, 0]\nheadset: {space: local, "
                                        "position_mm: [10, 20, 30], rotation_deg: [0, 0, 90]}\n"),
                 diagnostics);
    diagnostics.throw_if_errors();
    ASSERT_TRUE(rig.headset);
    EXPECT_EQ(rig.headset->space, display::HeadsetSpace::local);
    const Pose X_WS = rig.headset->X_WS();
    EXPECT_EQ(X_WS.p, Vec3(0.01, 0, 0.03));
    // turned left by 90 degrees, so that forward is -x and up is +z
    EXPECT_LT((X_WS.R * Vec3(0, 0, -1) - Vec3(-1, 0, 0)).norm(), 1e-15);
    EXPECT_LT((X_WS.R * Vec3(0, 1, 0) - Vec3(0, 0, 1)).norm(), 1e-15);
    EXPECT_FALSE(read_rig(folder.write("none.yaml", devices), diagnostics).headset);
}

struct Bad {
    const char* yaml;
    const char* says;
};
void PrintTo(const Bad& bad, std::ostream* out) {
    *out << bad.says;
}
class BadRig : public ::testing::TestWithParam<Bad> {};
TEST_P(BadRig, IsReported) {
    EXPECT_NE(problems_of(GetParam().yaml).find(GetParam().says), std::string::npos)
        << problems_of(GetParam().yaml);
}
INSTANTIATE_TEST_SUITE_P(
    RigFile, BadRig,
    ::testing::Values(
        Bad{"title: x\n", "devices: is missing"}, Bad{"devices: []\n", "there are none"},
        Bad{"devices:\n  - {finger: thumb, backend: phantom}\n",
            "rig.yaml:2: error: backend: 'phantom' is not known. Known: "},
        Bad{"devices:\n  - {finger: a, backend: simulated}\n  - {finger: a, backend: simulated}\n",
            "'a' holds two devices"},
        Bad{"devices:\n  - {finger: a, backend: simulated, options: {preset: premium}}\n",
            "'premium' is not known. Use plant, premium_1_0, touch or sigma_7."},
        Bad{"devices:\n  - {finger: a, backend: simulated, options: {mass_g: 0}}\n",
            "mass_g: must be positive"},
        Bad{"devices:\n  - {finger: a, backend: simulated}\nwall: {size_mm: [1, 0, 1]}\n",
            "rig.yaml:3: error: size_mm: "},
        Bad{"devices:\n  - {finger: a, backend: simulated}\n  - {finger: b, backend: replay}\n",
            "All devices of a rig must have the same backend"}));

class StillDriver final : public hand::Driver {
  public:
    double duration() const override { return 0; }
    const std::vector<Phase>& phases() const override { return phases_; }

  private:
    hand::FingerTarget do_target(int, double) const noexcept override {
        return {{0.03, 0.02, 0.01}, Vec3::Zero()};
    }
    std::vector<Phase> phases_;
};

constexpr const char* kPart =
    "date: 2026-10-01\ndevices:\n  - {finger: thumb, serial: P-1, shift_mm: [1, 2, 3], turn_deg: "
    "[0, 0, "
    "90]}\n";

/// A rig with one device and a calibration.
Rig calibrated(const testing::TemporaryFolder& folder, const std::string& calibration,
               const std::string& options, Diagnostics& diagnostics) {
    folder.write("calibration.yaml", calibration);
    return read_rig(folder.write("rig.yaml",
                                 "calibration: calibration.yaml\ndevices:\n  - {finger: thumb, "
                                 "backend: simulated, options: {" +
                                     options + "}}\n"),
                    diagnostics);
}

TEST(RigFile, ReadsItsCalibrationAndItsDevicesAreCorrected) {
    const testing::TemporaryFolder folder;
    Diagnostics diagnostics;
    const Rig rig = calibrated(folder, kPart, "serial: P-1", diagnostics);
    ASSERT_FALSE(diagnostics.has_errors());
    const StillDriver driver;
    devices::Context context;
    context.driver = &driver;
    const auto first = [&](const Rig& of) {
        const auto group = make_devices(of, {"thumb"}, context);
        group->activate();
        std::vector<devices::Reading> readings(1);
        group->read(Time(0), readings);
        return readings[0].p_DH;
    };
    EXPECT_LT((first(uncorrected(rig)) - Vec3(0.03, 0.02, 0.01)).norm(), 1e-12);
    EXPECT_LT((first(rig) - Vec3(-0.02 + 1e-3, 0.03 + 2e-3, 0.01 + 3e-3)).norm(), 1e-12);

    check_age(rig, "2026-10-31", diagnostics);
    EXPECT_TRUE(diagnostics.problems().empty());
    check_age(rig, "2026-11-21", diagnostics);
    ASSERT_EQ(diagnostics.problems().size(), 1U);
    EXPECT_NE(diagnostics.problems()[0].text().find("calibrated 51 days ago. Calibrate it again"),
              std::string::npos);
}

TEST(RigFile, RefusesACalibrationOfOtherDevices) {
    const testing::TemporaryFolder folder;
    const StillDriver driver;
    devices::Context context;
    context.driver = &driver;
    const auto refusal = [&](const std::string& calibration, const std::string& options) {
        Diagnostics diagnostics;
        const Rig rig = calibrated(folder, calibration, options, diagnostics);
        std::string all;
        for (const Problem& problem : diagnostics.problems()) all += problem.text() + "\n";
        if (!all.empty()) return all;
        try {
            make_devices(rig, {"thumb"}, context);
        } catch (const Error& e) {
            return std::string(e.what());
        }
        return all;
    };
    const auto said = [&](const std::string& text, const std::string& words) {
        EXPECT_NE(text.find(words), std::string::npos) << text;
    };
    said(refusal(kPart, "serial: P-2"),
         "belongs to device P-1, but the thumb holds P-2. Calibrate");
    said(refusal("date: 2026-10-01\ndevices:\n  - {finger: toe}\n", ""),
         "calibration.yaml:2: error: devices: has no part for the thumb's device");
    said(refusal("date: 2026-10-01\ndevices:\n  - {finger: thumb, joint_offset_deg: [0, 1, 1]}\n",
                 ""),
         "which reports no joint angles. Calibrate the rig again");
    said(refusal("date: soon\ndevices:\n  - {finger: thumb}\n", ""),
         "'soon' is not a date. Write it as");
    said(refusal("date: 2026-10-01\ndevices:\n  - {finger: thumb, shift_cm: [0, 0, 5]}\nwhat: 1\n",
                 ""),
         "calibration.yaml:4: error: what");
    said(problems_of("calibration: none.yaml\ndevices:\n  - {finger: thumb, backend: simulated}\n"),
         "calibration: none.yaml cannot be used. Calibrate the rig (dihaptic calibrate)");
    said(problems_of("devices:\n  - {finger: thumb, backend: simulated, scale: 100}\n"), "scale: ");
}

TEST(RigFile, SaysWhichFingerHasNoDevice) {
    const Rig rig = simulated_rig({"thumb"});
    try {
        poses(rig, {"thumb", "middle"});
        FAIL();
    } catch (const Error& e) {
        EXPECT_NE(std::string(e.what()).find("the scene's finger 'middle' holds no device"),
                  std::string::npos)
            << e.what();
    }
}

}  // namespace
}  // namespace dihaptic::rig::rig_test
