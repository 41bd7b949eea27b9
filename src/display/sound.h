// Where the sounds of a task are played.
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
    std::string device;           ///< part of its name; empty: the system's default
    double rate = 48000;          ///< [Hz]
    std::optional<double> delay;  ///< from a tick to the first sample of its sounds [s]
    Place place{};

    template <class Visitor>
    void visit(Visitor& v) {
        v("to", to,
          says("Where sounds go: to speakers or headphones, in real time; or to the session's file "
               "sound.wav, where time 0 is the session's."));
        v("device", device,
          says("Part of the name of the sound device; left out, the system's default."));
        v("rate", rate,
          Field::of(Quantity::frequency).within(8000, 192000).says("Samples in a second."));
        v("delay", delay,
          Field::of(Quantity::time)
              .within(0, 1)
              .says("Time from a tick to its sounds, the same each time; left out, what the sound "
                    "device needs, and of a file none."));
        if constexpr (requires { v.place(); }) place = v.place();
    }
};

}  // namespace dihaptic::display
