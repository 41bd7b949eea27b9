// Runs a complete shipped experiment, of which src/session/test/session_run_test.cpp runs only a
// tenth.
#include "session/test/repeats.h"

namespace dihaptic::session {
namespace {

TEST(ShippedSoak, AllLiftsBySightRepeatThemselvesAndReplayToTheBit) {
    expect_repeats_and_replays("experiments/grip-by-sight.yaml");
}

}  // namespace
}  // namespace dihaptic::session
