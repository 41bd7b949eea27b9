#include "hand/movement.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
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
INSTANTIATE_TEST_SUITE_P(Movement, DamagedMovement,
                         ::
                             testing::Values(Damage{"text for a number",
                                                    [](std::vector<std::string> l) {
                                                        l[57].replace(l[57].find(',') + 1, 3,
                                                                      "abc");
                                                        return l;
                                                    },
                                                    "m.csv:58: error: thumb_x_mm: 'abc"},
                                             Damage{"a missing cell",
                                                    [](std::vector<std::string> l) {
                                                        l[57] = l[57].substr(0, l[57].rfind(','));
                                                        return l;
                                                    },
                                                    "m.csv:58: error: has 7 values where the first "
                                                    "line names 8 columns. Complete the "
                                                    "line, or delete it"},
                                             Damage{"a missing column",
                                                    [](std::vector<std::string> l) {
                                                        for (std::string& line : l)
                                                            line = line.substr(
                                                                0, line.rfind(',',
                                                                              line.rfind(',') - 1));
                                                        return l;
                                                    },
                                                    "m.csv:1: error: index_z_mm: this column is "
                                                    "missing"},
                                             Damage{"time going backwards",
                                                    [](std::vector<std::string> l) {
                                                        std::swap(l[57], l[58]);
                                                        return l;
                                                    },
                                                    "m.csv:59: error: time_ms: time goes from "
                                                    "670.588 ms back to 658.824 ms. Correct it"},
                                             Damage{"no time",
                                                    [](std::vector<std::string> l) {
                                                        l[57].replace(0, l[57].find(','), "");
                                                        return l;
                                                    },
                                                    "m.csv:58: error: time_ms: has no time"},
                                             Damage{"an empty file",
                                                    [](std::vector<std::string>) {
                                                        return std::vector<std::string>{};
                                                    },
                                                    "m.csv:1: error: is empty"},
                                             Damage{"only a header",
                                                    [](std::vector<std::string> l) {
                                                        return std::vector<std::string>{l[0]};
                                                    },
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
                                                            for (int c = 0;
                                                                 std::getline(in, cell, ','); ++c) {
                                                                out += (c ? "," : "") +
                                                                       (c >= 1 && c <= 6
                                                                            ? fmt::format(
                                                                                  "{:.6f}",
                                                                                  std::stod(cell) /
                                                                                      1000)
                                                                            : cell);
                                                            }
                                                            l[i] = out;
                                                        }
                                                        return l;
                                                    },
                                                    "If the values are in metres, name the columns "
                                                    "so: thumb_x_m"},
                                             Damage{"millimetres called metres",
                                                    [](std::vector<std::string> l) {
                                                        for (size_t at = 0;
                                                             (at = l[0].find("_mm", at)) !=
                                                             std::string::npos;)
                                                            l[0].replace(at, 3, "_m");
                                                        return l;
                                                    },
                                                    "If the values are in millimetres, name the "
                                                    "columns so: thumb_x_mm"},
                                             Damage{"millimetres called centimetres",
                                                    [](std::vector<std::string> l) {
                                                        for (size_t at = 0;
                                                             (at = l[0].find("x_mm", at)) !=
                                                             std::string::npos;)
                                                            l[0].replace(at, 4, "x_cm");
                                                        for (size_t at = 0;
                                                             (at = l[0].find("y_mm", at)) !=
                                                             std::string::npos;)
                                                            l[0].replace(at, 4, "y_cm");
                                                        for (size_t at = 0;
                                                             (at = l[0].find("z_mm", at)) !=
                                                             std::string::npos;)
                                                            l[0].replace(at, 4, "z_cm");
                                                        return l;
                                                    },
                                                    "If the values are in millimetres, name the "
                                                    "columns so: thumb_x_mm"},
                                             Damage{"an absurd time at the end",
                                                    [](std::vector<std::string> l) {
                                                        set_cell(l.back(), 0, "1e303");
                                                        return l;
                                                    },
                                                    "m.csv:299: error: time_ms: time jumps from "
                                                    "3482.353 ms (line 298) to 1e+303 ms"},
                                             Damage{"an absurd time at the start",
                                                    [](std::vector<std::string> l) {
                                                        set_cell(l[1], 0, "-500000");
                                                        return l;
                                                    },
                                                    "m.csv:3: error: time_ms: time jumps from "
                                                    "-500000 ms (line 2) to 11.765 ms: a gap "
                                                    "may last 5 s at most"},
                                             Damage{"the same time twice",
                                                    [](std::vector<std::string> l) {
                                                        set_cell(l[58], 0, cell(l[57], 0));
                                                        return l;
                                                    },
                                                    "m.csv:59: error: time_ms: twice the same "
                                                    "time, 658.824 ms"},
                                             Damage{"milliseconds called seconds",
                                                    [](std::vector<std::string> l) {
                                                        l[0].replace(0, 7, "time_s");
                                                        return l;
                                                    },
                                                    "m.csv:1: error: time_s: the lines are 11.765 "
                                                    "s apart, where at least 10 frames a "
                                                    "second are needed. If the times are in "
                                                    "milliseconds, name the column so: time_ms."},
                                             Damage{"seconds called milliseconds",
                                                    [](std::vector<std::string> l) {
                                                        for (size_t i = 1; i < l.size(); ++i)
                                                            set_cell(l[i], 0,
                                                                     fmt::format(
                                                                         "{:.6f}",
                                                                         std::stod(cell(l[i], 0)) /
                                                                             1000));
                                                        return l;
                                                    },
                                                    "If the times are in seconds, name the column "
                                                    "so: time_s."},
                                             Damage{"a recording of an hour",
                                                    [](std::vector<std::string> l) {
                                                        for (int i = 0; i < 2000; ++i) {
                                                            l.push_back(l.back());
                                                            set_cell(
                                                                l.back(), 0,
                                                                fmt::format("{}", 3500 + 4000 * i));
                                                        }
                                                        return std::vector<std::string>(l);
                                                    },
                                                    "a second are needed"},
                                             Damage{"many gaps that make ten minutes",
                                                    [](std::vector<std::string> l) {
                                                        const double end =
                                                            std::stod(cell(l.back(), 0));
                                                        for (int i = 0; i < 150; ++i) {
                                                            l.push_back(l.back());
                                                            set_cell(
                                                                l.back(), 0,
                                                                fmt::format("{}",
                                                                            end + 4500 * (i + 1)));
                                                        }
                                                        return l;
                                                    },
                                                    "m.csv:449: error: time_ms: the recording "
                                                    "lasts 678 s, where 600 s are the most"},
                                             Damage{
                                                 "an occlusion of 2",
                                                 [](std::vector<std::string> l) {
                                                     l[57].back() = '2';
                                                     return l;
                                                 },
                                                 "m.csv:58: error: occluded: must be 0 or 1, is 2"},
                                             Damage{"a column given twice",
                                                    [](std::vector<std::string> l) {
                                                        l[0].replace(l[0].find("thumb_y"), 7,
                                                                     "thumb_x");
                                                        return l;
                                                    },
                                                    "m.csv:1: error: thumb_x_mm: column 3 repeats "
                                                    "an earlier one"},
                                             Damage{"a thumb that never moves",
                                                    [](std::vector<std::string> l) {
                                                        for (size_t i = 2; i < l.size(); ++i)
                                                            for (int c = 1; c <= 3; ++c)
                                                                set_cell(l[i], c, cell(l[1], c));
                                                        return l;
                                                    },
                                                    "m.csv:1: error: thumb: never moves: its "
                                                    "marker was frozen throughout"},
                                             Damage{"an index that was never seen",
                                                    [](std::vector<std::string> l) {
                                                        for (size_t i = 1; i < l.size(); ++i)
                                                            for (int c = 4; c <= 6; ++c)
                                                                set_cell(l[i], c, "NaN");
                                                        return l;
                                                    },
                                                    "m.csv:1: error: index: was never seen"},
                                             Damage{"one marker for both fingers",
                                                    [](std::vector<std::string> l) {
                                                        for (size_t i = 1; i < l.size(); ++i)
                                                            for (int c = 4; c <= 6; ++c)
                                                                set_cell(l[i], c,
                                                                         cell(l[i], c - 3));
                                                        return l;
                                                    },
                                                    "m.csv:1: error: index: is where thumb is, in "
                                                    "298 of 298 lines"}));

