#include <gtest/gtest.h>

#include <thread>

#include "recording/recorder.h"
#include "recording/session.h"
#include "testing/allocation_guard.h"
#include "testing/files.h"

namespace dihaptic::recording {
namespace {

LogHead head() {
    LogHead out;
    out.fingers = {"thumb", "index"};
    out.bodies = {"table", "block", "ball"};
    return out;
}

servo::Frame frame(int64_t sequence) {
    servo::Frame f;
    f.sequence = sequence;
    f.time = sequence * std::chrono::milliseconds(1);
    f.grip_force = 0.1 * static_cast<double>(sequence);
    f.fingers.resize(2);
    f.bodies.resize(3);
    f.fingers[1].f_sent_W = {1.0 / 3, -2, static_cast<double>(sequence)};
    f.bodies[2].X_WB.p = {0, 0, 1e-3 * static_cast<double>(sequence)};
    f.changed = sequence == 0 ? std::vector<uint16_t>{0, 1, 2} : std::vector<uint16_t>{2};
    f.contacts.resize(static_cast<size_t>(sequence % 3));
    for (servo::ContactFrame& c : f.contacts) c.b = 2;
    return f;
}

TEST(Codec, GivesBackEveryFieldAndCarriesOverBodiesThatDidNotChange) {
    std::vector<std::byte> bytes(most_bytes(head().layout(), 8));
    servo::Frame out;
    servo::Frame first = frame(0);
    first.bodies[1].X_WB.p = {7, 8, 9};
    size_t size = encode(first, bytes);
    ASSERT_GT(size, 0u);
    ASSERT_TRUE(decode(std::span(bytes).first(size), head().layout(), out));
    size = encode(frame(5), bytes);
    ASSERT_TRUE(decode(std::span(bytes).first(size), head().layout(), out));
    EXPECT_EQ(out.sequence, 5);
    EXPECT_EQ(out.fingers[1].f_sent_W, Vec3(1.0 / 3, -2, 5));
    EXPECT_EQ(out.bodies[2].X_WB.p.z(), 5e-3);
    EXPECT_EQ(out.bodies[1].X_WB.p, Vec3(7, 8, 9));
    EXPECT_EQ(out.contacts.size(), 2u);
    EXPECT_TRUE(std::isnan(out.lateness));
}

TEST(Codec, RefusesWhatDoesNotFitAndWhatIsNoFrame) {
    std::vector<std::byte> small(100);
    EXPECT_EQ(encode(frame(1), small), 0u);
    std::vector<std::byte> bytes(most_bytes(head().layout(), 8));
    const size_t size = encode(frame(1), bytes);
    servo::Frame out;
    EXPECT_FALSE(decode(std::span(bytes).first(size - 1), head().layout(), out));
    EXPECT_FALSE(decode(std::span(bytes).first(size), {1, 3}, out));
    EXPECT_FALSE(decode(std::span(bytes).first(size), {2, 2}, out));
}

TEST(Codec, SchemaNamesEveryFieldWithItsUnit) {
    for (const char* line : {"grip_force float64 N\n", "  force_sent float64[3] N\n",
                             "  angular_velocity float64[3] rad/s\n", "time int64 ns\n"}) {
        EXPECT_NE(schema().find(line), std::string::npos) << line;
    }
}

/// Reads a log to its end; returns the number of frames, each checked to be the next.
int64_t count(RawLogReader& reader) {
    int64_t n = 0;
    while (const servo::Frame* f = reader.next()) EXPECT_EQ(f->sequence, n++);
    return n;
}

TEST(RawLog, ReadsBackWhatWasWritten) {
    const testing::TemporaryFolder folder;
    Recorder recorder(folder.file("raw.log"), head(), Writing::in_place);
    for (int i = 0; i < 1000; ++i) recorder.record(frame(i));
    recorder.finish();
    RawLogReader reader(folder.file("raw.log"));
    EXPECT_EQ(reader.head().fingers, head().fingers);
    EXPECT_EQ(count(reader), 1000);
    EXPECT_TRUE(reader.complete());
    EXPECT_EQ(reader.damaged_bytes(), 0);
}

TEST(RawLog, CutAnywhereItGivesAllWholeChunksBefore) {
    const testing::TemporaryFolder folder;
    Recorder recorder(folder.file("raw.log"), head(), Writing::in_place);
    for (int i = 0; i < 300; ++i) recorder.record(frame(i));
    recorder.finish();
    const std::string whole = testing::read_file(folder.file("raw.log"));
    int64_t last = 0;
    for (size_t cut = whole.size() / 3; cut < whole.size(); cut += 997) {
        RawLogReader reader(folder.write("cut.log", whole.substr(0, cut)));
        const int64_t n = count(reader);
        EXPECT_GE(n, last);
        EXPECT_FALSE(reader.complete());
        last = n;
    }
    EXPECT_GE(last, 250);  // at most a chunk of 50 ms is lost
}

TEST(RawLog, ADamagedByteEndsItThereAndIsNeverTakenForData) {
    const testing::TemporaryFolder folder;
    Recorder recorder(folder.file("raw.log"), head(), Writing::in_place);
    for (int i = 0; i < 300; ++i) recorder.record(frame(i));
    recorder.finish();
    const std::string whole = testing::read_file(folder.file("raw.log"));
    for (size_t at = whole.size() / 2; at < whole.size(); at += 4999) {
        std::string damaged = whole;
        damaged[at] = static_cast<char>(damaged[at] ^ 0x10);
        RawLogReader reader(folder.write("damaged.log", damaged));
        EXPECT_LT(count(reader), 300);
        EXPECT_GT(reader.damaged_bytes(), 0);
    }
}

TEST(RawLog, RefusesOtherFilesAndOtherVersions) {
    const testing::TemporaryFolder folder;
    EXPECT_THROW(RawLogReader(folder.file("gone.log")), Error);
    EXPECT_THROW(RawLogReader(folder.write("text.log", "hello, this is no log at all\n")), Error);
    EXPECT_THROW(RawLogReader(folder.write("empty.log", "")), Error);
}

TEST(RawLog, NeverOverwritesAnother) {
    const testing::TemporaryFolder folder;
    folder.write("raw.log", "precious");
    EXPECT_THROW(RawLogWriter(folder.file("raw.log"), head()), Error);
    EXPECT_EQ(testing::read_file(folder.file("raw.log")), "precious");
}

TEST(RawLog, SaysThatTheDiskIsFull) {
    if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "there is no /dev/full";
    // /dev/full exists, so creating it fails; a link to it in a folder stands for a disk that fills
    // later
    const testing::TemporaryFolder folder;
    try {
        RawLogWriter writer("/dev/full", head());
        FAIL();
    } catch (const Error& e) {
        EXPECT_NE(std::string(e.what()).find("--out"), std::string::npos) << e.what();
    }
}

TEST(Recorder, FlushesEveryFiftyMilliseconds) {
    const testing::TemporaryFolder folder;
    Recorder recorder(folder.file("raw.log"), head(), Writing::in_place);
    for (int i = 0; i <= 500; ++i) recorder.record(frame(i));
    RawLogReader reader(folder.file("raw.log"));  // while it is being written
    EXPECT_GE(count(reader), 500 - 50);
}

TEST(Recorder, InAThreadLosesNothingAndAllocatesNothing) {
    const testing::TemporaryFolder folder;
    Recorder recorder(folder.file("raw.log"), head(), Writing::in_thread);
    servo::Frame f = frame(0);
    f.contacts.reserve(2);
    size_t allocations = 0;
    for (int i = 0; i < 2000; ++i) {
        f = frame(i);
        {
            const testing::AllocationGuard guard;
            recorder.record(f);
            allocations += guard.count();
        }
        if (i % 20 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    recorder.finish();
    EXPECT_EQ(recorder.dropped(), 0);
    if (testing::AllocationGuard::works()) {
        EXPECT_EQ(allocations, 0u);
    }
    RawLogReader reader(folder.file("raw.log"));
    EXPECT_EQ(count(reader), 2000);
}

TEST(Recorder, InAThreadCountsWhatItHadToDrop) {
    const testing::TemporaryFolder folder;
    Recorder recorder(folder.file("raw.log"), head(), Writing::in_thread);
    servo::Frame f = frame(0);
    f.contacts.resize(60);
    for (int i = 0; i < 20000; ++i) {
        f.sequence = i;
        recorder.record(f);
    }
    recorder.finish();
    EXPECT_GT(recorder.dropped(), 0);
    RawLogReader reader(folder.file("raw.log"));
    int64_t read = 0;
    while (reader.next() != nullptr) ++read;
    EXPECT_EQ(read + recorder.dropped(), 20000);
}

TEST(SessionFolder, NamesAreUniqueAndTidy) {
    const testing::TemporaryFolder folder;
    const auto a = SessionFolder::create(folder.path(), "my exp/../x_S01");
    const auto b = SessionFolder::create(folder.path(), "my exp/../x_S01");
    EXPECT_NE(a.path(), b.path());
    EXPECT_EQ(std::filesystem::path(a.path()).parent_path(), folder.path());
    EXPECT_NE(a.path().find("my-exp----x_S01"), std::string::npos) << a.path();
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

TEST(Session, TimesCarryTheirOffset) {
    // 2026-11-20T10:15:00+01:00
    const std::string now = iso_now();
    ASSERT_EQ(now.size(), 25u) << now;
    EXPECT_EQ(now[10], 'T');
    EXPECT_EQ(now[22], ':');
}

}  // namespace
}  // namespace dihaptic::recording
