// Tests that docs/tables.md describes the columns of a session's tables in the same way as the
// code.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "analysis/episodes.h"
#include "analysis/events.h"
#include "analysis/lifts.h"
#include "analysis/report/population_tables.h"
#include "analysis/report/session_tables.h"
#include "analysis/session_report.h"
#include "analysis/trials.h"
#include "base/figure.h"
#include "rows/correction_row.h"
#include "testing/files.h"

namespace dihaptic::analysis::tables_test {
namespace {

constexpr const char* kFile = "docs/tables.md";
using Columns = std::vector<Table::Column>;

/// Makes a session that contains something for each table.
SessionData session_in(const testing::TemporaryFolder& folder) {
    folder.write("session.yaml", "");
    AdaptationCurve curve;
    curve.trials.resize(1);
    return {recording::SessionFolder::open_tables(folder.path()),
            {},
            {},
            rows::TrialFile(folder.write("trials.csv",
                                         "trial_num,attempt,kind,peak_speed_m_s,not_measured\n"
                                         "1,1,baseline,0.3,\n")),
            rows::LiftFile(folder.write("lifts.csv", "trial_num,attempt,preload_s\n1,1,0.1\n")),
            {curve},
            {ThresholdTrack{}},
            {Generalisation{}},
            {}};
}

std::string table(const std::string& name, const std::string& meaning, const Columns& columns) {
    std::string out =
        fmt::format("\n## {}\n\n{}\n\n| column | unit | meaning |\n|---|---|---|\n", name, meaning);
    for (const Table::Column& c : columns) {
        EXPECT_FALSE(c.description.empty()) << name << ": " << c.name;
        out += fmt::format("| `{}` | {} | {} |\n", c.name, c.unit, c.description);
    }
    return out;
}

std::string tables() {
    const testing::TemporaryFolder folder;
    const FittedSession session(session_in(folder));
    const SessionTables own = session_tables(session);
    const PopulationTables people = population_tables({{&session}});
    return table("trials.csv", "A row for each attempt at a trial of a task.", trial_columns()) +
           table("trials.csv without a task", "A row for each trial.",
                 list_figures(rows::PlainTrialRow{}).columns) +
           table("phases.csv", "A row for each phase of a trial.",
                 list_figures(rows::PhaseRow{}).columns) +
           table("events.csv", "A row for each moment.", list_figures(rows::EventRow{}).columns) +
           table("episodes.csv", "A row for each hold, slide and flight of the object.",
                 list_figures(rows::EpisodeRow{}).columns) +
           table("lifts.csv", "A row for each attempt with an object and two fingers.",
                 list_figures(rows::LiftRow{}).columns) +
           table("corrections.csv", "A row for each condition in which something happens.",
                 list_figures(rows::CorrectionRow{}).columns) +
           table("adaptation.csv", "A row for each reach.", own.adaptation.columns) +
           table("adaptation-blocks.csv", "A row for each block of reaches.", own.blocks.columns) +
           table("fits.csv", "A row for each round.", own.fits.columns) +
           table("generalisation.csv", "A row for each condition.", own.generalisation.columns) +
           table("thresholds.csv", "A row for each procedure.", own.thresholds.columns) +
           table("population-people.csv", "A row for each person and round.",
                 people.people.columns) +
           table("population-adaptation.csv", "A row for each trial of a round.",
                 people.adaptation.columns) +
           table("population-thresholds.csv", "A row for each person and procedure.",
                 people.thresholds.columns) +
           table("population-lifts.csv", "A row for each group of trials and figure.",
                 people.lifts.columns) +
           table("population-measures.csv",
                 "A row for each measure, round, block, condition, kind of trial and perturbation.",
                 people.measures.columns);
}

/// The text before the tables on the page is written by hand.
TEST(Tables, AreTheReferences) {
    const std::string page = testing::read_file(kFile);
    const std::string made = page.substr(0, page.find("\n## ")) + tables();
    if (std::getenv("DIHAPTIC_RENEW_TABLES") != nullptr) {
        std::ofstream(kFile) << made;
    } else {
        EXPECT_EQ(page, made) << kFile
                              << " says something else than the code. Renew it in the same commit: "
                                 "DIHAPTIC_RENEW_TABLES=1 build/release/src/analysis/analysis_test "
                                 "--gtest_filter='Tables.*'";
    }
}

}  // namespace
}  // namespace dihaptic::analysis::tables_test
