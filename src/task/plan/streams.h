// Names of the random streams (base/random.h) that a participant's trials are made from: each
// participant has orders and draws of their own, or a carry-over from trial to trial would be the
// same in all and look like an effect. The first participant, and whoever has no number, has those
// of the seed itself.
#pragma once

#include <fmt/format.h>

#include <string>

namespace dihaptic::task {

/// `number`: the participant's, as of participant_number().
inline bool has_own_stream(int number) {
    return number > 1;
}

inline std::string stream_of(const std::string& what, int number) {
    return has_own_stream(number) ? fmt::format("{} of participant {}", what, number) : what;
}

}  // namespace dihaptic::task
