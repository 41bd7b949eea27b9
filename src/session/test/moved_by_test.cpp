// Tests that every single file shows whether its data come from a simulation or from a person.
#include "recording/moved_by.h"

#include <filesystem>

#include "analysis/recovery.h"
#include "analysis/report/report_json.h"
#include "session/test/sessions.h"

namespace dihaptic::session::moved_by_test {
namespace {

namespace fs = std::filesystem;

size_t count(const std::string& text, const std::string& what) {
    size_t out = 0;
    for (size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += what.size()) ++out;
    return out;
}

/// Checks that each row of these tables says, in its last columns, who moved the hand.
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

    const auto report = analysis::write_tables(folder, {});
    ASSERT_EQ(report.samples.size(), 1u);
    EXPECT_EQ(report.samples[0].moved_by.describe(), by.describe());
    EXPECT_EQ(count(analysis::report_json(report, ""), by.describe()), 1u);
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
    const auto report = analysis::write_tables(folder, {});
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
    ASSERT_EQ(report.samples.size(), 2u);
    for (const analysis::ReportSample& sample : report.samples) {
        EXPECT_EQ(sample.title, "Reaches");
        EXPECT_EQ(sample.folders.size(), sample.moved_by.name() == "script" ? 1u : 2u);
    }
    EXPECT_NE(report.samples[0].moved_by.name(), report.samples[1].moved_by.name());
}

TEST(Report, OfAFolderCountsAParticipantWithSeveralSessionsOnce) {
    Sessions sessions;
    for (const char* person : {"sim-001", "sim-001", "sim-002"})
        sessions.make(Mover::simulated_person, false, person);
    const std::string folder = sessions.files.folder.file("sessions");
    const auto report = analysis::write_tables(folder, {});
    const CsvFile curves(folder + "/population-adaptation.csv");
    ASSERT_GT(curves.rows(), 0u);
    for (size_t i = 0; i < curves.rows(); ++i) EXPECT_LE(curves.number(i, "people"), 2);
    EXPECT_EQ(curves.number(0, "people"), 2);
    EXPECT_EQ(CsvFile(folder + "/population-people.csv").rows(), 3u);
    EXPECT_EQ(report.sessions, 3);
    ASSERT_EQ(report.samples.size(), 1u);
    EXPECT_EQ(report.samples[0].folders.size(), 3u);
}

TEST(Report, OfAFolderHasTheTablesOfEachSessionAndTellsWhichItCouldNotWrite) {
    Sessions sessions;
    const std::string first = sessions.make(Mover::simulated_person, false, "sim-001");
    const std::string second = sessions.make(Mover::simulated_person, false, "sim-002");
    std::vector<std::string> tables;
    std::vector<std::string> texts;
    for (const std::string& file : analysis::write_tables(first, {}).tables) {
        tables.push_back(fs::path(file).filename());
        texts.push_back(testing::read_file(file));
        fs::remove(file);
    }
    ASSERT_GT(tables.size(), 1u);
    // the program must never write through a link
    fs::create_symlink(sessions.files.folder.file("elsewhere.csv"), second + "/" + tables[0]);
    const auto report = analysis::write_tables(sessions.files.folder.file("sessions"), {});
    EXPECT_EQ(report.sessions, 2);
    for (size_t i = 0; i < tables.size(); ++i)
        EXPECT_EQ(testing::read_file(first + "/" + tables[i]), texts[i]) << tables[i];
    EXPECT_TRUE(report.changed.empty());
    ASSERT_EQ(report.unwritten.size(), 1u);
    EXPECT_EQ(report.unwritten[0].severity, Severity::warning);
    EXPECT_NE(report.unwritten[0].text().find(tables[0]), std::string::npos);
    EXPECT_FALSE(fs::exists(sessions.files.folder.file("elsewhere.csv")));
}

TEST(Report, SaysOfASessionWhatPythonCannotKnow) {
    Sessions sessions;
    const std::string folder = sessions.make(Mover::script);
    std::ofstream(folder + "/note.txt") << "coughed in the second reach";
    analysis::ReportResult report = analysis::write_tables(folder + "/", {});
    EXPECT_EQ(report.paths, std::vector<std::string>{folder});
    EXPECT_EQ(report.page(), folder + "/report.html");
    EXPECT_TRUE(report.log.empty());
    report.left_out.push_back("a\xff");
    const std::string text = analysis::report_json(report, "dihaptic report \"it\"");
    const auto has = [&](const std::string& what) { return text.find(what) != std::string::npos; };
    EXPECT_TRUE(has(R"("command":"dihaptic report \"it\"")")) << text;
    EXPECT_TRUE(has("\"program\":\"" + recording::program_version())) << text;
    EXPECT_TRUE(has("\"paths\":[\"" + folder + "\"]")) << text;
    EXPECT_TRUE(has("\"folders\":[\"" + folder + "\"]")) << text;
    EXPECT_TRUE(has(R"("columns":["perturbation","in","kind and size"])")) << text;
    EXPECT_TRUE(has(R"("mover":"script")")) << text;
    EXPECT_TRUE(has(R"("note":"coughed in the second reach")")) << text;
    EXPECT_TRUE(has("\"left_out\":[\"a\uFFFD\"]")) << text;
    EXPECT_EQ(report.samples[0].contact,
              recording::SessionFolder::open(folder).read_info().convergence->describe());
    // a link could show any file
    fs::remove(folder + "/note.txt");
    fs::create_symlink("/etc/hostname", folder + "/note.txt");
    EXPECT_EQ(analysis::write_tables(folder, {}).samples[0].note,
              "not shown: note.txt is a link to another file");
    report.add(report);
    report.out = "both";
    EXPECT_EQ(report.page(), "both/report.html");
    EXPECT_EQ(report.paths.size(), 2u);
    EXPECT_EQ(report.sessions, 2);
}

TEST(SimulatedId, CannotBeTakenForAPersons) {
    EXPECT_EQ(recording::simulated_id(""), "sim-001");
    EXPECT_EQ(recording::simulated_id("S07"), "sim-S07");
    EXPECT_EQ(recording::simulated_id("sim-012"), "sim-012");
}

}  // namespace
}  // namespace dihaptic::session::moved_by_test
