// Sounds in a task: tones, noise and sound files, which states and exits can play.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "base/diagnostics.h"
#include "base/field.h"

namespace dihaptic::task {

/// Colour of noise. white: equal power at each frequency; pink: equal power in each octave.
enum class Noise { no, white, pink };
constexpr auto enum_names(Noise) {
    return std::array{"no", "white", "pink"};
}

/// How long a sound lasts: until it has been played once, as long as consecutive states name it, or
/// from the first to the last tick of the session.
enum class Lasts { once, state, session };
constexpr auto enum_names(Lasts) {
    return std::array{"once", "state", "session"};
}

/// A sound, given by exactly one of a tone, noise and a file.
struct SoundSpec {
    static constexpr double kHighest = 20e3;            ///< frequency [Hz]
    static constexpr int64_t kLargest = 1'000'000'000;  ///< maximum size of a sound file [bytes]

    std::string name;
    std::optional<double> tone;  ///< frequency of a sine tone [Hz]
    Noise noise = Noise::no;
    std::string file;       ///< path of the sound file, relative to the experiment file
    std::string checksum;   ///< checksum of the file, once the file is found (base/checksum.h)
    double duration = 0.1;  ///< duration of a tone or noise that is played once [s]
    double ramp = 0.005;    ///< duration of the onset and offset ramps of a tone or noise, in the
                            ///< form of raised cosines [s]
    double level = 0.5;     ///< amplitude relative to the maximum that can be played
    Lasts lasts = Lasts::once;
    Place place;

    bool goes_on() const noexcept { return lasts != Lasts::once; }

    template <class Visitor>
    void visit(Visitor& v) {
        v("name", name, Field::text().required().says("Name of the sound."));
        v("tone", tone,
          Field::of(Quantity::frequency).within(20, kHighest).says("Frequency of a sine tone."));
        v("noise", noise, says("Colour of the noise, if the sound is noise."));
        v("file", file,
          says("Sound file (WAV, FLAC, Ogg...), relative to this file; several channels are "
               "averaged."));
        v("duration", duration,
          Field::of(Quantity::time)
              .within(1e-3, 60)
              .says("Duration of a tone or noise that is played once."));
        v("ramp", ramp,
          Field::of(Quantity::time)
              .within(0, 10)
              .says("Duration of the ramps at the sound's beginning and end."));
        v("level", level,
          Field::number().within(0, 1).says(
              "Amplitude of a tone, or of the loudest sample of noise or a file, relative to the "
              "largest that can be played."));
        v("lasts", lasts,
          says("Whether the sound is played once, repeatedly while states name it, or throughout "
               "the session."));
    }
};

struct Task;

/// Checks a sound by itself. Problems are added to `diagnostics`.
void check(const SoundSpec& sound, Diagnostics& diagnostics);

/// Makes the paths of the sound files, which are relative to `folder`, relative to the program's
/// folder. Missing files are reported to `diagnostics`.
void find_sounds(Task& task, const std::string& folder, Diagnostics& diagnostics);

}  // namespace dihaptic::task
