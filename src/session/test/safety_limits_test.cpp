// Tests that the rig's safety limits cannot be relaxed by an experiment, a scene or the command
// line.
#include <gtest/gtest.h>

#include "devices/test/fakes.h"
#include "session/safety_limits.h"
#include "testing/files.h"

namespace dihaptic::session::safety_limits_test {
namespace {

constexpr const char* kScene = R"(
bodies:
  - { name: block, shape: box, size_mm: [40, 40, 40], mass_g: 100, position_mm: [0, 0, 20] }
fingers: [{ name: thumb, shape: sphere, radius_mm: 8 }]
hand: { centre_mm: [0, 0, 100], script: [{ name: wait, duration_s: 0.1 }] }
)";

/// A rig, a scene and an experiment, each with its own `settings: safety:` section.
struct Files {
    testing::TemporaryFolder folder;
    Request request;

    explicit Files(const std::string& rig, const std::string& experiment,
                   const std::string& scene = "") {
        const auto safety = [](const std::string& text) {
            return text.empty() ? "" : "settings:\n  safety:\n    " + text + "\n";
        };
        folder.write("scene.yaml", kScene + safety(scene));
        request.rig = folder.write(
            "rig.yaml",
            "devices: [{ finger: thumb, backend: simulated, options: { peak_torque_Nm: 1, "
            "orientation: yes } }]\n" +
                safety(rig));
        request.file =
            folder.write("experiment.yaml", "title: One\nscene: scene.yaml\n" + safety(experiment));
    }
    /// Returns the error when planning; "" if there is none.
    std::string refusal() const {
        try {
            make_plan(request);
            return "";
        } catch (const Error& e) {
            return e.what();
        }
    }
};

struct Case {
    const char* name;
    const char* rig;
    const char* wider;
    const char* tighter;
    const char* key;
};
void PrintTo(const Case& c, std::ostream* out) {
    *out << c.name;
}
class Limit : public ::testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(
    Safety, Limit,
    ::testing::Values(
        Case{"force", "max_force_N: 2", "max_force_N: 2.5", "max_force_N: 1.5", "max_force_N"},
        Case{"force_rate", "max_force_rate_N_s: 500", "max_force_rate_N_ms: 0.6",
             "max_force_rate_N_s: 400", "max_force_rate_N_s"},
        Case{"torque", "max_torque_Nm: 0.1", "max_torque_Nm: 0.2", "max_torque_mNm: 50",
             "max_torque_Nm"},
        Case{"torque_rate", "max_torque_rate_Nm_s: 100", "max_torque_rate_Nm_s: 120",
             "max_torque_rate_Nm_s: 90", "max_torque_rate_Nm_s"},
        Case{"speed", "max_speed_m_s: 1", "max_speed_m_s: 2", "max_speed_mm_s: 500",
             "max_speed_m_s"},
        Case{"pause", "max_pause_ms: 30", "max_pause_ms: 31", "max_pause_ms: 20", "max_pause_s"},
        Case{"late", "max_late_ms: 5", "max_late_ms: 6", "max_late_ms: 4", "max_late_s"},
        Case{"hand_damping", "hand_damping_Ns_m: 1", "hand_damping_Ns_m: 2", "",
             "hand_damping_Ns_m"},
        Case{"heating", "heating_time_s: 5", "heating_time_s: 6", "heating_time_s: 4",
             "heating_time_s"},
        Case{"wall", "workspace_stiffness_N_m: 400", "workspace_stiffness_N_m: 0",
             "workspace_stiffness_N_m: 600", "workspace_stiffness_N_m"},
        Case{"soft_start", "soft_start_s: 1", "soft_start_s: 0", "soft_start_s: 2", "soft_start_s"},
        Case{"dead_man_finger", "dead_man_finger: thumb", "dead_man_finger: ''", "",
             "dead_man_finger"},
        Case{"dead_man_button", "{ dead_man_finger: thumb, dead_man_button: 1 }",
             "dead_man_button: 0", "", "dead_man_button"},
        Case{"energy_guard", "energy_guard: act", "energy_guard: 'off'", "", "energy_guard"}),
    [](const auto& instance) { return std::string(instance.param.name); });

TEST_P(Limit, IsNotWidenedByAnExperiment) {
    const Case& c = GetParam();
    const Files files(c.rig, c.wider);
    const std::string told = files.refusal();
    EXPECT_NE(told.find("experiment.yaml:5: error: safety." + std::string(c.key)),
              std::string::npos)
        << told;
    EXPECT_NE(told.find("rig.yaml:4"), std::string::npos) << told;
    EXPECT_NE(told.find("may only tighten the rig's safety limits"), std::string::npos) << told;
}

TEST_P(Limit, IsNotWidenedByASceneOrTheCommandLine) {
    const Case& c = GetParam();
    const Files scene(c.rig, "", c.wider);
    EXPECT_NE(scene.refusal().find("rig.yaml:4"), std::string::npos) << scene.refusal();
    Files typed(c.rig, "");
    const std::string wish = c.wider;
    const size_t colon = wish.find(": ");
    typed.request.set = {"safety." + wish.substr(0, colon) + "=" + wish.substr(colon + 2)};
    EXPECT_NE(typed.refusal().find("command line"), std::string::npos) << typed.refusal();
}

TEST_P(Limit, IsTightenedByAnyoneAndKeptByAll) {
    const Case& c = GetParam();
    EXPECT_EQ(Files(c.rig, "").refusal(), "");
    EXPECT_EQ(Files(c.rig, c.tighter).refusal(), "");
    EXPECT_EQ(Files(c.rig, "", c.tighter).refusal(), "");
    if (*c.tighter == '\0') return;
    // a scene's safety settings apply, although a rig's other settings override those of a scene
    const Files files(c.rig, "", c.tighter);
    const std::string told = describe_safety(make_plan(files.request)).front();
    EXPECT_NE(told.find("scene.yaml:"), std::string::npos) << told;
}

TEST_P(Limit, IsFreeWhereASimulatedRigSaysNothing) {
    EXPECT_EQ(Files("", GetParam().wider).refusal(), "");
}

TEST(SafetyLimits, OfRealDevicesAreTheDefaultsWhereTheirRigSaysNothing) {
    devices::forcedimension::fake_dhd();
    Files files("", "max_pause_ms: 50");
    files.request.rig = files.folder.write(
        "real.yaml",
        std::string("devices: [{ finger: thumb, backend: forcedimension, options: { serial: 101, "
                    "library: ") +
            DIHAPTIC_FAKE_DHD + " } }]\n");
    const std::string told = files.refusal();
    EXPECT_NE(told.find("safety.max_pause_s: 0.05 s widens what the default for real devices "
                        "allows: 0.04 s"),
              std::string::npos)
        << told;
}

TEST(SafetyLimits, AreListedWithWhoSetThem) {
    const Files files("max_force_N: 2\n    dead_man_finger: thumb", "max_speed_m_s: 1");
    const auto told = describe_safety(make_plan(files.request));
    ASSERT_EQ(told.size(), 3u);
    EXPECT_NE(told[0].find("safety.max_force: 2 N, by "), std::string::npos) << told[0];
    EXPECT_NE(told[0].find("rig.yaml:4"), std::string::npos) << told[0];
    EXPECT_NE(told[1].find("safety.max_speed: 1 m/s, by "), std::string::npos) << told[1];
    EXPECT_NE(told[2].find("safety.dead_man_finger: thumb, button 0, by "), std::string::npos);
}

}  // namespace
}  // namespace dihaptic::session::safety_limits_test
