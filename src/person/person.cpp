#include "person/person.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

#include "hand/places.h"

namespace dihaptic::person {
namespace {

using task::TaskPlan;
using task::When;

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
constexpr double kDecision = 0.4;  // time to decide on an answer, after the reaction time [s]
constexpr double kFeelTime = 0.05;  // same as kFeelTime in hand/finger.h [s]
constexpr double kStill = 0.05;     // speed below which the hand is felt to be still [m/s]

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

RotationMemory rotation_memory(const Traits& traits) {
    return {traits.rotation(), traits.generalisation, {traits.fast_limit, traits.slow_limit}};
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
std::vector<GripMemory> looks_of(const scene::Scene& scene, size_t first, const Traits& traits,
                                 uint64_t seed) {
    std::vector<GripMemory> out;
    Random random(seed, fmt::format("looks to {}", traits.id));
    for (scene::Body body : scene.bodies) {
        GripMemory& look = out.emplace_back();
        const double misjudged = std::exp(traits.friction_error * random.normal());
        look.friction = misjudged * friction_of(scene, first, body);
        body.mass.reset();
        body.density = kUsualDensity;
        if (body.moves_at_all()) look.weight = kGravity * scene::mass(body);
    }
    return out;
}

/// The region to which the last reaching step of a state leads; -1 if there is none.
int reached_by(const std::vector<TaskPlan::Step>& steps) noexcept {
    int out = -1;
    for (const TaskPlan::Step& step : steps) {
        if (step.step.reach.index >= 0) out = step.step.reach.index;
    }
    return out;
}

/// For each state, the first state whose reaches lead to the same region. What is learned in one of
/// them shows in the others, e.g. in reaches without a cursor; but the movement back does not undo
/// what the movement there has taught.
std::vector<size_t> shared_memories(const std::vector<std::vector<TaskPlan::Step>>& steps) {
    std::vector<size_t> out;
    for (size_t i = 0; i < steps.size(); ++i) {
        const int region = reached_by(steps[i]);
        size_t first = i;
        for (size_t j = i; region >= 0 && j-- > 0;) {
            if (reached_by(steps[j]) == region) first = j;
        }
        out.push_back(first);
    }
    return out;
}

/// Whether the state waits for a key press.
bool asks(const TaskPlan::PlannedState& planned) noexcept {
    return std::any_of(planned.transitions.begin(), planned.transitions.end(),
                       [](const TaskPlan::Transition& transition) {
                           return transition.exit.when == When::key ||
                                  transition.exit.when == When::answered;
                       });
}

}  // namespace

Person::Person(const Traits& traits, const Situation& situation)
    : traits_(traits),
      plan_(situation.task),
      numbers_(*plan_),
      first_(first_finger(situation)),
      places_(own_places(situation)),
      impedance_(situation.hand.impedance),
      start_{places_.front().centre.value_or(situation.hand.centre),
             places_.front().aperture.value_or(situation.hand.aperture), 0},
      seed_(situation.seed),
      random_(seed_, fmt::format("person {}", traits.id)),
      lifts_(seed_, fmt::format("lifts of {}", traits.id)),
      presses_(seed_, fmt::format("presses of {}", traits.id)),
      eyes_(traits.visual_delay, first_, places_.size(), situation.tick),
      touch_(first_, sides_of(places_), frictions_of(situation.scene, first_), situation.tick),
      velocities_(ForceMemory::kLongestLag, situation.tick),
      strains_(traits.visual_delay, situation.tick),
      known_(plan_->task.regions.size(), Vec3::Zero()),
      cursor_(plan_->states),
      appears_(plan_->states.size(), 0),
      rotations_(plan_->states.size(), rotation_memory(traits)),
      gains_(plan_->states.size(), GainMemory(traits.gain())),
      forces_(plan_->states.size(), ForceMemory(traits.force(), traits.force_generalisation)),
      grip_(traits, looks_of(situation.scene, first_, traits, situation.seed), situation.tick) {
    for (const scene::Body& body : situation.scene.bodies) bodies_.push_back(body.name);
    for (const std::string& name : plan_->phases()) phases_.push_back({name, 0, 0});
    for (const TaskPlan::PlannedState& planned : plan_->states) {
        std::vector<TaskPlan::Step>& own = steps_.emplace_back(planned.hand);
        std::erase_if(own, [&](const auto& step) { return !step.moves(first_); });
    }
    memory_ = shared_memories(steps_);
    if (plan_->first_fingers.size() == 1 && places_.size() < situation.scene.fingers.size())
        other_.emplace(plan_, situation.hand, scene::finger_names(situation.scene));
    restart();
}

void Person::restart() {
    random_ = Random(seed_, fmt::format("person {}", traits_.id));
    lifts_ = Random(seed_, fmt::format("lifts of {}", traits_.id));
    presses_ = Random(seed_, fmt::format("presses of {}", traits_.id));
    if (other_) other_->restart();
    now_ = 0;
    eyes_.restart();
    touch_.restart();
    velocities_.clear();
    strains_.clear();
    grip_.restart();
    std::fill(appears_.begin(), appears_.end(), 0);
    std::fill(rotations_.begin(), rotations_.end(), rotation_memory(traits_));
    std::fill(gains_.begin(), gains_.end(), GainMemory(traits_.gain()));
    std::fill(forces_.begin(), forces_.end(),
              ForceMemory(traits_.force(), traits_.force_generalisation));
    recall_known();
    felt_ = 0;
    seen_ = 0;
    doing_ = Doing::nothing;
    aim_.rest(start_);
    numbers_.restart();
    trial_ = attempt_ = phase_ = acting_ = 0;
    between_ = true;
    since_ = wait_until_ = delay_ = 0;
    step_ = 0;
    corrections_ = 0;
    reach_ = {};
    moved_at_ = 0;
    velocity_ = off_felt_ = Vec3::Zero();
    answer_at_ = -1;
    key_ = 0;
    typed_at_ = typed_length_ = 0;
}

Learned Person::learned() const {
    Learned out;
    for (size_t i = 0; i < rotations_.size(); ++i) {
        const size_t m = memory_[i];
        out.states.push_back({plan_->task.states[i].name, rotations_[m], gains_[m], forces_[m]});
        out.states.back().rotation.sleep();
        out.states.back().force.sleep();
    }
    for (size_t i = 0; i < bodies_.size(); ++i) {
        const int body = static_cast<int>(i);
        out.bodies.push_back({bodies_[i], grip_.look(body).weight, grip_.memory(body)});
    }
    return out;
}

void Person::recall(Learned before) {
    before_ = std::move(before);
    restart();
}

void Person::recall_known() noexcept {
    for (const Learned::InState& known : before_.states) {
        for (size_t i = 0; i < rotations_.size(); ++i) {
            if (plan_->task.states[i].name != known.state) continue;
            rotations_[memory_[i]] = known.rotation;
            gains_[memory_[i]] = known.gain;
            forces_[memory_[i]] = known.force;
        }
    }
    constexpr double kAlike = 1e-9;  // [N]
    for (const Learned::OfBody& known : before_.bodies) {
        for (size_t i = 0; i < bodies_.size(); ++i) {
            const int body = static_cast<int>(i);
            if (bodies_[i] == known.body &&
                std::abs(grip_.look(body).weight - known.looks) < kAlike)
                grip_.recall(body, known.memory);
        }
    }
}

const std::vector<TaskPlan::Step>& Person::steps() const noexcept {
    return steps_[static_cast<size_t>(acting_ - 1)];
}

double Person::noisy(double value, double share) noexcept {
    return value * std::max(0.3, 1 + share * random_.normal());
}

hand::FingerTarget Person::do_target(int finger, double t) const noexcept {
    const size_t own = static_cast<size_t>(finger) - first_;
    if (own >= places_.size()) return other_ ? other_->target(finger, t) : hand::FingerTarget{};
    const hand::FingerPlace& place = places_[own];
    const Aim aim = aim_.at(t);
    const Aim rate = aim_.rate(t);
    hand::FingerTarget target;
    target.p_WT = aim.centre + place.offset;
    target.v_WT = rate.centre;
    target.p_WT += reach_.held_back;
    target.v_WT += reach_.held_back_rate;
    if (reach_.presses != Vec3::Zero()) {
        const double speed = aim_.rate(t - reach_.lag).centre.dot(reach_.along);
        target.p_WT += speed / stiffness() * reach_.presses;
    }
    if (!grip_.holds()) {
        target.p_WT += aim.aperture / 2 * place.side;
        target.v_WT += rate.aperture / 2 * place.side;
        return target;
    }
    // fingers press and carry with given forces: targets are off the handles by force / stiffness
    const double k = stiffness();
    const auto count = static_cast<double>(places_.size());
    // if an object yields under the fingers, they press less
    const double yields = std::clamp((touched_ - half_ - kYields) / kYields, 0.0, 1.0);
    target.p_WT += (half_ - (1 - yields) * grip_.squeeze() / k) * place.side;
    if (grip_.phase() == GripPhase::load) target.p_WT.z() = centre_.z() + place.offset.z();
    target.p_WT += (aim.load * Vec3::UnitZ() + grip_.inertial()) / (count * k);
    return target;
}

/// Feels where the hand is.
void Person::measure(const frame::Frame& frame) noexcept {
    const auto count = static_cast<double>(places_.size());
    centre_ = velocity_ = Vec3::Zero();
    double force = 0;
    for (size_t i = 0; i < places_.size(); ++i) {
        const frame::FingerFrame& finger = frame.fingers[first_ + i];
        centre_ += (finger.p_WH - places_[i].offset) / count;
        velocity_ += finger.v_WH / count;
        force += finger.f_sent_W.norm() / count;
    }
    tick_ = seconds(frame.time) - now_;
    now_ = seconds(frame.time);
    if (velocity_.norm() > kStill) moved_at_ = now_;
    felt_ += (force - felt_) * std::clamp(tick_ / kFeelTime, 0.0, 1.0);
    half_ = 0;
    for (size_t i = 0; i < places_.size(); ++i) {
        const Vec3& p_WH = frame.fingers[first_ + i].p_WH;
        half_ += (p_WH - places_[i].offset - centre_).dot(places_[i].side) / count;
    }
}

void Person::do_see(const frame::Frame& frame) noexcept {
    if (other_) other_->see(frame);
    eyes_.take(frame);
    measure(frame);
    stray();
    velocities_.add(velocity_);
    strains_.add(strain(frame));
    const bool held = grip_.holds();
    const bool loads = grip_.phase() == GripPhase::load;
    grip_.tick(now_, touch_.feel(frame), places_.front().side, aim_);
    // after opening, the hand continues from its current aperture
    if (held && !grip_.holds()) aim_.shift({Vec3::Zero(), 2 * half_ - aim_.at(now_).aperture, 0});
    if (loads && grip_.phase() != GripPhase::load)
        aim_.shift({(centre_.z() - aim_.at(now_).centre.z()) * Vec3::UnitZ(), 0, 0});
    const Sight& sight = eyes_.sight();
    follow_cues(sight);
    numbers_.follow(trial_, attempt_, frame.task.variables, phase_ - 1);
    feel_strain();
    follow_jumps(sight);
    watch_reach(sight);
    go_on(sight);
}

void Person::begin_attempt() noexcept {
    Grip::Trial lift;
    lift.latency = traits_.reflex_latency + traits_.reflex_noise * random_.normal();
    if (random_.uniform(0, 1) < traits_.slip_rate) lift.strength = kWeak;
    lift.misfelt = std::exp(traits_.friction_error * random_.normal());
    lift.strength *= std::exp(traits_.grip_noise * lifts_.normal());
    lift.slowness = std::exp(traits_.load_time_noise * lifts_.normal());
    grip_.set(lift);
    delay_ = 0;
    if (random_.uniform(0, 1) < traits_.hesitation_rate)
        delay_ = -traits_.hesitation_time * std::log(1 - random_.uniform(0, 1));
    if (random_.uniform(0, 1) < traits_.give_up_rate) delay_ = kGivingUp;
}

void Person::await_trial() noexcept {
    if (!between_) since_ = now_;
    between_ = true;
    if (now_ - since_ > kIdle && phase_ > 0 && trial_ != 0) rest();
}

void Person::see_targets(const Sight& sight) noexcept {
    for (size_t i = 0; i < known_.size(); ++i) {
        if ((sight.shown >> i & 1u) != 0) known_[i] = sight.target[i];
    }
    seen_ |= sight.shown;
}

/// Reacts to a new state, which is recognised by its targets and its message. If the new state
/// requires no movement, the current movement continues.
void Person::follow_cues(const Sight& sight) noexcept {
    if (sight.trial < 1 || sight.phase == task::kBetween) return await_trial();
    between_ = false;
    see_targets(sight);
    const bool new_attempt = sight.trial != trial_ || sight.attempt != attempt_;
    if (!new_attempt && sight.phase == phase_) return;
    cursor_.enter(sight.phase - 1, new_attempt, {now_ - traits_.visual_delay, felt_hand()});
    if (new_attempt) begin_attempt();
    trial_ = sight.trial;
    attempt_ = sight.attempt;
    phase_ = sight.phase;
    const double reaction = noisy(traits_.reaction_time, traits_.reaction_noise);
    const double begins = now_ + std::max(0.0, reaction - traits_.visual_delay) + delay_;
    delay_ = 0;
    const TaskPlan::PlannedState& planned = plan_->states[static_cast<size_t>(phase_ - 1)];
    answer_at_ = asks(planned) ? begins + kDecision : -1;
    rated_ = 0;
    if (!new_attempt && steps_[static_cast<size_t>(phase_ - 1)].empty()) return;
    end_reach();
    acting_ = phase_;
    step_ = 0;
    doing_ = Doing::waiting;
    since_ = now_;
    wait_until_ = begins;
}

/// Felt position of the hand at the time that the person currently sees.
const Vec3& Person::felt_hand() const noexcept {
    return strains_.before(traits_.visual_delay).hand;
}

/// Position of the hand as seen or, while the display holds the cursor, as felt.
const Vec3& Person::hand(const Sight& sight) const noexcept {
    return cursor_.is_held() ? felt_hand() : sight.hand;
}

/// Felt position of the hand at the time that the display shows, which is earlier if the cursor is
/// held.
const Vec3& Person::felt_where_shown() const noexcept {
    return cursor_.is_held() ? cursor_.shown().felt : felt_hand();
}

/// Whether the display still shows the hand before the start of the current reach.
bool Person::shows_earlier_reach() const noexcept {
    return cursor_.is_held() && cursor_.shown().time < reach_.begin;
}

/// Lets go of the object or, if nothing is held, moves the hand to its rest position: objects are
/// put back between trials, and the hand must not be in their way.
void Person::rest() noexcept {
    end_reach();
    doing_ = Doing::nothing;
    if (grip_.holds()) {
        if (grip_.phase() != GripPhase::unload) grip_.release(now_, aim_);
        return;
    }
    trial_ = 0;  // the next state begins a new attempt
    const Aim goal = aim_.goal();
    aim_.add({start_.centre - goal.centre, start_.aperture - goal.aperture, 0}, now_, kRestTime);
    reach_.presses = Vec3::Zero();
}

void Person::go_on(const Sight& sight) noexcept {
    if (answer_at_ >= 0 && now_ >= answer_at_) answer(sight);
    switch (doing_) {
        case Doing::nothing:
            try_again(sight);
            return;
        case Doing::waiting:
            if (now_ < wait_until_) return give_way();
            if (steps().empty()) {
                doing_ = Doing::nothing;
            } else {
                begin_step(sight);
            }
            return;
        case Doing::preloading:
            if (grip_.phase() != GripPhase::preload) finish_step(sight);
            return;
        case Doing::loading:
            if (grip_.phase() == GripPhase::lifted) {
                move(pending_, pending_time_, sight);
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
    const bool failed = !between_ && trial_ > 0 && phase_ == acting_ && now_ - since_ > kRetry &&
                        !steps().empty() && steps().front().step.reach.index >= 0;
    if (!failed) return;
    step_ = 0;
    begin_step(sight);
}

double Person::stiffness() const noexcept {
    return impedance_.stiffness + impedance_.stiffness_per_force * felt_;
}

void Person::go_on_moving(const Sight& sight) noexcept {
    const bool closes = pending_.aperture < 0 && places_.size() > 1;
    if (closes && !grip_.holds() && grip_.felt().held) {
        grip_.close(now_, stiffness() * (half_ - aim_.at(now_).aperture / 2));
        touched_ = half_;
        doing_ = Doing::preloading;
        return;
    }
    if (now_ < aim_.end()) return;
    if (correct(sight)) return;
    if (grip_.phase() == GripPhase::lifted) grip_.carried();
    finish_step(sight);
}

void Person::finish_step(const Sight& sight) noexcept {
    end_reach();
    ++step_;
    if (step_ < steps().size()) {
        begin_step(sight);
    } else {
        doing_ = Doing::nothing;
        since_ = now_;
    }
}

Vec3 Person::target(const Sight& sight, const TaskPlan::Step& step) const noexcept {
    const auto region = static_cast<size_t>(step.step.reach.index);
    const Vec3 move = numbers_.of(step.step.move);
    if ((sight.shown >> region & 1u) != 0) return sight.target[region] + move;
    if ((seen_ >> region & 1u) != 0) return known_[region] + move;
    // if the region was never seen, its planned position is used
    return numbers_.cell().p_W[region] + move;
}

void Person::begin_step(const Sight& sight) noexcept {
    const TaskPlan::Step& next = steps()[step_];
    corrections_ = 0;
    const double aperture = grip_.holds() ? 2 * half_ : aim_.goal().aperture;
    const double wanted = next.step.aperture ? numbers_.of(*next.step.aperture) : aperture;
    if (grip_.phase() == GripPhase::preload) {
        doing_ = Doing::waiting;  // waits until the fingers have settled
        return;
    }
    if (grip_.holds() && next.step.aperture && wanted > aperture + kOpening) {
        if (grip_.phase() != GripPhase::unload) grip_.release(now_, aim_);
        doing_ = Doing::releasing;
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
        pending_ = way;
        pending_time_ = duration;
        doing_ = Doing::loading;
        return;
    }
    move(way, duration, sight);
}

void Person::move(const Aim& way, double duration, const Sight& sight) noexcept {
    if (way.centre.norm() > kReach) {
        shown_from_ = sight.hand;
        felt_from_ = centre_;
    }
    if (grip_.phase() == GripPhase::lifted && way.centre.norm() > kReach)
        grip_.carry(way.centre.normalized());
    pending_ = way;
    doing_ = Doing::moving;
    const double up = way.centre.z();
    // a movement in two parts has no single direction that could be judged
    if (from_above(way.centre)) reach_.going = false;
    if (reach_.going) {
        reach_.begin = now_;
        reach_.duration = duration;
    } else {
        reach_.presses = Vec3::Zero();
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

/// Answers whether the last movement looked larger than it felt. Of the keys for which the state
/// waits, the first means yes and the second means no.
void Person::answer(const Sight& sight) noexcept {
    answer_at_ = -1;
    const TaskPlan::PlannedState& planned = plan_->states[static_cast<size_t>(phase_ - 1)];
    const TaskPlan::Questions& questions = planned.questions;
    if (!questions.items.empty() && questions.items.front().question.by != task::AnswerBy::cursor)
        return rate(questions);
    const double felt = (centre_ - felt_from_).norm();
    const double shown = (sight.hand - shown_from_).norm();
    const double evidence = felt > 0 && shown > 0 ? std::log(shown / felt) : 0;
    const bool yes = random_.uniform(0, 1) < traits_.answers().probability(evidence);
    char first = 0;
    char second = 0;
    for (const TaskPlan::Transition& transition : planned.transitions) {
        if (transition.exit.when != When::key) continue;
        if (first == 0) {
            first = transition.exit.key.front();
        } else if (second == 0) {
            second = transition.exit.key.front();
        }
    }
    key_ = yes || second == 0 ? first : second;
}

/// Types the simulated answer to the next question. Because there is no model of ratings, the
/// default is a random whole number on the question's scale. After the last question of a form,
/// presses Enter.
void Person::rate(const TaskPlan::Questions& questions) noexcept {
    if (rated_ == questions.items.size()) {
        key_ = task::Rating::kEnter;
        return;
    }
    const task::Question& question = questions.items[rated_++].question;
    if (questions.is_form) answer_at_ = now_ + kDecision;
    const double most = question.most < task::kMostMagnitude ? question.most : question.least + 100;
    const double random = std::clamp(
        std::ceil(random_.uniform(question.least - 1, std::floor(most))), question.least, most);
    const auto end = std::to_chars(typed_.data(), typed_.data() + task::Rating::kLongest,
                                   question.simulated.value_or(random), std::chars_format::fixed)
                         .ptr;
    *end = task::Rating::kEnter;
    typed_length_ = static_cast<size_t>(end - typed_.data()) + 1;
    typed_at_ = 0;
}

char Person::do_take_key() noexcept {
    if (typed_at_ < typed_length_) return typed_[typed_at_++];
    return std::exchange(key_, '\0');
}

}  // namespace dihaptic::person
