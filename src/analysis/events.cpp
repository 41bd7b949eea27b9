#include "analysis/events.h"

namespace dihaptic::analysis {

EventFinder::EventFinder(const recording::LogHead& head, int object,
                         std::vector<std::string> phases)
    : head_(head),
      object_(object),
      phases_(std::move(phases)),
      touching_(head.fingers.size() * (head.bodies.size() + head.fingers.size()), 0) {}

std::string EventFinder::name(int body) const {
    const auto i = static_cast<size_t>(body);
    return i < head_.bodies.size() ? head_.bodies[i] : head_.fingers[i - head_.bodies.size()];
}

void EventFinder::add(const servo::Frame& frame) {
    const double now = seconds(frame.time);
    const auto say = [&](const char* what, std::string detail) {
        events_.push_back({now, frame.trial, what, std::move(detail)});
    };

    if (frame.phase != phase_) {
        phase_ = frame.phase;
        const auto i = static_cast<size_t>(phase_);
        say("phase", i < phases_.size() ? phases_[i] : std::to_string(phase_));
    }
    const size_t bodies = head_.bodies.size();
    const size_t all = bodies + head_.fingers.size();
    std::vector<char> touching(touching_.size(), 0);
    bool on_support = false;
    for (const servo::ContactFrame& contact : frame.contacts) {
        if (contact.normal_force <= 0) continue;
        const auto a = static_cast<size_t>(contact.a);
        const auto b = static_cast<size_t>(contact.b);
        if (a >= bodies) touching[(a - bodies) * all + b] = 1;
        if (b >= bodies) touching[(b - bodies) * all + a] = 1;
        const bool of_object = contact.a == object_ || contact.b == object_;
        if (of_object && a < bodies && b < bodies) on_support = true;
    }
    for (size_t i = 0; i < touching.size(); ++i) {
        if (touching[i] == touching_[i]) continue;
        say(touching[i] ? "touch" : "release",
            head_.fingers[i / all] + " " + name(static_cast<int>(i % all)));
    }
    touching_ = std::move(touching);
    // an object asleep on its support has no contacts in the frame, and has not moved either
    const bool asleep = object_ >= 0 && !frame.bodies[static_cast<size_t>(object_)].awake;
    if (object_ >= 0 && !asleep) {
        if (seen_ && supported_ && !on_support) say("lift-off", name(object_));
        if (seen_ && !supported_ && on_support) say("replaced", name(object_));
        supported_ = on_support;
    }
    seen_ = true;
    for (int bit = 0; bit < servo::kStatusBits; ++bit) {
        const auto flag = static_cast<servo::Status>(1u << bit);
        if ((frame.status & flag) != 0 && (status_ & flag) == 0)
            say("limit", servo::describe(flag).what);
    }
    status_ = frame.status;
}

}  // namespace dihaptic::analysis
