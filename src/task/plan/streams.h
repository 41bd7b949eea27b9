// Names of the random streams (base/random.h) that generate a participant's trials. Each
// participant has individual orders and draws; otherwise, a carry-over from trial to trial would be
// the same in everyone and look like an effect. The first participant, and participants without a
// number, use the streams of the seed itself.
#pragma once

#include <fmt/format.h>

#include <string>

namespace dihaptic::task {

/// Whether the participant has streams of their own. `number` is the participant's number, as
/// returned by participant_number().
inline bool has_own_stream(int number) {
    return number > 1;
}

inline std::string stream_of(const std::string& what, int number) {
    return has_own_stream(number) ? fmt::format("{} of participant {}", what, number) : what;
}

}  // namespace dihaptic::task