/// What is said of a file that is no table of a movement at all: it is said once.
class NoMovement : public ::testing::TestWithParam<std::pair<std::string, std::string>> {};
TEST_P(NoMovement, IsRefusedInOneMessage) {
    const auto& [text, says] = GetParam();
    const std::string said = errors_of(text);
    EXPECT_NE(said.find(says), std::string::npos) << said;
    EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 1) << said;
}
std::string replaced(std::string text, char from, char to) {
    std::replace(text.begin(), text.end(), from, to);
    return text;
}
INSTANTIATE_TEST_SUITE_P(
    Movement, NoMovement,
    ::testing::Values(
        std::pair{replaced(join(reach_lines()), ',', ';'),
                  std::string("m.csv:1: error: is separated by semicolons. Export it with commas")},
        std::pair{replaced(join(reach_lines()), ',', '\t'), std::string("separated by tabs")},
        std::pair{replaced(join(reach_lines()), '\n', '\r'), std::string("end in CR alone")},
        std::pair{std::string("\xff\xfet\0i\0", 6), std::string("is UTF-16 text")},
        std::pair{std::string("\x7f"
                              "ELF\2\1\0\0",
                              8),
                  std::string("is not a text file")},
        std::pair{std::string("Dear reader,\nthis is a letter.\n"),
                  std::string("names no column of a movement")}));

