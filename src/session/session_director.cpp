#include "session/session_director.h"

namespace dihaptic::session {
namespace {

/// Whether a simulated session gets a trigger in this tick: one comes every second.
bool simulated_trigger(const servo::Frame& last, Time period) noexcept {
    return (last.time + period) % std::chrono::seconds(1) < period;
}

}  // namespace

SessionDirector::SessionDirector(const Plan& plan, const RunOptions& options,
                                 const std::atomic<bool>& stop,
                                 const std::vector<recording::PhaseInfo>& phases,
                                 const servo::Servo& servo, Outward* outward)
    : plan_(plan),
      options_(options),
      stop_(stop),
      servo_(servo),
      outward_(outward),
      live_(options.live),
      real_(options.clock == Clock::real),
      phases_(phases, plan.settings.tick()) {
    if (!plan.task) return;
    task_.emplace(*plan.task, plan.seed, plan.settings.tick(), plan.done);
    if (plan.seeing && !real_) wait_.emplace(plan.task->stages);
}

void SessionDirector::operator()(const servo::Frame& last, std::span<const haptics::Handle> handles,
                                 servo::Commands& commands) {
    if (task_) {
        direct_task(last, handles, commands);
    } else {
        phases_(last, handles, commands);
    }
    if (wait_) wait_->look(last, commands);
    commands.stop = commands.stop || (wait_ && wait_->over());
    commands.force_off = real_ && stop_.load(std::memory_order_relaxed);
    if (live_ != nullptr) be_steered(last, commands);
}

void SessionDirector::direct_task(const servo::Frame& last,
                                  std::span<const haptics::Handle> handles,
                                  servo::Commands& commands) {
    if (servo_.fault()) {
        // without force there are no trials: the current one is over
        commands.trial = last.trial;
        commands.phase = last.phase;
        commands.task.attempt = last.task.attempt;
        return;
    }
    if (options_.keys != nullptr) task_->press(options_.keys->exchange(0));
    if (const char key = plan_.seeing ? plan_.seeing->take_key() : '\0'; key != 0)
        task_->press(key);
    if (outward_) {
        if (const int code = outward_->take_trigger(); code != 0) task_->trigger(code);
    } else if (!real_ && simulated_trigger(last, servo_.period())) {
        task_->trigger(task::TaskDirector::kAnyTrigger);
    }
    (*task_)(last, handles, commands);
}

/// Applies what the thread that watches the session, on the real clock, asks for.
void SessionDirector::be_steered(const servo::Frame& last, servo::Commands& commands) {
    commands.stop = commands.stop || live_->ended.load(std::memory_order_relaxed);
    commands.rest = live_->paused.load(std::memory_order_relaxed);
    commands.abandoned = live_->abandoned();
    live_->turn_knobs(last, plan_.settings.tick(), commands.knobs);
    if (task_) {
        if (live_->skip.exchange(false, std::memory_order_relaxed)) task_->skip();
        live_->done.store(task_->share(), std::memory_order_relaxed);
    }
}

}  // namespace dihaptic::session
