// Tests what is left of a session after a power failure.
#include "session/test/power_loss.h"

#include <gtest/gtest.h>

#include <optional>
#include <thread>

#include "analysis/recovery.h"
#include "analysis/session_report.h"
#include "base/number.h"
#include "recording/raw_log.h"
#include "session/replay.h"
#include "session/session_run.h"
#include "testing/sanitizer.h"

namespace dihaptic::session::power_loss_test {
namespace {

namespace fs = std::filesystem;
using testing::Disk;

const std::atomic<bool> kGoOn{false};

const char* const kShort = R"(bodies:
  - { name: floor, shape: plane, fixed: yes }
hand: { centre_mm: [0, 0, 100], script: [{ name: wait, duration_s: 0.2 }] }
)";

RunResult run(const std::string& file, const std::string& out, Clock clock, double sync) {
    Request request;
    request.file = file;
    request.set = {"safety.max_pause_ms=1000"};  // the machine may be busy
    RunOptions options;
    options.out = out;
    options.clock = clock;
    options.sync = sync;
    return run_session(make_plan(request), options, kGoOn, {});
}

std::string only_folder_in(const std::string& folder) {
    for (const auto& entry : fs::directory_iterator(folder)) return entry.path().string();
    return "";
}

int64_t frames_in(const std::string& session) {
    recording::RawLogReader log(session + "/raw.log");
    return log.read_to_end().frames;
}

constexpr int64_t kLeastWritten = testing::kSanitized ? 200 : 700;  // frames

/// Simulates a power failure in the middle of a session of three seconds on the real clock.
struct Loss {
    testing::TemporaryFolder folder;
    Disk disk;
    int64_t written = 0;  ///< number of frames left if the program had only been killed
    double unsynced = 0;  ///< time since the last synchronisation began [s]
    std::string left;     ///< the session's folder; "" if there is none

    explicit Loss(double sync) {
        const std::string out = folder.file("new/sessions");
        std::thread session([&] { run("scenes/block-on-table.yaml", out, Clock::real, sync); });
        while (!fs::exists(out) || only_folder_in(out).empty() ||
               !fs::exists(only_folder_in(out) + "/raw.log") ||
               fs::file_size(only_folder_in(out) + "/raw.log") < 300'000)
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        const std::string running = only_folder_in(out);
        std::this_thread::sleep_for(std::chrono::milliseconds(730));
        disk.lose_power(folder.path(), folder.file("after"));
        const auto last_sync = disk.last_sync(running + "/raw.log");
        written = frames_in(running);  // frames are counted while the session continues
        unsynced = std::chrono::duration<double>(Disk::Clock::now() - last_sync).count();
        session.join();
        const std::string sessions = folder.file("after/new/sessions");
        if (fs::exists(sessions)) left = only_folder_in(sessions);
    }
};

TEST(PowerLoss, EverythingUpToTheLastSynchronisationIsThere) {
    const Loss loss(0.2);
    ASSERT_FALSE(loss.left.empty());
    const int64_t left = frames_in(loss.left);
    EXPECT_GT(loss.written, kLeastWritten);
    EXPECT_LT(static_cast<double>(loss.written - left), 1000 * loss.unsynced + 100);
    EXPECT_LT(loss.unsynced, 2);  // 0.2 s, and more on a busy machine
    const auto folder = recording::SessionFolder::open(loss.left);
    const analysis::Recovery recovery = analysis::recover_session(folder, {});
    EXPECT_EQ(recovery.figures.frames, left);
    EXPECT_TRUE(
        recovery.warnings.empty());  // the other files were written before the session began
    EXPECT_TRUE(recovery.figures.log.gaps.empty());
    EXPECT_TRUE(replay_session(loss.left, kGoOn, {}).good());
}

TEST(PowerLoss, WithoutSynchronisationTheSessionsFrameIsThereAlone) {
    const Loss loss(0);
    ASSERT_FALSE(loss.left.empty());
    EXPECT_GT(loss.written, kLeastWritten);
    EXPECT_EQ(frames_in(loss.left), 0);
    EXPECT_EQ(recording::SessionFolder::open(loss.left).read_info().state,
              recording::SessionState::running);
}

TEST(PowerLoss, AStateThatSaysCompleteHasAllFilesWheneverPowerFails) {
    const testing::TemporaryFolder folder;
    const std::string file = folder.write("short.yaml", kShort);
    const std::string out = folder.file("sessions");
    Disk disk;
    int losses = 0;
    int complete = 0;
    std::string session;
    const auto look = [&] {
        const std::string after = folder.file("after") + number_text(++losses);
        disk.lose_power(folder.path(), after);
        const std::string left = after + "/sessions/" + fs::path(session).filename().string();
        if (!fs::exists(left + "/session.yaml")) return;
        const auto info = recording::SessionFolder::open(left).read_info();
        if (info.state == recording::SessionState::running) return;
        ++complete;
        for (const char* name : {"raw.log", "session.nwb", "trials.csv", "phases.csv", "events.csv",
                                 "episodes.csv", "scene.yaml", "settings.csv"}) {
            EXPECT_EQ(testing::read_file(left + "/" + name),
                      testing::read_file(session + "/" + name))
                << name;
        }
        fs::remove_all(after);
    };
    const RunResult result = run(file, out, Clock::virtual_clock, 0);
    session = result.folder;
    disk.synced = look;
    analysis::finish_session(recording::SessionFolder::open(session), result.info, {});
    EXPECT_GT(losses, 10);
    EXPECT_GE(complete, 1);  // the last synchronisation is the one that writes the final state
    // after finish_session() has returned, all files are on the disk
    look();
    EXPECT_GE(complete, 2);
}

}  // namespace
}  // namespace dihaptic::session::power_loss_test
