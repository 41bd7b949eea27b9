// Checks whether a sound file is complete. The library that reads sound files silently accepts what
// remains of a file that was truncated by a full disk or an interrupted copy.
#pragma once

#include <string>
#include <string_view>

namespace dihaptic::sound {

/// Describes how a WAV or Ogg file shows that it was cut short ("ends ..."), or does not match its
/// header. Returns "" if there is no such evidence. For FLAC, the library itself counts fewer
/// samples than the header states.
std::string cut_short(std::string_view bytes);

}  // namespace dihaptic::sound
