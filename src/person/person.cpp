#include "person/person.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "hand/places.h"

namespace dihaptic::person {
namespace {

using task::TaskPlan;

constexpr double kUsualDensity = 1000;  // density expected before the first lift [kg/m^3]
constexpr double kYields = 0.015;       // yielding under a finger above which it presses less [m]
constexpr double kOverlap = 0.6;        // duration of each part, as a share of the whole duration
constexpr double kOpening = 2e-3;       // increase in aperture that releases the object [m]
constexpr double kUpward = 2e-3;   // upward movement beyond which a gripping hand starts a lift [m]
constexpr double kIdle = 0.4;      // time between trials after which the hand returns to rest [s]
constexpr double kRestTime = 0.6;  // duration of the movement back to rest [s]
constexpr double kRetry = 3;       // time in a state before its steps are repeated [s]
constexpr double kGivingUp = 10;   // delay that stands for not making an attempt [s]
constexpr double kWeak = 0.4;      // ratio of a too weak grip to the right one

std::vector<Vec3> sides_of(const std::vector<hand::FingerPlace>& places) {
    std::vector<Vec3> out;
    for (const hand::FingerPlace& place : places) out.push_back(place.side);
    return out;
}

double friction_of(const scene::Scene& scene, size_t first, const scene::Body& body) {
    const scene::Finger& finger = scene.fingers[first];
    return scene::pair_friction(scene, body.name, body.friction, finger.name, finger.friction);
}

std::vector<double> frictions_of(const scene::Scene& scene, size_t first) {
    std::vector<double> out;
    for (const scene::Body& body : scene.bodies) out.push_back(friction_of(scene, first, body));
    return out;
}

size_t first_finger(const Situation& situation) {
    return situation.task->first_fingers[situation.participant];
}

/// The fingers that the person moves with skill: with several participants, the fingers of this
/// participant; with one participant, all fingers of the scene before those of another hand. Throws
/// Error if the fingers of another hand are not the last ones.
std::vector<hand::FingerPlace> own_places(const Situation& situation) {
    auto out = hand::finger_places(situation.hand, scene::finger_names(situation.scene));
    const std::vector<size_t>& firsts = situation.task->first_fingers;
    if (firsts.size() > 1) {
        const size_t next = situation.participant + 1;
        const size_t end = next < firsts.size() ? firsts[next] : out.size();
        return {out.begin() + static_cast<std::ptrdiff_t>(first_finger(situation)),
                out.begin() + static_cast<std::ptrdiff_t>(end)};
    }
    const auto of_another = [](const hand::FingerPlace& f) { return f.centre || f.aperture; };
    const auto other = std::find_if(out.begin(), out.end(), of_another);
    const auto wrong = std::find_if_not(other, out.end(), of_another);
    if (other == out.begin() || wrong != out.end()) {
        throw Error(other->place, other->name,
                    "belongs to another hand (it has its own centre or aperture), and precedes "
                    "fingers of the simulated person's hand",
                    "List the fingers of each hand together; do not give the first hand's "
                    "fingers their own centre.");
    }
    out.erase(other, out.end());
    return out;
}

/// The properties that the appearance of objects suggests: uniform and of usual density, with
/// approximately their true friction.
BodyMemories looks_of(const scene::Scene& scene, size_t first, const Traits& traits,
                      uint64_t seed) {
    BodyMemories out;
    Random random(seed, fmt::format("looks to {}", traits.id));
    for (scene::Body body : scene.bodies) {
        GripMemory look;
        const double misjudged = std::exp(traits.friction_error * random.normal());
        look.friction = misjudged * friction_of(scene, first, body);
        body.mass.reset();
        body.density = kUsualDensity;
        if (body.moves_at_all()) look.weight = kGravity * scene::mass(body);
        out.add(body.name, look);
    }
    return out;
}

/// The steps that move the finger `first`, by state.
std::vector<std::vector<TaskPlan::Step>> steps_of(const TaskPlan& plan, size_t first) {
    std::vector<std::vector<TaskPlan::Step>> out;
    for (const TaskPlan::PlannedState& planned : plan.states) {
        std::vector<TaskPlan::Step>& own = out.emplace_back(planned.hand);
        std::erase_if(own, [&](const auto& step) { return !step.moves(first); });
    }
    return out;
}

}  // namespace

Person::Draws::Draws(uint64_t seed, const std::string& id)
    : seed(seed),
      others(seed, fmt::format("person {}", id)),
      lifts(seed, fmt::format("lifts of {}", id)),
      presses(seed, fmt::format("presses of {}", id)) {}

Person::Person(const Traits& traits, const Situation& situation)
    : traits_(traits),
      plan_(situation.task),
      numbers_(*plan_),
      impedance_(situation.hand.impedance),
      draws_(situation.seed, traits.id),
      senses_{FeltHand(first_finger(situation), own_places(situation), ForceMemory::kLongestLag,
                       situation.tick),
              Eyes(traits.visual_delay, first_finger(situation), own_places(situation).size(),
                   situation.tick),
              Touch(first_finger(situation), sides_of(own_places(situation)),
                    frictions_of(situation.scene, first_finger(situation)), situation.tick),
              Past<Strain>(traits.visual_delay, situation.tick),
              SeenTargets(plan_->task.regions.size()),
              HeldCursor(plan_->states),
              traits.visual_delay},
      start_{senses_.felt.places().front().centre.value_or(situation.hand.centre),
             senses_.felt.places().front().aperture.value_or(situation.hand.aperture), 0},
      steps_(steps_of(*plan_, senses_.felt.first())),
      memories_(traits, *plan_, steps_),
      grip_(traits, looks_of(situation.scene, senses_.felt.first(), traits, situation.seed),
            situation.tick) {
    for (const std::string& name : plan_->phases()) phases_.push_back({name, 0, 0});
    if (plan_->first_fingers.size() == 1 &&
        senses_.felt.places().size() < situation.scene.fingers.size())
        other_.emplace(plan_, situation.hand, scene::finger_names(situation.scene));
    restart();
}

void Person::restart() {
    draws_ = Draws(draws_.seed, traits_.id);
    if (other_) other_->restart();
    now_ = 0;
    senses_.restart();
    grip_.restart(before_.bodies);
    memories_.restart(before_.states);
    aim_.rest(start_);
    numbers_.restart();
    cue_ = {};
    action_ = {};
    reach_ = {};
    answers_.restart();
}

Learned Person::learned() const {
    return {memories_.overnight(), grip_.memories().overnight()};
}

void Person::recall(Learned before) {
    before_ = std::move(before);
    restart();
}

const std::vector<TaskPlan::Step>& Person::steps() const noexcept {
    return steps_[static_cast<size_t>(action_.state - 1)];
}

double Person::noisy(double value, double share) noexcept {
    return value * std::max(0.3, 1 + share * draws_.others.normal());
}

hand::FingerTarget Person::do_target(int finger, double t) const noexcept {
    const size_t own = static_cast<size_t>(finger) - senses_.felt.first();
    if (own >= senses_.felt.places().size())
        return other_ ? other_->target(finger, t) : hand::FingerTarget{};
    const hand::FingerPlace& place = senses_.felt.places()[own];
    const Aim aim = aim_.at(t);
    const Aim rate = aim_.rate(t);
    hand::FingerTarget target;
    target.p_WT = aim.centre + place.offset;
    target.v_WT = rate.centre;
    target.p_WT += reach_.stray.held_back;
    target.v_WT += reach_.stray.held_back_rate;
    if (reach_.pushes.opposed != Vec3::Zero()) {
        const double speed = aim_.rate(t - reach_.pushes.lag).centre.dot(reach_.along);
        target.p_WT += speed / stiffness() * reach_.pushes.opposed;
    }
    if (!grip_.holds()) {
        target.p_WT += aim.aperture / 2 * place.side;
        target.v_WT += rate.aperture / 2 * place.side;
        return target;
    }
    // fingers press and carry with given forces: targets are off the handles by force / stiffness
    const double k = stiffness();
    // if an object yields under the fingers, they press less
    const double yields =
        std::clamp((action_.touched - senses_.felt.half_aperture() - kYields) / kYields, 0.0, 1.0);
    target.p_WT += (senses_.felt.half_aperture() - (1 - yields) * grip_.squeeze() / k) * place.side;
    if (grip_.phase() == GripPhase::load)
        target.p_WT.z() = senses_.felt.centre().z() + place.offset.z();
    target.p_WT += (aim.load * Vec3::UnitZ() + grip_.inertial()) / (senses_.felt.fingers() * k);
    return target;
}

void Person::do_see(const frame::Frame& frame) noexcept {
    if (other_) other_->see(frame);
    senses_.eyes.take(frame);
    tick_ = seconds(frame.time) - now_;
    now_ = seconds(frame.time);
    senses_.felt.feel(frame, now_, tick_);
    stray();
    senses_.strains.add(strain(frame));
    const bool held = grip_.holds();
    const bool loads = grip_.phase() == GripPhase::load;
    grip_.tick(now_, senses_.touch.feel(frame), senses_.felt.places().front().side, aim_);
    // after opening, the hand continues from its current aperture
    if (held && !grip_.holds())
        aim_.shift({Vec3::Zero(), 2 * senses_.felt.half_aperture() - aim_.at(now_).aperture, 0});
    if (loads && grip_.phase() != GripPhase::load)
        aim_.shift({(senses_.felt.centre().z() - aim_.at(now_).centre.z()) * Vec3::UnitZ(), 0, 0});
    const Sight& sight = senses_.eyes.sight();
    follow_cues(sight);
    numbers_.follow(cue_.trial, cue_.attempt, frame.task.variables, cue_.phase - 1);
    feel_strain();
    follow_jumps(sight);
    watch_reach(sight);
    go_on(sight);
}

void Person::begin_attempt() noexcept {
    Grip::Trial lift;
    lift.latency = traits_.reflex_latency + traits_.reflex_noise * draws_.others.normal();
    if (draws_.others.uniform(0, 1) < traits_.slip_rate) lift.strength = kWeak;
    lift.misfelt = std::exp(traits_.friction_error * draws_.others.normal());
    lift.strength *= std::exp(traits_.grip_noise * draws_.lifts.normal());
    lift.slowness = std::exp(traits_.load_time_noise * draws_.lifts.normal());
    grip_.set(lift);
    action_.delay = 0;
    if (draws_.others.uniform(0, 1) < traits_.hesitation_rate)
        action_.delay = -traits_.hesitation_time * std::log(1 - draws_.others.uniform(0, 1));
    if (draws_.others.uniform(0, 1) < traits_.give_up_rate) action_.delay = kGivingUp;
}

void Person::await_trial() noexcept {
    if (!cue_.between) action_.since = now_;
    cue_.between = true;
    if (now_ - action_.since > kIdle && cue_.phase > 0 && cue_.trial != 0) rest();
}

/// Reacts to a new state, which is recognised by its targets and its message. If the new state
/// requires no movement, the current movement continues.
void Person::follow_cues(const Sight& sight) noexcept {
    if (sight.trial < 1 || sight.phase == task::kBetween) return await_trial();
    cue_.between = false;
    senses_.targets.see(sight);
    const bool new_attempt = sight.trial != cue_.trial || sight.attempt != cue_.attempt;
    if (!new_attempt && sight.phase == cue_.phase) return;
    senses_.cursor.enter(sight.phase - 1, new_attempt,
                         {now_ - traits_.visual_delay, senses_.felt_hand()});
    if (new_attempt) begin_attempt();
    cue_.trial = sight.trial;
    cue_.attempt = sight.attempt;
    cue_.phase = sight.phase;
    const double reaction = noisy(traits_.reaction_time, traits_.reaction_noise);
    const double begins = now_ + std::max(0.0, reaction - traits_.visual_delay) + action_.delay;
    action_.delay = 0;
    const TaskPlan::PlannedState& planned = plan_->states[static_cast<size_t>(cue_.phase - 1)];
    answers_.enter(planned, begins);
    if (!new_attempt && steps_[static_cast<size_t>(cue_.phase - 1)].empty()) return;
    end_reach();
    action_.state = cue_.phase;
    action_.step = 0;
    action_.doing = Doing::waiting;
    action_.since = now_;
    action_.wait_until = begins;
}

/// Whether the display still shows the hand before the start of the current reach.
bool Person::shows_earlier_reach() const noexcept {
    return senses_.cursor.is_held() && senses_.cursor.shown().time < reach_.begin;
}

/// Lets go of the object or, if nothing is held, moves the hand to its rest position: objects are
/// put back between trials, and the hand must not be in their way.
void Person::rest() noexcept {
    end_reach();
    action_.doing = Doing::nothing;
    if (grip_.holds()) {
        if (grip_.phase() != GripPhase::unload) grip_.release(now_, aim_);
        return;
    }
    cue_.trial = 0;  // the next state begins a new attempt
    const Aim goal = aim_.goal();
    aim_.add({start_.centre - goal.centre, start_.aperture - goal.aperture, 0}, now_, kRestTime);
    reach_.pushes.opposed = Vec3::Zero();
}

void Person::go_on(const Sight& sight) noexcept {
    if (answers_.is_due(now_)) {
        answers_.answer(traits_, plan_->states[static_cast<size_t>(cue_.phase - 1)],
                        {sight.hand, senses_.felt.centre()}, now_, draws_.others);
    }
    switch (action_.doing) {
        case Doing::nothing:
            try_again(sight);
            return;
        case Doing::waiting:
            if (now_ < action_.wait_until) return give_way();
            if (steps().empty()) {
                action_.doing = Doing::nothing;
            } else {
                begin_step(sight);
            }
            return;
        case Doing::preloading:
            if (grip_.phase() != GripPhase::preload) finish_step(sight);
            return;
        case Doing::loading:
            if (grip_.phase() == GripPhase::lifted) {
                move(action_.way, action_.duration, sight);
            } else if (!grip_.holds()) {
                finish_step(sight);
            }
            return;
        case Doing::releasing:
            if (!grip_.holds()) begin_step(sight);
            return;
        case Doing::moving:
            go_on_moving(sight);
            return;
    }
}

/// Repeats the steps if the hand did not move far enough for the trial to continue.
void Person::try_again(const Sight& sight) noexcept {
    const bool failed = !cue_.between && cue_.trial > 0 && cue_.phase == action_.state &&
                        now_ - action_.since > kRetry && !steps().empty() &&
                        steps().front().step.reach.index >= 0;
    if (!failed) return;
    action_.step = 0;
    begin_step(sight);
}

double Person::stiffness() const noexcept {
    return impedance_.stiffness + impedance_.stiffness_per_force * senses_.felt.force();
}

void Person::go_on_moving(const Sight& sight) noexcept {
    const bool closes = action_.way.aperture < 0 && senses_.felt.places().size() > 1;
    if (closes && !grip_.holds() && grip_.felt().held) {
        grip_.close(now_,
                    stiffness() * (senses_.felt.half_aperture() - aim_.at(now_).aperture / 2));
        action_.touched = senses_.felt.half_aperture();
        action_.doing = Doing::preloading;
        return;
    }
    if (now_ < aim_.end()) return;
    if (correct(sight)) return;
    if (grip_.phase() == GripPhase::lifted) grip_.carried();
    finish_step(sight);
}

void Person::finish_step(const Sight& sight) noexcept {
    end_reach();
    ++action_.step;
    if (action_.step < steps().size()) {
        begin_step(sight);
    } else {
        action_.doing = Doing::nothing;
        action_.since = now_;
    }
}

Vec3 Person::target(const Sight& sight, const TaskPlan::Step& step) const noexcept {
    const auto region = static_cast<size_t>(step.step.reach.index);
    // if the region was never seen, its planned position is used
    return senses_.targets.position(region, sight).value_or(numbers_.cell().p_W[region]) +
           numbers_.of(step.step.move);
}

void Person::begin_step(const Sight& sight) noexcept {
    const TaskPlan::Step& next = steps()[action_.step];
    action_.corrections = 0;
    const double aperture = grip_.holds() ? 2 * senses_.felt.half_aperture() : aim_.goal().aperture;
    const double wanted = next.step.aperture ? numbers_.of(*next.step.aperture) : aperture;
    if (grip_.phase() == GripPhase::preload) {
        action_.doing = Doing::waiting;  // waits until the fingers have settled
        return;
    }
    if (grip_.holds() && next.step.aperture && wanted > aperture + kOpening) {
        if (grip_.phase() != GripPhase::unload) grip_.release(now_, aim_);
        action_.doing = Doing::releasing;
        return;
    }
    Aim way;
    if (!grip_.holds()) way.aperture = wanted - aperture;
    if (next.step.reach.index >= 0) {
        way.centre = plan_reach(sight, target(sight, next));
    } else {
        way.centre = noisy(1, traits_.extent_noise) * numbers_.of(next.step.move);
    }
    const double duration = std::max(
        kShortest, noisy(traits_.tempo * numbers_.of(next.step.duration), traits_.tempo_noise));
    if (grip_.phase() == GripPhase::ready && way.centre.z() > kUpward) {
        grip_.lift(now_, aim_);
        action_.way = way;
        action_.duration = duration;
        action_.doing = Doing::loading;
        return;
    }
    move(way, duration, sight);
}

void Person::move(const Aim& way, double duration, const Sight& sight) noexcept {
    if (way.centre.norm() > kReach) {
        answers_.begin_movement({sight.hand, senses_.felt.centre()});
    }
    if (grip_.phase() == GripPhase::lifted && way.centre.norm() > kReach)
        grip_.carry(way.centre.normalized());
    action_.way = way;
    action_.doing = Doing::moving;
    const double up = way.centre.z();
    // a movement in two parts has no single direction that could be judged
    if (from_above(way.centre)) reach_.going = false;
    if (reach_.going) {
        reach_.begin = now_;
        reach_.duration = duration;
    } else {
        reach_.pushes.opposed = Vec3::Zero();
    }
    if (!from_above(way.centre)) {
        aim_.add(way, now_, duration);
        return;
    }
    const double part = kOverlap * duration;
    const Aim aside{way.centre - up * Vec3::UnitZ(), way.aperture, 0};
    const Aim upward{up * Vec3::UnitZ(), 0, 0};
    aim_.add(aside, now_, part, up > 0 ? duration - part : 0);
    aim_.add(upward, now_, part, up > 0 ? 0 : duration - part);
}

char Person::do_take_key() noexcept {
    return answers_.take_key();
}

}  // namespace dihaptic::person
