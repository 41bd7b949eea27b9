#include "hand/movement.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <sstream>

#include "hand/grasp_site.h"
#include "hand/recorded.h"
#include "model/minimum_jerk.h"
#include "testing/files.h"

namespace dihaptic::hand {
namespace {

constexpr double kFrame = 1.0 / 85;

/// Thumb and index go 30 cm out, open to 80 mm, close to 40 mm, wait, and come back: no fault in
/// it.
struct Reach {
    static Vec3 at(int finger, double t) {
        const double there =
            model::minimum_jerk((t - 0.2) / 1.0).share - model::minimum_jerk((t - 2.6) / 0.8).share;
        const double aperture = 0.012 + 0.068 * model::minimum_jerk((t - 0.2) / 0.7).share -
                                0.04 * model::minimum_jerk((t - 1.1) / 0.5).share -
                                0.028 * model::minimum_jerk((t - 2.6) / 0.8).share;
        return Vec3(0.2 - 0.2 * there, 0.1 + 0.25 * there, -0.3 + 0.28 * there) +
               (finger == 0 ? -0.5 : 0.5) * aperture * Vec3(0, 1, 0);
    }
};

/// The reach as a CSV, a line of text a frame.
std::vector<std::string> reach_lines() {
    std::vector<std::string> lines{
        "time_ms,thumb_x_mm,thumb_y_mm,thumb_z_mm,index_x_mm,index_y_mm,index_z_mm,occluded"};
    for (double t = 0; t < 3.5; t += kFrame) {
        const Vec3 thumb = 1e3 * Reach::at(0, t);
        const Vec3 index = 1e3 * Reach::at(1, t);
        lines.push_back(fmt::format("{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},0", t * 1e3,
                                    thumb.x(), thumb.y(), thumb.z(), index.x(), index.y(),
                                    index.z()));
    }
    return lines;
}

std::string join(const std::vector<std::string>& lines) {
    std::string out;
    for (const std::string& line : lines) out += line + "\n";
    return out;
}

struct Result {
    Movement movement;
    Diagnostics diagnostics;
};
Result read(const std::string& text) {
    const testing::TemporaryFolder folder;
    Result result;
    result.movement =
        read_movement(folder.write("m.csv", text), RecordingAxes::world, result.diagnostics);
    return result;
}
std::string errors_of(const std::string& text) {
    const Result result = read(text);
    std::string all;
    for (const Problem& p : result.diagnostics.problems()) all += p.text() + "\n";
    return all;
}

TEST(Movement, ReadsFingersTimesAndUnits) {
    const Result result = read(join(reach_lines()));
    EXPECT_TRUE(result.diagnostics.problems().empty());
    ASSERT_EQ(result.movement.fingers, (std::vector<std::string>{"thumb", "index"}));
    EXPECT_NEAR(result.movement.frames[10].time, 10 * kFrame, 1e-6);
    EXPECT_LT((result.movement.frames[90].p_WH[1] - Reach::at(1, 90 * kFrame)).norm(), 1e-6);
}

TEST(Movement, TurnsAxesThatHaveYUp) {
    const testing::TemporaryFolder folder;
    Diagnostics diagnostics;
    const Movement m =
        read_movement(folder.write("m.csv", join(reach_lines())), RecordingAxes::y_up, diagnostics);
    const Vec3 p = Reach::at(0, 0);
    EXPECT_LT((m.frames[0].p_WH[0] - Vec3(p.x(), -p.z(), p.y())).norm(), 1e-6);
}

// every way in which one line of a file may be damaged
struct Damage {
    const char* what;
    std::vector<std::string> (*apply)(std::vector<std::string> lines);
    const char* says;
};
void PrintTo(const Damage& damage, std::ostream* out) {
    *out << damage.what;
}
class DamagedMovement : public ::testing::TestWithParam<Damage> {};
TEST_P(DamagedMovement, IsRefusedWithItsLineAndRemedy) {
    const std::string said = errors_of(join(GetParam().apply(reach_lines())));
    EXPECT_NE(said.find(GetParam().says), std::string::npos) << said;
}
INSTANTIATE_TEST_SUITE_P(
    Movement, DamagedMovement,
    ::testing::Values(
        Damage{"text for a number",
               [](std::vector<std::string> l) {
                   l[57].replace(l[57].find(',') + 1, 3, "abc");
                   return l;
               },
               "m.csv:58: error: thumb_x: 'abc"},
        Damage{"a missing cell",
               [](std::vector<std::string> l) {
                   l[57] = l[57].substr(0, l[57].rfind(','));
                   return l;
               },
               "m.csv:58: error: has 7 values where the first line names 8 columns. Complete the "
               "line, or delete it"},
        Damage{"a missing column",
               [](std::vector<std::string> l) {
                   for (std::string& line : l)
                       line = line.substr(0, line.rfind(',', line.rfind(',') - 1));
                   return l;
               },
               "m.csv:1: error: index_z_mm: this column is missing"},
        Damage{"time going backwards",
               [](std::vector<std::string> l) {
                   std::swap(l[57], l[58]);
                   return l;
               },
               "m.csv:59: error: time: time goes from"},
        Damage{"no time",
               [](std::vector<std::string> l) {
                   l[57].replace(0, l[57].find(','), "");
                   return l;
               },
               "m.csv:58: error: time: has no time"},
        Damage{"an empty file", [](std::vector<std::string>) { return std::vector<std::string>{}; },
               "m.csv:1: error: is empty"},
        Damage{"only a header",
               [](std::vector<std::string> l) { return std::vector<std::string>{l[0]}; },
               "has only 0 frames"},
        Damage{"an unknown column",
               [](std::vector<std::string> l) {
                   l[0].replace(0, 7, "zeit_ms");
                   return l;
               },
               "zeit_ms: is not a column of a movement"},
        Damage{"metres called millimetres",
               [](std::vector<std::string> l) {
                   for (size_t i = 1; i < l.size(); ++i) {
                       std::istringstream in(l[i]);
                       std::string out, cell;
                       for (int c = 0; std::getline(in, cell, ','); ++c) {
                           out += (c ? "," : "") +
                                  (c >= 1 && c <= 6 ? fmt::format("{:.6f}", std::stod(cell) / 1000)
                                                    : cell);
                       }
                       l[i] = out;
                   }
                   return l;
               },
               "If the values are in metres, name the columns so: thumb_x_m"},
        Damage{"millimetres called metres",
               [](std::vector<std::string> l) {
                   for (size_t at = 0; (at = l[0].find("_mm", at)) != std::string::npos;)
                       l[0].replace(at, 3, "_m");
                   return l;
               },
               "If the values are in millimetres, name the columns so: thumb_x_mm"}));

Path repaired(const std::vector<std::string>& lines) {
    return repair(read(join(lines)).movement);
}

/// Largest distance of the repaired path from the reach without faults [m].
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

void set_cell(std::string& line, int column, const std::string& text) {
    size_t at = 0;
    for (int i = 0; i < column; ++i) at = line.find(',', at) + 1;
    line.replace(at, line.find(',', at) - at, text);
}
std::string cell(const std::string& line, int column) {
    std::istringstream in(line);
    std::string out;
    for (int i = 0; i <= column; ++i) std::getline(in, out, ',');
    return out;
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

TEST(Repair, SuspectsALineInMetres) {
    auto lines = reach_lines();
    for (int c = 1; c <= 6; ++c)
        set_cell(lines[60], c, fmt::format("{:.6f}", std::stod(cell(lines[60], c)) / 1000));
    const Path path = repaired(lines);
    ASSERT_EQ(path.faults.size(), 2u);  // thumb and index
    for (const Fault& fault : path.faults) {
        EXPECT_TRUE(fault.wrong_unit);
        EXPECT_EQ(fault.line, 61);
        EXPECT_NE(describe(fault, path.fingers).find("metres? multiply them by 1000"),
                  std::string::npos);
    }
    EXPECT_LT(error_of(path), 2e-3);
}

TEST(Repair, CrossesAJumpNoFasterThanAHandWould) {
    auto lines = reach_lines();
    for (size_t i = 130; i < lines.size(); ++i)
        set_cell(lines[i], 1, fmt::format("{:.3f}", std::stod(cell(lines[i], 1)) + 120));
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
            set_cell(
                lines[i], 4 + axis,
                fmt::format("{:.3f}", std::stod(cell(lines[i], 1 + axis)) + (axis == 1 ? 30 : 0)));
        }
    }
    EXPECT_FALSE(find_grasp(repaired(lines)));
}

TEST(RecordedDriver, FollowsThePathWithItsShiftAndNamesPhases) {
    const Path path = repaired(reach_lines());
    const auto site = find_grasp(path);
    const RecordedDriver driver(path, *site, {1, 0, 0},
                                {"index", "thumb"});  // in the scene's order
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
}  // namespace dihaptic::hand
