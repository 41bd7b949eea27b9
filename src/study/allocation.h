// Determines the group and the number of the next participant.
//
// If people are allocated in turn or in permuted blocks, the study has a sequence of groups, and
// the next participant takes the first free place in the sequence. A place becomes free again when
// its holder withdraws. Minimisation (Pocock and Simon 1975) considers each group that the person
// might join. For each fact, it computes the range, between groups, of the proportion of people who
// share the person's value, and adds up these ranges. It chooses the group with the smallest sum
// with probability `chance`, and one of the other groups otherwise.
#pragma once

#include <string>
#include <vector>

#include "study/roster.h"

namespace dihaptic::study {

struct Allocated {
    std::string group;
    int number = 0;  ///< number in the group, from 1; the smallest that is not taken
};

/// Returns the groups of the first `count` places, for allocation methods that use a sequence.
std::vector<std::string> sequence_of(const StudyFile& study, size_t count);

/// Allocates a person to a group. The same study, roster and person always give the same result.
/// Throws Error when every group has reached its target number.
Allocated allocate(const StudyFile& study, const Roster& roster, const Member& person);

}  // namespace dihaptic::study
