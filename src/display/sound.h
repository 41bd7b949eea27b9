// Describes the output device for the sounds of a task.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "base/diagnostics.h"
#include "base/field.h"

namespace dihaptic::display {

enum class SoundTo { speakers, file, nowhere };
constexpr auto enum_names(SoundTo) {
    return std::array{"speakers", "file", "nowhere"};
}

struct SoundOutput {
    SoundTo to = SoundTo::speakers;
    std::string device;   ///< part of the device's name; if empty, the system's default is used
    double rate = 48000;  ///< [Hz]
    std::optional<double> delay;  ///< time from a tick to the first sample of its sounds [s]
    Place place{};

    template <class Visitor>
    void visit(Visitor& v) {
        v("to", to,
          says("Output of sounds: speakers or headphones, in real time; or the session's file "
               "sound.wav, whose time 0 is the session's."));
        v("device", device,
          says("Part of the sound device's name; if left out, the system's default."));
        v("rate", rate,
          Field::of(Quantity::frequency).within(8000, 192000).says("Samples per second."));
        v("delay", delay,
          Field::of(Quantity::time)
              .within(0, 1)
              .says("Constant time from a tick to its sounds; if left out, the sound device's "
                    "own delay, or 0 for a file."));
    }
};

}  // namespace dihaptic::display
