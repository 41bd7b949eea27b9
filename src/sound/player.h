// Plays a task's sounds while its session runs. The player receives requests from the servo, which
// never waits for the player, and writes heard.csv, which contains the time at which each sound was
// heard.
#pragma once

#include <thread>

#include "display/sound.h"
#include "frame/frame.h"
#include "recording/hearings.h"
#include "task/file/sound.h"

namespace dihaptic::sound {

class Sink;

/// Checks that the sounds can be made. Those that cannot are reported to `diagnostics`, with the
/// reason.
void check(const std::vector<task::SoundSpec>& sounds, const display::SoundOutput& output,
           Diagnostics& diagnostics);

/// Opens the selected sound device, closes it again, and returns its name. Throws Error when the
/// device cannot be opened.
std::string try_speakers(const display::SoundOutput& output);

class Player {
  public:
    struct Plan {
        const std::vector<task::SoundSpec>& sounds;
        const display::SoundOutput& output;
        uint64_t seed;
        bool real;  ///< whether the session runs on the real clock
    };
    /// Throws Error when the sounds cannot be played.
    Player(const Plan& plan, const recording::SessionFolder& folder);
    ~Player();
    Player(const Player&) = delete;
    Player& operator=(const Player&) = delete;

    /// Must be called in each tick. On the real clock, neither waits nor allocates.
    void hear(const frame::Frame& frame) noexcept;
    /// Must be called after the last tick. Returns messages about any failures.
    std::vector<std::string> finish();

  private:
    void tend();
    void run();

    std::vector<std::string> names_;
    std::unique_ptr<Sink> sink_;
    recording::HearingsWriter hearings_;
    bool real_;
    std::atomic<int64_t> lost_{0};
    std::atomic<bool> done_{false};
    std::thread thread_;  // only on the real clock
};

}  // namespace dihaptic::sound
