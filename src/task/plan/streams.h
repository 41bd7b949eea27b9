// Names of the random streams (base/random.h) that generate a participant's trials: each
// participant has individual orders and draws, since otherwise a carry-over from trial to trial
// would be the same in everyone and look like an effect. The first participant, and participants
// without a number, use the streams of the seed itself.
#pragma once

#include <fmt/format.h>

#include <string>

namespace dihaptic::task {

/// `number`: of the participant, from participant_number().
inline bool has_own_stream(int number) {
    return number > 1;
}

inline std::string stream_of(const std::string& what, int number) {
    return has_own_stream(number) ? fmt::format("{} of participant {}", what, number) : what;
}

}  // namespace dihaptic::task
