#include "task/file/sound.h"

#include <fmt/format.h>

#include <filesystem>

#include "base/checksum.h"
#include "base/installed.h"
#include "base/regular_file.h"
#include "task/file/task.h"

namespace dihaptic::task {

void check(const SoundSpec& sound, Diagnostics& diagnostics) {
    const int kinds =
        int{sound.tone.has_value()} + int{sound.noise != Noise::no} + int{!sound.file.empty()};
    if (kinds != 1)
        diagnostics.error(sound.place, sound.name,
                          kinds == 0 ? "has no sound" : "gives several sounds at once",
                          "Give it one of tone_Hz, 'noise' and 'file'.");
    if (sound.file.empty() && !sound.goes_on() && 2 * sound.ramp > sound.duration)
        diagnostics.error(sound.place, "ramp",
                          fmt::format("two ramps take longer than the duration of '{}', {:g} ms",
                                      sound.name, 1e3 * sound.duration),
                          "Make the ramp at most half of the duration.");
}

namespace {

void note_checksum(SoundSpec& sound, Diagnostics& diagnostics) {
    try {
        sound.checksum = checksum_of(read_bytes(sound.file, SoundSpec::kLargest));
    } catch (const Error& e) {
        const Problem& why = e.problems().front();
        diagnostics.error(sound.place, "file", sound.file + " " + why.what, why.remedy);
    }
}

}  // namespace

void find_sounds(Task& task, const std::string& folder, Diagnostics& diagnostics) {
    for (SoundSpec& sound : task.sounds) {
        if (sound.file.empty()) continue;
        sound.file = named_in(folder, sound.file);
        std::error_code unreadable;
        if (std::filesystem::is_regular_file(sound.file, unreadable)) {
            note_checksum(sound, diagnostics);
        } else {
            diagnostics.error(sound.place, "file", fmt::format("there is no file {}", sound.file),
                              "Name a sound file, relative to this file.");
        }
    }
}

}  // namespace dihaptic::task
