#include "hand/movement.h"
#include "base/number.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "hand/test/reach.h"

namespace dihaptic::hand::movement_test {
namespace {

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

// a way of damaging a line of a file, and what the report must say
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
const std::vector<Damage> kDamages{
    {"text for a number",
     [](std::vector<std::string> l) {
         l[57].replace(l[57].find(',') + 1, 3, "abc");
         return l;
     },
     "m.csv:58: error: thumb_x_mm: 'abc"},
    {"a missing cell",
     [](std::vector<std::string> l) {
         l[57] = l[57].substr(0, l[57].rfind(','));
         return l;
     },
     "m.csv:58: error: has 7 values, but the first line names 8 columns. Complete the line, or "
     "delete it"},
    {"a missing column",
     [](std::vector<std::string> l) {
         for (std::string& line : l) line = line.substr(0, line.rfind(',', line.rfind(',') - 1));
         return l;
     },
     "m.csv:1: error: index_z_mm: this column is missing"},
    {"time going backwards",
     [](std::vector<std::string> l) {
         std::swap(l[57], l[58]);
         return l;
     },
     "m.csv:59: error: time_ms: time goes from 670.588 ms back to 658.824 ms. Correct it"},
    {"no time",
     [](std::vector<std::string> l) {
         l[57].replace(0, l[57].find(','), "");
         return l;
     },
     "m.csv:58: error: time_ms: has no time"},
    {"an empty file", [](std::vector<std::string>) { return std::vector<std::string>{}; },
     "m.csv:1: error: is empty"},
    {"only a header", [](std::vector<std::string> l) { return std::vector<std::string>{l[0]}; },
     "has only 0 frames"},
    {"a single frame",
     [](std::vector<std::string> l) {
         return std::vector<std::string>{l[0], l[1]};
     },
     "error: has only 1 frame. A movement needs"},
    {"an unknown column",
     [](std::vector<std::string> l) {
         l[0].replace(0, 7, "zeit_ms");
         return l;
     },
     "zeit_ms: is not a column of a movement"},
    {"metres called millimetres",
     [](std::vector<std::string> l) {
         for (size_t i = 1; i < l.size(); ++i) {
             std::istringstream in(l[i]);
             std::string out, cell;
             for (int c = 0; std::getline(in, cell, ','); ++c) {
                 out +=
                     (c ? "," : "") +
                     (c >= 1 && c <= 6 ? fmt::format("{:.6f}", finite_number(cell).value() / 1000)
                                       : cell);
             }
             l[i] = out;
         }
         return l;
     },
     "If the values are in metres, name the columns thumb_x_m"},
    {"millimetres called metres",
     [](std::vector<std::string> l) {
         for (size_t at = 0; (at = l[0].find("_mm", at)) != std::string::npos;)
             l[0].replace(at, 3, "_m");
         return l;
     },
     "If the values are in millimetres, name the columns thumb_x_mm"},
    {"millimetres called centimetres",
     [](std::vector<std::string> l) {
         for (size_t at = 0; (at = l[0].find("x_mm", at)) != std::string::npos;)
             l[0].replace(at, 4, "x_cm");
         for (size_t at = 0; (at = l[0].find("y_mm", at)) != std::string::npos;)
             l[0].replace(at, 4, "y_cm");
         for (size_t at = 0; (at = l[0].find("z_mm", at)) != std::string::npos;)
             l[0].replace(at, 4, "z_cm");
         return l;
     },
     "If the values are in millimetres, name the columns thumb_x_mm"},
    {"an absurd time at the end",
     [](std::vector<std::string> l) {
         set_cell(l.back(), 0, "1e303");
         return l;
     },
     "m.csv:299: error: time_ms: time jumps from 3482.353 ms (line 298) to 1e+303 ms"},
    {"an absurd time at the start",
     [](std::vector<std::string> l) {
         set_cell(l[1], 0, "-500000");
         return l;
     },
     "m.csv:3: error: time_ms: time jumps from -500000 ms (line 2) to 11.765 ms: a gap may last 5 "
     "s at most"},
    {"the same time twice",
     [](std::vector<std::string> l) {
         set_cell(l[58], 0, cell(l[57], 0));
         return l;
     },
     "m.csv:59: error: time_ms: the same time twice, 658.824 ms"},
    {"milliseconds called seconds",
     [](std::vector<std::string> l) {
         l[0].replace(0, 7, "time_s");
         return l;
     },
     "m.csv:1: error: time_s: the lines are 11.765 s apart, but at least 10 frames a second are "
     "needed. If the times are in milliseconds, name the column time_ms."},
    {"seconds called milliseconds",
     [](std::vector<std::string> l) {
         for (size_t i = 1; i < l.size(); ++i)
             set_cell(l[i], 0, fmt::format("{:.6f}", finite_number(cell(l[i], 0)).value() / 1000));
         return l;
     },
     "If the times are in seconds, name the column time_s."},
    {"a recording of an hour",
     [](std::vector<std::string> l) {
         for (int i = 0; i < 2000; ++i) {
             l.push_back(l.back());
             set_cell(l.back(), 0, fmt::format("{}", 3500 + 4000 * i));
         }
         return std::vector<std::string>(l);
     },
     "a second are needed"},
    {"many gaps that make ten minutes",
     [](std::vector<std::string> l) {
         const double end = finite_number(cell(l.back(), 0)).value();
         for (int i = 0; i < 150; ++i) {
             l.push_back(l.back());
             set_cell(l.back(), 0, fmt::format("{}", end + 4500 * (i + 1)));
         }
         return l;
     },
     "m.csv:449: error: time_ms: the recording lasts 678 s, but at most 600 s are allowed"},
    {"an occlusion of 2",
     [](std::vector<std::string> l) {
         l[57].back() = '2';
         return l;
     },
     "m.csv:58: error: occluded: must be 0 or 1, but is 2"},
    {"a column given twice",
     [](std::vector<std::string> l) {
         l[0].replace(l[0].find("thumb_y"), 7, "thumb_x");
         return l;
     },
     "m.csv:1: error: thumb_x_mm: column 3 repeats an earlier one"},
    {"a thumb that never moves",
     [](std::vector<std::string> l) {
         for (size_t i = 2; i < l.size(); ++i)
             for (int c = 1; c <= 3; ++c) set_cell(l[i], c, cell(l[1], c));
         return l;
     },
     "m.csv:1: error: thumb: never moves: its marker was frozen throughout"},
    {"an index that was never seen",
     [](std::vector<std::string> l) {
         for (size_t i = 1; i < l.size(); ++i)
             for (int c = 4; c <= 6; ++c) set_cell(l[i], c, "NaN");
         return l;
     },
     "m.csv:1: error: index: was never seen"},
    {"one marker for both fingers",
     [](std::vector<std::string> l) {
         for (size_t i = 1; i < l.size(); ++i)
             for (int c = 4; c <= 6; ++c) set_cell(l[i], c, cell(l[i], c - 3));
         return l;
     },
     "m.csv:1: error: index: coincides with thumb in 298 of 298 lines"},
};
INSTANTIATE_TEST_SUITE_P(Movement, DamagedMovement, ::testing::ValuesIn(kDamages));

/// Files that are not movement tables: a single message must say so.
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
    ::testing::Values(std::pair{replaced(join(reach_lines()), '\n', '\r'),
                                std::string("end in CR only")},
                      std::pair{std::string("\xff\xfet\0i\0", 6), std::string("is UTF-16 text")},
                      std::pair{std::string("\x7f"
                                            "ELF\2\1\0\0",
                                            8),
                                std::string("is not a text file")},
                      std::pair{std::string("Dear reader,\nthis is a letter.\n"),
                                std::string("names no column of a movement")}));

TEST(Movement, ReadsTablesOfAllCountries) {
    const std::string commas = join(reach_lines());
    const Result usual = read(commas);
    const std::string others[] = {replaced(commas, ',', ';'), replaced(commas, ',', '\t'),
                                  replaced(replaced(commas, ',', ';'), '.', ','),
                                  "sep=;\r\n" + replaced(commas, ',', ';')};
    for (const std::string& text : others) {
        const Result result = read(text);
        EXPECT_TRUE(result.diagnostics.problems().empty());
        ASSERT_EQ(result.movement.frames.size(), usual.movement.frames.size());
        EXPECT_EQ(result.movement.frames[100].p_WH, usual.movement.frames[100].p_WH);
        EXPECT_EQ(result.movement.frames[100].time, usual.movement.frames[100].time);
    }
}

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
            set_cell(lines[i], c,
                     fmt::format("{:.4f}", finite_number(cell(lines[i], c)).value() / 10));
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
                  "error: middle: the movement has no such finger; it has index, thumb"),
              std::string::npos);
    choose_fingers(movement, {"thumb"}, diagnostics);
    EXPECT_NE(diagnostics.problems()[1].text().find("warning: index: is not a finger of the scene"),
              std::string::npos);
}

}  // namespace
}  // namespace dihaptic::hand::movement_test
