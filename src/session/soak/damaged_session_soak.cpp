// Thousands of damaged sessions: none is called complete, and none crashes what reads it.
#include "session/test/damaged_session.h"

namespace dihaptic::session {
namespace {

TEST(DamagedSessionSoak, RecoverReplayReportAndExportTellOfEveryMischief) {
    expect_all_tell(300);
}

TEST(DamagedSessionSoak, NoMutatedFileCrashesWhatReadsIt) {
    expect_mutated_files_are_borne(3000, 1000);
}

}  // namespace
}  // namespace dihaptic::session
