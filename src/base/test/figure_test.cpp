#include "base/figure_text.h"

#include <gtest/gtest.h>

#include <array>
#include <nlohmann/json.hpp>
#include <optional>

#include "base/unmeasured.h"

namespace dihaptic::figure_test {
namespace {

enum class Kind { push, pull };
constexpr auto enum_names(Kind) {
    return std::array{"push", "pull"};
}

struct Lift {
    double start = 1.5;
    Kind kind = Kind::pull;
    std::string mark = "complete";
    bool held = true;
    int slips = 3;
    double height = 0.02;
    double turn = 3.14159265358979323846;
    double rate = 7;
    double torque = kUnmeasured;
    double drop_mm = 4;

    template <class Self, class Visitor>
    static void visit(Self& f, Visitor& v) {
        v("start_time", f.start, "s", "of the session");
        v("kind", f.kind, "", "");
        v("lift", f.mark, "", "complete, or what is not there");
        v("held", f.held, "", "");
        v("slips", f.slips, "1", "");
        v("height", f.height, "mm", "in the hold");
        v("turn", f.turn, "deg", "");
        v("rate", f.rate, "N/s", "");
        v("torque", f.torque, "N*m", "");
        v("drop_mm", f.drop_mm, "mm", "");
    }
};

struct All {
    std::vector<Lift> lifts = std::vector<Lift>(1);
    std::optional<double> limit;
    template <class Self, class Visitor>
    static void visit(Self& f, Visitor& v) {
        v("lift", f.lifts, "", "");
        v("limit", f.limit, "N", "");
    }
};

TEST(Figure, GivesATable) {
    const Table table = figure_table<Lift>(std::array{Lift{}});
    EXPECT_EQ(to_csv(table),
              "start_time,kind,lift,held,slips,height_mm,turn_deg,rate_N_s,torque_Nm,drop_mm\n"
              "1.5,pull,complete,yes,3,20,180,7,,4\n");
    EXPECT_EQ(table.columns[5].description, "in the hold");
    EXPECT_EQ(table.columns[5].unit, "mm");
    EXPECT_EQ(table.columns[4].unit, "");
    EXPECT_EQ(figure_table<Lift>(std::vector<Lift>{}).columns.size(), table.columns.size());
}

TEST(Figure, GivesJson) {
    EXPECT_EQ(
        FigureJson<nlohmann::ordered_json>::of(All{}).dump(),
        R"({"lift":[{"start_time":1.5,"kind":"pull","lift":"complete","held":true,"slips":3,)"
        R"("height_mm":20.0,"turn_deg":180.0,"rate_N_s":7.0,"torque_Nm":null,"drop_mm":4.0}],)"
        R"("limit_N":null})");
}

struct Costs {
    Lift lift;
    std::optional<double> drag_n;
    std::vector<Lift> lifts = std::vector<Lift>(1);
    template <class Self, class Visitor>
    static void visit(Self& f, Visitor& v) {
        v("first", f.lift, "", "");
        v("drag_n", f.drag_n, "N", "a unit in lower case");
        v("lifts", f.lifts, "", "lifts, one by one");
    }
};

TEST(Figure, GivesTextForPeople) {
    const std::string text = figure_text(Costs{{}, 0.25, {}});
    EXPECT_EQ(text.find("first.start_time  1.5\nfirst.kind        pull\n"), 0u) << text;
    EXPECT_NE(text.find("\ndrag_n            0.25\n"), std::string::npos) << text;
    EXPECT_NE(text.find("\nlifts, one by one\nstart_time  kind  "), std::string::npos) << text;
    EXPECT_NE(figure_text(Costs{}).find("\ndrag_n            -\n"), std::string::npos);
}

TEST(Figure, TablesForPeopleAreAligned) {
    EXPECT_EQ(to_text(Table{{{"name", ""}, {"size", ""}}, {{"a", 1.5}, {"longer", kUnmeasured}}}),
              "name    size\n"
              "a        1.5\n"
              "longer     -\n");
}

}  // namespace
}  // namespace dihaptic::figure_test
