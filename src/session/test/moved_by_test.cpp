// Tests that each file alone tells whether its data come from a simulation or a person.
#include "recording/moved_by.h"

#include <filesystem>

#include "analysis/recovery.h"
#include "analysis/report/report.h"
#include "session/test/sessions.h"

namespace dihaptic::session::moved_by_test {
namespace {

namespace fs = std::filesystem;

size_t count(const std::string& text, const std::string& what) {
    size_t out = 0;
    for (size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += what.size()) ++out;
    return out;
}

/// Expects that each row of these tables says who moved the hand, in its last columns.
void expect_tables_say(const std::string& folder, const recording::MovedBy& by,
                       const std::vector<std::string>& names) {
    for (const std::string& name : names) {
        const CsvFile table(folder + "/" + name);
        ASSERT_GT(table.rows(), 0u) << name;
        for (size_t i = 0; i < table.rows(); ++i) {
            EXPECT_EQ(table.text(i, "simulated"), by.simulated()) << name;
            EXPECT_EQ(table.text(i, "moved_by"), by.name()) << name;
        }
    }
}

class MovedBy : public ::testing::TestWithParam<Mover> {};

TEST_P(MovedBy, StandsInEachFileOfASession) {
    Sessions sessions;
    const std::string folder = sessions.make(GetParam());
    const auto info = recording::SessionFolder::open(folder).read_info();
    const recording::MovedBy& by = info.moved_by;
    EXPECT_EQ(by.mover, GetParam());
    EXPECT_EQ(by.simulated(), GetParam() == Mover::mouse ? "no" : "yes");
    if (GetParam() == Mover::simulated_person) {
        EXPECT_EQ(by.program, recording::program_version());
        EXPECT_EQ(by.seed, "1");
        EXPECT_FALSE(by.population.empty());
    }
    expect_tables_say(folder, by, {"trials.csv", "phases.csv", "events.csv"});

    const std::string nwb = testing::read_file(folder + "/session.nwb");
    EXPECT_EQ(count(nwb, "Homo sapiens"), GetParam() == Mover::mouse ? 1u : 0u);
    EXPECT_EQ(count(nwb, by.describe()), 1u);

    const auto report = analysis::write_report(folder, "dihaptic report", {});
    const std::string page = testing::read_file(report.page);
    EXPECT_EQ(count(page, "<p class=\"who\">" + by.describe()), 2u);
    for (size_t at = 0; (at = page.find("class=\"caption\">", at)) != std::string::npos; ++at) {
        const std::string caption = page.substr(at, page.find('<', at) - at);
        if (caption.size() < 30 || caption.find("Drag across") != std::string::npos) continue;
        EXPECT_NE(caption.find(by.describe()), std::string::npos) << caption;
    }
    for (const std::string& table : report.tables)
        expect_tables_say(folder, by, {fs::path(table).filename().string()});
}

TEST_P(MovedBy, IsKnownFromTheLogAlone) {
    Sessions sessions;
    const std::string folder = sessions.make(GetParam());
    fs::remove(folder + "/session.yaml");
    analysis::recover_session(recording::SessionFolder::open(folder), {});
    const auto info = recording::SessionFolder::open(folder).read_info();
    EXPECT_EQ(info.moved_by.mover, GetParam());
    expect_tables_say(folder, info.moved_by, {"trials.csv"});
}

INSTANTIATE_TEST_SUITE_P(Each, MovedBy,
                         ::testing::Values(Mover::script, Mover::simulated_person, Mover::mouse),
                         [](const auto& one) { return std::string(enum_name(one.param)); });

TEST(Report, OfAFolderNeverMixesASimulationWithAPerson) {
    Sessions sessions;
    sessions.make(Mover::simulated_person, false, "sim-001");
    sessions.make(Mover::simulated_person, false, "sim-002");
    sessions.make(Mover::script);
    const std::string folder = sessions.files.folder.file("sessions");
    const auto report = analysis::write_report(folder, "dihaptic report", {});
    const CsvFile curves(folder + "/population-adaptation.csv");
    ASSERT_GT(curves.rows(), 0u);
    for (size_t i = 0; i < curves.rows(); ++i) {
        EXPECT_EQ(curves.text(i, "simulated"), "yes");
        EXPECT_LE(curves.number(i, "people"),
                  curves.text(i, "moved_by") == "simulated_person" ? 2 : 1);
    }
    const CsvFile people(folder + "/population-people.csv");
    ASSERT_EQ(people.rows(), 3u);
    EXPECT_EQ(people.text(2, "ppid").substr(0, 4),
              people.text(2, "moved_by") == "script" ? "S07" : "sim-");
    const std::string page = testing::read_file(report.page);
    EXPECT_EQ(count(page, "<h2>Reaches"), 2u);
    EXPECT_NE(page.find("Simulated: a simulated person moved the hand"), std::string::npos);
}

TEST(Report, OfAFolderCountsAParticipantWithSeveralSessionsOnce) {
    Sessions sessions;
    for (const char* person : {"sim-001", "sim-001", "sim-002"})
        sessions.make(Mover::simulated_person, false, person);
    const std::string folder = sessions.files.folder.file("sessions");
    const auto report = analysis::write_report(folder, "dihaptic report", {});
    const CsvFile curves(folder + "/population-adaptation.csv");
    ASSERT_GT(curves.rows(), 0u);
    for (size_t i = 0; i < curves.rows(); ++i) EXPECT_LE(curves.number(i, "people"), 2);
    EXPECT_EQ(curves.number(0, "people"), 2);
    EXPECT_EQ(CsvFile(folder + "/population-people.csv").rows(), 3u);
    const std::string page = testing::read_file(report.page);
    EXPECT_NE(page.find("count once in the means"), std::string::npos);
    EXPECT_NE(page.find("of 2 participants: sim-001, sim-002"), std::string::npos);
}

TEST(SimulatedId, CannotBeTakenForAPersons) {
    EXPECT_EQ(recording::simulated_id(""), "sim-001");
    EXPECT_EQ(recording::simulated_id("S07"), "sim-S07");
    EXPECT_EQ(recording::simulated_id("sim-012"), "sim-012");
}

}  // namespace
}  // namespace dihaptic::session::moved_by_test
