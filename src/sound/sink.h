// The destination of a mixer's stream: speakers or a file.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/clock.h"
#include "display/sound.h"
#include "sound/mixer.h"

namespace dihaptic::sound {

class Sink {
  public:
    virtual ~Sink() = default;

    virtual Mixer& mixer() noexcept = 0;
    /// Must be called during the tick at this session time. Returns the corresponding time on the
    /// stream's clock [ns].
    virtual int64_t clock(Time session) const noexcept = 0;
    /// Must be called during the tick, after the requests of the tick. Neither waits nor allocates.
    virtual void pass(Time) noexcept {}
    /// Must be called every few milliseconds, from a thread other than the servo's.
    virtual void tend() {}
    /// Must be called after the last tick. Returns messages about any failures.
    virtual std::vector<std::string> finish() = 0;
};

/// Opens the named sound device or, without a name, the system's default device. Throws Error when
/// this fails.
std::unique_ptr<Sink> open_speakers(const std::vector<task::SoundSpec>& sounds, uint64_t seed,
                                    const display::SoundOutput& output);

/// Opens a WAV file with one channel for writing. The start of the file corresponds to session time
/// 0. Throws Error when the file cannot be written.
std::unique_ptr<Sink> open_file(const std::vector<task::SoundSpec>& sounds, uint64_t seed,
                                const display::SoundOutput& output, const std::string& file);

/// Makes the samples of all sounds.
std::vector<Wave> make_waves(const std::vector<task::SoundSpec>& sounds, uint64_t seed,
                             double rate);

}  // namespace dihaptic::sound
