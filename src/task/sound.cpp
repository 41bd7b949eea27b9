#include "task/sound.h"

#include <fmt/format.h>

#include <filesystem>

#include "task/task.h"

#include "base/installed.h"

namespace dihaptic::task {

void check(const SoundSpec& sound, Diagnostics& diagnostics) {
    const int kinds =
        int{sound.tone.has_value()} + int{sound.noise != Noise::no} + int{!sound.file.empty()};
    if (kinds != 1)
        diagnostics.error(sound.place, sound.name,
                          kinds == 0 ? "has no sound" : "is several sounds at once",
                          "Give it one of tone_Hz, noise and file.");
    if (sound.file.empty() && !sound.goes_on() && 2 * sound.ramp > sound.duration)
        diagnostics.error(sound.place, "ramp",
                          fmt::format("to swell and to fade takes longer than '{}' lasts, {:g} ms",
                                      sound.name, 1e3 * sound.duration),
                          "Make the ramp half of the duration at most.");
}

void find_sounds(Task& task, const std::string& folder, Diagnostics& diagnostics) {
    for (SoundSpec& sound : task.sounds) {
        if (sound.file.empty()) continue;
        sound.file = named_in(folder, sound.file);
        std::error_code unreadable;
        if (!std::filesystem::is_regular_file(sound.file, unreadable))
            diagnostics.error(sound.place, "file", fmt::format("there is no file {}", sound.file),
                              "Give a sound file, relative to this file.");
    }
}

}  // namespace dihaptic::task
