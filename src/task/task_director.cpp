#include "task/task_director.h"

#include <algorithm>
#include <bit>
#include <utility>

#include "servo/displayed.h"
#include "task/clearance.h"

namespace dihaptic::task {
namespace {

constexpr double kAtHome = 1e-6;  // tolerance for a body to be in its place [m], [rad], [m/s]
constexpr double kNever = -1;

bool same_pose(const Pose& a, const Pose& b) noexcept {
    return (a.p - b.p).norm() < kAtHome && a.R.angularDistance(b.R) < kAtHome;
}

/// Position of the hand, by which the simulated hand's steps and a person's eyes go.
Vec3 middle(std::span<const haptics::Handle> handles) noexcept {
    Vec3 sum = Vec3::Zero();
    for (const haptics::Handle& handle : handles) sum += handle.p_WH;
    return sum / static_cast<double>(handles.size());
}

/// Whether the finger is slower than `speed` [m/s]; -1: whether all fingers are.
bool slower(std::span<const haptics::Handle> handles, int finger, double speed) noexcept {
    for (size_t i = 0; i < handles.size(); ++i) {
        const bool counts = finger < 0 || i == static_cast<size_t>(finger);
        if (counts && handles[i].v_WH.norm() >= speed) return false;
    }
    return true;
}

}  // namespace

TaskDirector::TaskDirector(const TaskPlan& plan, uint64_t seed, double tick,
                           const std::vector<Attempt>& done)
    : plan_(plan), tick_(tick), queue_(plan.trials, plan.task.redo, plan.task.most_attempts, seed) {
    for (const ProcedureSpec& spec : plan.task.procedures)
        procedures_.push_back(make_procedure(spec));
    for (const Attempt& attempt : done) {
        if (!queue_.go_to(attempt.trial, attempt.attempt) || attempt.outcome < 0) continue;
        take_answer(attempt.outcome);
        queue_.finish(plan.outcomes[static_cast<size_t>(attempt.outcome)].redo);
        skip_done();
    }
    share_ = static_cast<double>(queue_.done()) / queue_.all();
    size_t ways = 0;
    for (const TaskPlan::Stage& stage : plan.stages) ways = std::max(ways, stage.ways.size());
    since_.assign(ways, kNever);
}

void TaskDirector::operator()(const servo::Frame& last, std::span<const haptics::Handle> handles,
                              servo::Commands& commands) noexcept {
    const double now = last.sequence < 0 ? 0 : seconds(last.time) + tick_;
    if (now >= feedback_until_ && next_message_ >= 0) message_ = std::exchange(next_message_, -1);
    // taken in every tick, so that input between trials counts for no trial
    const Input input{key_.exchange(0, std::memory_order_relaxed),
                      trigger_.exchange(0, std::memory_order_relaxed)};
    if (queue_.empty()) {
        order_end(now, commands);
        return;
    }
    if (skip_.exchange(false, std::memory_order_relaxed)) {
        finish(plan_.skipped, false, now, commands);
        return;
    }
    if (state_ < 0) {
        begin(last, now, commands);
    } else if (const TaskPlan::Way* way = way_out(last, handles, input, now)) {
        if (way->feedback >= 0) {
            message_ = way->feedback;
            next_message_ = -1;
            feedback_until_ = now + plan_.task.feedback - tick_ / 2;
        }
        if (way->state < 0) {
            finish(way->outcome, way->exit.redo, now, commands);
            return;
        }
        enter(way->state, now, commands);
    }
    order(last, handles, commands);
}

void TaskDirector::begin(const servo::Frame& last, double now, servo::Commands& commands) noexcept {
    if (now < feedback_until_) return;  // the feedback is still being read
    if (!clear(last)) {
        message_ = plan_.move_away;
        return;
    }
    for (const TaskPlan::Home& home : plan_.cell(trial()).homes) {
        const bool there =
            last.sequence >= 0 &&
            (same_pose(last.bodies[static_cast<size_t>(home.body)].X_WB, home.X_WB) &&
             last.bodies[static_cast<size_t>(home.body)].v_WB.norm() < kAtHome);
        if (!there) add(commands.task.placements, {home.body, home.X_WB});
    }
    if (message_ == plan_.move_away) message_ = -1;
    enter(0, now, commands);
}

/// Whether bodies can be put back. A body put where a finger is would push the finger out; a body
/// taken from between fingers that press it would let them clap together.
bool TaskDirector::clear(const servo::Frame& last) const noexcept {
    if (last.sequence < 0) return true;
    for (const TaskPlan::Home& home : plan_.cell(trial()).homes) {
        if (same_pose(last.bodies[static_cast<size_t>(home.body)].X_WB, home.X_WB)) continue;
        if (pressed(last, home.body, -1, 1)) return false;
        for (size_t i = 0; i < last.fingers.size(); ++i) {
            if (in_the_way(home.X_WB, home.box, last.fingers[i].p_WP, plan_.finger_radius[i]))
                return false;
        }
    }
    return true;
}

void TaskDirector::enter(int state, double now, servo::Commands& commands) noexcept {
    state_ = state;
    entered_ = now;
    std::fill(since_.begin(), since_.end(), kNever);
    const TaskPlan::Stage& stage = plan_.stages[static_cast<size_t>(state)];
    if (stage.message >= 0) (now < feedback_until_ ? next_message_ : message_) = stage.message;
    commands.task.marker = stage.marker;
}

const TaskPlan::Way* TaskDirector::way_out(const servo::Frame& last,
                                           std::span<const haptics::Handle> handles,
                                           const Input& input, double now) noexcept {
    const auto& ways = plan_.stages[static_cast<size_t>(state_)].ways;
    for (size_t i = 0; i < ways.size(); ++i) {
        const TaskPlan::Way& way = ways[i];
        // half a tick of tolerance, because times are sums of ticks, which round
        if (way.exit.when == When::time) {
            if (now - entered_ >= way.exit.hold - tick_ / 2) return &way;
            continue;
        }
        if (!holds(way, last, handles, input)) {
            since_[i] = kNever;
            continue;
        }
        if (since_[i] == kNever) since_[i] = now;
        if (now - since_[i] >= way.exit.hold - tick_ / 2) return &way;
    }
    return nullptr;
}

bool TaskDirector::holds(const TaskPlan::Way& way, const servo::Frame& last,
                         std::span<const haptics::Handle> handles,
                         const Input& input) const noexcept {
    switch (way.exit.when) {
        case When::inside:
            return inside(way, last, handles);
        case When::outside:
            return !inside(way, last, handles);
        case When::touched:
            return pressed(last, way.body, way.finger, 1);
        case When::released:
            return !pressed(last, way.body, way.finger, 1);
        case When::gripped:
            return pressed(last, way.body, -1, 2);
        case When::lifted:
            return lifted(way, last);
        case When::still:
            return slower(handles, way.finger, way.exit.speed);
        case When::key:
            return input.key == way.exit.key.front();
        case When::button: {
            const auto finger = static_cast<size_t>(std::max(0, way.finger));
            return (last.fingers[finger].buttons >> way.exit.button & 1u) != 0;
        }
        case When::trigger:
            return input.trigger == kAnyTrigger ||
                   (input.trigger != 0 && (way.exit.code == 0 || input.trigger == way.exit.code));
        case When::time:
            break;
    }
    return false;
}

bool TaskDirector::inside(const TaskPlan::Way& way, const servo::Frame& last,
                          std::span<const haptics::Handle> handles) const noexcept {
    const TaskPlan::Cell& cell = plan_.cell(trial());
    const auto region = static_cast<size_t>(way.region);
    const Vec3 hand_W =
        way.finger < 0 ? middle(handles) : handles[static_cast<size_t>(way.finger)].p_WH;
    const servo::VisualMap* map =
        way.exit.shown ? servo::map_of(last, servo::kMovesProxies) : nullptr;
    const Vec3 p_W = map != nullptr ? map->displayed(hand_W) : hand_W;
    return (p_W - cell.p_W[region]).norm() <= cell.radius[region];
}

bool TaskDirector::lifted(const TaskPlan::Way& way, const servo::Frame& last) const noexcept {
    for (const TaskPlan::Home& home : plan_.cell(trial()).homes) {
        if (home.body != way.body) continue;
        const double z = last.bodies[static_cast<size_t>(way.body)].X_WB.p.z();
        return z - home.X_WB.p.z() >= way.exit.height;
    }
    return false;
}

/// Whether at least `fingers` fingers press the body. Counts only `finger`, unless it is -1.
bool TaskDirector::pressed(const servo::Frame& last, int body, int finger,
                           int fingers) const noexcept {
    const auto scene_bodies = static_cast<int>(last.bodies.size());
    uint32_t which = 0;
    for (const servo::ContactFrame& contact : last.contacts) {
        if (contact.normal_force <= 0 || (contact.a != body && contact.b != body)) continue;
        const int other = (contact.a == body ? contact.b : contact.a) - scene_bodies;
        if (other >= 0 && other < 32 && (finger < 0 || other == finger)) which |= 1u << other;
    }
    return std::popcount(which) >= fingers;
}

void TaskDirector::finish(int outcome, bool redo, double now, servo::Commands& commands) noexcept {
    last_trial_ = queue_.trial() + 1;
    last_attempt_ = queue_.attempt();
    commands.trial = last_trial_;
    // a trial skipped before it began has its only frame in its first state
    commands.phase = std::max(state_, 0) + 1;
    commands.task.attempt = last_attempt_;
    commands.task.outcome = outcome;
    commands.task.message = message_;
    take_answer(outcome);
    queue_.finish(redo);
    skip_done();
    state_ = -1;
    share_.store(static_cast<double>(queue_.done()) / queue_.all(), std::memory_order_relaxed);
    commands.stop = queue_.empty() && now >= feedback_until_;
}

/// After the last trial, the session lasts until its feedback has been read. A session that was
/// over when it was resumed ends at once.
void TaskDirector::order_end(double now, servo::Commands& commands) const noexcept {
    commands.stop = now >= feedback_until_;
    commands.trial = last_trial_;
    commands.phase = 0;
    commands.task.attempt = last_attempt_;
    commands.task.message = message_;
}

void TaskDirector::skip_done() noexcept {
    while (!queue_.empty() && trial().procedure >= 0 &&
           procedures_[static_cast<size_t>(trial().procedure)].done())
        queue_.finish(false);
}

/// The level that the trial's procedure chose, within the range of the shares.
double TaskDirector::level() const noexcept {
    const auto i = static_cast<size_t>(trial().procedure);
    const ProcedureSpec& spec = plan_.task.procedures[i];
    return std::clamp(procedures_[i].level(), spec.least(), spec.most());
}

double TaskDirector::share_of_trial() const noexcept {
    if (trial().procedure < 0) return trial().share;
    return plan_.task.procedures[static_cast<size_t>(trial().procedure)].share(level());
}

/// Gives the outcome of the ending trial to its procedure. An outcome that is neither its yes nor
/// its no is no answer.
void TaskDirector::take_answer(int outcome) noexcept {
    if (trial().procedure < 0) return;
    const auto i = static_cast<size_t>(trial().procedure);
    const std::string& name = plan_.outcomes[static_cast<size_t>(outcome)].name;
    const bool yes = name == plan_.task.procedures[i].yes;
    if (yes || name == plan_.task.procedures[i].no) procedures_[i].answer(level(), yes);
}

void TaskDirector::order(const servo::Frame& last, std::span<const haptics::Handle> handles,
                         servo::Commands& commands) const noexcept {
    commands.trial = queue_.trial() + 1;
    commands.phase = state_ + 1;
    servo::TaskFrame& out = commands.task;
    out.attempt = queue_.attempt();
    out.message = message_;
    if (state_ < 0) return;
    const TaskPlan::Stage& stage = plan_.stages[static_cast<size_t>(state_)];
    const TaskPlan::Cell& cell = plan_.cell(trial());
    for (size_t i = 0; i < cell.p_W.size(); ++i) {
        if (stage.shown >> i & 1u)
            add(out.targets, {static_cast<int32_t>(i), cell.p_W[i], cell.radius[i]});
    }
    if (stage.perturbed && trial().perturb >= 0) {
        out.share = share_of_trial();
        cell.perturbations[static_cast<size_t>(trial().perturb)].order(out.share, cell.p_W, last,
                                                                       handles, out);
    }
}

}  // namespace dihaptic::task
