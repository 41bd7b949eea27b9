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

/// What can be changed while a session runs, as settings have it.
struct Knob {
    const char* key;
    double (*of)(const servo::Frame& frame);  ///< enums by their index
    std::string (*said)(double value);
};
const Knob kKnobs[] = {
    {"coupling.kind", [](const servo::Frame& f) { return static_cast<double>(f.coupling); },
     choice<haptics::CouplingKind>},
    {"coupling.stiffness_N_m", [](const servo::Frame& f) { return f.stiffness; }, number},
    // not a number where it is k h / 2, which would look like a change in each tick
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
    const double now = seconds(frame.time);
    const auto say = [&](const char* what, std::string detail) {
        events_.push_back({frame.sequence, now, frame.trial, what, std::move(detail)});
    };

    // a task's trials begin with their first state: before it the last one's feedback is seen
    const bool begun = frame.phase > 0 || frame.task.attempt == 0;
    if (begun && (frame.trial != trial_ || frame.task.attempt != attempt_)) {
        trial_ = frame.trial;
        attempt_ = frame.task.attempt;
        if (attempt_ > 0) say("trial", fmt::format("attempt {}", attempt_));
    }
    const servo::TaskFrame& task = frame.task;
    const bool perturbed = !(task.visual.empty() && task.properties.empty() && task.loads.empty());
    if (perturbed != perturbed_) say("perturbation", perturbed ? "on" : "off");
    perturbed_ = perturbed;
    if (task.marker != 0) say("marker", std::to_string(task.marker));
    if (task.message != message_ && task.message >= 0)
        say("message", listed(head_.messages, task.message));
    message_ = task.message;
    if (!task.placements.empty()) say("put back", fmt::format("{} bodies", task.placements.size()));
    if (task.outcome >= 0) say("outcome", listed(head_.outcomes, task.outcome));
    if (frame.phase != phase_) {
        phase_ = frame.phase;
        const auto i = static_cast<size_t>(phase_);
        say("phase", i < phases_.size() ? phases_[i] : std::to_string(phase_));
    }
    const size_t bodies = head_.bodies.size();
    const size_t all = bodies + head_.fingers.size();
    now_touching_.assign(touching_.size(), 0);
    bool on_support = false;
    for (const servo::ContactFrame& contact : frame.contacts) {
        if (contact.normal_force <= 0) continue;
        const auto a = static_cast<size_t>(contact.a);
        const auto b = static_cast<size_t>(contact.b);
        if (a >= bodies) now_touching_[(a - bodies) * all + b] = 1;
        if (b >= bodies) now_touching_[(b - bodies) * all + a] = 1;
        const bool of_object = contact.a == object_ || contact.b == object_;
        if (of_object && a < bodies && b < bodies) on_support = true;
    }
    for (size_t i = 0; i < touching_.size(); ++i) {
        if (now_touching_[i] == touching_[i]) continue;
        say(now_touching_[i] ? "touch" : "release",
            head_.fingers[i / all] + " " + name(static_cast<int>(i % all)));
    }
    std::swap(touching_, now_touching_);
    // an object asleep on its support has no contacts in the frame, and has not moved either
    const bool asleep = object_ >= 0 && !frame.bodies[static_cast<size_t>(object_)].awake;
    if (object_ >= 0 && !asleep) {
        if (seen_ && supported_ && !on_support) say("lift-off", name(object_));
        if (seen_ && !supported_ && on_support) say("replaced", name(object_));
        supported_ = on_support;
    }
    for (size_t i = 0; i < tuned_.size(); ++i) {
        const Knob& knob = kKnobs[i];
        const double value = knob.of(frame);
        Tuned& tuned = tuned_[i];
        if (!seen_) tuned = {value, value};  // the first ticks may be lost
        // what is eased in is told of when it has arrived
        if (value == tuned.last && value != tuned.told) {
            say("setting",
                fmt::format("{}: {} -> {}", knob.key, knob.said(tuned.told), knob.said(value)));
            tuned.told = value;
        }
        tuned.last = value;
    }
    seen_ = true;
    if ((frame.status & servo::kPaused) != 0) say("paused", "force off");
    if ((frame.status & servo::kResumed) != 0) say("went on", "after a pause");
    uint32_t begun_limits = frame.status & ~status_ & ~(servo::kPaused | servo::kResumed);
    for (; begun_limits != 0; begun_limits &= begun_limits - 1) {
        const uint32_t lowest = begun_limits & ~(begun_limits - 1);
        say("limit", servo::describe(static_cast<servo::Status>(lowest)).what);
    }
    status_ = frame.status;
}

}  // namespace dihaptic::analysis
