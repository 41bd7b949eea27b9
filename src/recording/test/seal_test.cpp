#include "recording/seal.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "testing/files.h"

namespace dihaptic::recording::seal_test {
namespace {

struct Sealed {
    testing::TemporaryFolder parent;
    SessionFolder folder = SessionFolder::create(parent.path(), "x");
    SessionInfo info;

    Sealed() {
        write("trials.csv", "a,b\n1,2\n3,\"4\n5\"\n");
        write("events.csv", "a\n");
        write("procedures.csv", "a\n1\n");
        info.identity = "abc";
        info.participant.id = "S07";
        info.seed = "1";
        info.state = SessionState::complete;
        info.ticks = 100;
        info.inputs = {{"scene.yaml", "12345678"}};
        seal(folder, info);
        folder.write_info(info);
    }
    void write(const std::string& name, const std::string& text) const {
        std::ofstream(folder.file(name)) << text;
    }
    std::string told(const SessionInfo& of) const {
        std::string out;
        for (const Problem& problem : broken_seals(folder, of, Severity::warning))
            out += problem.text() + "\n";
        return out;
    }
    std::string told() const { return told(folder.read_info()); }
};

TEST(Seal, FitsWhatWasSealedAndIsKeptBySessionYaml) {
    const Sealed session;
    EXPECT_EQ(session.told(), "");
    const SessionInfo back = session.folder.read_info();
    EXPECT_TRUE(is_sealed(back));
    ASSERT_EQ(back.tables.size(), 3u);
    EXPECT_EQ(back.tables[0].file, "trials.csv");
    EXPECT_EQ(back.tables[0].rows, 2);  // one row spans two lines
    EXPECT_EQ(back.tables[1].rows, 0);
}

TEST(Seal, TellsWhatHappenedToATable) {
    const Sealed session;
    session.write("trials.csv", "a,b\n1,2\n");
    EXPECT_NE(
        session.told().find("trials.csv: warning: has 1 row; it had 2 rows when the session ended"),
        std::string::npos)
        << session.told();
    session.write("trials.csv", "a,b\n1,2\n3,4\n");
    EXPECT_NE(session.told().find("has been changed since the session ended (it still has 2 rows)"),
              std::string::npos)
        << session.told();
    session.write("trials.csv", "");
    EXPECT_NE(session.told().find("has 0 rows"), std::string::npos) << session.told();
    std::filesystem::remove(session.folder.file("trials.csv"));
    EXPECT_NE(session.told().find("trials.csv: warning: is gone: it had 2 rows"), std::string::npos)
        << session.told();
    std::filesystem::create_directory(session.folder.file("trials.csv"));
    EXPECT_NE(session.told().find("trials.csv: warning: is a folder"), std::string::npos)
        << session.told();
    session.write("lifts.csv", "a\n1\n");
    EXPECT_NE(session.told().find("lifts.csv: warning: did not exist when the session ended"),
              std::string::npos)
        << session.told();
}

TEST(Seal, TheRemedyIsOneThatHelps) {
    const Sealed session;
    session.write("trials.csv", "a,b\n");
    session.write("procedures.csv", "a\n2\n");
    EXPECT_EQ(session.told().find("dihaptic recover"), std::string::npos) << session.told();
    session.write("raw.log", "");
    const std::string told = session.told();
    EXPECT_NE(told.find("Rebuild it from raw.log: dihaptic recover " + session.folder.path()),
              std::string::npos)
        << told;
    // the log does not contain what was written before the first tick
    const auto for_good = broken_for_good(session.folder, session.info, Severity::warning);
    ASSERT_EQ(for_good.size(), 1u);
    EXPECT_EQ(for_good[0].text().find("dihaptic recover"), std::string::npos) << for_good[0].text();
}

TEST(Seal, TellsWhatSessionYamlSaysNow) {
    const Sealed session;
    const auto expect_told = [&](const auto& change) {
        SessionInfo other = session.info;
        change(other);
        EXPECT_NE(session.told(other).find("session.yaml: warning: seal: does not match"),
                  std::string::npos)
            << session.told(other);
    };
    expect_told([](SessionInfo& info) { info.identity = "abd"; });
    expect_told([](SessionInfo& info) { info.participant.id = "S08"; });
    expect_told([](SessionInfo& info) { info.seed = "2"; });
    expect_told([](SessionInfo& info) { info.program = "another"; });
    expect_told([](SessionInfo& info) { info.state = SessionState::interrupted; });
    expect_told([](SessionInfo& info) { info.ticks = 99; });
    expect_told([](SessionInfo& info) { info.inputs[0].checksum = "12345679"; });
    expect_told([](SessionInfo& info) { info.tables[0].rows = 3; });
    expect_told([](SessionInfo& info) { info.tables.pop_back(); });
    expect_told([](SessionInfo& info) { info.seal = ""; });
    SessionInfo noted = session.info;
    noted.notes = {"what somebody adds by hand"};
    EXPECT_EQ(session.told(noted), "");
}

TEST(Seal, IsMissedWhereThereIsNone) {
    const Sealed session;
    SessionInfo old = session.info;
    old.tables.clear();
    old.seal.clear();
    EXPECT_FALSE(is_sealed(old));
    session.write("trials.csv", "a\n");
    EXPECT_EQ(session.told(old), "");
}

TEST(Seal, IsRenewedOnlyForWhatIsMadeAnew) {
    Sealed session;
    session.write("trials.csv", "a,b\n1,2\n");
    session.write("procedures.csv", "a\n2\n");
    seal(session.folder, session.info);
    const std::string told = session.told(session.info);
    EXPECT_EQ(told.find("trials.csv"), std::string::npos) << told;
    EXPECT_NE(told.find("procedures.csv: warning: has been changed"), std::string::npos) << told;
}

TEST(Seal, OfSettingsIsNotExpectedOfOlderVersions) {
    Sealed session;
    session.write("settings.csv", "setting,value,origin\nsolver,newton,default\n");
    EXPECT_EQ(session.told(session.info), "");
    seal(session.folder, session.info);
    EXPECT_EQ(session.told(session.info), "");
    session.write("settings.csv", "setting,value,origin\nsolver,newton,scene\n");
    EXPECT_NE(session.told(session.info).find("settings.csv: warning: has been changed"),
              std::string::npos)
        << session.told(session.info);
    unseal(session.info, "settings.csv");
    seal(session.folder, session.info);
    EXPECT_EQ(session.told(session.info), "");
}

}  // namespace
}  // namespace dihaptic::recording::seal_test
