// Whether a sound file is there to its end. The library that reads them takes what is left of a
// file that a full disk, or a copy that broke off, has cut, and says nothing.
#pragma once

#include <string>
#include <string_view>

namespace dihaptic::sound {

/// What shows that a WAV or Ogg file was cut short, as "ends ...", or is not what its head says; ""
/// if nothing does. Of FLAC, the library counts fewer samples than the head has.
std::string cut_short(std::string_view bytes);

}  // namespace dihaptic::sound
