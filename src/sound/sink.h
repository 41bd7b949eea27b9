// The destination of a mixer's stream: speakers, or a file.
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
    /// Call in a tick at this session time: returns the time by the stream's clock [ns].
    virtual int64_t clock(Time session) const noexcept = 0;
    /// Call in the tick, after its requests. Neither waits nor allocates.
    virtual void pass(Time) noexcept {}
    /// Call every few milliseconds, from a thread that is not the servo's.
    virtual void tend() {}
    /// Call after the last tick: returns a message about any failure.
    virtual std::vector<std::string> finish() = 0;
};

/// Opens the system's sound device, or the named one. Throws Error when this fails.
std::unique_ptr<Sink> open_speakers(const std::vector<task::SoundSpec>& sounds, uint64_t seed,
                                    const display::SoundOutput& output);

/// Writes a WAV file of one channel in which the session's time is counted from the start of the
/// file. Throws Error when it cannot be written.
std::unique_ptr<Sink> open_file(const std::vector<task::SoundSpec>& sounds, uint64_t seed,
                                const display::SoundOutput& output, const std::string& file);

/// The samples of all sounds.
std::vector<Wave> make_waves(const std::vector<task::SoundSpec>& sounds, uint64_t seed,
                             double rate);

}  // namespace dihaptic::sound
