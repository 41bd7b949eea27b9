// Tests that every number in a file has two finite bounds, so that no number can be added without
// bounds, and that a value that overflows when its unit is converted is rejected.
#include <gtest/gtest.h>

#include "frame/settings.h"
#include "rig/rig.h"
#include "task/file/experiment.h"
#include "testing/bounds.h"

namespace dihaptic::task::bounds_test {
namespace {

using testing::expect_bounds;

TEST(Bounds, AreOfEverySettingAndOfScenesAndHands) {
    expect_bounds<frame::Settings>();
    expect_bounds<scene::Scene>();
    expect_bounds<hand::HandSpec>();
    for (size_t kind = 0; kind < enum_names(scene::ShapeKind{}).size(); ++kind) {
        scene::Body body;
        body.shape.kind = static_cast<scene::ShapeKind>(kind);
        expect_bounds(body);
    }
}

TEST(Bounds, AreOfRigsAndCalibrations) {
    expect_bounds<rig::Rig>();
    expect_bounds<rig::Calibration>();
}

TEST(Bounds, AreOfExperimentsTasksAndProcedures) {
    expect_bounds<Experiment>();
    for (size_t when = 0; when < enum_names(When{}).size(); ++when) {
        Exit exit;
        exit.when = static_cast<When>(when);
        expect_bounds(exit);
    }
    for (size_t kind = 0; kind < enum_names(LoadKind{}).size(); ++kind) {
        LoadSpec load;
        load.kind = static_cast<LoadKind>(kind);
        expect_bounds(load);
    }
}

/// Returns the problems found when a line of settings is read.
std::string said_of(const std::string& line) {
    Diagnostics diagnostics;
    frame::Settings settings;
    read_fields(settings, parse_yaml(line, "settings.yaml"), diagnostics);
    return diagnostics.problems().empty() ? "" : diagnostics.problems().front().text();
}

TEST(Bounds, HoldAfterTheConversionOfUnits) {
    EXPECT_EQ(said_of("safety: { max_force_rate_N_ms: 3 }"), "");
    EXPECT_NE(said_of("safety: { max_force_rate_N_ms: 1e308 }").find("max_force_rate_N_ms"),
              std::string::npos);
    EXPECT_NE(said_of("safety: { max_force_rate_N_ms: 1e308 }").find("too large"),
              std::string::npos);
    EXPECT_NE(said_of("safety: { max_force_rate_N_s: 20 }").find("at least 85"), std::string::npos);
    EXPECT_EQ(said_of("coupling: { stiffness_N_mm: 100 }"), "");
    EXPECT_NE(said_of("coupling: { stiffness_N_mm: 101 }").find("at most 100"), std::string::npos);
    EXPECT_NE(said_of("coupling: { damping_Ns_mm: 1e308 }").find("too large"), std::string::npos);
    EXPECT_NE(said_of("coupling: { body_mass_g: 1e-300 }").find("body_mass_g"), std::string::npos);
}

}  // namespace
}  // namespace dihaptic::task::bounds_test
