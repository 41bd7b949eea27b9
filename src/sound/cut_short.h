// Checks whether a sound file is complete. The library that reads sound files silently accepts the
// remains of a file that was cut by a full disk or an interrupted copy.
#pragma once

#include <string>
#include <string_view>

namespace dihaptic::sound {

/// Evidence that a WAV or Ogg file was cut short ("ends ..."), or does not match its head; "" if
/// there is none. For FLAC, the library itself counts fewer samples than the head states.
std::string cut_short(std::string_view bytes);

}  // namespace dihaptic::sound
