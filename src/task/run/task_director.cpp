#include "task/run/task_director.h"

#include <algorithm>
#include <cmath>

namespace dihaptic::task {
namespace {

constexpr double kNever = -1;
// initial time during which a form ignores input, since nobody can have read it yet [s]
constexpr double kUnread = 0.2;

}  // namespace

TaskDirector::TaskDirector(const TaskPlan& plan, uint64_t seed, double tick,
                           const std::vector<Attempt>& done)
    : plan_(plan),
      tick_(tick),
      queue_(plan.trials, plan.task.redo, plan.task.most_attempts, seed),
      numbers_(plan),
      variables_(plan.start),
      messages_(plan.task.feedback_beside),
      placer_(plan),
      motions_(plan.bodies, plan.finger_radius.size(), plan.longest_delay, tick),
      began_(plan.task.perturbations.size(), kNever),
      displayer_(plan, seed, tick),
      sounder_(plan),
      opening_(plan),
      rules_(plan, numbers_.quantities().values().size()) {
    for (const ProcedureSpec& spec : plan.task.procedures)
        procedures_.push_back(make_procedure(spec, seed));
    skip_done();
    for (const Attempt& attempt : done) {
        for (size_t i = 0; i < attempt.variables.size(); ++i)
            variables_[i].value = attempt.variables[i];
        if (!queue_.go_to(attempt.trial, attempt.attempt) || attempt.outcome < 0) continue;
        take_answer(attempt.outcome);
        const TaskPlan::Outcome& outcome = plan.outcomes[static_cast<size_t>(attempt.outcome)];
        queue_.finish(outcome.redo);
        if (outcome.ends_session) queue_.end();
        skip_done();
    }
    share_ = static_cast<double>(queue_.done()) / queue_.all();
    size_t transitions = 0;
    for (const TaskPlan::PlannedState& planned : plan.states)
        transitions = std::max(transitions, planned.transitions.size());
    current_.judged.assign(transitions, {});
}

void TaskDirector::operator()(const frame::Frame& last, std::span<const frame::Handle> handles,
                              frame::Commands& commands) noexcept {
    const double now = last.sequence < 0 ? 0 : seconds(last.time) + tick_;
    motions_.add(last, handles);
    displayer_.see(last);
    // the quantities are updated between trials too, since texts use them
    rules_.keep(numbers_.values());
    numbers_.quantities().update(last, handles);
    rules_.take_measures(last, current_.state, numbers_.quantities());
    direct(last, handles, now, commands);
    displayer_.order(now, commands.task);
    sounder_.order(current_.state < 0 ? nullptr : &planned(), commands.task);
    say(now, commands.task);
}

void TaskDirector::direct(const frame::Frame& last, std::span<const frame::Handle> handles,
                          double now, frame::Commands& commands) noexcept {
    messages_.tick(now);
    // input is read in every tick, so that input between trials does not affect the next trial
    const Input input = inputs_.take();
    if (queue_.empty()) {
        order_end(now, commands);
        return;
    }
    if (inputs_.take_skip()) {
        finish(plan_.skipped, false, now, commands);
        return;
    }
    take_answers(handles, input, now);
    if (current_.state < 0) {
        begin(last, input.key, now, commands);
    } else if (const TaskPlan::Transition* transition = transition_taken(last, input, now)) {
        sounder_.take(*transition);
        if (transition->feedback >= 0)
            messages_.give_feedback(transition->feedback, feedback_until(now));
        if (transition->exit.to.index < 0) {
            finish(plan_.outcome_of(*transition, trial()), transition->exit.redo, now, commands);
            return;
        }
        enter(transition->exit.to.index, now, commands);
    }
    if (current_.state >= 0)
        placer_.order(planned(), last, now + tick_ - current_.entered, numbers_, motions_,
                      commands);
    order(now, commands);
}

void TaskDirector::begin(const frame::Frame& last, char key, double now,
                         frame::Commands& commands) noexcept {
    if (!deciding_.is_over(now, [&](const Decision& made) { return follow(made, now); })) return;
    if (messages_.shows_feedback(now)) return;
    if (!opening_.over(trial(), last_.trial > 0, key, now)) return;
    if (!current_.begun) resolve();
    if (!placer_.is_clear(last, numbers_.cell())) {
        messages_.interrupt(plan_.move_away);
        return;
    }
    placer_.begin(last, numbers_.cell(), motions_, commands);
    for (const int body : plan_.task.stays.indices) {
        if (last.sequence < 0) break;
        const auto i = static_cast<size_t>(body);
        numbers_.quantities().set(numbers_.quantities().start(i), last.bodies[i].X_WB.p);
    }
    messages_.withdraw(plan_.move_away);
    enter(std::max(0, plan_.task.blocks[static_cast<size_t>(trial().block)].begins.index), now,
          commands);
}

void TaskDirector::decide_by(TrialControl& between) noexcept {
    deciding_.decide_by(between);
    ask(0, -1, 0);
}

void TaskDirector::ask(int attempt, int outcome, double now) noexcept {
    Ended ended;
    ended.trial = last_.trial;
    ended.attempt = attempt;
    ended.outcome = outcome;
    for (size_t i = 0; i < plan_.task.variables.size(); ++i)
        ended.variables[i] = variables_[i].value;
    deciding_.ask(ended, now);
}

/// Follows the decision of a program. Returns whether the program chose a trial that can be next.
bool TaskDirector::follow(const Decision& decision, double now) noexcept {
    for (size_t i = 0; i < plan_.task.variables.size(); ++i) {
        if (std::isfinite(decision.variables[i])) variables_[i].value = decision.variables[i];
    }
    bool possible = true;
    if (const int next = decision.next - 1; next >= 0) {
        // pages and breaks precede a block, so the next trial must be in the current block
        const bool here = plan_.trials[static_cast<size_t>(next)].number == trial().number;
        possible = here && queue_.go_to(next, 1);
    }
    skip_done();
    if (decision.message >= 0) messages_.announce(decision.message, feedback_until(now));
    return possible;
}

void TaskDirector::enter(int state, double now, frame::Commands& commands) noexcept {
    if (current_.state >= 0) placer_.leave(planned(), current_.state, queue_.trial() + 1);
    if (current_.state < 0) current_.trial_began = now;
    numbers_.follow(queue_.trial() + 1, queue_.attempt(), variables_, state);
    const TaskPlan::Cell& cell = numbers_.cell();
    for (const int i : trial().perturb) {
        if (cell.acts(i, state) && !cell.acts(i, current_.state))
            began_[static_cast<size_t>(i)] = now;
    }
    displayer_.enter(state, cell.looks[static_cast<size_t>(state)], current_.state < 0);
    sounder_.enter(plan_.states[static_cast<size_t>(state)]);
    current_.state = state;
    current_.entered = now;
    numbers_.quantities().set(Quantities::kTimeInState, 0);  // drives use the time in this tick
    answering_.begin(planned().questions);
    std::fill(current_.judged.begin(), current_.judged.end(), Judged{});
    placer_.enter();
    if (planned().message >= 0) messages_.show(planned().message, now);
    commands.task.marker = planned().marker;
}

const TaskPlan::Transition* TaskDirector::transition_taken(const frame::Frame& last,
                                                           const Input& input,
                                                           double now) noexcept {
    const auto& transitions = planned().transitions;
    Quantities& quantities = numbers_.quantities();
    quantities.set_times(now - current_.entered, now - current_.trial_began);
    for (size_t i = 0; i < transitions.size(); ++i) {
        const TaskPlan::Transition& transition = transitions[i];
        // half a tick of tolerance allows for rounding errors in sums of ticks
        if (transition.exit.when == When::time) {
            if (now - current_.entered >= numbers_.of(transition.exit.hold) - tick_ / 2)
                return &transition;
            continue;
        }
        Judged& judged = current_.judged[i];
        if (!holds(transition, last, input)) {
            judged.since = kNever;
            judged.met = false;
            continue;
        }
        if (judged.since == kNever) judged.since = now;
        if (judged.met || now - judged.since < numbers_.of(transition.exit.hold) - tick_ / 2)
            continue;
        judged.met = true;
        if (++judged.count >= transition.exit.count) return &transition;
    }
    return nullptr;
}

bool TaskDirector::holds(const TaskPlan::Transition& transition, const frame::Frame& last,
                         const Input& input) const noexcept {
    switch (transition.exit.when) {
        case When::key:
            return input.key == transition.exit.key.front();
        case When::button: {
            const auto finger = static_cast<size_t>(std::max(0, transition.finger));
            return (last.fingers[finger].buttons >> transition.exit.button & 1u) != 0;
        }
        case When::trigger:
            return input.trigger == Inputs::kAnyTrigger ||
                   (input.trigger != 0 &&
                    (transition.exit.code == 0 || input.trigger == transition.exit.code));
        case When::answered:
            return answering_.answered();
        default:
            return transition.condition(numbers_.values()) != 0;
    }
}

void TaskDirector::finish(int outcome, bool redo, double now, frame::Commands& commands) noexcept {
    last_.trial = queue_.trial() + 1;
    if (current_.state >= 0) placer_.leave(planned(), current_.state, last_.trial);
    last_.attempt = queue_.attempt();
    commands.trial = last_.trial;
    // a trial that is skipped before it starts has a single frame, in its first state
    commands.phase = std::max(current_.state, 0) + 1;
    commands.task.attempt = last_.attempt;
    commands.task.outcome = outcome;
    commands.task.message = messages_.message();
    // rules need the trial's numbers even if the trial is skipped before it starts
    if (!current_.begun) resolve();
    const bool again =
        redo && plan_.task.redo != Redo::never && last_.attempt < plan_.task.most_attempts;
    rules_.follow(outcome, !again, numbers_, variables_);
    commands.task.variables = variables_;
    take_answer(outcome);
    queue_.finish(redo);
    if (plan_.outcomes[static_cast<size_t>(outcome)].ends_session) queue_.end();
    skip_done();
    current_.state = -1;
    current_.begun = false;
    share_.store(static_cast<double>(queue_.done()) / queue_.all(), std::memory_order_relaxed);
    if (!queue_.empty()) ask(last_.attempt, outcome, now);
    commands.stop = queue_.empty() && !messages_.shows_feedback(now);
}

/// Gives the commands after the last trial. The session continues until the feedback has been
/// shown, but a session that was already complete when resumed ends immediately.
void TaskDirector::order_end(double now, frame::Commands& commands) const noexcept {
    commands.stop = !messages_.shows_feedback(now);
    commands.trial = last_.trial;
    commands.phase = 0;
    commands.task.attempt = last_.attempt;
    commands.task.message = messages_.message();
    commands.task.variables = variables_;
}

void TaskDirector::say(double now, frame::TaskFrame& out) const noexcept {
    if (const int page = opening_.page(); page >= 0) {
        out.page = page;
        out.message = plan_.pages[static_cast<size_t>(page)].message;
        say(out.message, now, out);
        return;
    }
    const bool rests = opening_.on();
    if (rests) out.message = plan_.rest;
    say(out.message, now, out);
    const auto add_line = [&](int message) {
        add(out.lines, {message});
        say(message, now, out);
    };
    if (const int line = messages_.line(now); line >= 0) add_line(line);
    if (rests) add_line(plan_.countdown);
    if (current_.state >= 0) {
        for (const int line : planned().lines) add_line(line);
        for (const int line : answering_.lines()) add_line(line);
    }
    for (const int line : plan_.lines) add_line(line);
}

void TaskDirector::say(int message, double now, frame::TaskFrame& out) const noexcept {
    if (message < 0) return;
    for (const TextNumber& number : plan_.numbers[static_cast<size_t>(message)]) {
        if (!number.quantity.empty()) {
            add(out.numbers, {number.quantity(numbers_.values())});
        } else {
            add(out.numbers, {number.figure == Figure::answer ? answering_.shown()
                                                              : value_of(number.figure, now)});
        }
    }
}

double TaskDirector::value_of(Figure figure, double now) const noexcept {
    // between trials, texts refer to the last trial, whereas pages refer to the next trial
    const bool ended = current_.state < 0 && !opening_.on() && last_.trial > 0;
    if (queue_.empty() && !ended) return kUnmeasured;
    const int number = ended ? last_.trial : queue_.trial() + 1;
    const Trial& trial = plan_.trials[static_cast<size_t>(number - 1)];
    switch (figure) {
        case Figure::trial_num:
            return number;
        case Figure::trials:
            return static_cast<double>(plan_.trials.size());
        case Figure::trials_left:
            return queue_.all() - queue_.done();
        case Figure::trial_num_in_block:
            return trial.in_block;
        case Figure::block_num:
            return trial.number;
        case Figure::blocks:
            return plan_.trials.back().number;
        case Figure::attempt:
            return ended ? last_.attempt : queue_.attempt();
        case Figure::countdown:
            return countdown(now);
        default:
            return kUnmeasured;
    }
}

/// Returns the seconds left in a break or a state. Half a tick of tolerance allows for rounding
/// errors in sums of ticks.
double TaskDirector::countdown(double now) const noexcept {
    const double rest = opening_.rest_left(now);
    if (rest >= 0) return std::ceil(rest - tick_ / 2);
    if (current_.state < 0) return kUnmeasured;
    for (const TaskPlan::Transition& transition : planned().transitions) {
        if (transition.exit.when == When::time)
            return std::max(0.0, std::ceil(numbers_.of(transition.exit.hold) -
                                           (now - current_.entered) - tick_ / 2));
    }
    return kUnmeasured;
}

void TaskDirector::skip_done() noexcept {
    numbers_.set(variables_);
    while (!queue_.empty() && is_done()) queue_.finish(false);
}

bool TaskDirector::is_done() noexcept {
    if (numbers_.ends_before(queue_.trial())) return true;
    return trial().procedure >= 0 && procedures_[static_cast<size_t>(trial().procedure)].done();
}

void TaskDirector::take_answers(std::span<const frame::Handle> handles, const Input& input,
                                double now) noexcept {
    if (current_.state < 0) return;
    const TaskPlan::Questions& questions = planned().questions;
    if (questions.items.empty()) return;
    const Question& first = questions.items.front().question;
    if (questions.is_form && now - current_.entered < kUnread) {
        // ignored, because these keys were meant for the previous page
    } else if (first.by != AnswerBy::cursor) {
        answering_.press(input.key);
        answering_.click(input.clicked);
    } else {
        Vec3 middle_W = Vec3::Zero();
        for (const frame::Handle& handle : handles)
            middle_W += handle.p_WH / static_cast<double>(handles.size());
        const auto& p_W = numbers_.cell().p_W;
        answering_.point(middle_W, p_W[static_cast<size_t>(first.from)],
                         p_W[static_cast<size_t>(first.to)]);
    }
    for (size_t i = 0; i < questions.items.size(); ++i) {
        const Question& question = questions.items[i].question;
        const double answer = question.si * answering_.answer(i);
        variables_[question.variable].value = answer;
        numbers_.quantities().set(plan_.symbols.variables[question.variable].slot, answer);
    }
}

void TaskDirector::resolve() noexcept {
    current_.begun = true;
    for (size_t i = plan_.task.variables.size() + plan_.levels.size(); i < variables_.size(); ++i)
        variables_[i].value = kUnmeasured;
    for (const TaskPlan::Level& level : plan_.levels)
        variables_[level.variable].value = level.standard;
    if (const TaskPlan::Level* const chosen = plan_.level_of(trial())) {
        const auto i = static_cast<size_t>(trial().procedure);
        variables_[chosen->variable].value = chosen->si * plan_.task.procedures[i].share(level());
    }
    numbers_.begin(queue_.trial(), queue_.attempt(), variables_, 0);
}

/// Returns the level that the trial's procedure has chosen, limited to the range of the procedure.
double TaskDirector::level() const noexcept {
    const auto i = static_cast<size_t>(trial().procedure);
    const ProcedureSpec& spec = plan_.task.procedures[i];
    return std::clamp(procedures_[i].level(), spec.least(), spec.most());
}

double TaskDirector::share_of_trial() const noexcept {
    if (trial().procedure < 0 || plan_.level_of(trial()) != nullptr) return trial().share;
    if (plan_.shows_standard(trial(), current_.state)) return 0;
    return plan_.task.procedures[static_cast<size_t>(trial().procedure)].share(level());
}

/// Passes the outcome of the trial that ends to the trial's procedure. An outcome that is neither
/// 'yes' nor 'no' of the procedure is not an answer.
void TaskDirector::take_answer(int outcome) noexcept {
    if (trial().procedure < 0) return;
    const auto i = static_cast<size_t>(trial().procedure);
    const std::string& name = plan_.outcomes[static_cast<size_t>(outcome)].name;
    const bool yes = name == plan_.task.procedures[i].yes;
    if (yes || name == plan_.task.procedures[i].no) procedures_[i].answer(level(), yes);
}

void TaskDirector::order(double now, frame::Commands& commands) const noexcept {
    commands.trial = queue_.trial() + 1;
    commands.phase = current_.state + 1;
    frame::TaskFrame& out = commands.task;
    out.attempt = queue_.attempt();
    out.message = messages_.message();
    out.variables = variables_;
    if (current_.state < 0) return;
    const TaskPlan::Cell& cell = numbers_.cell();
    for (size_t i = 0; i < cell.p_W.size(); ++i) {
        if (planned().shown >> i & 1u)
            add(out.targets, {static_cast<int32_t>(i), cell.p_W[i], cell.regions[i].radius.value});
    }
    for (const int p : trial().perturb) {
        const auto i = static_cast<size_t>(p);
        if (!cell.acts(p, current_.state)) continue;
        const double part = cell.perturbations[i].share_at(now - began_[i]);
        if (part == 0) continue;  // the perturbation's profile has not started or is already over
        // share in the trial, without the profile, whose effect is visible in the commands
        const double share = share_of_trial();
        if (share == 0 && plan_.shows_standard(trial(), current_.state)) continue;
        out.share = share;
        cell.perturbations[i].order(part * out.share, cell.p_W, motions_, out);
    }
}

}  // namespace dihaptic::task
