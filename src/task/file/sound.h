// Sounds of a task: tones, noise and sound files, for use in states and exits.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "base/diagnostics.h"
#include "base/field.h"

namespace dihaptic::task {

/// white: equal power at each frequency; pink: equal power in each octave.
enum class Noise { no, white, pink };
constexpr auto enum_names(Noise) {
    return std::array{"no", "white", "pink"};
}

/// Duration of a sound: to its end, or while consecutive states name it, or from the first tick of
/// the session to the last.
enum class Lasts { once, state, session };
constexpr auto enum_names(Lasts) {
    return std::array{"once", "state", "session"};
}

/// A sound: exactly one of a tone, noise or a file.
struct SoundSpec {
    static constexpr double kHighest = 20e3;            ///< frequency [Hz]
    static constexpr int64_t kLargest = 1'000'000'000;  ///< largest size of a file [bytes]

    std::string name;
    std::optional<double> tone;  ///< frequency of a sine [Hz]
    Noise noise = Noise::no;
    std::string file;       ///< path, relative to the experiment file
    std::string checksum;   ///< of the file, once it is found (base/checksum.h)
    double duration = 0.1;  ///< of a tone or noise that is played once [s]
    double ramp = 0.005;    ///< onset and offset ramp of a tone or noise, a raised cosine [s]
    double level = 0.5;     ///< amplitude relative to the largest that can be played
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

/// Checks a sound by itself; problems go to `diagnostics`.
void check(const SoundSpec& sound, Diagnostics& diagnostics);

/// Converts the paths of the sound files from relative to `folder` to relative to the program's
/// folder; missing files go to `diagnostics`.
void find_sounds(Task& task, const std::string& folder, Diagnostics& diagnostics);

}  // namespace dihaptic::task
