#include "recording/remarks.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "testing/files.h"

namespace dihaptic::recording::remarks_test {
namespace {

TEST(Remarks, AreReadAsTheyWereWritten) {
    const testing::TemporaryFolder parent;
    const SessionFolder folder = SessionFolder::create(parent.path(), "lift");
    EXPECT_TRUE(read_remarks(folder).empty());
    RemarksWriter writer(folder);
    EXPECT_FALSE(std::filesystem::exists(folder.file("notes.csv")));
    writer.add({12300, 12.3, 4, "2026-11-30T09:15:00+0100", "said \"oh, no\"; coughed, twice"});
    writer.add({13000, 13, 0, "2026-11-30T09:15:01+0100", "Größe"});
    const std::vector<Remark> remarks = read_remarks(folder);  // while the writer is open
    ASSERT_EQ(remarks.size(), 2u);
    EXPECT_EQ(remarks[0].tick, 12300);
    EXPECT_EQ(remarks[0].clock, "2026-11-30T09:15:00+0100");
    EXPECT_EQ(describe(remarks[0]), "12.3 s, trial 4: said \"oh, no\"; coughed, twice");
    EXPECT_EQ(describe(remarks[1]), "13.0 s: Größe");
    EXPECT_EQ(writer.lost(), 0);
}

TEST(Remarks, ALineThatAKillCutIsLeftOut) {
    for (const char* cut :
         {"", "tick,ti", "tick,time_s,trial,clock,note\n1",
          "tick,time_s,trial,clock,note\n100,0.104,1,2026-11-30T09:15:00+0100,"}) {
        const testing::TemporaryFolder parent;
        const SessionFolder folder = SessionFolder::create(parent.path(), "lift");
        std::ofstream(folder.file("notes.csv")) << cut;
        EXPECT_TRUE(read_remarks(folder).empty()) << cut;
    }
}

TEST(Remarks, ThoseThatCannotBeWrittenAreCounted) {
    const testing::TemporaryFolder parent;
    const SessionFolder folder = SessionFolder::create(parent.path(), "lift");
    std::filesystem::create_directory(folder.file("notes.csv"));
    RemarksWriter writer(folder);
    writer.add({1, 0.001, 1, "", "coughed"});
    writer.add({2, 0.002, 1, "", "again"});
    EXPECT_EQ(writer.lost(), 2);
}

}  // namespace
}  // namespace dihaptic::recording::remarks_test
