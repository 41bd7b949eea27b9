// Tests thousands of damaged sessions. None may count as complete, and none may crash a program
// that reads it.
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
