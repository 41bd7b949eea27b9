#include "session/session_director.h"

#include <fmt/format.h>

#include "base/plural.h"
#include "session/listeners/trial_controller.h"
#include "task/run/clearance.h"

namespace dihaptic::session {

SessionDirector::SessionDirector(const Opening& session, const std::atomic<bool>& stop,
                                 std::vector<Listener*> listeners)
    : plan_(session.plan),
      options_(session.options),
      stop_(stop),
      servo_(session.servo),
      real_(session.real),
      listeners_(std::move(listeners)),
      phases_(session.info.phases, plan_.settings.tick()) {
    if (!plan_.task) return;
    task_.emplace(*plan_.task, plan_.seed, plan_.settings.tick(), plan_.done);
    if (options_.controller != nullptr) task_->decide_by(*options_.controller->between());
    if (plan_.seeing && !real_) wait_.emplace(*plan_.task);
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

std::string SessionDirector::missed_placements() const {
    if (!task_ || task_->missed_placements().count == 0) return "";
    const task::Placer::Missed& missed = task_->missed_placements();
    const std::string& state = plan_.task->task.states[static_cast<size_t>(missed.state)].name;
    return fmt::format(
        "{} in a state did not take place, since a finger pressed the body or was in the way until "
        "the state ended; the last one was of {} in the state '{}' of trial {}",
        counted(missed.count, "placement"),
        plan_.scene.bodies[static_cast<size_t>(missed.body)].name, state, missed.trial);
}

std::string SessionDirector::endless_wait(const std::vector<recording::PhaseInfo>& phases) const {
    if (!wait_ || !wait_->over()) return "";
    const task::Placer::Obstacle in_the_way = task_->obstacle();
    if (in_the_way.body < 0) return wait_->describe(phases, "");
    const scene::Scene& scene = plan_.scene;
    const std::string& body = scene.bodies[static_cast<size_t>(in_the_way.body)].name;
    if (in_the_way.finger < 0)
        return wait_->describe(phases, fmt::format("A finger presses {}.", body));
    const auto finger = static_cast<size_t>(in_the_way.finger);
    return wait_->describe(
        phases, fmt::format("The centre of {} is less than {:.1f} mm from the box around the "
                            "place of {}.",
                            scene.fingers[finger].name,
                            1e3 * (plan_.task->finger_radius[finger] + task::kClearance), body));
}

void SessionDirector::operator()(const frame::Frame& last, std::span<const frame::Handle> handles,
                                 frame::Commands& commands) {
    be_steered(last, commands);
    bool ends = false;
    for (const Listener* listener : listeners_) ends = ends || listener->ends();
    if (task_) {
        direct_task(last, handles, commands);
    } else {
        phases_(last, handles, commands);
    }
    commands.stop = commands.stop || ends;
    if (wait_) wait_->look(last, commands);
    commands.stop = commands.stop || (wait_ && wait_->over());
    commands.force_off = real_ && stop_.load(std::memory_order_relaxed);
}

void SessionDirector::be_steered(const frame::Frame& last, frame::Commands& commands) {
    const Steering steering{last, task_ ? &*task_ : nullptr, commands, servo_.period(), real_};
    if (task_ && options_.keys != nullptr) {
        while (const std::optional<char> key = options_.keys->pop()) task_->press(*key);
    }
    for (Listener* listener : listeners_) listener->steer(steering);
    // a simulated session receives one trigger per second
    if (task_ && !real_ && steering.is_once_a_second())
        task_->trigger(task::TaskDirector::kAnyTrigger);
}

void SessionDirector::direct_task(const frame::Frame& last, std::span<const frame::Handle> handles,
                                  frame::Commands& commands) {
    if (!servo_.fault()) {
        (*task_)(last, handles, commands);
        return;
    }
    // while force is off, there are no trials: the current one is over
    commands.trial = last.trial;
    commands.phase = last.phase;
    commands.task.attempt = last.task.attempt;
}

}  // namespace dihaptic::session
