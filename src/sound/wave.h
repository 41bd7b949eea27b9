// Makes the samples of a task's sounds before a session begins.
#pragma once

#include <cstdint>
#include <vector>

#include "task/file/sound.h"

namespace dihaptic::sound {

struct Wave {
    std::vector<float> samples;  ///< samples of a single channel, from -1 to 1
    bool goes_on = false;  ///< whether the wave repeats: the first sample follows the last one
    double ramp = 0;       ///< time over which a continuous wave fades in or out [s]
};

/// Largest relative error in the frequency of a continuous tone. The frequency is adjusted so that
/// a whole number of periods fits into the samples.
constexpr double kDetuned = 1e-6;

/// `rate`: samples per second. `seed`: seed for noise. Throws Error when the file of the sound
/// cannot be read.
Wave make_wave(const task::SoundSpec& sound, double rate, uint64_t seed);

}  // namespace dihaptic::sound
