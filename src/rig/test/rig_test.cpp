#include "rig/rig.h"

#include <gtest/gtest.h>

#include "testing/files.h"

namespace dihaptic::rig {
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
              1e-15);  // a Premium's up is the world's
    EXPECT_LT((X_WD[1] * Vec3(0, 1, 0) - Vec3(0, 1, 0)).norm(), 1e-15);
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
        Bad{"devices:\n  - {finger: a, backend: simulated}\n  - {finger: b, backend: replay}\n",
            "All devices of a rig are of one backend"}));

TEST(RigFile, SaysWhichFingerHasNoDevice) {
    const Rig rig = simulated_rig({"thumb"});
    try {
        poses(rig, {"thumb", "middle"});
        FAIL();
    } catch (const Error& e) {
        EXPECT_NE(std::string(e.what()).find("no device is held by the scene's finger 'middle'"),
                  std::string::npos)
            << e.what();
    }
}

}  // namespace
}  // namespace dihaptic::rig
