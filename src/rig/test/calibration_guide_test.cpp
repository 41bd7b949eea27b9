// Tests the guide with a simulated person who follows it, using the fake OpenHaptics library.
#include "rig/calibration_guide.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "devices/openhaptics/hd.h"
#include "devices/test/fakes.h"
#include "testing/files.h"

namespace dihaptic::rig::calibration_guide_test {
namespace {

constexpr double kLink = 0.05;       // length of the link [m]
constexpr double kTogether = 0.012;  // distance between endpoints held together [m]

/// Two devices whose poses differ from those in the rig file, and a simulated person who holds
/// them.
struct Person {
    testing::TemporaryFolder folder;
    devices::openhaptics::FakeHd& fake = devices::openhaptics::fake_hd();
    Rig rig;
    std::vector<Pose> X_WD;  // true poses
    Guidance now;
    std::vector<std::string> told;
    int64_t ticks = 0;          // number of ticks since the start of the step
    int64_t patience = 60'000;  // number of ticks for which the link is carried
    double moving = 0;          // amplitude with which held endpoints move apart [m]
    int given_up_at = 0;        // step at which the person cancels; 0 if the person never cancels
    double felt = 0;            // largest force exerted so far [N]

    /// `options` are further options for each device.
    explicit Person(const std::string& options = "") {
        std::string text = "title: A rig\ndevices:\n";
        for (const int i : {0, 1}) {
            text += fmt::format(
                "  - {{finger: {}, backend: openhaptics, rotation_deg: [90, 0, {}], "
                "options: {{library: {}, name: {}{}}}}}\n",
                i == 0 ? "thumb" : "index", i == 0 ? 90 : -90, DIHAPTIC_FAKE_HD,
                fake.devices[static_cast<size_t>(i)].name, options);
        }
        text +=
            "jig:\n  - {name: left, position_mm: [-30, -30, 0]}\n"
            "  - {name: right, position_mm: [30, -30, 0]}\n"
            "  - {name: back, position_mm: [0, 30, 10]}\n";
        Diagnostics diagnostics;
        rig = read_rig(folder.write("rig.yaml", text), diagnostics, NamedBy::the_operator);
        diagnostics.throw_if_errors();
        X_WD = poses(rig, held_fingers(rig));
        X_WD[0] = X_WD[0] * Pose{rotation_xyz({0.02, -0.01, 0.03}), {0.002, -0.001, 0.003}};
        X_WD[1] = X_WD[1] * Pose{rotation_xyz({-0.01, 0.03, 0.02}), {-0.003, 0.002, 0.001}};
        fake.hand = [this](size_t i, double t, const Wrench& push) {
            felt = std::max(felt, push.force.norm());
            devices::Held held;
            held.p = X_WD[i].inverse() * place(i, t);
            return held;
        };
    }