TEST(Movement, ReadsWhatSpreadsheetsAndRWrite) {
    auto lines = reach_lines();
    for (size_t at = 0; (at = lines[0].find(',', at)) != std::string::npos; at += 3)
        lines[0].replace(at, 1, "\",\"");
    lines[0] = "\xef\xbb\xbf\"" + lines[0] + "\"";
    for (std::string& line : lines) line += "\r";
    const Result result = read(join(lines));
    EXPECT_TRUE(result.diagnostics.problems().empty());
    EXPECT_EQ(result.movement.frames.size(), lines.size() - 1);
}

TEST(Movement, WarnsOfAHandThatHardlyMoves) {
    auto lines = reach_lines();
    for (size_t i = 1; i < lines.size(); ++i) {
        for (int c = 1; c <= 6; ++c)
            set_cell(lines[i], c, fmt::format("{:.4f}", std::stod(cell(lines[i], c)) / 10));
    }
    EXPECT_NE(errors_of(join(lines)).find("warning: the fingers move by only"), std::string::npos);
}

TEST(Movement, GivesTheFingersThatAreAskedForInTheirOrder) {
    Movement movement = read(join(reach_lines())).movement;
    const Vec3 thumb = movement.frames[5].p_WH[0];
    Diagnostics diagnostics;
    choose_fingers(movement, {"index", "thumb"}, diagnostics);
    EXPECT_TRUE(diagnostics.problems().empty());
    EXPECT_EQ(movement.frames[5].p_WH[1], thumb);
    EXPECT_EQ(movement.columns[1][0], "thumb_x_mm");
    choose_fingers(movement, {"thumb", "middle"}, diagnostics);
    ASSERT_EQ(diagnostics.problems().size(), 1u);
    EXPECT_EQ(diagnostics.problems()[0].place.line, 1);
    EXPECT_NE(diagnostics.problems()[0].text().find(
                  "error: middle: the movement has no such finger, but index, thumb"),
              std::string::npos);
    choose_fingers(movement, {"thumb"}, diagnostics);
    EXPECT_NE(diagnostics.problems()[1].text().find("warning: index: is no finger of the scene"),
              std::string::npos);
}

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
            EXPECT_NE(said.find("index_y_mm is off by"), std::string::npos) << said;
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
                    set_cell(line, c, fmt::format("{:.6f}", std::stod(cell(line, c)) / 1000));
            }
            const Path path = repaired(lines);
            ASSERT_EQ(path.faults.size(), 2u);  // thumb and index
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
