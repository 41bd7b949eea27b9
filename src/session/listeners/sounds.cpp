#include "session/listeners/sounds.h"

#include "session/plan.h"
#include "session/session_run.h"
#include "sound/player.h"

namespace dihaptic::session {
namespace {

class Sounds : public Listener {
  public:
    Sounds(const sound::Player::Plan& plan, const recording::SessionFolder& folder)
        : player_(plan, folder) {}

    void take(const frame::Frame& frame) noexcept override { player_.hear(frame); }
    std::vector<std::string> finish() override { return player_.finish(); }

  private:
    sound::Player player_;
};

}  // namespace

std::unique_ptr<Listener> play_sounds(const Opening& opening) {
    const Plan& plan = opening.plan;
    if (!plan.task || plan.task->task.sounds.empty() || opening.options.in_place_of_log)
        return nullptr;
    const display::SoundOutput output = plan.rig.sound.value_or(display::SoundOutput{});
    const bool in_real_time = output.to == display::SoundTo::speakers;
    if (output.to == display::SoundTo::nowhere || (in_real_time && !opening.real)) return nullptr;
    try {
        return std::make_unique<Sounds>(
            sound::Player::Plan{plan.task->task.sounds, output, plan.seed, opening.real},
            opening.folder);
    } catch (const Error& e) {
        std::vector<Problem> problems = e.problems();
        problems.front().what = "The sounds are not played: " + problems.front().what;
        throw Error(std::move(problems));
    }
}

}  // namespace dihaptic::session
