// Tests the warnings about loads that a loop, a device or a body cannot withstand, including the
// numbers in them.
#include <gtest/gtest.h>

#include "session/test/reaches.h"

namespace dihaptic::session::load_checks_test {
namespace {

const char* const kField =
    "field: { kind: channel, on: index, from: start, to: target, stiffness_N_m: 1000, "
    "damping_Ns_m: 5 }";

/// Returns the messages about a load that is planned on a simulated device with these options.
std::string said_of(const std::string& load, const std::string& options = "preset: plant",
                    const std::string& settings = "") {
    Files files;
    files.replace(kField, "loads: [{ " + load + " }]");
    files.replace("scene: scene.yaml\n", "scene: scene.yaml\nrig: rig.yaml\n" + settings);
    files.folder.write(
        "rig.yaml",
        "devices:\n  - { finger: index, backend: simulated, options: { " + options + " } }\n");
    std::vector<Problem> problems;
    try {
        problems = make_plan(files.request()).warnings;
    } catch (const Error& e) {
        problems = e.problems();
    }
    std::string all;
    for (const Problem& p : problems) {
        all += p.text() + "\n";
        EXPECT_NE(p.place.file.find("experiment.yaml"), std::string::npos) << p.text();
        EXPECT_GT(p.place.line, 0);
        EXPECT_FALSE(p.remedy.empty());
    }
    return all;
}

void expect_said(const std::string& said, const std::string& part) {
    EXPECT_NE(said.find(part), std::string::npos) << "not said: " << part << "\nbut: " << said;
}

TEST(LoadChecks, SayNothingOfLoadsThatAreHeld) {
    EXPECT_EQ(said_of("kind: channel, on: index, from: start, to: target, stiffness_N_m: 1000, "
                      "damping_Ns_m: 5"),
              "");
    EXPECT_EQ(said_of("kind: curl, on: index, axis: [0, 0, 1], damping_Ns_m: 13"), "");
    EXPECT_EQ(said_of("kind: constant, on: index, force_N: [3, 0, 0]"), "");
    EXPECT_EQ(said_of("kind: spring, on: index, about: start, stiffness_N_m: -100, "
                      "safe_within_mm: 50, fade_mm: 20"),
              "");
    EXPECT_EQ(said_of("kind: spring, on: block, about: start, stiffness_N_m: 100"), "");
    EXPECT_EQ(said_of("kind: constant, on: index, torque_mNm: [0, 0, 20]", "preset: sigma_7"), "");
}

TEST(LoadChecks, CompareStiffnessAndDampingWithTheLoop) {
    expect_said(said_of("kind: spring, on: index, about: start, stiffness_N_m: 9000"),
                "a spring load of 9000 N/m is above 6000 N/m (2 b / T)");
    // the age of the inputs counts twice, as a device's delay does
    expect_said(said_of("kind: channel, on: index, from: start, to: target, stiffness_N_m: 1000, "
                        "delay_ms: 10"),
                "a channel load of 1000 N/m is above 286 N/m (2 b / T)");
    expect_said(said_of("kind: spring, on: index, about: start, stiffness_N_m: -300, "
                        "safe_within_mm: 20, fade_mm: 0.5"),
                "a spring load of 1.2e+04 N/m is above 6000 N/m");
    expect_said(said_of("kind: viscous, on: index, damping_Ns_m: 200"), "(2 m / T)");
    expect_said(said_of("kind: viscous, on: index, damping_Ns_m: -5"),
                "pushes the hand on with 5 N*s/m, more than the 3 N*s/m");
    expect_said(said_of("kind: general, on: index, B_Ns_m: [[6, 0, 0], [0, 0, 0], [0, 0, 0]]"),
                "pushes the hand on with 6 N*s/m");
}

TEST(LoadChecks, CompareForcesWithTheDevicesAndTheSafetyLimit) {
    expect_said(said_of("kind: constant, on: index, force_N: [6, 0, 8]"),
                "reaches 10 N, more than the 8.5 N");
    expect_said(said_of("kind: constant, on: index, force_N: [3, 0, 0]", "preset: plant",
                        "settings: { safety: { max_force_N: 2 } }\n"),
                "reaches 3 N, more than the 2 N");
    expect_said(said_of("kind: curl, on: index, axis: [0, 0, 1], damping_Ns_m: 34"),
                "reaches the 8.5 N that");
    expect_said(said_of("kind: curl, on: index, axis: [0, 0, 1], damping_Ns_m: 34"), "at 0.25 m/s");
    expect_said(said_of("kind: spring, on: index, about: start, stiffness_N_m: -500, "
                        "safe_within_mm: 50, fade_mm: 50"),
                "reaches 25 N, more than the 8.5 N");
    expect_said(said_of("kind: spring, on: index, about: start, stiffness_N_m: 100",
                        "workspace_mm: [400, 300, 0.001e6]"),
                "8.5 N");
    expect_said(said_of("kind: constant, on: index, torque_Nm: [0, 0, 5]", "preset: sigma_7"),
                "reaches 5 N*m, more than the");
}

TEST(LoadChecks, RefuseATorqueOnAHandleThatRendersNone) {
    expect_said(said_of("kind: constant, on: index, torque_mNm: [0, 0, 20]"), "error: torque: ");
}

TEST(LoadChecks, CompareLoadsOnABodyWithTheStep) {
    expect_said(said_of("kind: viscous, on: block, damping_Ns_m: 300"),
                "throws a body of 100 g about in steps of 1 ms");
    expect_said(
        said_of("kind: spring, on: block, about: start, stiffness_N_mm: 90, damping_Ns_m: 200"),
        "9e+04 N/m and 200 N*s/m");
}

}  // namespace
}  // namespace dihaptic::session::load_checks_test
