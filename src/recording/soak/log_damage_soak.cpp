// Damages logs in thousands of ways. Every fault must be reported, and none may cause a crash.
#include "recording/test/log_damage.h"

namespace dihaptic::recording {
namespace {

TEST(DamagedLogSoak, WhateverIsNotWhereItWasWrittenIsTold) {
    expect_mischief_is_told(300);
}

TEST(DamagedLogSoak, NoMutationCrashesItsReaderOrPassesForAFrame) {
    expect_mutations_are_borne(3000, 100000);
}

}  // namespace
}  // namespace dihaptic::recording
