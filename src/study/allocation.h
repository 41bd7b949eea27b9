// The group and the number of the next participant.
//
// If people are allocated in turn or in permuted blocks, the study has a sequence of groups, and
// the next participant takes its first free place. A place is free again when its holder withdraws.
// Minimisation (Pocock and Simon 1975) adds up, for each group that the person might join, the
// ranges between groups of the shares of people with the same value of each fact, and chooses the
// group with the smallest sum with probability `chance`, and otherwise one of the other groups.
#pragma once

#include <string>
#include <vector>

#include "study/roster.h"

namespace dihaptic::study {

struct Allocated {
    std::string group;
    int number = 0;  ///< in the group, from 1: the smallest that nobody holds
};

/// The sequence of groups of the first `count` places, for methods with a sequence.
std::vector<std::string> sequence_of(const StudyFile& study, size_t count);

/// Allocates a person. The same study, roster and person always give the same result. Throws Error
/// when every group has its target number.
Allocated allocate(const StudyFile& study, const Roster& roster, const Member& person);

}  // namespace dihaptic::study