    bool does(const char* words) const { return now.text.find(words) != std::string::npos; }
    Vec3 place(size_t device, double t) const {
        const double side = device == 0 ? 0.5 : -0.5;
        if (does("Move the link")) {
            const Vec3 off(0.05 * std::sin(0.7 * t), 0.05 * std::sin(1.1 * t),
                           0.05 * std::sin(1.3 * t));
            const double up = 0.95 * std::sin(0.9 * t);
            const Vec3 along(std::sqrt(1 - up * up) * std::cos(1.7 * t),
                             std::sqrt(1 - up * up) * std::sin(1.7 * t), up);
            return off + side * kLink * along;
        }
        if (does("together")) {
            const double apart = kTogether + moving * std::sin(20 * t);
            return {side * apart, 0.01, 0.02};
        }
        for (const JigPoint& point : rig.jig) {
            const bool own = does(rig.devices[device].finger.c_str());
            if (own && does(point.name.c_str()) && does("Touch")) return point.position;
        }
        return {0, 0, 0.02 * side};
    }
    /// Checks the calibration in the way a session does, on newly made devices.
    std::vector<Together> hold_together() {
        now = {};
        const auto fingers = held_fingers(rig);
        const auto devices = make_devices(rig, fingers, {});
        devices->activate();
        auto out = check_together(rig, fingers, *devices, guide());
        devices->deactivate();
        return out;
    }
    Guide guide() {
        Guide out;
        out.show = [this](const Guidance& guidance) {
            if (guidance.step != now.step) ticks = 0;
            now = guidance;
            if (!now.measured.empty()) told.push_back(now.measured);
        };
        out.done = [this] {
            if (given_up_at != 0 && now.step == given_up_at) throw GivenUp{};
            const int64_t enough = does("Move the link") ? patience : 5;
            return ++ticks % enough == 0;
        };
        return out;
    }
};

TEST(CalibrationGuide, LeadsAPersonToACalibration) {
    Person person;
    const CalibrationInput input = lead_calibration(person.rig, person.guide());
    EXPECT_EQ(person.now.step, 10);
    EXPECT_EQ(person.now.steps, 10);
    EXPECT_EQ(person.now.share, 0);
    EXPECT_NE(person.told.back().find("60 needed"), std::string::npos) << person.told.back();
    const CalibrationResult result = calibrate(input);
    EXPECT_NEAR(result.calibration.link_length, kLink, 1e-6);
    EXPECT_LT(result.calibration.agreement_rms, 1e-6);
    EXPECT_LT(*result.calibration.jig_rms, 1e-6);
    EXPECT_NEAR(*result.calibration.find("index")->together, kTogether, 1e-6);
    EXPECT_FALSE(result.calibration.find("thumb")->together);
    EXPECT_NE(describe(result).find("12.0 mm from the first, when held together"),
              std::string::npos);
    EXPECT_EQ(person.fake.violations, 0);
    EXPECT_EQ(person.felt, 0);
}

/// A reset in a pose other than the standard configuration distorts the space of a device that
/// reports no joint angles.
TEST(CalibrationGuide, FindsAResetThatWasOffByTheJoints) {
    const double degree = std::numbers::pi / 180;
    for (const bool joints : {true, false}) {
        Person person(joints ? ", joint_angles: yes" : "");
        person.fake.devices[0].joint_offset = Vec3(1, -1, 1) * degree;
        person.fake.devices[1].joint_offset = Vec3(-1, 1, 1) * degree;
        const CalibrationResult result = calibrate(lead_calibration(person.rig, person.guide()));
        const double rms = result.calibration.agreement_rms;
        if (joints) {
            EXPECT_LT(rms, 1e-5);
            EXPECT_NEAR(result.calibration.find("thumb")->joint_offset->y(), -degree,
                        0.02 * degree);
        } else {
            EXPECT_GT(rms, 1e-4);
        }
    }
}

TEST(CalibrationGuide, RefusesJointsThatDoNotExplainThePositions) {
    Person person(", joint_angles: yes, thigh_mm: 215, shin_mm: 170");
    for (auto& device : person.fake.devices) device.joint_offset = Vec3::Zero();
    try {
        calibrate(lead_calibration(person.rig, person.guide()));
        FAIL();
    } catch (const Error& e) {
        EXPECT_NE(std::string(e.what()).find("Correct the lengths of its links"), std::string::npos)
            << e.what();
    }
}

TEST(CalibrationGuide, AsksForMoreWhenTheCloudIsTooSmall) {
    Person person;
    person.patience = 400;
    lead_calibration(person.rig, person.guide());
    const bool told = std::any_of(person.told.begin(), person.told.end(), [](const auto& text) {
        return text.find("continue, that is not enough") != std::string::npos;
    });
    EXPECT_TRUE(told);
}

TEST(CalibrationGuide, AsksAgainWhenEndpointsMoveApart) {
    Person person;
    person.moving = 0.005;
    Guide guide = person.guide();
    guide.show = [&, show = guide.show](const Guidance& now) {
        show(now);
        if (now.measured.find("hold them still once more") != std::string::npos) person.moving = 0;
    };
    const CalibrationInput input = lead_calibration(person.rig, guide);
    EXPECT_EQ(person.moving, 0);
    EXPECT_EQ(input.together_samples.size(), 50U);
}

TEST(CalibrationGuide, EndsWhenThePersonGivesUpOrADeviceFallsSilent) {
    for (const int step : {1, 3, 5}) {
        Person person;
        person.given_up_at = step;
        EXPECT_THROW(lead_calibration(person.rig, person.guide()), GivenUp) << step;
        for (const auto& device : person.fake.devices) EXPECT_FALSE(device.initialised);
    }
    Person person;
    Guide guide = person.guide();
    guide.done = [&, done = guide.done] {
        if (person.now.step == 3) person.fake.devices[1].nonsense = true;
        return done();
    };
    try {
        lead_calibration(person.rig, guide);
        FAIL();
    } catch (const Error& e) {
        EXPECT_NE(std::string(e.what()).find("the index's device does not answer"),
                  std::string::npos)
            << e.what();
    }
}

TEST(Together, TellsWhenADeviceWasMovedSinceTheCalibration) {
    Person person;
    const auto fingers = held_fingers(person.rig);
    EXPECT_FALSE(can_check_together(person.rig, fingers));
    person.rig.calibrated = calibrate(lead_calibration(person.rig, person.guide())).calibration;
    ASSERT_TRUE(can_check_together(person.rig, fingers));
    EXPECT_FALSE(can_check_together(person.rig, {"index"}));  // a session with only one finger
    const Together well = person.hold_together().at(0);
    EXPECT_TRUE(well.agrees);
    EXPECT_NEAR(well.apart, kTogether, 1e-5);
    EXPECT_NEAR(well.before, kTogether, 1e-5);
    // a device has been pushed 4 mm out of place
    person.X_WD[1].p.x() += 0.004;
    const Together moved = person.hold_together().at(0);
    EXPECT_FALSE(moved.agrees);
    EXPECT_NEAR(moved.apart, kTogether + 0.004, 1e-4);
    EXPECT_NE(moved.warning(person.rig).text().find("Calibrate the rig again"), std::string::npos);
    // a scale does not separate endpoints that are held together
    person.X_WD[1].p.x() -= 0.004;
    for (Device& device : person.rig.devices) device.scale = 3;
    EXPECT_NEAR(person.hold_together().at(0).apart, kTogether, 1e-5);
}

}  // namespace
}  // namespace dihaptic::rig::calibration_guide_test
