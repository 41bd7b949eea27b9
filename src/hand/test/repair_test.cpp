// Tests how recorded movements are repaired and followed, and how their grasp is found.
#include "hand/repair.h"
#include "base/number.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "hand/grasp_site.h"
#include "hand/recorded.h"
#include "hand/test/reach.h"

namespace dihaptic::hand::repair_test {
namespace {

Path repaired(const std::vector<std::string>& lines) {
    return repair(read(join(lines)).movement);
}

/// Largest distance between the repaired path and the reach without faults [m].
double error_of(const Path& path) {
    double worst = 0;
    for (size_t f = 0; f < 2; ++f) {
        for (size_t s = 0; s < path.size(); ++s) {
            worst =
                std::max(worst, (path.p_WH[f][s] - Reach::at(static_cast<int>(f),
                                                             static_cast<double>(s) / Path::kRate))
                                    .norm());
        }
    }
    return worst;
}

double fastest(const Path& path) {
    double most = 0;
    for (const auto& finger : path.p_WH) {
        for (size_t s = 1; s < finger.size(); ++s)
            most = std::max(most, (finger[s] - finger[s - 1]).norm() * Path::kRate);
    }
    return most;
}

TEST(Repair, LeavesAGoodMovementAlone) {
    const Path path = repaired(reach_lines());
    EXPECT_TRUE(path.faults.empty());
    EXPECT_EQ(path.bridged_share(), 0);
    EXPECT_LT(error_of(path), 1e-3);
}

TEST(Repair, BridgesMissingFrames) {
    auto lines = reach_lines();
    lines.erase(lines.begin() + 60, lines.begin() + 64);
    const Path path = repaired(lines);
    ASSERT_EQ(path.faults.size(), 1u);
    EXPECT_EQ(path.faults[0].kind, FaultKind::missing_frames);
    EXPECT_NEAR(path.faults[0].end - path.faults[0].start, 5 * kFrame, 1e-4);
    EXPECT_LT(error_of(path), 2e-3);
    EXPECT_NEAR(path.bridged_share(), 5 * kFrame / 3.5, 2e-3);
}

TEST(Repair, BridgesNaN) {
    auto lines = reach_lines();
    set_cell(lines[60], 5, "NaN");
    set_cell(lines[61], 5, "");
    const Path path = repaired(lines);
    ASSERT_EQ(path.faults.size(), 1u);
    EXPECT_EQ(path.faults[0].kind, FaultKind::missing_marker);
    EXPECT_EQ(path.faults[0].line, 61);
    EXPECT_LT(error_of(path), 2e-3);
}

TEST(Repair, BridgesAFrozenMarkerWhetherTheTrackerTellsOrNot) {
    for (const bool told : {true, false}) {
        auto lines = reach_lines();
        for (size_t i = 60; i < 75; ++i) {
            for (int c = 4; c <= 6; ++c) set_cell(lines[i], c, cell(lines[59], c));
            if (told) lines[i].back() = '1';
        }
        const Path path = repaired(lines);
        ASSERT_EQ(path.faults.size(), 1u) << told;
        EXPECT_EQ(path.faults[0].kind, FaultKind::frozen_marker);
        EXPECT_EQ(path.faults[0].finger, 1);
        EXPECT_LT(error_of(path), 0.012)
            << "it moved " << path.faults[0].distance << " m meanwhile";
        EXPECT_LT(fastest(path), kMaxSpeed);
    }
}

TEST(Repair, BelievesAHandAtRest) {
    auto lines = reach_lines();
    for (size_t i = 2; i < 15; ++i) {
        for (int c = 1; c <= 6; ++c) set_cell(lines[i], c, cell(lines[1], c));
    }
    EXPECT_TRUE(repaired(lines).faults.empty());
}

TEST(Repair, DropsAWildPosition) {
    auto lines = reach_lines();
    set_cell(lines[60], 1, "900");
    const Path path = repaired(lines);
    ASSERT_EQ(path.faults.size(), 1u);
    EXPECT_EQ(path.faults[0].kind, FaultKind::wild_position);
    EXPECT_FALSE(path.faults[0].wrong_unit);
    EXPECT_LT(error_of(path), 2e-3);
}

TEST(Repair, DropsAnAbsurdCellAndNamesItsLineAndColumn) {
    for (const char* absurd : {"99999", "-99999", "1e300"}) {
        for (const size_t line : {size_t{1}, size_t{2}, size_t{100}, size_t{297}, size_t{298}}) {
            auto lines = reach_lines();
            ASSERT_EQ(lines.size(), 299u);
            set_cell(lines[line], 5, absurd);
            const Result result = read(join(lines));
            EXPECT_TRUE(result.diagnostics.problems().empty()) << absurd << line;
            const Path path = repair(result.movement);
            ASSERT_EQ(path.faults.size(), 1u) << absurd << line;
            EXPECT_EQ(path.faults[0].kind, FaultKind::wild_position);
            EXPECT_EQ(path.faults[0].line, static_cast<int>(line) + 1);
            const std::string said = describe(path.faults[0], path.fingers);
            EXPECT_NE(said.find("index: wild position"), std::string::npos) << said;
            EXPECT_NE(said.find("index_y_mm deviates by"), std::string::npos) << said;
            EXPECT_EQ(said.find("nan"), std::string::npos) << said;
            EXPECT_LT(error_of(path), 2e-3) << absurd << line;
        }
    }
}

TEST(Repair, DropsWildFramesAtTheEndsAndKeepsTheirNeighbours) {
    for (const size_t count : {size_t{1}, size_t{3}}) {
        for (const bool first : {true, false}) {
            auto lines = reach_lines();
            for (size_t i = 0; i < count; ++i) {
                std::string& line = lines[first ? 1 + i : lines.size() - 1 - i];
                for (int c = 1; c <= 6; ++c)
                    set_cell(line, c,
                             fmt::format("{:.6f}", finite_number(cell(line, c)).value() / 1000));
            }
            const Path path = repaired(lines);
            ASSERT_EQ(path.faults.size(), 2u);  // thumb and index finger
            for (const Fault& fault : path.faults) {
                EXPECT_EQ(fault.kind, FaultKind::wild_position);
                EXPECT_TRUE(fault.wrong_unit);
                EXPECT_EQ(describe(fault, path.fingers).find("apart"), std::string::npos);
            }
            EXPECT_LT(error_of(path), 2e-3) << count << first;
            EXPECT_LT(path.bridged_share(), static_cast<double>(count + 1) * kFrame / 3.4);
        }
    }
}

TEST(Repair, SaysNothingOfDistancesThatItDoesNotKnow) {
    auto lines = reach_lines();
    for (const size_t i : {size_t{1}, lines.size() - 1}) set_cell(lines[i], 2, "NaN");
    for (const Fault& fault : repaired(lines).faults) {
        const std::string said = describe(fault, {"thumb", "index"});
        EXPECT_EQ(said.find("nan mm"), std::string::npos) << said;
        EXPECT_EQ(said.find("inf"), std::string::npos) << said;
    }
}

TEST(Repair, SuspectsALineInMetres) {
    auto lines = reach_lines();
    for (int c = 1; c <= 6; ++c)
        set_cell(lines[60], c,
                 fmt::format("{:.6f}", finite_number(cell(lines[60], c)).value() / 1000));
    const Path path = repaired(lines);
    ASSERT_EQ(path.faults.size(), 2u);  // thumb and index finger
    for (const Fault& fault : path.faults) {
        EXPECT_TRUE(fault.wrong_unit);
        EXPECT_EQ(fault.line, 61);
        EXPECT_NE(
            describe(fault, path.fingers).find("if they are in metres, multiply them by 1000"),
            std::string::npos);
    }
    EXPECT_LT(error_of(path), 2e-3);
}

TEST(Repair, CrossesAJumpNoFasterThanAHandWould) {
    auto lines = reach_lines();
    for (size_t i = 130; i < lines.size(); ++i)
        set_cell(lines[i], 1,
                 fmt::format("{:.3f}", finite_number(cell(lines[i], 1)).value() + 120));
    const Path path = repaired(lines);
    ASSERT_EQ(path.faults.size(), 1u);
    EXPECT_EQ(path.faults[0].kind, FaultKind::jump);
    EXPECT_LT(fastest(path), 2 * kBridgeSpeed);
}

TEST(GraspSite, IsFoundWhereTheFingersClosedAndRested) {
    const auto site = find_grasp(repaired(reach_lines()));
    ASSERT_TRUE(site);
    EXPECT_GT(site->start, 1.4);
    EXPECT_LT(site->end, 2.7);
    EXPECT_NEAR(site->aperture, 0.040, 1e-3);
    EXPECT_NEAR(site->peak_aperture, 0.080, 2e-3);
    EXPECT_LT((site->axis - Vec3::UnitY()).norm(), 1e-3);
    EXPECT_LT((site->centre - Vec3(0, 0.35, -0.02)).norm(), 2e-3);
}

TEST(GraspSite, CanBeGiven) {
    const auto site = find_grasp(repaired(reach_lines()), 1.0);
    ASSERT_TRUE(site);
    EXPECT_NEAR((site->start + site->end) / 2, 1.0, 1e-9);
}

TEST(GraspSite, IsNotFoundInAHandThatNeverOpens) {
    auto lines = reach_lines();
    for (size_t i = 1; i < lines.size(); ++i) {
        for (int axis = 0; axis < 3; ++axis) {
            set_cell(lines[i], 4 + axis,
                     fmt::format("{:.3f}", finite_number(cell(lines[i], 1 + axis)).value() +
                                               (axis == 1 ? 30 : 0)));
        }
    }
    EXPECT_FALSE(find_grasp(repaired(lines)));
}

TEST(RecordedDriver, FollowsThePathWithItsShiftAndNamesPhases) {
    const Path path = repaired(reach_lines());
    const auto site = find_grasp(path);
    const RecordedDriver driver(path, *site, {1, 0, 0},
                                {"index", "thumb"});  // in the order of the scene
    EXPECT_LT((driver.target(0, 1.5).p_WT - Reach::at(1, 1.5) - Vec3(1, 0, 0)).norm(), 1e-3);
    EXPECT_EQ(driver.target(0, 99).v_WT, Vec3::Zero());
    EXPECT_EQ(driver.phases()[1].name, "grasp");
    EXPECT_THROW(RecordedDriver(path, *site, Vec3::Zero(), {"thumb", "middle"}), Error);
}

TEST(RecordedData, EveryMovementIsReadRepairedAndHasAGrasp) {
    DIHAPTIC_NEEDS_DATA(folder, "reach-to-grasp");
    int count = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        if (entry.path().extension() != ".csv") continue;
        ++count;
        Diagnostics diagnostics;
        const Movement movement =
            read_movement(entry.path().string(), RecordingAxes::y_up, diagnostics);
        ASSERT_FALSE(diagnostics.has_errors()) << entry.path();
        const Path path = repair(movement);
        EXPECT_LT(fastest(path), 2.0) << entry.path();
        const auto site = find_grasp(path);
        ASSERT_TRUE(site) << entry.path();
        EXPECT_GT(site->aperture, 0.015) << entry.path();
        EXPECT_LT(site->aperture, 0.060) << entry.path();
    }
    EXPECT_EQ(count, 30);
}

}  // namespace
}  // namespace dihaptic::hand::repair_test
