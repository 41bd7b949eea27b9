#include "task/run/task_director.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "task/run/clearance.h"
#include "task/run/recorded.h"

namespace dihaptic::task {
namespace {

constexpr double kAtStart = 1e-6;  // tolerance for a body at its start pose [m], [rad], [m/s]
constexpr double kNever = -1;
// initial time during which a form ignores input, since nobody can have read it yet [s]
constexpr double kUnread = 0.2;

bool same_pose(const Pose& a, const Pose& b) noexcept {
    return (a.p - b.p).norm() < kAtStart && a.R.angularDistance(b.R) < kAtStart;
}

/// Whether a finger presses the body.
bool pressed(const frame::Frame& last, int body) noexcept {
    const auto bodies = static_cast<int>(last.bodies.size());
    return std::any_of(
        last.contacts.begin(), last.contacts.end(), [&](const frame::ContactFrame& contact) {
            const bool of_body = contact.a == body || contact.b == body;
            return contact.normal_force > 0 && of_body && std::max(contact.a, contact.b) >= bodies;
        });
}

/// Rounds a time to nanoseconds, to remove the rounding errors of sums of ticks.
double exact(double time) noexcept {
    return std::round(time * 1e9) / 1e9;
}

/// Returns the pose at which the body is placed in this tick or, if it is not placed, its pose in
/// the last Frame.
Pose pose_of(int body, const frame::Frame& last, const frame::Commands& commands) noexcept {
    for (const frame::PlacementFrame& placed : commands.task.placements) {
        if (placed.body == body) return placed.X_WB;
    }
    return last.bodies[static_cast<size_t>(body)].X_WB;
}

/// Returns the coordinate of the joint.
double coordinate_of(int joint, const frame::Frame& last) noexcept {
    const frame::JointFrame& frame = last.joints[static_cast<size_t>(joint)];
    return std::isnan(frame.angle) ? frame.displacement : frame.angle;
}

/// Returns the statistic of the values at the ends of the last trials. `sorted` is memory for
/// sorting these values.
double statistic_of(LookBack::Statistic statistic, const std::vector<double>& x,
                    std::vector<double>& sorted) noexcept {
    if (x.empty()) return kUnmeasured;
    const auto count = static_cast<double>(x.size());
    const double mean = std::accumulate(x.begin(), x.end(), 0.0) / count;
    double squares = 0;
    for (const double value : x) squares += (value - mean) * (value - mean);
    switch (statistic) {
        case LookBack::Statistic::mean:
            return mean;
        case LookBack::Statistic::sd:
            return x.size() > 1 ? std::sqrt(squares / (count - 1)) : kUnmeasured;
        case LookBack::Statistic::best:
            return *std::max_element(x.begin(), x.end());
        case LookBack::Statistic::median:
            sorted.assign(x.begin(), x.end());
            return median_of(sorted);
    }
    return kUnmeasured;
}

}  // namespace

TaskDirector::TaskDirector(const TaskPlan& plan, uint64_t seed, double tick,
                           const std::vector<Attempt>& done)
    : plan_(plan),
      tick_(tick),
      queue_(plan.trials, plan.task.redo, plan.task.most_attempts, seed),
      numbers_(plan),
      variables_(plan.start),
      motions_(plan.bodies, plan.finger_radius.size(), plan.longest_delay, tick),
      began_(plan.task.perturbations.size(), kNever),
      displayer_(plan, seed, tick),
      sounder_(plan),
      opening_(plan) {
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
    size_t placements = 0;
    size_t drives = 0;
    size_t motors = 0;
    for (const TaskPlan::PlannedState& planned : plan.states) {
        transitions = std::max(transitions, planned.transitions.size());
        placements = std::max(placements, planned.placements.size());
        drives = std::max(drives, planned.drives.size());
        motors = std::max(motors, planned.motors.size());
    }
    for (const TaskPlan::RuleMeasure& measure : plan.rule_measures)
        taken_.emplace_back(measure.measured.take);
    in_frame_.resize(numbers_.quantities().values().size());
    frame_handles_.reserve(plan.finger_radius.size());
    for (const LookBack& look_back : plan.look_backs) {
        Past& past = past_.emplace_back();
        past.values.reserve(look_back.count);
        past.sorted.reserve(look_back.count);
    }
    judged_.assign(transitions, {});
    is_put_.assign(placements, 0);
    put_at_.resize(placements);
    drive_from_.resize(drives);
    motor_from_.resize(motors);
}

void TaskDirector::operator()(const frame::Frame& last, std::span<const frame::Handle> handles,
                              frame::Commands& commands) noexcept {
    const double now = last.sequence < 0 ? 0 : seconds(last.time) + tick_;
    motions_.add(last, handles);
    displayer_.see(last);
    // the quantities are updated between trials too, since texts use them
    const std::span<const double> values = numbers_.quantities().values();
    if (!taken_.empty()) std::ranges::copy(values, in_frame_.begin());
    numbers_.quantities().update(last, handles);
    if (state_ >= 0 && !taken_.empty()) take_measures(last);
    direct(last, handles, now, commands);
    displayer_.order(now, commands.task);
    sounder_.order(state_ < 0 ? nullptr : &plan_.states[static_cast<size_t>(state_)],
                   commands.task);
    say(now, commands.task);
}

void TaskDirector::direct(const frame::Frame& last, std::span<const frame::Handle> handles,
                          double now, frame::Commands& commands) noexcept {
    if (now >= feedback_until_ && next_message_ >= 0) message_ = std::exchange(next_message_, -1);
    // input is read in every tick, so that input between trials does not affect the next trial
    const Input input{keys_.pop().value_or(0), trigger_.exchange(0, std::memory_order_relaxed),
                      clicked_.exchange(Click{}, std::memory_order_relaxed)};
    if (queue_.empty()) {
        order_end(now, commands);
        return;
    }
    if (skip_.exchange(false, std::memory_order_relaxed)) {
        finish(plan_.skipped, false, now, commands);
        return;
    }
    take_answers(handles, input, now);
    if (state_ < 0) {
        begin(last, input.key, now, commands);
    } else if (const TaskPlan::Transition* transition = transition_taken(last, input, now)) {
        sounder_.take(*transition);
        if (transition->feedback >= 0) {
            (plan_.task.feedback_beside ? feedback_ : message_) = transition->feedback;
            next_message_ = -1;
            feedback_until_ = now + plan_.task.feedback - tick_ / 2;
        }
        if (transition->exit.to.index < 0) {
            finish(plan_.outcome_of(*transition, trial()), transition->exit.redo, now, commands);
            return;
        }
        enter(transition->exit.to.index, now, commands);
    }
    put_bodies(last, commands);
    drive_bodies(last, now, commands);
    order(now, commands);
}

void TaskDirector::begin(const frame::Frame& last, char key, double now,
                         frame::Commands& commands) noexcept {
    if (!decided(now)) return;
    if (now < feedback_until_) return;  // the feedback is still shown
    if (!opening_.over(trial(), last_trial_ > 0, key, now)) return;
    if (!begun_) resolve();
    if (!clear(last)) {
        message_ = plan_.move_away;
        return;
    }
    for (const TaskPlan::StartPose& start_pose : numbers_.cell().start_poses) {
        const bool there =
            last.sequence >= 0 &&
            (same_pose(last.bodies[static_cast<size_t>(start_pose.body)].X_WB, start_pose.X_WB) &&
             last.bodies[static_cast<size_t>(start_pose.body)].v_WB.norm() < kAtStart &&
             start_pose.motion.v.isZero(0) && start_pose.motion.w.isZero(0));
        if (!there) put(start_pose.body, start_pose.X_WB, start_pose.motion, commands);
    }
    for (const int body : plan_.task.stays.indices) {
        if (last.sequence < 0) break;
        const auto i = static_cast<size_t>(body);
        numbers_.quantities().set(numbers_.quantities().start(i), last.bodies[i].X_WB.p);
    }
    if (message_ == plan_.move_away) message_ = -1;
    enter(std::max(0, plan_.task.blocks[static_cast<size_t>(trial().block)].begins.index), now,
          commands);
}

void TaskDirector::decide_by(TrialControl& between) noexcept {
    between_ = &between;
    ask(0, -1, 0);
}

void TaskDirector::ask(int attempt, int outcome, double now) noexcept {
    if (between_ == nullptr) return;
    Ended ended;
    ended.trial = last_trial_;
    ended.attempt = attempt;
    ended.outcome = outcome;
    for (size_t i = 0; i < plan_.task.variables.size(); ++i)
        ended.variables[i] = variables_[i].value;
    between_->ask(ended);
    asked_ = true;
    ask_until_ = now + between_->patience();
}

bool TaskDirector::decided(double now) noexcept {
    if (!asked_) return true;
    if (const Decision* const decision = between_->answer()) {
        follow(*decision, now);
    } else if (now < ask_until_ && !between_->gone()) {
        return false;
    } else {
        between_->note_late();
    }
    asked_ = false;
    return true;
}

void TaskDirector::follow(const Decision& decision, double now) noexcept {
    for (size_t i = 0; i < plan_.task.variables.size(); ++i) {
        if (std::isfinite(decision.variables[i])) variables_[i].value = decision.variables[i];
    }
    if (const int next = decision.next - 1; next >= 0) {
        // pages and breaks precede a block, so the next trial must be in the current block
        const bool here = plan_.trials[static_cast<size_t>(next)].number == trial().number;
        if (!here || !queue_.go_to(next, 1)) between_->note_refused();
    }
    skip_done();
    if (decision.message < 0) return;
    message_ = decision.message;
    next_message_ = -1;
    feedback_until_ = now + plan_.task.feedback - tick_ / 2;
}

/// Whether all bodies can be returned to their start poses.
bool TaskDirector::clear(const frame::Frame& last) noexcept {
    const auto& start_poses = numbers_.cell().start_poses;
    return std::all_of(start_poses.begin(), start_poses.end(),
                       [&](const TaskPlan::StartPose& start_pose) {
                           return clear(last, start_pose, start_pose.X_WB);
                       });
}

/// Whether a body can be placed at X_WB. If it were placed onto a finger, it would push the finger
/// out; if it were removed from between fingers that press it, the fingers would collide.
bool TaskDirector::clear(const frame::Frame& last, const TaskPlan::StartPose& start_pose,
                         const Pose& X_WB) noexcept {
    if (last.sequence < 0) return true;
    if (same_pose(last.bodies[static_cast<size_t>(start_pose.body)].X_WB, X_WB)) return true;
    obstacle_ = {start_pose.body, -1};
    if (pressed(last, start_pose.body)) return false;
    for (size_t i = 0; i < last.fingers.size(); ++i) {
        obstacle_.finger = static_cast<int>(i);
        if (in_the_way(X_WB, start_pose.box, last.fingers[i].p_WP, plan_.finger_radius[i]))
            return false;
    }
    obstacle_ = {};
    return true;
}

/// Adds the placement of the body in this tick to the commands, replacing any earlier placement of
/// this body.
void TaskDirector::put(int body, const Pose& X_WB, const BodyMotion& motion,
                       frame::Commands& commands) noexcept {
    std::vector<frame::PlacementFrame>& list = commands.task.placements;
    const auto same = std::find_if(list.begin(), list.end(),
                                   [&](const auto& placed) { return placed.body == body; });
    if (same == list.end()) {
        add(list, {body, X_WB, motion.v, motion.w});
    } else {
        *same = {body, X_WB, motion.v, motion.w};
    }
    motions_.put(body, X_WB.p);
}

void TaskDirector::enter(int state, double now, frame::Commands& commands) noexcept {
    if (state_ < 0) trial_began_ = now;
    numbers_.follow(queue_.trial() + 1, queue_.attempt(), variables_, state);
    const TaskPlan::Cell& cell = numbers_.cell();
    for (const int i : trial().perturb) {
        if (cell.acts(i, state) && !cell.acts(i, state_)) began_[static_cast<size_t>(i)] = now;
    }
    displayer_.enter(state, cell.looks[static_cast<size_t>(state)], state_ < 0);
    sounder_.enter(plan_.states[static_cast<size_t>(state)]);
    state_ = state;
    entered_ = now;
    numbers_.quantities().set(Quantities::kTimeInState, 0);  // drives use the time in this tick
    answering_.begin(plan_.states[static_cast<size_t>(state)].questions);
    std::fill(judged_.begin(), judged_.end(), Judged{});
    std::fill(is_put_.begin(), is_put_.end(), 0);
    driving_ = false;
    const TaskPlan::PlannedState& planned = plan_.states[static_cast<size_t>(state)];
    const bool waits = now < feedback_until_ && !plan_.task.feedback_beside;
    if (planned.message >= 0) (waits ? next_message_ : message_) = planned.message;
    commands.task.marker = planned.marker;
}

const TaskPlan::Transition* TaskDirector::transition_taken(const frame::Frame& last,
                                                           const Input& input,
                                                           double now) noexcept {
    const auto& transitions = plan_.states[static_cast<size_t>(state_)].transitions;
    Quantities& quantities = numbers_.quantities();
    quantities.set(Quantities::kTimeInState, exact(now - entered_));
    quantities.set(Quantities::kTimeInTrial, exact(now - trial_began_));
    for (size_t i = 0; i < transitions.size(); ++i) {
        const TaskPlan::Transition& transition = transitions[i];
        // half a tick of tolerance allows for rounding errors in sums of ticks
        if (transition.exit.when == When::time) {
            if (now - entered_ >= numbers_.of(transition.exit.hold) - tick_ / 2) return &transition;
            continue;
        }
        Judged& judged = judged_[i];
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
            return input.trigger == kAnyTrigger ||
                   (input.trigger != 0 &&
                    (transition.exit.code == 0 || input.trigger == transition.exit.code));
        case When::answered:
            return answering_.answered();
        default:
            return transition.condition(numbers_.values()) != 0;
    }
}

void TaskDirector::finish(int outcome, bool redo, double now, frame::Commands& commands) noexcept {
    last_trial_ = queue_.trial() + 1;
    last_attempt_ = queue_.attempt();
    commands.trial = last_trial_;
    // a trial that is skipped before it starts has a single frame, in its first state
    commands.phase = std::max(state_, 0) + 1;
    commands.task.attempt = last_attempt_;
    commands.task.outcome = outcome;
    commands.task.message = message_;
    follow_rules(outcome, redo);
    commands.task.variables = variables_;
    take_answer(outcome);
    queue_.finish(redo);
    if (plan_.outcomes[static_cast<size_t>(outcome)].ends_session) queue_.end();
    skip_done();
    state_ = -1;
    begun_ = false;
    share_.store(static_cast<double>(queue_.done()) / queue_.all(), std::memory_order_relaxed);
    if (!queue_.empty()) ask(last_attempt_, outcome, now);
    commands.stop = queue_.empty() && now >= feedback_until_;
}

/// Gives the commands after the last trial. The session continues until the feedback has been
/// shown, but a session that was already complete when resumed ends immediately.
void TaskDirector::order_end(double now, frame::Commands& commands) const noexcept {
    commands.stop = now >= feedback_until_;
    commands.trial = last_trial_;
    commands.phase = 0;
    commands.task.attempt = last_attempt_;
    commands.task.message = message_;
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
    if (feedback_ >= 0 && now < feedback_until_) add_line(feedback_);
    if (rests) add_line(plan_.countdown);
    if (state_ >= 0) {
        const TaskPlan::PlannedState& planned = plan_.states[static_cast<size_t>(state_)];
        for (const int line : planned.lines) add_line(line);
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
    const bool ended = state_ < 0 && !opening_.on() && last_trial_ > 0;
    if (queue_.empty() && !ended) return kUnmeasured;
    const int number = ended ? last_trial_ : queue_.trial() + 1;
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
            return ended ? last_attempt_ : queue_.attempt();
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
    if (state_ < 0) return kUnmeasured;
    for (const TaskPlan::Transition& transition :
         plan_.states[static_cast<size_t>(state_)].transitions) {
        if (transition.exit.when == When::time)
            return std::max(
                0.0, std::ceil(numbers_.of(transition.exit.hold) - (now - entered_) - tick_ / 2));
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

/// Adds values to the measures that rules use. Exits use the handles of the current tick, but
/// measures use only the last Frame, as do the columns with the same names.
void TaskDirector::take_measures(const frame::Frame& last) noexcept {
    handles_of(last, frame_handles_);
    numbers_.quantities().read_frame(last, frame_handles_, in_frame_);
    for (size_t i = 0; i < taken_.size(); ++i) {
        const TaskPlan::Measured& measured = plan_.rule_measures[i].measured;
        if ((measured.states >> state_ & 1u) != 0) taken_[i].add(measured.in_tick(in_frame_));
    }
}

/// Sets a range of the statistics over earlier trials that rules use. `counts` tells whether these
/// statistics include the attempt that has just ended.
void TaskDirector::look_back(size_t from, size_t to, bool counts) noexcept {
    Quantities& quantities = numbers_.quantities();
    for (size_t i = from; i < to; ++i) {
        const LookBack& what = plan_.look_backs[i];
        Past& past = past_[i];
        const double value = what.of(quantities.values());
        if (counts && std::isfinite(value)) {
            past.best = std::fmax(past.best, value);
            if (past.values.size() < what.count) {
                past.values.push_back(value);
            } else if (what.count > 0) {
                past.values[past.next] = value;
                past.next = (past.next + 1) % what.count;
            }
        }
        quantities.set(what.slot, what.count == 0
                                      ? past.best
                                      : statistic_of(what.statistic, past.values, past.sorted));
    }
}

void TaskDirector::follow_rules(int outcome, bool redo) noexcept {
    // rules need the trial's numbers even if the trial is skipped before it starts
    if (!begun_) resolve();
    Quantities& quantities = numbers_.quantities();
    quantities.set(plan_.symbols.outcome, plan_.symbols.outcomes[static_cast<size_t>(outcome)]);
    for (size_t i = 0; i < taken_.size(); ++i) {
        quantities.set(plan_.rule_measures[i].slot, taken_[i].statistic());
        taken_[i].clear();
    }
    const bool again =
        redo && plan_.task.redo != Redo::never && last_attempt_ < plan_.task.most_attempts;
    size_t looked = 0;
    for (const TaskPlan::Change& change : plan_.changes) {
        // the statistics in a rule include the values that earlier rules have set in this trial
        look_back(std::exchange(looked, change.look_backs), change.look_backs, !again);
        if (change.when && (*change.when)(quantities.values()) == 0) continue;
        const double value = change.to.value(quantities.values());
        if (!std::isfinite(value)) continue;
        variables_[change.variable].value = value;
        numbers_.set(variables_);
    }
}

void TaskDirector::take_answers(std::span<const frame::Handle> handles, const Input& input,
                                double now) noexcept {
    if (state_ < 0) return;
    const TaskPlan::Questions& questions = plan_.states[static_cast<size_t>(state_)].questions;
    if (questions.items.empty()) return;
    const Question& first = questions.items.front().question;
    if (questions.is_form && now - entered_ < kUnread) {
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
    begun_ = true;
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
    if (plan_.shows_standard(trial(), state_)) return 0;
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

/// Places each of the state's bodies as soon as no finger presses or obstructs the body, and keeps
/// held bodies in place.
void TaskDirector::put_bodies(const frame::Frame& last, frame::Commands& commands) noexcept {
    if (state_ < 0) return;
    const auto& placements = plan_.states[static_cast<size_t>(state_)].placements;
    for (size_t i = 0; i < placements.size(); ++i) {
        const TaskPlan::Placement& wanted = placements[i];
        const int body = wanted.pose.body;
        if (is_put_[i] && !wanted.stays) continue;
        if (!is_put_[i]) {
            const Pose X_WB{wanted.pose.X_WB.R, numbers_.of(wanted.pose.position)};
            // before the first Frame, the positions of the fingers are not known
            if (wanted.moves && (last.sequence < 0 || !clear(last, wanted.pose, X_WB))) continue;
            is_put_[i] = 1;
            put_at_[i] = wanted.moves ? X_WB : pose_of(body, last, commands);
        }
        put(body, put_at_[i], {numbers_.of(wanted.pose.velocity), Vec3::Zero()}, commands);
    }
}

/// Commands where the state's drives and motors should be at the end of the tick, relative to where
/// their bodies and joints were at the beginning of the state.
void TaskDirector::drive_bodies(const frame::Frame& last, double now,
                                frame::Commands& commands) noexcept {
    if (state_ < 0 || last.sequence < 0) return;
    const auto& drives = plan_.states[static_cast<size_t>(state_)].drives;
    const auto& motors = plan_.states[static_cast<size_t>(state_)].motors;
    if (!driving_) {
        for (size_t i = 0; i < drives.size(); ++i)
            drive_from_[i] = pose_of(drives[i].body(), last, commands);
        for (size_t i = 0; i < motors.size(); ++i)
            motor_from_[i] = coordinate_of(motors[i].joint(), last);
        driving_ = true;
    }
    const auto of = [&](const Formula& number) { return numbers_.of(number); };
    const double t = now + tick_ - entered_;
    for (size_t i = 0; i < motors.size(); ++i)
        add(commands.task.motors, motors[i].at(t, motor_from_[i], of, numbers_.values()));
    for (size_t i = 0; i < drives.size(); ++i) {
        const Pose X_WB = drives[i].at(t, drive_from_[i], of, numbers_.values());
        add(commands.task.drives, {drives[i].body(), X_WB});
    }
}

void TaskDirector::order(double now, frame::Commands& commands) const noexcept {
    commands.trial = queue_.trial() + 1;
    commands.phase = state_ + 1;
    frame::TaskFrame& out = commands.task;
    out.attempt = queue_.attempt();
    out.message = message_;
    out.variables = variables_;
    if (state_ < 0) return;
    const TaskPlan::PlannedState& planned = plan_.states[static_cast<size_t>(state_)];
    const TaskPlan::Cell& cell = numbers_.cell();
    for (size_t i = 0; i < cell.p_W.size(); ++i) {
        if (planned.shown >> i & 1u)
            add(out.targets, {static_cast<int32_t>(i), cell.p_W[i], cell.regions[i].radius.value});
    }
    for (const int p : trial().perturb) {
        const auto i = static_cast<size_t>(p);
        if (!cell.acts(p, state_)) continue;
        const double part = cell.perturbations[i].share_at(now - began_[i]);
        if (part == 0) continue;  // the perturbation's profile has not started or is already over
        // share in the trial, without the profile, whose effect is visible in the commands
        const double share = share_of_trial();
        if (share == 0 && plan_.shows_standard(trial(), state_)) continue;
        out.share = share;
        cell.perturbations[i].order(part * out.share, cell.p_W, motions_, out);
    }
}

}  // namespace dihaptic::task
