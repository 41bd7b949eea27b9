#include "analysis/events.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/number.h"
#include "base/unit.h"
#include "frame/shown_texts.h"

namespace dihaptic::analysis {
namespace {

std::string listed(const std::vector<std::string>& names, int32_t i) {
    const auto at = static_cast<size_t>(i);
    return at < names.size() ? names[at] : number_text(i);
}

}  // namespace

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

void EventFinder::add(const frame::Frame& frame) {
    add_trial(frame);
    add_task(frame);
    add_answers(frame);
    add_phase(frame);
    add_touches(frame);
    add_support(frame);
    add_settings(frame);
    seen_ = true;
    add_status(frame);
}

void EventFinder::say(const frame::Frame& frame, const char* what, std::string detail) {
    events_.push_back({frame.sequence, seconds(frame.time), frame.trial, what, std::move(detail)});
}

void EventFinder::add_trial(const frame::Frame& frame) {
    // a task's trial begins with its first state; until then, the last trial's feedback is shown
    const bool begun = frame.phase > 0 || frame.task.attempt == 0;
    if (!begun || (frame.trial == trial_ && frame.task.attempt == attempt_)) return;
    trial_ = frame.trial;
    attempt_ = frame.task.attempt;
    if (attempt_ > 0) say(frame, "trial", fmt::format("attempt {}", attempt_));
}

void EventFinder::add_task(const frame::Frame& frame) {
    const frame::TaskFrame& task = frame.task;
    const bool perturbed = task.perturbed();
    if (perturbed != perturbed_) say(frame, "perturbation", perturbed ? "on" : "off");
    perturbed_ = perturbed;
    if (task.marker != 0) say(frame, "marker", number_text(task.marker));
    add_texts(frame);
    add_sounds(frame);
    if (task.placements.size() > placed_)  // a body held in place is placed again in each tick
        say(frame, "put back", fmt::format("{} bodies", task.placements.size()));
    placed_ = task.placements.size();
    if (task.outcome >= 0) say(frame, "outcome", listed(head_.outcomes, task.outcome));
}

void EventFinder::add_sounds(const frame::Frame& frame) {
    for (const frame::SoundFrame& sound : frame.task.sounds)
        say(frame, sound.on != 0 ? "sound" : "sound ends", listed(head_.sounds, sound.sound));
}

void EventFinder::add_texts(const frame::Frame& frame) {
    const frame::TaskFrame& task = frame.task;
    if (task.page != page_ && task.page >= 0) say(frame, "page", listed(head_.pages, task.page));
    page_ = task.page;
    lines_.resize(task.lines.size(), -1);
    bool changed = task.message != message_;
    for (size_t i = 0; i < lines_.size(); ++i) changed |= task.lines[i].message != lines_[i];
    if (!changed) return;
    const std::vector<std::string> texts = frame::shown_texts(task, head_.messages);
    const size_t first = task.message >= 0 ? 1 : 0;
    if (first > 0 && task.message != message_) say(frame, "message", texts.front());
    message_ = task.message;
    const std::vector<int32_t> before = lines_;
    for (size_t i = 0; i < lines_.size(); ++i) {
        lines_[i] = task.lines[i].message;
        if (std::find(before.begin(), before.end(), lines_[i]) == before.end())
            say(frame, "line", texts[first + i]);
    }
}

/// Answers are reported when their state ends, because they can change until then.
void EventFinder::add_answers(const frame::Frame& frame) {
    const bool ended = frame.phase != phase_ || frame.task.outcome >= 0;
    const size_t first = head_.variables.size() + head_.levels.size();
    answers_.resize(head_.answers.size(), kUnmeasured);
    for (size_t i = 0; i < answers_.size() && first + i < frame.task.variables.size(); ++i) {
        const double answer = frame.task.variables[first + i].value;
        if (std::isnan(answer)) answers_[i] = answer;  // the question is being asked again
        if (!ended || std::isnan(answer) || answer == answers_[i]) continue;
        answers_[i] = answer;
        const std::string& name = head_.answers[i];
        std::string what = fmt::format("{} {:g}", name, answer / split_unit(name).si);
        const auto state =
            static_cast<size_t>((frame.task.outcome >= 0 ? frame.phase : phase_) - 1);
        if (state < head_.forms.size() && !head_.forms[state].empty())
            what += "; " + head_.forms[state];
        say(frame, "answer", std::move(what));
    }
}

void EventFinder::add_phase(const frame::Frame& frame) {
    if (frame.phase == phase_) return;
    phase_ = frame.phase;
    say(frame, "phase", listed(phases_, phase_));
}

void EventFinder::add_touches(const frame::Frame& frame) {
    const size_t bodies = head_.bodies.size();
    const size_t all = bodies + head_.fingers.size();
    now_touching_.assign(touching_.size(), 0);
    for (const frame::ContactFrame& contact : frame.contacts) {
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

bool EventFinder::on_support(const frame::Frame& frame) const {
    const size_t bodies = head_.bodies.size();
    for (const frame::ContactFrame& contact : frame.contacts) {
        if (contact.normal_force <= 0) continue;
        const bool of_object = contact.a == object_ || contact.b == object_;
        const bool of_bodies =
            static_cast<size_t>(contact.a) < bodies && static_cast<size_t>(contact.b) < bodies;
        if (of_object && of_bodies) return true;
    }
    return false;
}

void EventFinder::add_support(const frame::Frame& frame) {
    // an object asleep on its support has no contacts in the frame and does not move
    if (object_ < 0 || !frame.bodies[static_cast<size_t>(object_)].awake) return;
    const bool supported = on_support(frame);
    if (seen_ && supported_ && !supported) say(frame, "lift-off", name(object_));
    if (seen_ && !supported_ && supported) say(frame, "replaced", name(object_));
    supported_ = supported;
}

void EventFinder::add_settings(const frame::Frame& frame) {
    if (!seen_) told_ = last_ = frame;  // the first ticks may be missing from the log
    frame::Knobs::visit([&](auto knob, const frame::Knob& is) {
        const auto value = frame.*knob;
        auto& told = told_.*knob;
        // a gradual change is reported once the value has stopped changing
        const bool stays = frame::Knobs::same(value, last_.*knob);
        if (is.key == nullptr || !stays || frame::Knobs::same(value, told)) return;
        say(frame, "setting",
            fmt::format("{}: {} -> {}", is.key, words(is, told), words(is, value)));
        told = value;
    });
    last_ = frame;
}

void EventFinder::add_status(const frame::Frame& frame) {
    if ((frame.status & kPaused) != 0) say(frame, "paused", "force off");
    if ((frame.status & kResumed) != 0) say(frame, "went on", "after a pause");
    constexpr uint32_t kLimits = ~uint32_t{kPaused | kResumed};
    for_each_status(frame.status & ~status_ & kLimits,
                    [&](Status bit) { say(frame, "limit", std::string(describe(bit).what)); });
    status_ = frame.status;
}

}  // namespace dihaptic::analysis
