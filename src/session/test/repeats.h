// Checks whether a session gives the same results when it is run again and when its recording is
// replayed. Used by tests and soak tests.
#pragma once

#include <gtest/gtest.h>

#include <atomic>
#include <string>

#include "session/replay.h"
#include "session/session_run.h"
#include "testing/files.h"

namespace dihaptic::session {

inline void expect_repeats_and_replays(const std::string& file) {
    const std::atomic<bool> go_on{false};
    const testing::TemporaryFolder folder;
    const auto session = [&] {
        Request request;
        request.file = file;
        RunOptions options;
        options.out = folder.path();
        options.clock = Clock::virtual_clock;
        return run_session(make_plan(request), options, go_on, {});
    };
    const RunResult first = session();
    const RunResult second = session();
    EXPECT_EQ(first.dropped, 0);
    EXPECT_GT(first.ticks, 1000);
    const std::string log = testing::read_file(first.folder + "/raw.log");
    EXPECT_TRUE(log == testing::read_file(second.folder + "/raw.log"))
        << "raw.log differs between two runs";
    const ReplayResult replay = replay_session(first.folder, go_on, {});
    EXPECT_EQ(replay.ticks, first.ticks);
    EXPECT_EQ(replay.different_ticks, 0) << "first at " << replay.first_difference << " s";
}

}  // namespace dihaptic::session
