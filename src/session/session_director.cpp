#include "session/session_director.h"

#include <fmt/format.h>

#include "base/plural.h"
#include "session/decider.h"

namespace dihaptic::session {
namespace {

/// Whether a simulated session receives a trigger, and turns a page, in this tick: once per second.
bool once_a_second(const frame::Frame& last, Time period) noexcept {
    return (last.time + period) % std::chrono::seconds(1) < period;
}

}  // namespace

SessionDirector::SessionDirector(const Plan& plan, const RunOptions& options,
                                 const std::atomic<bool>& stop,
                                 const std::vector<recording::PhaseInfo>& phases,
                                 const servo::Servo& servo, Outward* outward, Onlookers* onlookers)
    : plan_(plan),
      options_(options),
      stop_(stop),
      servo_(servo),
      outward_(outward),
      onlookers_(onlookers),
      live_(options.live),
      real_(options.clock == Clock::real),
      phases_(phases, plan.settings.tick()) {
    if (!plan.task) return;
    task_.emplace(*plan.task, plan.seed, plan.settings.tick(), plan.done);
    if (options.decider != nullptr) task_->decide_by(*options.decider->between());
    if (plan.seeing && !real_) wait_.emplace(*plan.task);
}

std::string SessionDirector::bounded() const {
    if (!task_ || task_->numbers().bounded() == 0) return "";
    const task::TrialNumbers& numbers = task_->numbers();
    const auto last = static_cast<size_t>(numbers.last_bounded());
    const Formula& formula = plan_.task->formulas[last].formula;
    return fmt::format(
        "{}:{}: warning: {}: a formula gave values that this key does not allow; they were kept "
        "within its bounds, {} in all; the last was '{}'",
        formula.place.file, formula.place.line, formula.key, counted(numbers.bounded(), "time"),
        formula.text);
}

void SessionDirector::operator()(const frame::Frame& last, std::span<const frame::Handle> handles,
                                 frame::Commands& commands) {
    if (task_) {
        direct_task(last, handles, commands);
    } else {
        phases_(last, handles, commands);
    }
    if (wait_) wait_->look(last, commands);
    commands.stop = commands.stop || (wait_ && wait_->over());
    commands.force_off = real_ && stop_.load(std::memory_order_relaxed);
    if (live_ != nullptr) be_steered(last, commands);
    if (onlookers_ == nullptr) return;
    commands.stop = commands.stop || onlookers_->ended();
    onlookers_->turn_knobs(last, plan_.settings.tick(), commands.knobs);
}

void SessionDirector::direct_task(const frame::Frame& last, std::span<const frame::Handle> handles,
                                  frame::Commands& commands) {
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
    if (onlookers_ != nullptr) {
        if (const char key = onlookers_->take_key(); key != 0) task_->press(key);
        if (const int code = onlookers_->take_trigger(); code != 0) task_->trigger(code);
    }
    if (plan_.seeing && last.task.page >= 0 && once_a_second(last, servo_.period()))
        task_->press(plan_.task->pages[static_cast<size_t>(last.task.page)].any_key());
    if (outward_) {
        if (const int code = outward_->take_trigger(); code != 0) task_->trigger(code);
    } else if (!real_ && once_a_second(last, servo_.period())) {
        task_->trigger(task::TaskDirector::kAnyTrigger);
    }
    (*task_)(last, handles, commands);
}

/// Applies the requests of the thread that watches the session. On the virtual clock the session
/// stands still in a pause (Pacing), and no person's hand is at risk.
void SessionDirector::be_steered(const frame::Frame& last, frame::Commands& commands) {
    commands.stop = commands.stop || live_->ended.load(std::memory_order_relaxed);
    commands.rest = real_ && live_->paused.load(std::memory_order_relaxed);
    commands.abandoned = real_ ? live_->abandoned() : 0;
    live_->knobs.turn(last, plan_.settings.tick(), commands.knobs);
    if (task_) {
        if (live_->skip.exchange(false, std::memory_order_relaxed)) task_->skip();
        const double nowhere = task::Rating::kNowhere;
        if (const double at = live_->clicked.exchange(nowhere, std::memory_order_relaxed);
            at != nowhere)
            task_->click(at);
        live_->done.store(task_->share(), std::memory_order_relaxed);
    }
}

}  // namespace dihaptic::session
