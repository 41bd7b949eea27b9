// Tests thousands of damaged sessions: none must count as complete, and none must crash its reader.
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
