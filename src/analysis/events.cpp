#include "analysis/events.h"

#include <fmt/format.h>

#include <cmath>
#include <iterator>

#include "servo/settings.h"

namespace dihaptic::analysis {
namespace {

std::string listed(const std::vector<std::string>& names, int32_t i) {
    const auto at = static_cast<size_t>(i);
    return at < names.size() ? names[at] : std::to_string(i);
}

template <class E>
std::string choice(double value) {
    return std::string(enum_name(static_cast<E>(static_cast<int>(value))));
}

std::string number(double value) {
    return fmt::format("{:g}", value);
}

/// A setting that can be changed while a session runs.
struct Knob {
    const char* key;
    double (*of)(const servo::Frame& frame);  ///< value; an enum gives its index
    std::string (*said)(double value);
};
const Knob kKnobs[] = {
    {"coupling.kind", [](const servo::Frame& f) { return static_cast<double>(f.coupling); },
     choice<haptics::CouplingKind>},
    {"coupling.stiffness_N_m", [](const servo::Frame& f) { return f.stiffness; }, number},
    // the damping is NaN where it is k h / 2, and would look like a change in each tick
    {"coupling.damping_Ns_m",
     [](const servo::Frame& f) { return std::isnan(f.damping) ? -1 : f.damping; },
     [](double value) { return value < 0 ? "k h / 2" : number(value); }},
    {"coupling.smoothing", [](const servo::Frame& f) { return f.smoothing; }, number},
    {"dynamics.solver", [](const servo::Frame& f) { return static_cast<double>(f.solver); },
     choice<dynamics::Solver>},
    {"proxy.kind", [](const servo::Frame& f) { return static_cast<double>(f.proxy); },
     choice<scene::ProxyKind>},
    {"friction, times the scene's", [](const servo::Frame& f) { return f.friction_scale; }, number},
};

}  // namespace

EventFinder::EventFinder(const recording::LogHead& head, int object,
                         std::vector<std::string> phases)
    : head_(head),
      object_(object),
      phases_(std::move(phases)),
      touching_(head.fingers.size() * (head.bodies.size() + head.fingers.size()), 0),
      tuned_(std::size(kKnobs)) {}

std::string EventFinder::name(int body) const {
    const auto i = static_cast<size_t>(body);
    return i < head_.bodies.size() ? head_.bodies[i] : head_.fingers[i - head_.bodies.size()];
}

void EventFinder::add(const servo::Frame& frame) {
    add_trial(frame);
    add_task(frame);
    add_phase(frame);
    add_touches(frame);
    add_support(frame);
    add_settings(frame);
    seen_ = true;
    add_status(frame);
}

void EventFinder::say(const servo::Frame& frame, const char* what, std::string detail) {
    events_.push_back({frame.sequence, seconds(frame.time), frame.trial, what, std::move(detail)});
}

void EventFinder::add_trial(const servo::Frame& frame) {
    // a task's trial begins with its first state: before it, the last trial's feedback is shown
    const bool begun = frame.phase > 0 || frame.task.attempt == 0;
    if (!begun || (frame.trial == trial_ && frame.task.attempt == attempt_)) return;
    trial_ = frame.trial;
    attempt_ = frame.task.attempt;
    if (attempt_ > 0) say(frame, "trial", fmt::format("attempt {}", attempt_));
}

void EventFinder::add_task(const servo::Frame& frame) {
    const servo::TaskFrame& task = frame.task;
    const bool perturbed = !(task.visual.empty() && task.properties.empty() && task.loads.empty());
    if (perturbed != perturbed_) say(frame, "perturbation", perturbed ? "on" : "off");
    perturbed_ = perturbed;
    if (task.marker != 0) say(frame, "marker", std::to_string(task.marker));
    if (task.message != message_ && task.message >= 0)
        say(frame, "message", listed(head_.messages, task.message));
    message_ = task.message;
    if (!task.placements.empty())
        say(frame, "put back", fmt::format("{} bodies", task.placements.size()));
    if (task.outcome >= 0) say(frame, "outcome", listed(head_.outcomes, task.outcome));
}

void EventFinder::add_phase(const servo::Frame& frame) {
    if (frame.phase == phase_) return;
    phase_ = frame.phase;
    say(frame, "phase", listed(phases_, phase_));
}

void EventFinder::add_touches(const servo::Frame& frame) {
    const size_t bodies = head_.bodies.size();
    const size_t all = bodies + head_.fingers.size();
    now_touching_.assign(touching_.size(), 0);
    for (const servo::ContactFrame& contact : frame.contacts) {
        if (contact.normal_force <= 0) continue;
        const auto a = static_cast<size_t>(contact.a);
        const auto b = static_cast<size_t>(contact.b);
        if (a >= bodies) now_touching_[(a - bodies) * all + b] = 1;
        if (b >= bodies) now_touching_[(b - bodies) * all + a] = 1;
    }
    for (size_t i = 0; i < touching_.size(); ++i) {
        if (now_touching_[i] == touching_[i]) continue;
        say(frame, now_touching_[i] ? "touch" : "release",
            head_.fingers[i / all] + " " + name(static_cast<int>(i % all)));
    }
    std::swap(touching_, now_touching_);
}

bool EventFinder::on_support(const servo::Frame& frame) const {
    const size_t bodies = head_.bodies.size();
    for (const servo::ContactFrame& contact : frame.contacts) {
        if (contact.normal_force <= 0) continue;
        const bool of_object = contact.a == object_ || contact.b == object_;
        const bool of_bodies =
            static_cast<size_t>(contact.a) < bodies && static_cast<size_t>(contact.b) < bodies;
        if (of_object && of_bodies) return true;
    }
    return false;
}

void EventFinder::add_support(const servo::Frame& frame) {
    // an object asleep on its support has no contacts in the frame, and has not moved either
    if (object_ < 0 || !frame.bodies[static_cast<size_t>(object_)].awake) return;
    const bool supported = on_support(frame);
    if (seen_ && supported_ && !supported) say(frame, "lift-off", name(object_));
    if (seen_ && !supported_ && supported) say(frame, "replaced", name(object_));
    supported_ = supported;
}

void EventFinder::add_settings(const servo::Frame& frame) {
    for (size_t i = 0; i < tuned_.size(); ++i) {
        const Knob& knob = kKnobs[i];
        const double value = knob.of(frame);
        Tuned& tuned = tuned_[i];
        if (!seen_) tuned = {value, value};  // the first ticks may be lost
        // a change that is eased in is reported once the value has stopped changing
        if (value == tuned.last && value != tuned.told) {
            say(frame, "setting",
                fmt::format("{}: {} -> {}", knob.key, knob.said(tuned.told), knob.said(value)));
            tuned.told = value;
        }
        tuned.last = value;
    }
}

void EventFinder::add_status(const servo::Frame& frame) {
    if ((frame.status & servo::kPaused) != 0) say(frame, "paused", "force off");
    if ((frame.status & servo::kResumed) != 0) say(frame, "went on", "after a pause");
    constexpr uint32_t kLimits = ~uint32_t{servo::kPaused | servo::kResumed};
    servo::for_each_status(frame.status & ~status_ & kLimits, [&](servo::Status bit) {
        say(frame, "limit", servo::describe(bit).what);
    });
    status_ = frame.status;
}

}  // namespace dihaptic::analysis
