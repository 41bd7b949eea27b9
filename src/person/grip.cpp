#include "person/grip.h"

#include <algorithm>

#include "model/grasp.h"

namespace dihaptic::person {
namespace {

constexpr double kLongestLatency = 0.3;  // [s]
constexpr double kMuscle = 0.02;         // time constant of grip force [s]
constexpr double kAimedAbove = 1.1;      // ratio of the intended load force to the expected weight
constexpr double kRise =
    1.5e-3;  // upward speed of the fingertips above which the object counts as lifted off [m/s]
constexpr double kProbe = 0.1;        // interval between increases of the load force [s]
constexpr double kProbeShare = 0.35;  // size of an increase, as a share of the expected weight
constexpr double kLeastProbe = 0.3;   // smallest increase [N]
constexpr double kStrongest = 40;     // intended load force above which it is not increased [N]
constexpr double kPeakTime = 0.1;     // time from lift-off until peak grip decays [s]
constexpr double kPeakDecay = 0.25;   // time constant of the decay of peak grip [s]
constexpr double kUnload = 0.25;      // duration of the unload phase [s]
constexpr double kWeighing = 0.3;     // time constant of weight perception [s]
constexpr double kCorrection = 0.15;  // time to adjust the load force to the felt weight [s]
constexpr double kWeighed = 0.3;      // holding time after which the weight is remembered [s]
constexpr double kSurprise =
    1.15;  // ratio of the grip for the felt load to the planned grip that triggers a response
constexpr double kReplaced =
    0.7;                        // share of the weight below which the object must rest on something
constexpr double kTrust = 0.1;  // share of the uncertainty about friction that a lift removes
constexpr double kReflex = 1.15;        // factor by which a slip increases the grip
constexpr double kStrongestReflex = 2;  // largest increase by slips in one hold, as a factor
constexpr double kReflexTime = 0.15;    // time after which another slip is answered separately [s]
constexpr double kDoubt = 0.6;          // smallest friction inferred from a slip, as a ratio
constexpr double kMovement = 0.1;  // integral of a^2 from which on a mass is inferred [m^2/s^3]

Vec3 up() {
    return Vec3::UnitZ();
}

}  // namespace

Grip::Grip(const Traits& traits, BodyMemories memories, double tick)
    : traits_(traits), memories_(std::move(memories)), tick_(tick), past_(kLongestLatency, tick) {}

void Grip::restart(const std::vector<Learned::OfBody>& before) noexcept {
    memories_.restart(before);
    past_.clear();
    end();
}

void Grip::set(const Trial& trial) noexcept {
    trial_ = trial;
    trial_.latency = std::clamp(trial.latency, 0.0, kLongestLatency);
}

void Grip::end() noexcept {
    phase_ = GripPhase::open;
    squeeze_ = weight_ = 0;
    weighed_ = false;
    inertial_ = along_ = Vec3::Zero();
}

/// Remembers the felt weight, if the object was held long enough. A lift also removes some of the
/// uncertainty about the friction of the surface.
void Grip::remember() noexcept {
    if (!weighed_) return;
    weighed_ = false;
    memory().lifted(weight_, traits_.weight_learning);
    const double looks = memories_.looks(body_).friction;
    memory().friction += kTrust * (looks - memory().friction);
}

void Grip::close(double now, double grip) noexcept {
    phase_ = GripPhase::preload;
    since_ = touched_ = now;
    squeeze_ = hold_ = std::max(grip, traits_.least_grip);
    body_ = std::max(0, felt().body);
}

void Grip::lift(double now, Strokes& aim) noexcept {
    const double weight = memory().weight;
    const double duration = trial_.slowness * (traits_.load_time + traits_.load_time_rise * weight);
    aim.add({Vec3::Zero(), 0, kAimedAbove * weight - aim.goal().load}, now, duration);
    phase_ = GripPhase::load;
    since_ = now;
    probe_ = now + duration + trial_.latency;
}

void Grip::release(double now, Strokes& aim) noexcept {
    remember();
    aim.add({Vec3::Zero(), 0, -aim.goal().load}, now, kUnload);
    hold_ = squeeze_;
    phase_ = GripPhase::unload;
    since_ = now;
}

void Grip::carry(const Vec3& u) noexcept {
    along_ = u;
    push_ = moved_ = 0;
}

void Grip::carried() noexcept {
    if (moved_ * tick_ > kMovement) memory().carried(along_, push_ / moved_, traits_.mass());
    along_ = Vec3::Zero();
}

/// Grip force needed for a force on the object, including the safety margin. A force along the
/// grasp axis unloads one of the fingers.
double Grip::needed(const Vec3& force_W, const Vec3& axis) const noexcept {
    const double along = force_W.dot(axis);
    const double across = (force_W - along * axis).norm();
    const double friction = memories_.of(body_).friction;
    return model::grip_with_margin(across, friction, traits_.safety_margin) + std::abs(along) / 2;
}

bool Grip::lost(double now) const noexcept {
    return !felt().held && now - since_ > trial_.latency && phase_ != GripPhase::unload;
}

void Grip::feel_skin(double now, const Feeling& newest) noexcept {
    // the newest sample instead of felt(), because skin_time is itself the delay of the skin, and
    // touched_ already lags by trial_.latency
    if (traits_.skin_time > 0 && newest.body == body_ &&
        now - touched_ + trial_.latency > traits_.skin_time)
        memory().friction = trial_.misfelt * newest.friction;
}

void Grip::answer_slip(double now) noexcept {
    if (!carries() || !felt().slips || felt().body != body_ || now <= reflex_) return;
    const double known = memory().friction;
    const double told = std::max(felt().slip_friction, kDoubt * known);
    if (felt().slip_friction > 0 && told < known) memory().friction = told;
    trial_.strength = std::min(kStrongestReflex, std::max(1.0, trial_.strength) * kReflex);
    reflex_ = now + kReflexTime;
}

/// Detects that the object has lifted off, that it needs more load force to lift off, or that it
/// rests on something again.
void Grip::watch_lift(double now, Strokes& aim) noexcept {
    const double carried = felt().force_W.dot(up());
    if (phase_ == GripPhase::load && felt().rise > kRise) {
        phase_ = GripPhase::lifted;
        since_ = now;
        weight_ = carried;
        aim.add({Vec3::Zero(), 0, weight_ - aim.goal().load}, now, kCorrection);
    } else if (phase_ == GripPhase::load && now > probe_ && aim.goal().load < kStrongest) {
        const double more = std::max(kLeastProbe, kProbeShare * memory().weight);
        aim.add({Vec3::Zero(), 0, more}, now, kProbe);
        probe_ = now + kProbe;
    }
    if (phase_ == GripPhase::lifted && weighed_ && carried < kReplaced * weight_) {
        remember();
        phase_ = GripPhase::ready;
        since_ = now;
    }
}

void Grip::weigh(double now, Strokes& aim) noexcept {
    weight_ += (felt().force_W.dot(up()) - weight_) * tick_ / kWeighing;
    if (weighed_ || now - since_ <= kWeighed) return;
    weighed_ = true;
    aim.add({Vec3::Zero(), 0, weight_ - aim.goal().load}, now, kCorrection);
}

/// While the object is carried, accumulates evidence about its mass.
void Grip::feel_mass(const Feeling& newest) noexcept {
    if (along_ == Vec3::Zero()) return;
    const double a = newest.acceleration_W.dot(along_);
    push_ += (newest.force_W - weight_ * up()).dot(along_) * a;
    moved_ += a * a;
}

/// Desired grip force of each finger [N]: the force planned for the expected object at this load
/// force or, if the felt load clearly requires a larger force, the force for that load.
double Grip::wanted(double now, double load, const Vec3& axis) const noexcept {
    Vec3 expected = load * up();
    double peak = 1;
    if (phase_ == GripPhase::load) {
        peak = traits_.peak_grip;
        expected /= kAimedAbove;  // the intended load is larger than the expected weight
    }
    if (phase_ == GripPhase::lifted) {
        expected += inertial_;
        const double late = std::max(0.0, now - since_ - kPeakTime);
        peak = 1 + (traits_.peak_grip - 1) * std::exp(-late / kPeakDecay);
    }
    double grip = trial_.strength * peak * needed(expected, axis);
    if (carries()) {
        const double surprise = trial_.strength * needed(felt().force_W, axis);
        if (surprise > kSurprise * grip) grip = surprise;
    }
    return std::max(grip, phase_ == GripPhase::lifted ? traits_.least_grip : hold_);
}

void Grip::tick(double now, const Feeling& newest, const Vec3& axis, Strokes& aim) noexcept {
    past_.add(newest);
    if (phase_ == GripPhase::open) return;
    if (phase_ == GripPhase::preload && now - since_ >= traits_.preload_time - trial_.latency)
        phase_ = GripPhase::ready;
    if (lost(now)) {
        aim.add({Vec3::Zero(), 0, -aim.goal().load}, now, kUnload);
        end();
        return;
    }
    feel_skin(now, newest);
    answer_slip(now);
    watch_lift(now, aim);

    const double load = aim.at(now).load;
    inertial_ = Vec3::Zero();
    if (phase_ == GripPhase::lifted) {
        weigh(now, aim);
        inertial_ = memory().inertial(aim.acceleration(now));
        feel_mass(newest);
    }
    double grip = 0;
    if (phase_ != GripPhase::unload) {
        grip = wanted(now, load, axis);
    } else if (now - since_ < kUnload) {
        grip = hold_ * (1 - model::minimum_jerk((now - since_) / kUnload).share);
    } else {
        end();
        return;
    }
    squeeze_ += (grip - squeeze_) * std::min(1.0, tick_ / kMuscle);
}

}  // namespace dihaptic::person
