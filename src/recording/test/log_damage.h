// Damages logs and reads them: every frame returned must belong to the session, and every fault
// must be reported.
#pragma once

#include <gtest/gtest.h>

#include <set>

#include "base/number.h"
#include "recording/raw_log.h"
#include "recording/recorder.h"
#include "testing/files.h"
#include "testing/log_chunks.h"

namespace dihaptic::recording {

inline LogHead damage_head(const std::string& identity) {
    LogHead out;
    out.identity = identity;
    out.fingers = {"thumb", "index"};
    out.bodies = {"table", "block", "ball"};
    return out;
}

/// Returns a frame whose values all depend on `sequence` and `session`, so that a misplaced value
/// is noticed.
inline frame::Frame damage_frame(int64_t sequence, double session) {
    frame::Frame f;
    f.sequence = sequence;
    f.time = sequence * std::chrono::milliseconds(1);
    f.grip_force = static_cast<double>(sequence);
    f.load_force = session;
    f.fingers.resize(2);
    f.bodies.resize(3);
    for (size_t i = 0; i < 3; ++i)
        f.bodies[i].X_WB.p = {static_cast<double>(i), session, static_cast<double>(sequence / 70)};
    f.changed = sequence % 70 == 0 ? std::vector<uint16_t>{0, 1, 2} : std::vector<uint16_t>{};
    f.contacts.resize(static_cast<size_t>(sequence % 3));
    return f;
}

/// Writes a log with 600 frames in 12 chunks, followed by the end mark. Returns its contents.
inline std::string damage_log(const testing::TemporaryFolder& folder, double session) {
    const std::string file = folder.file("made.log");
    std::filesystem::remove(file);
    Recorder recorder(file, damage_head(number_text(session)), Writing::in_place);
    for (int i = 0; i < 600; ++i) recorder.record(damage_frame(i, session));
    recorder.finish();
    return testing::read_file(file);
}

/// Reads a log of `session` to its end. Every frame must be one that was written, and later than
/// the previous frame; every body must be where it was, or NaN.
inline LogHealth read_damaged(const std::string& file, double session) {
    RawLogReader reader(file);
    int64_t last = -1;
    while (const frame::Frame* f = reader.next()) {
        EXPECT_GT(f->sequence, last);
        last = f->sequence;
        EXPECT_EQ(f->grip_force, static_cast<double>(last));
        EXPECT_EQ(f->load_force, session);
        for (const frame::BodyFrame& body : f->bodies) {
            if (body.X_WB.p.hasNaN()) continue;
            EXPECT_EQ(body.X_WB.p.y(), session);
            EXPECT_EQ(body.X_WB.p.z(), static_cast<double>(last / 70));
        }
        if (::testing::Test::HasFailure()) break;
    }
    return reader.health();
}

inline void expect_mischief_is_told(int cases) {
    const testing::TemporaryFolder folder;
    const std::string log = damage_log(folder, 1);
    const std::string other = damage_log(folder, 2);
    for (int what = 0; what < testing::kMischiefs; ++what) {
        for (int seed = 0; seed < cases; ++seed) {
            SCOPED_TRACE(std::string(testing::kMischiefNames[what]) + " " + number_text(seed));
            std::mt19937_64 random(static_cast<uint64_t>(seed));
            const std::string text =
                do_mischief(static_cast<testing::Mischief>(what), log, other, random);
            const LogHealth health = read_damaged(folder.write("damaged.log", text), 1);
            EXPECT_TRUE(health.damaged(0));
            EXPECT_FALSE(describe(health, 0, 0).empty());
            // chunks that are still in the log are used, wherever they are stored
            const bool lost = what == static_cast<int>(testing::Mischief::dropped) ||
                              what == static_cast<int>(testing::Mischief::foreign_instead);
            EXPECT_GE(health.frames, lost ? 550 : 600);
            if (::testing::Test::HasFailure()) return;
        }
    }
}

/// Applies random damage and adds invented chunks with correct checksums. The reader must not
/// crash, hang, or return a frame that was never written.
inline void expect_mutations_are_borne(int cases, uint64_t first_seed) {
    const testing::TemporaryFolder folder;
    const std::string log = damage_log(folder, 1);
    const std::string other = damage_log(folder, 2);
    int read = 0;
    for (int i = 0; i < cases; ++i) {
        SCOPED_TRACE(i);
        std::mt19937_64 random(first_seed + static_cast<uint64_t>(i));
        bool crafted = false;
        const std::string text = testing::mutated(log, other, random, crafted);
        const std::string file = folder.write("mutated.log", text);
        try {
            if (crafted) {
                RawLogReader reader(file);
                reader.read_to_end();
            } else {
                const LogHealth health = read_damaged(file, 1);
                EXPECT_TRUE(text == log || health.damaged(600));
            }
            ++read;
        } catch (const Error& e) {
            EXPECT_FALSE(std::string(e.what()).empty());
        }
        if (::testing::Test::HasFailure()) return;
    }
    EXPECT_GT(read, cases / 2);  // otherwise, most cases only test how the head is read
}

}  // namespace dihaptic::recording
