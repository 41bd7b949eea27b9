// Tests that a single call records a whole session and reports only once how it ended.
#include "session/record.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "contact/solver.h"
#include "recording/raw_log.h"
#include "session/test/reaches.h"

namespace dihaptic::session::record_test {
namespace {

namespace fs = std::filesystem;

TEST(Record, MakesAllFilesOfASessionAndSetsItsState) {
    Files files;
    RunOptions options;
    options.out = files.folder.file("sessions");
    std::string folder;
    std::vector<double> shares;
    const Recorded recorded = record(make_plan(files.request()), options, kGoOn, {},
                                     [&](const std::string& of, double share) {
                                         folder = of;
                                         shares.push_back(share);
                                     });
    EXPECT_TRUE(recorded.good());
    EXPECT_EQ(recorded.notes, std::vector<std::string>());
    EXPECT_EQ(recorded.folder, folder);
    ASSERT_FALSE(shares.empty());
    EXPECT_EQ(shares.front(), 0);
    EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
    for (const char* name : {"raw.log", "session.nwb", "trials.csv", "phases.csv", "events.csv"})
        EXPECT_TRUE(fs::exists(folder + "/" + name)) << name;
    const auto made = recording::SessionFolder::open(folder);
    EXPECT_EQ(made.read_info().state, recording::SessionState::complete);
    EXPECT_NO_THROW(recording::SessionLock{made});  // released
}

TEST(Record, WithoutALogMakesTheTablesOnly) {
    Files files;
    RunOptions options;
    options.out = files.folder.file("sessions");
    options.keep_log = false;
    const Recorded recorded = record(make_plan(files.request()), options, kGoOn);
    EXPECT_TRUE(recorded.good());
    EXPECT_EQ(recorded.figures.frames, recorded.ticks);
    EXPECT_TRUE(fs::exists(recorded.folder + "/trials.csv"));
    EXPECT_FALSE(fs::exists(recorded.folder + "/raw.log"));
    EXPECT_FALSE(fs::exists(recorded.folder + "/session.nwb"));
}

TEST(Record, TellsOfAFaultFirst) {
    const testing::TemporaryFolder folder;
    Request request;
    request.file = "scenes/block-on-table.yaml";
    request.set = {"safety.max_speed_m_s=0.01"};
    RunOptions options;
    options.out = folder.path();
    const Recorded recorded = record(make_plan(request), options, kGoOn);
    EXPECT_FALSE(recorded.good());
    ASSERT_FALSE(recorded.notes.empty());
    EXPECT_EQ(recorded.notes.front(), "WARNING: " + recorded.fault);
    for (size_t i = 1; i < recorded.notes.size(); ++i)
        EXPECT_TRUE(recorded.notes[i].starts_with("note: in ")) << recorded.notes[i];
}

/// Computes the convergence figures of a session from its log.
recording::Convergence convergence_in(const std::string& log) {
    recording::RawLogReader reader(log);
    recording::Convergence out;
    int in_a_row = 0;
    while (const frame::Frame* frame = reader.next()) {
        ++out.ticks;
        const bool missed = (frame->status & kSolverMissed) != 0;
        in_a_row = missed ? in_a_row + 1 : 0;
        out.missed += missed;
        out.longest_run = std::max(out.longest_run, in_a_row);
        if (frame->solver_held_residual > out.held_residual.value_or(-1)) {
            out.held_residual = frame->solver_held_residual;
            out.held_residual_time = seconds(frame->time);
        }
    }
    return out;
}

/// Records a lift of a block with the given contact solver.
Recorded lift_with(const std::string& solver, const std::string& out) {
    Request request;
    request.file = "experiments/lift-block.yaml";
    request.set = {"dynamics.solver=" + solver};
    RunOptions options;
    options.out = out;
    return record(make_plan(request), options, kGoOn);
}

TEST(Record, SaysOfEverySessionHowCloselyItsContactsWereSolved) {
    for (const std::string solver : {"newton", "sequential_impulse"}) {
        const testing::TemporaryFolder folder;
        const Recorded recorded = lift_with(solver, folder.path());
        const auto made = recording::SessionFolder::open(recorded.folder);
        const recording::Convergence counted = convergence_in(made.raw_log());
        EXPECT_EQ(counted.missed == 0, solver == "newton");
        const recording::Convergence said = made.read_info().convergence.value();
        EXPECT_EQ(said.ticks, counted.ticks);
        EXPECT_EQ(said.missed, counted.missed);
        EXPECT_EQ(said.longest_run, counted.longest_run);
        EXPECT_EQ(said.held_residual, counted.held_residual);
        EXPECT_EQ(said.held_residual_time, counted.held_residual_time);
        EXPECT_EQ(recorded.figures.convergence.describe(), counted.describe());
        EXPECT_NE(counted.describe().find(fmt::format(" {:.0e} ", contact::kTolerance)),
                  std::string::npos);
        EXPECT_NE(testing::read_file(made.nwb()).find(counted.describe()), std::string::npos);
    }
}

TEST(Record, TellsOfWhatDoesNotBalanceWhereverTheSessionIsReadAgain) {
    const testing::TemporaryFolder folder;
    std::string scene = testing::read_file("scenes/block-on-table.yaml");
    const std::string rests = "position_mm: [0, 0, 20]";
    scene.replace(scene.find(rests), rests.size(), "position_mm: [0, 0, 5]");  // inside the table
    Request request;
    request.file = folder.write("sunk.yaml", scene);
    RunOptions options;
    options.out = folder.file("sessions");
    const Recorded recorded = record(make_plan(request), options, kGoOn);
    const int64_t ticks = recorded.figures.ticks_with(kUnbalanced);
    EXPECT_GT(ticks, 0);
    EXPECT_GT(recorded.figures.energy_imbalance, 1e-3);
    const std::string said = recorded.figures.describe_imbalance();
    const auto says = [&](const std::vector<std::string>& notes) {
        return std::count_if(notes.begin(), notes.end(), [&](const std::string& note) {
            return note.find(said) != std::string::npos;
        });
    };
    EXPECT_EQ(says(recorded.notes), 1) << said;
    const auto made = recording::SessionFolder::open(recorded.folder);
    EXPECT_EQ(says(made.read_info().notes), 1) << said;
    EXPECT_NE(
        testing::read_file(made.file("events.csv")).find(std::string(describe(kUnbalanced).what)),
        std::string::npos);
}

TEST(Record, TellsOfTheOperatorsStopOnce) {
    const testing::TemporaryFolder folder;
    Request request;
    request.file = "scenes/block-on-table.yaml";
    RunOptions options;
    options.out = folder.path();
    options.clock = Clock::real;
    std::atomic<bool> stop{false};
    const Recorded recorded =
        record(make_plan(request), options, stop, [&](double) { stop = true; });
    EXPECT_TRUE(recorded.interrupted);
    EXPECT_FALSE(recorded.good());
    ASSERT_FALSE(recorded.notes.empty());
    EXPECT_EQ(recorded.notes.front(), "WARNING: " + recorded.fault);
    const std::string again(describe(kStopped).what);
    for (size_t i = 1; i < recorded.notes.size(); ++i)
        EXPECT_EQ(recorded.notes[i].find(again), std::string::npos) << recorded.notes[i];
}

}  // namespace
}  // namespace dihaptic::session::record_test
