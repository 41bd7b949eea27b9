// Makes the samples of a task's sounds, before a session begins.
#pragma once

#include <cstdint>
#include <vector>

#include "task/file/sound.h"

namespace dihaptic::sound {

struct Wave {
    std::vector<float> samples;  ///< samples of one channel, from -1 to 1
    bool goes_on = false;        ///< the first sample follows the last one
    double ramp = 0;             ///< time in which a continuous wave swells and fades [s]
};

/// Largest error of the frequency of a continuous tone, which is adjusted so that a whole number of
/// periods fits into its samples.
constexpr double kDetuned = 1e-6;

/// `rate`: samples per second. `seed`: for noise. Throws Error when the sound's file cannot be
/// read.
Wave make_wave(const task::SoundSpec& sound, double rate, uint64_t seed);

}  // namespace dihaptic::sound
