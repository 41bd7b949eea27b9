// The reaches of a simulated person: how they are planned, how noise makes them stray, how pushes
// are felt in them, how they are corrected, and what is learned from them. README.md has the
// equations.
#include <algorithm>
#include <cmath>

#include "person/person.h"

namespace dihaptic::person {
namespace {

using task::TaskPlan;

constexpr double kGlance = 0.15;      // share of a reach after which the person corrects it
constexpr double kLookError = 1.41;   // usual error of a look in two axes, in SD of one
constexpr double kJudged = 0.4;       // share of a reach after which its error is judged
constexpr double kSettled = 0.05;     // time from a stroke until its end is judged [s]
constexpr double kGoodEnough = 4e-3;  // distance from the target that is good enough [m]
constexpr int kMostCorrections = 4;
constexpr double kWorse = 1.2;     // factor of error growth at which the person gives up correcting
constexpr double kOver = 0.02;     // vertical distance above which the hand moves in two parts [m]
constexpr double kGuided = 0.4;    // ratio of such a movement's noise to a reach's
constexpr double kArmMass = 0.8;   // mass of an arm that the hand has to move with it [kg]
constexpr double kDrifts = 3e-3;   // speed above which the hand drifts rather than rests [m/s]
constexpr double kGiving = 0.04;   // time constant with which a waiting arm gives way [s]
constexpr double kPatience = 0.5;  // longest time for which the hand is awaited to be still [s]
constexpr double kJump = 4e-3;     // smallest jump of target or cursor that is answered [m]
constexpr double kClearPush = 0.3;   // mean push above which its time is clearly felt [N]
constexpr double kSeenJump = 0.01;   // time for which a jump is seen before it is answered [s]
constexpr int kMostJumps = 2;        // of one reach that are answered
constexpr double kRedirected = 0.3;  // shortest duration of the stroke that answers a jump [s]

Vec3 rotation_between(const Vec3& from, const Vec3& to) noexcept {
    const Vec3 axis = from.cross(to);
    const double sine = axis.norm();
    if (sine < 1e-12) return Vec3::Zero();
    return std::atan2(sine, from.dot(to)) / sine * axis;
}

Vec3 rotated(const Vec3& rotation, const Vec3& v) noexcept {
    const double angle = rotation.norm();
    if (angle < 1e-12) return v;
    return Eigen::AngleAxisd(angle, rotation / angle) * v;
}

}  // namespace

/// While a person waits to reach, the arm gives way to whatever holds the hand off its aim, such as
/// the walls of a channel that have just appeared, so that the reach begins without a force. A hand
/// that moves as the arm gives way is not held, and the arm keeps its aim.
void Person::give_way() noexcept {
    const bool reaches =
        action_.step < steps().size() && steps()[action_.step].step.reach.index >= 0;
    if (!reaches || grip_.holds() || senses_.felt.velocity().norm() > kDrifts || now_ < aim_.end())
        return;
    const Vec3 off = senses_.felt.centre() - aim_.at(now_).centre;
    aim_.shift({std::min(1.0, tick_ / kGiving) * off, 0, 0});
}

/// Whether the hand makes a movement in two parts: an open hand approaches objects from above and
/// moves upward to leave them, so that it does not sweep them away.
bool Person::from_above(const Vec3& displacement) const noexcept {
    return senses_.felt.places().size() > 1 && !grip_.holds() && std::abs(displacement.z()) > kOver;
}

/// The movement that the hand must make so that the display shows `displacement`, as far as the
/// person has learned this and shows it in this reach.
Vec3 Person::made_for(const Vec3& displacement) const noexcept {
    if (displacement.norm() < 1e-9) return displacement;
    const StateMemory& known = memories_.of(static_cast<size_t>(action_.state - 1));
    const Vec3 d = displacement.normalized();
    const Vec3 turn = reach_.shows * known.rotation.expected(d);
    return std::exp(-known.gain.expected(d)) * rotated(-turn, displacement);
}

/// Plans a reach from where the hand is seen to `goal`. Returns the hand's movement.
Vec3 Person::plan_reach(const Sight& sight, const Vec3& goal) noexcept {
    const Vec3 displacement = look(goal, traits_.visual_noise, draws_.others) -
                              look(senses_.hand(sight), traits_.visual_noise, draws_.others);
    if (displacement.norm() < kReach) return made_for(displacement);
    end_reach();
    const auto state = static_cast<size_t>(action_.state - 1);
    // a cursor that appeared later in the reach, the last time that it was hidden at first, will do
    // so again
    const bool unseen = !sight.hand_shown && !memories_.cursor_appears(state);
    reach_ = {.going = true,
              .hidden = !sight.hand_shown,
              .number = reach_.number + 1,
              .state = state,
              .shows = unseen ? traits_.unseen_share : 1,
              .from = senses_.hand(sight),
              .felt_from = senses_.felt_hand(),
              .goal = goal,
              .way = displacement};
    const Vec3 made = made_for(displacement);
    reach_.along = made.normalized();
    Pushes& pushes = reach_.pushes;
    pushes.expected = memory().force.expected(reach_.along);
    pushes.opposed = -(1 + traits_.force_noise * draws_.presses.normal()) * pushes.expected;
    pushes.lag = memory().force.lag();
    const Vec3 noise(draws_.others.normal(), draws_.others.normal(), draws_.others.normal());
    const double learned = memory().rotation.learned(displacement.normalized());
    const double sd = std::hypot(traits_.direction_noise, traits_.adapted_noise * learned) *
                      (from_above(displacement) ? kGuided : 1);
    const Vec3 way = noisy(1, traits_.extent_noise) * rotated(sd * noise, made);
    reach_.stray.whole = astray(way, goal - senses_.hand(sight));
    return way;
}

/// The part of a planned stroke that noise makes it stray aside. `displacement`: from the hand to
/// the target, as displayed.
Vec3 Person::astray(const Vec3& way, const Vec3& displacement) const noexcept {
    const Vec3 intended = made_for(displacement);
    const double length = intended.norm();
    return length < 1e-9 ? Vec3::Zero()
                         : Vec3(way - way.dot(intended) / (length * length) * intended);
}

/// Whether a force field pushes the handles or the object in the hand.
bool Person::pushed(const frame::Frame& frame) const noexcept {
    const auto bodies = static_cast<int>(frame.bodies.size());
    return std::any_of(
        frame.task.loads.begin(), frame.task.loads.end(), [&](const frame::LoadFrame& load) {
            return load.body >= bodies || (grip_.holds() && load.body == grip_.felt().body);
        });
}

/// The push that the strain of the hand reveals in this Frame. If the hand has never been pushed in
/// this state and is not being pushed now, small strains are attributed to the hand's own noise.
Strain Person::strain(const frame::Frame& frame) const noexcept {
    Strain out;
    out.hand = senses_.felt.centre();
    if (!reach_.going || reach_.duration == 0) return out;
    const double done = (now_ - reach_.begin) / reach_.duration;
    const double delayed = done - reach_.pushes.lag / reach_.duration;
    if (delayed >= 1 || (memory().force.empty() && !pushed(frame))) return out;
    const Aim aim = aim_.at(now_);
    const Aim rate = aim_.rate(now_);
    const Vec3 off =
        senses_.felt.centre() - aim.centre + reach_.stray.so_far - reach_.stray.followed;
    const Vec3 drift =
        senses_.felt.velocity() - rate.centre + reach_.stray.rate - reach_.stray.following;
    out.push_W = stiffness() * off + impedance_.damping * drift;
    if (grip_.holds()) {
        out.push_W -= grip_.inertial() / senses_.felt.fingers();
        out.push_W.z() = 0;  // the weight of an object has a memory of its own
    }
    // a push that the hand opposed is no longer felt, but it did act
    out.push_W -=
        aim_.rate(now_ - reach_.pushes.lag).centre.dot(reach_.along) * reach_.pushes.opposed;
    if (delayed > 0) out.speed = senses_.felt.velocity_before(reach_.pushes.lag).dot(reach_.along);
    out.time = now_ - reach_.begin;
    out.reach = reach_.number;
    return out;
}

/// Accumulates the push on the hand. Between trials, the push may end before the movement does.
void Person::feel_strain() noexcept {
    const Strain& felt = senses_.strains.before(traits_.visual_delay);
    if (!reach_.going || cue_.between || felt.reach != reach_.number) return;
    reach_.pushes.add(felt);
}

/// Learns how much later than expected the push of this reach came, if it was clearly felt.
void Person::learn_lag() noexcept {
    const Pushes& pushes = reach_.pushes;
    const double total = pushes.sum.norm();
    if (total < kClearPush * pushes.ticks || pushes.speeds <= 0) return;
    const double middle = pushes.timed.dot(pushes.sum) / (total * total);
    memory().force.learn_lag(middle - pushes.timed_speeds / pushes.speeds);
}

/// Moves the noise of a reach. It is a noise of the force that moves the arm, so that a hand that
/// nothing holds strays by s(t), but a hand that is held, as by the walls of a channel, presses
/// with no more than that force. With the arm's mass m, and the spring k and damper c between the
/// arm, which strays by z, and the hand, which follows by h,
///
///     m z'' = m s'' - k (z - h) - c (z' - h')        held_back = z - s
///
/// h is the hand's deviation from the way without noise, as far as it lies between 0 and z: the
/// rest was caused by something else.
void Person::stray() noexcept {
    Stray& stray = reach_.stray;
    const double most = stray.whole.norm();
    if (!reach_.going || reach_.duration == 0 || most == 0) return;
    const Vec3 aside = stray.whole / most;
    const model::MinimumJerk share = model::minimum_jerk((now_ - reach_.begin) / reach_.duration);
    const double rate = most * share.rate / reach_.duration;
    const double z = most * share.share + stray.held_back.dot(aside);
    const double z_rate = rate + stray.held_back_rate.dot(aside);
    const double off =
        most * share.share + (senses_.felt.centre() - aim_.at(now_).centre).dot(aside);
    const double off_rate = rate + (senses_.felt.velocity() - aim_.rate(now_).centre).dot(aside);
    const double h = std::clamp(off, std::min(0.0, z), std::max(0.0, z));
    const double h_rate = h == off ? off_rate : h == z ? z_rate : 0;
    stray.so_far = most * share.share * aside;
    stray.rate = rate * aside;
    stray.followed = h * aside;
    stray.following = h_rate * aside;
    if (now_ > reach_.begin + reach_.duration) {
        // the arm rests where its stroke has led, and gives way to what holds the hand elsewhere
        stray.held_back_rate.setZero();
        if (std::abs(senses_.felt.velocity().dot(aside)) < kDrifts)
            stray.held_back -= std::min(1.0, tick_ / kGiving) * (z - h) * aside;
        return;
    }
    const double holds = stiffness() * (z - h) + impedance_.damping * (z_rate - h_rate);
    stray.held_back_rate -= senses_.felt.fingers() * holds / kArmMass * tick_ * aside;
    stray.held_back += stray.held_back_rate * tick_;
}

/// Adds a stroke to the reach that makes up for a jump of the target or of the cursor.
void Person::redirect(const Vec3& displacement) noexcept {
    ++reach_.jumps;
    aim_.add({made_for(displacement), 0, 0}, now_, std::max(kRedirected, aim_.end() - now_));
    // a reach that was redirected does not tell how well it was planned
    reach_.mended = reach_.ended = true;
    if (!reach_.seen) reach_.pushed = reach_.pushes.moved > 0;
    reach_.seen = true;
}

/// Answers jumps of the target and of the cursor within a reach, once they have been seen for a
/// moment: what jumps as a trial ends needs no answer.
void Person::follow_jumps(const Sight& sight) noexcept {
    const Vec3 jump = senses_.take_jump(sight);
    if (!reach_.going || reach_.duration == 0 || action_.doing != Doing::moving || cue_.between)
        return;
    if (reach_.jumps >= kMostJumps) return;
    const bool cursor_jumps = sight.hand_shown && !senses_.cursor.is_held() && jump.norm() > kJump;
    if (cursor_jumps) reach_.cursor_off += jump;
    const Vec3 aside = target(sight, steps()[action_.step]) - reach_.goal;
    const bool off = aside.norm() > kJump || reach_.cursor_off != Vec3::Zero();
    if (!off) reach_.jumped_at = now_;
    if (!off || now_ < reach_.jumped_at + kSeenJump) return;
    redirect(aside - reach_.cursor_off);
    reach_.goal += aside;
    reach_.from += reach_.cursor_off;
    reach_.cursor_off = Vec3::Zero();
}

/// The share of an angle, seen at a distance, that the noise of sight does not explain: nothing is
/// corrected, and nothing is learned, because of an error that is no larger than this noise.
double Person::beyond_noise(double angle, double distance) const noexcept {
    const double noise = kLookError * traits_.visual_noise / distance;
    return std::max(0.0, 1 - std::pow(noise / std::max(angle, 1e-9), 2));
}

/// Corrects part of a reach's error as soon as its direction is visible, and judges the direction
/// before the effect of the correction becomes visible.
void Person::watch_reach(const Sight& sight) noexcept {
    if (!reach_.going || reach_.seen || !sight.hand_shown || shows_earlier_reach()) return;
    const Vec3 shown = sight.hand - reach_.from;
    const double length = reach_.way.norm();
    if (!reach_.mended && shown.norm() >= kGlance * length) {
        reach_.mended = true;
        const Vec3 arm = look(shown, traits_.visual_noise, draws_.others).normalized();
        const Vec3 missed = reach_.way - length * arm;
        const double left = std::max(kShortest, aim_.end() - now_);
        const double share =
            traits_.online_correction *
            beyond_noise(rotation_between(reach_.way / length, arm).norm(), shown.norm());
        if (action_.doing == Doing::moving && share > 0 && !senses_.cursor.is_held())
            aim_.add({share * made_for(missed), 0, 0}, now_, left);
    }
    if (shown.norm() < kJudged * length) return;
    reach_.seen = true;
    const Vec3 arm = look(shown, traits_.visual_noise, draws_.others);
    Vec3 wanted = reach_.way;
    reach_.pushed = reach_.pushes.moved > 0;  // later pushes belong to the next state
    if (reach_.pushed) {
        // a pushed hand is seen where it is felt to be, turned by the expected rotation
        const Vec3 felt = senses_.felt_where_shown() - reach_.felt_from;
        wanted = rotated(memory().rotation.expected(reach_.way.normalized()), felt);
    }
    const Vec3 error = rotation_between(wanted.normalized(), arm.normalized());
    reach_.error = beyond_noise(error.norm(), shown.norm()) * error;
}

/// When the first stroke of a reach has ended, judges the extent of the reach and learns from it. A
/// held cursor shows how far the hand had come when the cursor froze, not where the hand stopped.
void Person::judge_extent(const Sight& sight) noexcept {
    if (!reach_.going || reach_.ended || !sight.hand_shown || shows_earlier_reach()) return;
    reach_.ended = true;
    const double shown = look(sight.hand - reach_.from, traits_.visual_noise, draws_.others)
                             .dot(reach_.way.normalized());
    const double least = 0.1 * reach_.way.norm();  // shorter movements do not reveal the extent
    if (shown < least) return;
    const Vec3 d = reach_.way.normalized();
    double wanted = reach_.way.norm();
    if (reach_.pushed || senses_.cursor.is_held()) {
        const Vec3 felt = senses_.felt_where_shown() - reach_.felt_from;
        wanted = std::exp(memory().gain.expected(d)) * felt.norm();
        if (wanted < least) return;
    }
    memory().gain.learn(d, std::log(shown / wanted));
}

void Person::end_reach() noexcept {
    if (reach_.going && reach_.hidden) memories_.note_cursor(reach_.state, reach_.seen);
    if (reach_.going && reach_.seen) {
        memory().rotation.learn(reach_.way.normalized(), reach_.error);
        if (reach_.pushed) {
            memory().force.learn(
                reach_.along, reach_.pushes.impulse / reach_.pushes.moved - reach_.pushes.expected);
            learn_lag();
        }
    }
    aim_.shift({reach_.stray.held_back, 0, 0});
    reach_.stray.held_back = reach_.stray.held_back_rate = Vec3::Zero();
    reach_.going = false;
}

/// Corrects the visible endpoint of a reach with another stroke. Returns whether the reach
/// continues, either with a stroke or because its endpoint is not visible yet.
bool Person::correct(const Sight& sight) noexcept {
    const TaskPlan::Step& step = steps()[action_.step];
    if (step.step.reach.index < 0 || action_.corrections >= kMostCorrections) return false;
    const double still = std::min(senses_.felt.moved_at(), aim_.end() + kPatience);
    if (now_ < std::max(aim_.end() + kSettled, still) + traits_.visual_delay) return true;
    if (!sight.hand_shown) return false;  // a hidden hand is assumed to be at its goal
    judge_extent(sight);
    if (senses_.cursor.is_held()) return false;  // a held cursor does not follow the hand
    const Vec3 missed = look(target(sight, step) - sight.hand, traits_.visual_noise, draws_.others);
    if (missed.norm() < kGoodEnough) return false;
    // if the display rotates movements by more than 70 degrees, each stroke leads further away
    const bool worse = missed.norm() > std::max(kReach, kWorse * action_.missed);
    if (action_.corrections > 0 && worse && !reach_.pushed) return false;
    action_.missed = missed.norm();
    ++action_.corrections;
    aim_.add({made_for(missed), 0, 0}, now_, kShortest);
    return true;
}

}  // namespace dihaptic::person
