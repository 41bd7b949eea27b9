#include <gtest/gtest.h>

#include <set>
#include <thread>

#include "base/field_writer.h"
#include "recording/recorder.h"
#include "recording/schema.h"
#include "testing/allocation_guard.h"
#include "testing/files.h"

namespace dihaptic::recording::recording_test {
namespace {

LogHead head() {
    LogHead out;
    out.fingers = {"thumb", "index"};
    out.bodies = {"table", "block", "ball"};
    return out;
}

const FrameDecoder kDecoder(schema(), "raw.log");

frame::Frame frame(int64_t sequence) {
    frame::Frame f;
    f.sequence = sequence;
    f.time = sequence * std::chrono::milliseconds(1);
    f.grip_force = 0.1 * static_cast<double>(sequence);
    f.fingers.resize(2);
    f.bodies.resize(3);
    f.fingers[1].f_sent_W = {1.0 / 3, -2, static_cast<double>(sequence)};
    f.bodies[2].X_WB.p = {0, 0, 1e-3 * static_cast<double>(sequence)};
    f.changed = sequence == 0 ? std::vector<uint16_t>{0, 1, 2} : std::vector<uint16_t>{2};
    f.contacts.resize(static_cast<size_t>(sequence % 3));
    for (frame::ContactFrame& c : f.contacts) c.b = 2;
    return f;
}

TEST(Codec, GivesBackEveryFieldAndCarriesOverBodiesThatDidNotChange) {
    std::vector<std::byte> bytes(most_bytes(head().layout(), 8));
    frame::Frame out;
    frame::Frame first = frame(0);
    first.bodies[1].X_WB.p = {7, 8, 9};
    size_t size = encode(first, bytes);
    ASSERT_GT(size, 0u);
    ASSERT_TRUE(kDecoder.decode(std::span(bytes).first(size), head().layout(), out));
    size = encode(frame(5), bytes);
    ASSERT_TRUE(kDecoder.decode(std::span(bytes).first(size), head().layout(), out));
    EXPECT_EQ(out.sequence, 5);
    EXPECT_EQ(out.fingers[1].f_sent_W, Vec3(1.0 / 3, -2, 5));
    EXPECT_EQ(out.bodies[2].X_WB.p.z(), 5e-3);
    EXPECT_EQ(out.bodies[1].X_WB.p, Vec3(7, 8, 9));
    EXPECT_EQ(out.contacts.size(), 2u);
    EXPECT_TRUE(std::isnan(out.lateness));
}

TEST(Codec, HasMoreOfFingersWhoseDevicesMeasureOrientation) {
    LogHead turning = head();
    turning.devices.resize(2);
    turning.devices[1].finger = "index";
    turning.devices[1].measures_orientation = true;
    EXPECT_EQ(turning.turning_fingers(), std::vector<std::string>{"index"});
    frame::Frame in = frame(1);
    in.turns.resize(1);
    in.turns[0].R_WH = rotation_by({0.1, 0.2, 0.3});
    in.turns[0].t_sent_W = {1, 2, 3};
    std::vector<std::byte> bytes(most_bytes(turning.layout(), 8));
    const size_t size = encode(in, bytes);
    ASSERT_GT(size, encode(frame(1), bytes));
    encode(in, bytes);
    frame::Frame out;
    ASSERT_TRUE(kDecoder.decode(std::span(bytes).first(size), turning.layout(), out));
    EXPECT_EQ(out.turns[0].R_WH.coeffs(), in.turns[0].R_WH.coeffs());
    EXPECT_EQ(out.turns[0].t_sent_W, Vec3(1, 2, 3));
    EXPECT_FALSE(kDecoder.decode(std::span(bytes).first(size), head().layout(), out));
}

TEST(Codec, HasTheScenesJoints) {
    LogHead jointed = head();
    jointed.joints = {"hinge", "drawer"};
    frame::Frame in = frame(1);
    in.joints.resize(2);
    in.joints[0].angle = 0.5;
    in.joints[1].displacement = -0.02;
    in.joints[1].f_B_W = {1, 2, 3};
    std::vector<std::byte> bytes(most_bytes(jointed.layout(), 8));
    const size_t size = encode(in, bytes);
    frame::Frame out;
    ASSERT_TRUE(kDecoder.decode(std::span(bytes).first(size), jointed.layout(), out));
    EXPECT_EQ(out.joints[0].angle, 0.5);
    EXPECT_TRUE(std::isnan(out.joints[0].displacement));
    EXPECT_EQ(out.joints[1].displacement, -0.02);
    EXPECT_EQ(out.joints[1].f_B_W, Vec3(1, 2, 3));
    EXPECT_FALSE(kDecoder.decode(std::span(bytes).first(size), head().layout(), out));
}

TEST(Codec, RefusesWhatDoesNotFitAndWhatIsNoFrame) {
    std::vector<std::byte> small(100);
    EXPECT_EQ(encode(frame(1), small), 0u);
    std::vector<std::byte> bytes(most_bytes(head().layout(), 8));
    const size_t size = encode(frame(1), bytes);
    frame::Frame out;
    EXPECT_FALSE(kDecoder.decode(std::span(bytes).first(size - 1), head().layout(), out));
    EXPECT_FALSE(kDecoder.decode(std::span(bytes).first(size), {1, 3}, out));
    EXPECT_FALSE(kDecoder.decode(std::span(bytes).first(size), {2, 2}, out));
}

TEST(Codec, SchemaNamesEveryFieldWithItsUnit) {
    for (const char* line : {"grip_force float64 N\n", "  force_sent float64[3] N\n",
                             "  angular_velocity float64[3] rad/s\n", "time int64 ns\n"}) {
        EXPECT_NE(schema().find(line), std::string::npos) << line;
    }
}

/// Returns the encoded bytes of a frame.
std::vector<std::byte> encoded(const frame::Frame& in) {
    std::vector<std::byte> bytes(most_bytes(head().layout(), 8));
    bytes.resize(encode(in, bytes));
    return bytes;
}

/// Returns the bytes of `in` without one field, which has a different value in `other`. Removes
/// `size` bytes, starting at the first difference, from each of the given number of items.
std::vector<std::byte> without(const frame::Frame& in, const frame::Frame& other, size_t size,
                               size_t items = 1) {
    std::vector<std::byte> bytes = encoded(in);
    std::vector<std::byte> differs = encoded(other);
    for (size_t n = 0; n < items; ++n) {
        const auto at = std::mismatch(bytes.begin(), bytes.end(), differs.begin()).first;
        const auto from = at - bytes.begin();
        bytes.erase(at, at + static_cast<std::ptrdiff_t>(size));
        differs.erase(differs.begin() + from,
                      differs.begin() + from + static_cast<std::ptrdiff_t>(size));
    }
    return bytes;
}

/// Returns this program's schema without the given line.
std::string schema_without(const std::string& line) {
    std::string out = schema();
    return out.erase(out.find(line), line.size() + 1);
}

void expect_as_in_frame_5(const frame::Frame& out) {
    EXPECT_EQ(out.sequence, 5);
    EXPECT_EQ(out.grip_force, 0.5);
    EXPECT_EQ(out.bodies[2].X_WB.p.z(), 5e-3);
    EXPECT_EQ(out.changed, std::vector<uint16_t>{2});
    ASSERT_EQ(out.contacts.size(), 2u);
    EXPECT_EQ(out.contacts[1].b, 2);
}

TEST(Decoder, ReadsFramesFromBeforeAFieldWasAdded) {
    const FrameDecoder decoder(schema_without("solver_route int32 1"), "raw.log");
    EXPECT_EQ(decoder.missing(), std::vector<std::string>{"solver_route"});
    EXPECT_TRUE(decoder.unknown().empty());
    frame::Frame in = frame(5);
    in.solver_route = -1;
    const std::vector<std::byte> bytes = without(frame(5), in, sizeof(in.solver_route));
    frame::Frame out;
    EXPECT_FALSE(kDecoder.decode(bytes, head().layout(), out));
    out = {};
    ASSERT_TRUE(decoder.decode(bytes, head().layout(), out));
    EXPECT_EQ(out.solver_route, 0);
    EXPECT_EQ(out.fingers[1].f_sent_W, Vec3(1.0 / 3, -2, 5));
    expect_as_in_frame_5(out);
}

TEST(Decoder, ReadsFramesFromBeforeAFingerHadAField) {
    const FrameDecoder decoder(schema_without("  buttons uint32 1"), "raw.log");
    EXPECT_EQ(decoder.missing(), std::vector<std::string>{"buttons of fingers"});
    frame::Frame in = frame(5);
    for (frame::FingerFrame& finger : in.fingers) finger.buttons = ~0u;
    const std::vector<std::byte> bytes = without(frame(5), in, sizeof(in.fingers[0].buttons), 2);
    frame::Frame out;
    ASSERT_TRUE(decoder.decode(bytes, head().layout(), out));
    EXPECT_EQ(out.fingers[0].buttons, 0u);
    EXPECT_EQ(out.fingers[1].f_sent_W, Vec3(1.0 / 3, -2, 5));
    expect_as_in_frame_5(out);
}

TEST(Decoder, PassesOverWhatALaterVersionRecorded) {
    const std::string list = "  colour uint8 1\n  glow float32[2] cd\n";
    const FrameDecoder decoder(schema() + "marks uint16 count, then each:\n" + list +
                                   "lamps uint16 count, then uint16 index and item of each that "
                                   "changed:\n" +
                                   list + "mood int64 1\n",
                               "raw.log");
    EXPECT_TRUE(decoder.missing().empty());
    EXPECT_EQ(decoder.unknown(), (std::vector<std::string>{"marks", "lamps", "mood"}));
    std::vector<std::byte> bytes = encoded(frame(5));
    const size_t ours = bytes.size();
    const auto add = [&](uint16_t count, size_t size) {
        bytes.push_back(static_cast<std::byte>(count));
        bytes.push_back(std::byte{0});
        bytes.resize(bytes.size() + size, std::byte{0xee});
    };
    add(3, 3 * 9);
    add(2, 2 * (2 + 9));
    bytes.resize(bytes.size() + 8);
    frame::Frame out;
    ASSERT_TRUE(decoder.decode(bytes, head().layout(), out));
    expect_as_in_frame_5(out);
    bytes.pop_back();
    EXPECT_FALSE(decoder.decode(bytes, head().layout(), out));
    bytes.resize(ours);
    EXPECT_FALSE(decoder.decode(bytes, head().layout(), out));
}

TEST(Decoder, TakesAFieldOfAnotherUnitOrTypeForAnotherField) {
    std::string other = schema();
    other.replace(other.find("grip_force float64 N"), 20, "grip_force float64 g");
    const FrameDecoder decoder(other, "raw.log");
    EXPECT_EQ(decoder.missing(), std::vector<std::string>{"grip_force"});
    EXPECT_EQ(decoder.unknown(), std::vector<std::string>{"grip_force"});
    frame::Frame out;
    ASSERT_TRUE(decoder.decode(encoded(frame(5)), head().layout(), out));
    EXPECT_TRUE(std::isnan(out.grip_force));
    EXPECT_EQ(out.load_force, 0);
}

TEST(Decoder, RefusesWhatIsNoSchemaOfFrames) {
    for (const std::string& text :
         {std::string(), std::string("nonsense"), schema_without("time int64 ns"),
          schema_without("sequence int64 1"), schema() + "colour chars 1\n",
          schema() + "colour int7 1\n", schema() + "colour int8[3 1\n",
          schema() + "colour int8[99999999999999999999] 1\n", "  colour int32 1\n" + schema(),
          // a field of an item that is not in a list
          schema() +
              "marks uint16 count, then each:\n  size int8 1\nhue int8 1\n  colour int8 1\n"}) {
        EXPECT_THROW(FrameDecoder(text, "raw.log"), Error) << text;
    }
}

TEST(Decoder, TakesNoMemoryForItemsThatAreNotThere) {
    std::vector<std::byte> bytes = encoded(frame(3));  // without contacts: their number is last
    bytes[bytes.size() - 1] = bytes[bytes.size() - 2] = std::byte{0xff};
    frame::Frame out;
    EXPECT_FALSE(kDecoder.decode(bytes, head().layout(), out));
    EXPECT_EQ(out.contacts.capacity(), 0u);
}

/// Reads a log to its end, checking that each frame is the next one. Returns the number of frames.
int64_t count(RawLogReader& reader) {
    int64_t n = 0;
    while (const frame::Frame* f = reader.next()) EXPECT_EQ(f->sequence, n++);
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
    EXPECT_TRUE(reader.health().complete);
    EXPECT_EQ(reader.health().tail_bytes, 0);
}

TEST(DeviceRecord, KeepsWhatTheDeviceWasAndReadsThoseOfEarlierVersions) {
    const auto read = [](const std::string& text) {
        Diagnostics diagnostics;
        DeviceRecord out;
        read_fields(out, parse_yaml(text, "session.yaml"), diagnostics);
        diagnostics.throw_if_errors();
        return out;
    };
    DeviceRecord record;
    record.finger = "index";
    record.peak_force = 8.5;
    record.delay = 2e-3;
    const DeviceRecord again = read(to_yaml(write_fields(record)));
    EXPECT_EQ(again.finger, "index");
    EXPECT_EQ(static_cast<const frame::DeviceInfo&>(again), record);
    // a device as stored by log version 2
    const DeviceRecord old = read(
        "finger: index\nmodel: simulated plant\npeak_force_N: 8.5\norientation: yes\n"
        "peak_torque_Nm: 0\nscale: 2\nsimulated: yes\n");
    EXPECT_EQ(old.finger, "index");
    EXPECT_EQ(old.model, "simulated plant");
    EXPECT_EQ(old.peak_force, 8.5);
    EXPECT_TRUE(old.measures_orientation);
    EXPECT_EQ(old.scale, 2);
    EXPECT_TRUE(old.simulated);
    EXPECT_TRUE(std::isinf(old.continuous_force));
    EXPECT_TRUE(std::isinf(old.damping));  // late ticks softened nothing in that version
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
        EXPECT_FALSE(reader.health().complete);
        last = n;
    }
    EXPECT_GE(last, 250);  // at most a chunk of 50 ms is lost
}

/// Writes 300 frames in six chunks of 50 frames. Body 1 moves only in frames 0 and 120.
std::string log_of_300(const testing::TemporaryFolder& folder) {
    Recorder recorder(folder.file("raw.log"), head(), Writing::in_place);
    for (int i = 0; i < 300; ++i) {
        frame::Frame f = frame(i);
        f.bodies[1].X_WB.p.x() = i < 120 ? 1 : 2;
        if (i == 120) f.changed = {1, 2};
        recorder.record(f);
    }
    recorder.finish();
    return testing::read_file(folder.file("raw.log"));
}

TEST(RawLog, ADamagedByteCostsItsChunkAloneAndIsNeverTakenForData) {
    const testing::TemporaryFolder folder;
    const std::string whole = log_of_300(folder);
    std::set<size_t> lost_chunks;
    for (size_t at = whole.find("PACK"); at < whole.rfind("DONE"); at += 37) {
        SCOPED_TRACE(at);
        std::string damaged = whole;
        damaged[at] = static_cast<char>(damaged[at] ^ 0x10);
        RawLogReader reader(folder.write("damaged.log", damaged));
        int64_t n = 0;
        while (const frame::Frame* f = reader.next()) {
            ++n;
            EXPECT_EQ(f->grip_force, 0.1 * static_cast<double>(f->sequence));
            EXPECT_EQ(f->bodies[1].X_WB.p.x(), f->sequence < 120 ? 1 : 2) << f->sequence;
        }
        EXPECT_EQ(n, 250);
        const LogHealth& health = reader.health();
        EXPECT_TRUE(health.complete);
        EXPECT_TRUE(health.damaged(0));
        if (health.last_tick == 249) {
            EXPECT_TRUE(health.gaps.empty());
            EXPECT_GT(health.tail_bytes, 0);
            EXPECT_NEAR(static_cast<double>(health.tail_ticks), 50, 5);
            lost_chunks.insert(250);
            continue;
        }
        ASSERT_EQ(health.gaps.size(), 1u);
        const Gap& gap = health.gaps[0];
        EXPECT_EQ(gap.ticks, 50);
        EXPECT_EQ(gap.first % 50, 0);
        EXPECT_EQ(gap.after - gap.before, std::chrono::milliseconds(gap.first == 0 ? 50 : 51));
        EXPECT_GT(gap.damaged_bytes, 0);
        lost_chunks.insert(static_cast<size_t>(gap.first));
    }
    EXPECT_EQ(lost_chunks.size(), 6u);
}

TEST(RawLog, GoesOnAfterBytesThatAreNoChunk) {
    const testing::TemporaryFolder folder;
    const std::string whole = log_of_300(folder);
    const size_t second = whole.find("PACK", whole.find("PACK") + 4);
    // junk between chunks: some looks like a chunk's beginning, some spans the reader's blocks
    for (const size_t length : {1u, 3u, 5u, 65535u, 65536u, 140000u}) {
        std::string junk(length, 'D');
        if (length > 4) junk.replace(length - 5, 4, "PACK");
        RawLogReader reader(
            folder.write("junk.log", whole.substr(0, second) + junk + whole.substr(second)));
        EXPECT_EQ(count(reader), 300) << length;
    }
}

TEST(RawLog, WhatIsNotKnownOfABodyAfterAGapIsNaN) {
    const testing::TemporaryFolder folder;
    RawLogWriter writer(folder.file("raw.log"), head());
    std::vector<std::byte> bytes(most_bytes(head().layout(), 8));
    for (const int i : {0, 1, 4, 5}) {  // body 1 stays here, but may have moved in 2 and 3
        const size_t size = encode(frame(i), bytes);
        writer.add(std::span(bytes).first(size));
    }
    writer.finish();
    RawLogReader reader(folder.file("raw.log"));
    reader.next();
    EXPECT_TRUE(reader.next()->bodies[1].X_WB.p.allFinite());
    for (int i = 0; i < 2; ++i) {
        const frame::Frame* after = reader.next();
        EXPECT_TRUE(after->bodies[1].X_WB.p.hasNaN());
        EXPECT_TRUE(after->bodies[1].X_WB.R.coeffs().hasNaN());
        EXPECT_TRUE(after->bodies[2].X_WB.p.allFinite());
    }
    EXPECT_EQ(reader.health().missing(), 2);
    EXPECT_EQ(reader.health().gaps[0].damaged_bytes, 0);
}

TEST(RawLog, TellsAnUnfinishedChunkFromADamagedOneAndHowMuchItHeld) {
    const testing::TemporaryFolder folder;
    const std::string whole = log_of_300(folder);
    size_t last = 0;
    for (size_t at = whole.find("PACK"); at != std::string::npos; at = whole.find("PACK", at + 1))
        last = at;
    RawLogReader cut(folder.write("cut.log", whole.substr(0, last + 300)));
    EXPECT_EQ(count(cut), 250);
    EXPECT_TRUE(cut.health().unfinished);
    EXPECT_EQ(cut.health().tail_bytes, 300);
    EXPECT_NEAR(static_cast<double>(cut.health().tail_ticks), 50, 5);
    std::string damaged = whole;
    damaged.resize(damaged.size() - 20);
    damaged[last + 100] ^= 1;
    damaged[last + 4] = 5;  // makes the size wrong, too
    RawLogReader reader(folder.write("damaged.log", damaged));
    EXPECT_EQ(count(reader), 250);
    EXPECT_FALSE(reader.health().unfinished);
}

TEST(RawLog, CountsTheTicksThatTheServoLeftOut) {
    const testing::TemporaryFolder folder;
    Recorder recorder(folder.file("raw.log"), head(), Writing::in_place);
    for (int i = 0; i < 100; ++i) {
        frame::Frame f = frame(i);
        f.time += std::chrono::milliseconds(i >= 50 ? 7 : 0);
        recorder.record(f);
    }
    recorder.finish();
    RawLogReader reader(folder.file("raw.log"));
    EXPECT_EQ(count(reader), 100);
    EXPECT_EQ(reader.health().left_out, 7);
    EXPECT_EQ(reader.health().missing(), 0);
    EXPECT_FALSE(reader.health().damaged(100));
    EXPECT_EQ(describe_left_out(7, 1e-3).substr(0, 16), "7 ticks (7.0 ms)");
}

TEST(RawLog, CountsWholeTicksOfDevicesThatKeepAPeriodOfTheirOwn) {
    const testing::TemporaryFolder folder;
    Recorder recorder(folder.file("raw.log"), head(), Writing::in_place);
    for (int i = 0; i < 100; ++i) {
        frame::Frame f = frame(i);
        f.time += std::chrono::microseconds(i % 2 == 0 ? 150 : -150);
        if (i >= 50) f.time += std::chrono::milliseconds(3);
        recorder.record(f);
    }
    recorder.finish();
    RawLogReader reader(folder.file("raw.log"));
    EXPECT_EQ(count(reader), 100);
    EXPECT_EQ(reader.health().left_out, 3);
}

TEST(LogHealth, SaysWhereTicksAreMissingAndInProperGrammar) {
    LogHealth health;
    health.frames = 98;
    health.last_tick = 98;
    health.last_time = std::chrono::milliseconds(98);
    health.complete = true;
    health.gaps = {{10, 1, std::chrono::milliseconds(9), std::chrono::milliseconds(11), 700}};
    EXPECT_EQ(describe(health, 100, 0),
              (std::vector<std::string>{
                  "1 tick missing from tick 10 on, between 0.009 s and 0.011 s: 700 bytes in the "
                  "log are damaged there",
                  "1 tick missing at the end, after 0.098 s: the session had 100 ticks"}));
    health.gaps.clear();
    EXPECT_TRUE(describe(health, 99, 0).empty());
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
    // /dev/full exists, so creating it fails; a link to it inside a folder stands for a disk that
    // fills up later
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
    RawLogReader reader(folder.file("raw.log"));  // opened while the log is being written
    EXPECT_GE(count(reader), 500 - 50);
}

TEST(Recorder, InAThreadLosesNothingAndAllocatesNothing) {
    const testing::TemporaryFolder folder;
    Recorder recorder(folder.file("raw.log"), head(), Writing::in_thread);
    frame::Frame f = frame(0);
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
    frame::Frame f = frame(0);
    f.contacts.resize(60);
    for (int i = 0; i < 20000; ++i) {
        f.sequence = i;
        f.time = std::chrono::milliseconds(i);
        recorder.record(f);
    }
    recorder.finish();
    EXPECT_GT(recorder.dropped(), 0);
    RawLogReader reader(folder.file("raw.log"));
    int64_t read = 0;
    while (reader.next() != nullptr) ++read;
    EXPECT_EQ(read + recorder.dropped(), 20000);
}

}  // namespace
}  // namespace dihaptic::recording::recording_test
