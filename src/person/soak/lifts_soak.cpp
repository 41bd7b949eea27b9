// Tests the analysis of lifts when people sometimes grip too weakly, give up or hesitate.
#include <fmt/format.h>

#include <map>

#include "base/table.h"
#include "person/test/sitting.h"

namespace dihaptic::person {
namespace {

TEST(Lifts, OfPeopleWhoSlipAndGiveUpAreFoundAndTheRestMarked) {
    Sitting sitting("grip-and-lift");
    int lifted = 0;
    int found = 0;
    int others = 0;
    int rows = 0;
    std::map<std::string, int> marked;  // number of the other attempts, by outcome and lift
    for (int i = 1; i <= 6; ++i) {
        session::Plan plan = sitting.plan(static_cast<uint64_t>(i));
        Traits traits = draw_person(Objects::real, 5, fmt::format("P{:03d}", i));
        traits.slip_rate = traits.give_up_rate = 0.15;
        sit_down(plan, traits);
        session::RunOptions options;
        options.out = sitting.folder.file("sessions");
        const session::Recorded result = session::record(plan, options, kGoOn);
        const CsvFile trials(result.folder + "/trials.csv");
        const CsvFile lifts(result.folder + "/lifts.csv");
        ASSERT_EQ(lifts.rows(), trials.rows());
        for (size_t row = 0; row < trials.rows(); ++row) {
            ASSERT_EQ(lifts.number(row, "trial_num"), trials.number(row, "trial_num"));
            ASSERT_EQ(lifts.number(row, "attempt"), trials.number(row, "attempt"));
            const std::string lift = lifts.text(row, "lift");
            ++rows;
            if (trials.text(row, "outcome") == "lifted") {
                ++lifted;
                found += lift == "complete" ? 1 : 0;
            } else {
                ++others;
                ++marked[trials.text(row, "outcome") + ": " + lift];
            }
        }
    }
    fmt::print("{} attempts, {} lifted, {} of them with all events; the others:\n", rows, lifted,
               found);
    for (const auto& [what, count] : marked) {
        fmt::print("    {:4d} {}\n", count, what);
        const bool complete = what.substr(what.size() - 8) == "complete";
        EXPECT_FALSE(complete && what.find("not lifted") == 0) << what;
    }
    EXPECT_GE(found, 0.95 * lifted);
    EXPECT_GT(others, 10);  // slips and aborted lifts must have occurred
}

}  // namespace
}  // namespace dihaptic::person
