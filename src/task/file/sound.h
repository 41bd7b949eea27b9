// Sounds of a task: tones, noise and sound files, which its states and exits name.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "base/diagnostics.h"
#include "base/field.h"

namespace dihaptic::task {

/// white: as strong at each frequency; pink: as strong in each octave.
enum class Noise { no, white, pink };
constexpr auto enum_names(Noise) {
    return std::array{"no", "white", "pink"};
}

/// How long a sound goes on: to its end, or as long as states name it one after the other, or from
/// the session's first tick to its last.
enum class Lasts { once, state, session };
constexpr auto enum_names(Lasts) {
    return std::array{"once", "state", "session"};
}

/// One of a tone, noise or a file.
struct SoundSpec {
    static constexpr double kHighest = 20e3;            ///< [Hz]
    static constexpr int64_t kLargest = 1'000'000'000;  ///< file [bytes]

    std::string name;
    std::optional<double> tone;  ///< frequency of a sine [Hz]
    Noise noise = Noise::no;
    std::string file;       ///< relative to the experiment file
    std::string checksum;   ///< of the file, once it was found (base/checksum.h)
    double duration = 0.1;  ///< of a tone or noise that lasts once [s]
    double ramp = 0.005;    ///< in which a tone or noise swells and fades, raised cosines [s]
    double level = 0.5;     ///< amplitude over the largest that can be played
    Lasts lasts = Lasts::once;
    Place place;

    bool goes_on() const noexcept { return lasts != Lasts::once; }

    template <class Visitor>
    void visit(Visitor& v) {
        v("name", name, Field::text().required().says("Name of the sound."));
        v("tone", tone,
          Field::of(Quantity::frequency)
              .within(20, kHighest)
              .says("Frequency of a tone, which is a sine."));
        v("noise", noise, says("Whether it is noise, and of which colour."));
        v("file", file,
          says("Sound file (WAV, FLAC, Ogg...), relative to this file; of several channels the "
               "mean is played."));
        v("duration", duration,
          Field::of(Quantity::time)
              .within(1e-3, 60)
              .says("How long a tone or noise lasts that is played once."));
        v("ramp", ramp,
          Field::of(Quantity::time)
              .within(0, 10)
              .says("Time in which it swells at its beginning, and fades at its end."));
        v("level", level,
          Field::number().within(0, 1).says("Amplitude of a tone, or of the loudest sample of "
                                            "noise or a file's, over the largest "
                                            "that can be played."));
        v("lasts", lasts,
          says("Whether it is played once, or over and over while states name it, or throughout "
               "the session."));
        if constexpr (requires { v.place(); }) place = v.place();
    }
};

struct Task;

/// Checks what each sound is by itself.
void check(const SoundSpec& sound, Diagnostics& diagnostics);

/// Makes the sounds' files relative to the program's folder instead of `folder`; a file that is
/// missing goes to `diagnostics`.
void find_sounds(Task& task, const std::string& folder, Diagnostics& diagnostics);

}  // namespace dihaptic::task
