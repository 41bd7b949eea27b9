#include "recording/session.h"

#include <gtest/gtest.h>

#include <fstream>

#include "recording/raw_log.h"
#include "testing/files.h"

namespace dihaptic::recording::session_test {
namespace {

TEST(SessionFolder, NamesAreUniqueAndTidy) {
    const testing::TemporaryFolder folder;
    const auto a = SessionFolder::create(folder.path(), "my exp/../x_S01");
    const auto b = SessionFolder::create(folder.path(), "my exp/../x_S01");
    EXPECT_NE(a.path(), b.path());
    EXPECT_EQ(std::filesystem::path(a.path()).parent_path(), folder.path());
    EXPECT_NE(a.path().find("my-exp----x_S01"), std::string::npos) << a.path();
}

TEST(SessionFolder, SaysWhichNameIsTooLongOrMissing) {
    const testing::TemporaryFolder folder;
    const auto message = [](const std::string& parent, const std::string& name) {
        try {
            SessionFolder::create(parent, name);
        } catch (const Error& e) {
            return std::string(e.what());
        }
        return std::string("none");
    };
    EXPECT_NE(message("", "x").find("--out: error: does not name a folder"), std::string::npos)
        << message("", "x");
    const std::string longest = message(folder.path(), "x_" + std::string(300, 'S'));
    EXPECT_NE(longest.find("--participant"), std::string::npos) << longest;
    EXPECT_EQ(longest.find("--out"), std::string::npos) << longest;
    EXPECT_EQ(message(folder.path(), "x_" + std::string(220, 'S')), "none");
    EXPECT_EQ(message(folder.path(), "x_J\xC3\xBCrgen O'Neill/\n*?"), "none");
}

TEST(SessionFolder, SaysWhatIsNoSession) {
    EXPECT_THROW(SessionFolder::open("/tmp"), Error);
}

TEST(SessionFolder, KeepsItsInfo) {
    const testing::TemporaryFolder folder;
    const auto session = SessionFolder::create(folder.path(), "x");
    SessionInfo info;
    info.title = "A: \"title\"";
    info.participant.id = "S07";
    info.phases = {{"hold", 1.5, 2}};
    info.notes = {"one", "two"};
    session.write_info(info);
    const SessionInfo back = session.read_info();
    EXPECT_EQ(back.title, info.title);
    EXPECT_EQ(back.participant.id, "S07");
    EXPECT_EQ(back.phases[0].start, 1.5);
    EXPECT_EQ(back.notes, info.notes);
}

/// Creates a session's folder with `info` and a nearly empty log.
SessionFolder small_session(const testing::TemporaryFolder& folder, const SessionInfo& info) {
    const auto session = SessionFolder::create(folder.path(), "x");
    session.write_info(info);
    RawLogWriter(session.raw_log(), {}).finish();
    return session;
}

TEST(SessionFolder, AnInfoThatWasCutAnywhereGivesWhatItStillSays) {
    const testing::TemporaryFolder folder;
    SessionInfo info;
    info.title = "A title";
    info.ticks = 1234;
    info.command = "dihaptic run \"my file.yaml\" --participant S07";
    info.participant.id = "S07";
    info.phases = {{"reach", 0, 1.5}, {"hold", 1.5, 2}};
    info.notes = {"one: two", "three"};
    recording::Setup setup;
    setup.title = "From the log";
    setup.phases = info.phases;
    const SessionFolder session = small_session(folder, info);
    const std::string whole = testing::read_file(session.file("session.yaml"));
    int knew = 0;
    for (size_t cut = 0; cut < whole.size(); ++cut) {
        SCOPED_TRACE(cut);
        std::ofstream(session.file("session.yaml")) << whole.substr(0, cut);
        EXPECT_THROW(session.read_info(), Error);
        Diagnostics diagnostics;
        const SessionInfo back = session.read_info(setup, diagnostics);
        EXPECT_EQ(diagnostics.problems().size(), 1u);
        EXPECT_EQ(back.title, "From the log");
        EXPECT_EQ(back.phases.size(), 2u);
        EXPECT_TRUE(back.ticks == 0 || back.ticks == 1234) << back.ticks;
        EXPECT_TRUE(back.participant.id.empty() || back.participant.id == "S07");
        EXPECT_EQ(back.started.substr(0, 10), iso_now().substr(0, 10));  // from the folder's name
        knew += back.participant.id == "S07";
    }
    EXPECT_GT(knew, 100);
    std::filesystem::remove(session.file("session.yaml"));
    Diagnostics diagnostics;
    EXPECT_EQ(session.read_info(setup, diagnostics).title, "From the log");
    EXPECT_EQ(diagnostics.problems().size(), 1u);
    std::ofstream(session.file("session.yaml")) << whole;
    EXPECT_EQ(session.read_info(setup, diagnostics).title, "A title");
    EXPECT_EQ(diagnostics.problems().size(), 1u);
}

TEST(SessionFolder, AnInfoWithAThousandDamagedLinesGivesWhatStandsBeforeThem) {
    const testing::TemporaryFolder folder;
    SessionInfo info;
    info.command = "dihaptic run";
    info.participant.id = "S07";
    const SessionFolder session = small_session(folder, info);
    const std::string whole = testing::read_file(session.file("session.yaml"));
    std::string lines;
    for (int i = 0; i < 1000; ++i) lines += "  a,\n";
    const recording::Setup setup;
    for (const std::string& damaged : {whole + "inputs: [\n" + lines, "[\n" + lines}) {
        std::ofstream(session.file("session.yaml")) << damaged;
        Diagnostics diagnostics;
        const SessionInfo back = session.read_info(setup, diagnostics);
        EXPECT_EQ(diagnostics.problems().size(), 1u);
        EXPECT_EQ(back.participant.id, damaged.starts_with("[") ? "" : "S07");
    }
}

TEST(SessionFolder, NamesInputsThatWereChangedOrAreGone) {
    const testing::TemporaryFolder folder;
    const SessionFolder session = small_session(folder, {});
    std::vector<InputFile> inputs;
    for (const char* name : {"a", "b", "c"}) {
        std::ofstream(session.file(name)) << name;
        inputs.push_back(session.input(name));
    }
    EXPECT_TRUE(session.changed(inputs, Severity::error).empty());
    std::ofstream(session.file("b")) << "B";
    std::filesystem::remove(session.file("c"));
    const auto problems = session.changed(inputs, Severity::error);
    ASSERT_EQ(problems.size(), 2u);
    EXPECT_EQ(problems[0].place.file, session.file("b"));
    EXPECT_EQ(problems[1].place.file, session.file("c"));
}

TEST(SessionLock, IsHeldByOne) {
    const testing::TemporaryFolder folder;
    const SessionFolder session = small_session(folder, {});
    {
        SessionLock first(session);
        EXPECT_THROW(SessionLock{session}, Error);
        const SessionLock moved(std::move(first));
        EXPECT_THROW(SessionLock{session}, Error);
    }
    EXPECT_NO_THROW(SessionLock{session});
}

TEST(Session, TimesCarryTheirOffset) {
    // 2026-11-20T10:15:00+01:00
    const std::string now = iso_now();
    ASSERT_EQ(now.size(), 25u) << now;
    EXPECT_EQ(now[10], 'T');
    EXPECT_EQ(now[22], ':');
}

}  // namespace
}  // namespace dihaptic::recording::session_test
