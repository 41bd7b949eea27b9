#include "recording/test/log_damage.h"

#include "base/number.h"

namespace dihaptic::recording::log_damage_test {
namespace {

TEST(DamagedLog, WhateverIsNotWhereItWasWrittenIsTold) {
    expect_mischief_is_told(30);
}

TEST(DamagedLog, NoMutationCrashesItsReaderOrPassesForAFrame) {
    expect_mutations_are_borne(300, 1000);
}

/// Returns the first line of the report on a log.
std::string told(const std::string& log, const testing::TemporaryFolder& folder) {
    const LogHealth health = read_damaged(folder.write("damaged.log", log), 1);
    const auto lines = describe(health, 0, 0);
    return lines.empty() ? "nothing" : lines.front();
}

TEST(DamagedLog, SaysWhatIsWrongFromWhenOnAndWhatWasUsed) {
    const testing::TemporaryFolder folder;
    const std::string log = damage_log(folder, 1);
    const std::vector<std::string> whole = testing::take_apart(log);
    const std::vector<std::string> others = testing::take_apart(damage_log(folder, 2));
    EXPECT_EQ(told(log, folder), "nothing");
    auto chunks = whole;
    std::swap(chunks[3], chunks[6]);
    EXPECT_EQ(
        told(testing::put_together(chunks), folder),
        "3 chunks out of place in the log, from 0.099 s on: used in the order of their numbers");
    chunks = whole;
    chunks.insert(chunks.begin() + 5, chunks[2]);
    EXPECT_EQ(told(testing::put_together(chunks), folder),
              "1 chunk in the log twice, from 0.199 s on: used once");
    chunks = whole;
    chunks.erase(chunks.begin() + 2);
    EXPECT_EQ(told(testing::put_together(chunks), folder),
              "50 ticks missing from tick 50 on, between 0.049 s and 0.100 s: 1 chunk missing from "
              "the log there");
    chunks = whole;
    chunks.insert(chunks.begin() + 4, others[2]);
    EXPECT_TRUE(told(testing::put_together(chunks), folder)
                    .starts_with("1 chunk from another session in the log ("));
    EXPECT_NE(told(testing::put_together(chunks), folder).find("from 0.149 s on: left out"),
              std::string::npos);
    chunks = whole;
    chunks.erase(chunks.end() - 2);
    EXPECT_EQ(told(testing::put_together(chunks), folder),
              "1 chunk missing before the log's end mark, after 0.549 s");
    EXPECT_EQ(told(log + "123", folder), "3 bytes after the log's end mark, at 0.599 s: left out");
    chunks = whole;
    chunks[3] += "junk";
    EXPECT_EQ(told(testing::put_together(chunks), folder),
              "4 bytes in the log that no recorder wrote, from 0.149 s on: left out");
}

TEST(DamagedLog, ARecordThatIsNoFrameEndsItsChunkAlone) {
    const testing::TemporaryFolder folder;
    std::vector<std::string> chunks = testing::take_apart(damage_log(folder, 1));
    std::string payload = testing::payload_of(chunks[4]);
    payload.replace(0, 4, "\xff\xff\xff\x7f");
    chunks[4] = testing::chunk_of(testing::header_of(chunks[4]), payload);
    const LogHealth health =
        read_damaged(folder.write("damaged.log", testing::put_together(chunks)), 1);
    EXPECT_EQ(health.frames, 550);
    ASSERT_EQ(health.strays.size(), 1u);
    EXPECT_EQ(health.strays[0].kind, Stray::Kind::no_frame);
    EXPECT_TRUE(health.damaged(0));
}

TEST(DamagedLog, AHeadWithAbsurdNumbersIsRefused) {
    const testing::TemporaryFolder folder;
    const std::vector<std::string> whole = testing::take_apart(damage_log(folder, 1));
    const std::string head = testing::payload_of(whole[0]);
    const auto refused = [&](const std::string& what, const std::string& by) {
        std::string text = head;
        const size_t at = text.find(what);
        EXPECT_NE(at, std::string::npos) << what;
        text.replace(at, what.size(), by);
        auto chunks = whole;
        chunks[0] = testing::chunk_of(testing::header_of(chunks[0]), text);
        try {
            RawLogReader(folder.write("crafted.log", testing::put_together(chunks)));
        } catch (const Error& e) {
            return std::string(e.what());
        }
        return std::string("accepted");
    };
    std::string many = "fingers: [a0";
    for (int i = 1; i < 70000; ++i) many += ", a" + number_text(i);
    EXPECT_NE(refused("fingers: [thumb, index]", many + "]").find("fingers"), std::string::npos);
    EXPECT_NE(refused("[thumb, index]", "[thumb, thumb]").find("fingers"), std::string::npos);
    EXPECT_NE(refused("[thumb, index]", "[../thumb, index]").find("fingers"), std::string::npos);
    EXPECT_NE(refused("tick_s: 0.001", "tick_s: 1e-300").find("tick"), std::string::npos);
    EXPECT_NE(refused("tick_s: 0.001", "tick_s: .nan").find("tick"), std::string::npos);
    EXPECT_NE(refused("tick_s: 0.001", "tick_s: 1e300").find("tick"), std::string::npos);
    // a chunk must not claim a size larger than the file
    auto chunks = whole;
    auto header = testing::header_of(chunks[0]);
    header.size = 0x7fffffff;
    chunks[0].replace(0, sizeof(header), reinterpret_cast<const char*>(&header), sizeof(header));
    EXPECT_THROW(RawLogReader(folder.write("crafted.log", testing::put_together(chunks))), Error);
}

TEST(DamagedLog, WhatIsMadeToKeepItsReaderBusyEnds) {
    const testing::TemporaryFolder folder;
    std::string log = testing::put_together({testing::take_apart(damage_log(folder, 1))[0]});
    testing::ChunkHeader header{recording::kData, 20'000'000, 1, 1, 1};
    const std::string bait(reinterpret_cast<const char*>(&header), sizeof(header));
    for (int i = 0; i < 1'000'000; ++i) log += bait;
    RawLogReader reader(folder.write("bait.log", log));
    EXPECT_TRUE(reader.read_to_end().damaged(0));
}

/// Returns a log as written by programs before version 2.
std::string old_log(const testing::TemporaryFolder& folder, double session) {
    return testing::as_version_1(testing::take_apart(damage_log(folder, session)));
}

TEST(OldLog, IsReadAsItWasWritten) {
    const testing::TemporaryFolder folder;
    const std::string log = old_log(folder, 1);
    LogHealth health = read_damaged(folder.write("old.log", log), 1);
    EXPECT_EQ(health.frames, 600);
    EXPECT_FALSE(health.damaged(600));
    EXPECT_TRUE(describe(health, 600, 0).empty());
    health = read_damaged(folder.write("cut.log", log.substr(0, log.size() * 2 / 3)), 1);
    EXPECT_TRUE(health.unfinished);
    EXPECT_GE(health.frames, 350);
    EXPECT_TRUE(health.damaged(0));
}

TEST(OldLog, TellsOfWhatIsDoubledGoneElsewhereOrBehindItsEnd) {
    const testing::TemporaryFolder folder;
    const std::vector<std::string> whole = testing::take_apart(damage_log(folder, 1));
    const auto health = [&](const std::vector<std::string>& chunks, const std::string& behind) {
        return read_damaged(folder.write("old.log", testing::as_version_1(chunks) + behind), 1);
    };
    auto chunks = whole;
    chunks.insert(chunks.begin() + 5, chunks[2]);
    EXPECT_TRUE(health(chunks, "").damaged(600));
    chunks = whole;
    chunks.erase(chunks.begin() + 5);
    EXPECT_TRUE(health(chunks, "").damaged(600));
    chunks = whole;
    std::swap(chunks[2], chunks[5]);
    EXPECT_TRUE(health(chunks, "").damaged(600));
    EXPECT_TRUE(health(whole, "junk").damaged(600));
    EXPECT_TRUE(health(whole, old_log(folder, 1)).damaged(600));
    EXPECT_FALSE(health(whole, "").damaged(600));
}

}  // namespace
}  // namespace dihaptic::recording::log_damage_test
