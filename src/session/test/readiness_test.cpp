// Tests what is checked before a session.
#include "session/readiness.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "session/test/reaches.h"

namespace dihaptic::session::readiness_test {
namespace {

const Finding& of(const std::vector<Finding>& all, const std::string& what) {
    const auto found =
        std::find_if(all.begin(), all.end(), [&](const Finding& f) { return f.what == what; });
    EXPECT_NE(found, all.end()) << what;
    return *found;
}

Plan plan_of(const std::string& rig) {
    Files files;
    Request request = files.request();
    request.rig = files.folder.write("rig.yaml", rig);
    return make_plan(request);
}

const char* const kSimulated = "devices: [{ finger: index, backend: simulated }]\n";

TEST(Readiness, OfASimulatedRigNeedsNoCalibration) {
    const auto all = readiness(plan_of(kSimulated), "/tmp/not/there/yet", "2026-11-25");
    EXPECT_TRUE(of(all, "devices").good);
    EXPECT_NE(of(all, "devices").found.find("no device moves"), std::string::npos);
    EXPECT_TRUE(of(all, "calibration").good);
    EXPECT_EQ(of(all, "calibration").remedy, Remedy::none);
    EXPECT_NE(of(all, "disk").found.find("GB free"), std::string::npos) << of(all, "disk").found;
}

TEST(Readiness, SaysWhenACalibrationOrARegistrationIsOldOrMissing) {
    Plan plan = plan_of(std::string(kSimulated) +
                        "displays:\n  - { name: mirror, lower_left_mm: [-200, 0, 0], "
                        "lower_right_mm: [200, 0, 0], upper_left_mm: [-200, 0, 200], eyes: { "
                        "position_mm: [0, -500, 200] } }\n");
    plan.rig.calibrated.emplace().date = "2026-09-01";
    auto all = readiness(plan, "/tmp", "2026-11-25");
    EXPECT_FALSE(of(all, "calibration").good);
    EXPECT_EQ(of(all, "calibration").found, "of 2026-09-01, 85 days ago");
    EXPECT_EQ(of(all, "calibration").remedy, Remedy::calibrate);
    EXPECT_TRUE(of(all, "display mirror").good);  // the rig is simulated
    plan.rig.calibrated->date = "2026-11-20";
    plan.rig.displays[0].registered.emplace().date = "2026-01-01";
    plan.rig.displays[0].registered->rms = 0.4e-3;
    all = readiness(plan, "/tmp", "2026-11-25");
    EXPECT_TRUE(of(all, "calibration").good);
    EXPECT_FALSE(of(all, "display mirror").good);
    EXPECT_EQ(of(all, "display mirror").found, "registered on 2026-01-01, 0.4 mm rms");
}

TEST(Readiness, CountsWhatASessionWrites) {
    // two fingers at 1 kHz write at most 450 kB per second
    EXPECT_NEAR(bytes_per_hour(plan_of(kSimulated)), 450e3 * 3600, 1);
}

}  // namespace
}  // namespace dihaptic::session::readiness_test
