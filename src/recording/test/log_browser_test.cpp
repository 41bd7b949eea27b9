// Tests that LogBrowser returns the frame for any moment of a log, exactly as if the log had been
// read from its beginning.
#include "recording/log_browser.h"

#include <gtest/gtest.h>

#include "base/random.h"
#include "recording/test/log_damage.h"

namespace dihaptic::recording::log_browser_test {
namespace {

/// Reads the log at random moments, and shortly after each of them.
void expect_all_moments(const std::string& file, int64_t frames) {
    LogBrowser browser(file);
    EXPECT_EQ(browser.begin(), 0);
    EXPECT_NEAR(browser.end(), 1e-3 * static_cast<double>(frames - 1), 1e-12);
    Random random(1, "moments");
    for (int i = 0; i < 300; ++i) {
        const double time = random.uniform(-0.1, 1e-3 * static_cast<double>(frames) + 0.1);
        for (const double later : {0.0, 0.003, 0.04, 0.2}) {
            const frame::Frame& frame = browser.at(time + later);
            const auto tick = std::clamp(static_cast<int64_t>(std::floor((time + later) * 1e3)),
                                         int64_t{0}, frames - 1);
            ASSERT_EQ(frame.sequence, tick) << time << " " << later;
            for (size_t k = 0; k < 3; ++k)
                ASSERT_EQ(frame.bodies[k].X_WB.p,
                          Vec3(static_cast<double>(k), 1, static_cast<double>(tick / 70)));
        }
    }
}

TEST(LogBrowser, GivesTheFrameOfAnyMoment) {
    const testing::TemporaryFolder folder;
    damage_log(folder, 1);
    expect_all_moments(folder.file("made.log"), 600);
}

TEST(LogBrowser, DoesSoOfALogThatAThreadWrote) {
    const testing::TemporaryFolder folder;
    const std::string file = folder.file("threaded.log");
    Recorder recorder(file, damage_head("1"), Writing::in_thread);
    for (int i = 0; i < 600; ++i) {
        recorder.record(damage_frame(i, 1));
        if (i % 7 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    recorder.finish();
    expect_all_moments(file, 600);
}

TEST(LogBrowser, FindsChunksThatAreNotInPlaceAndPassesOverGaps) {
    const testing::TemporaryFolder folder;
    auto chunks = testing::take_apart(damage_log(folder, 1));
    std::swap(chunks[3], chunks[6]);
    LogBrowser moved(folder.write("moved.log", testing::put_together(chunks)));
    EXPECT_EQ(moved.at(0.12).sequence, 120);
    EXPECT_EQ(moved.at(0.27).sequence, 270);
    EXPECT_NEAR(moved.end(), 0.599, 1e-12);
    chunks = testing::take_apart(damage_log(folder, 1));
    chunks.erase(chunks.begin() + 3);
    LogBrowser gap(folder.write("gap.log", testing::put_together(chunks)));
    EXPECT_EQ(gap.at(0.12).sequence, 99);
    EXPECT_EQ(gap.at(0.16).sequence, 160);
    chunks.back().resize(10);
    LogBrowser cut(folder.write("cut.log", testing::put_together(chunks)));
    EXPECT_EQ(cut.at(9).sequence, 599);
}

TEST(LogBrowser, GoesOnFrameByFrame) {
    const testing::TemporaryFolder folder;
    damage_log(folder, 1);
    LogBrowser browser(folder.file("made.log"));
    browser.at(0.4);
    for (int64_t tick = 401; tick < 600; ++tick) {
        const frame::Frame* const frame = browser.next();
        ASSERT_NE(frame, nullptr);
        ASSERT_EQ(frame->sequence, tick);
    }
    EXPECT_EQ(browser.next(), nullptr);
    EXPECT_EQ(browser.at(0.05).sequence, 50);
}

TEST(LogBrowser, RefusesALogWithoutFrames) {
    const testing::TemporaryFolder folder;
    const auto chunks = testing::take_apart(damage_log(folder, 1));
    EXPECT_THROW(LogBrowser(folder.write("empty.log", chunks[0])), Error);
}

}  // namespace
}  // namespace dihaptic::recording::log_browser_test
