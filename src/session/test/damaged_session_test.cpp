#include "session/test/damaged_session.h"

namespace dihaptic::session::damaged_session_test {
namespace {

TEST(DamagedSession, RecoverReplayReportAndExportTellOfEveryMischief) {
    expect_all_tell(4);
}

TEST(DamagedSession, NoMutatedFileCrashesWhatReadsIt) {
    expect_mutated_files_are_borne(33, 1);
}

TEST(DamagedSession, AWholeLogOfAnotherSessionIsRefused) {
    const TwoSessions sessions;
    const auto session = sessions.copy(sessions.other(), true);
    EXPECT_THROW(analysis::recover_session(session, {}), Error);
    EXPECT_THROW(replay_session(session.path(), kGoOn, {}), Error);
    EXPECT_THROW(analysis::export_bids(session, sessions.file("study"), {}), Error);
}

TEST(DamagedSession, OfAnEarlierProgramIsRecoveredAndReplayed) {
    const TwoSessions sessions;
    const std::string old = testing::as_version_1(testing::take_apart(sessions.log()));
    const auto session = sessions.copy(old, true);
    EXPECT_TRUE(replay_session(session.path(), kGoOn, {}).good());
    const analysis::Recovery recovery = analysis::recover_session(session, {});
    EXPECT_FALSE(recovery.figures.log.damaged(recovery.info.ticks));
    const std::string cut = old.substr(0, old.size() / 2);
    EXPECT_TRUE(analysis::recover_session(sessions.copy(cut, false), {}).figures.log.damaged(0));
}

TEST(DamagedSession, TwoOfTheSameSetupOnTheRealClockAreTwo) {
    const TwoSessions sessions;
    Request request;
    request.file = sessions.file("short0.2.yaml");
    request.set = {"safety.max_pause_ms=1000"};
    RunOptions options;
    options.out = sessions.file("real");
    options.clock = Clock::real;
    const RunResult first = run_session(make_plan(request), options, kGoOn, {});
    const RunResult second = run_session(make_plan(request), options, kGoOn, {});
    EXPECT_NE(first.info.identity, second.info.identity);
    EXPECT_EQ(first.info.identity.size(), 16u);
    fs::copy_file(second.folder + "/raw.log", first.folder + "/raw.log",
                  fs::copy_options::overwrite_existing);
    EXPECT_THROW(replay_session(first.folder, kGoOn, {}), Error);
}

}  // namespace
}  // namespace dihaptic::session::damaged_session_test
