#include "outlets/head_tracker.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "outlets/lsl/inlet.h"

namespace dihaptic::outlets {
namespace {

using Seconds = std::chrono::duration<double>;

constexpr Seconds kSearch{0.3};  // how often the thread checks whether it has to end
constexpr Seconds kWait{0.1};

double size_of(StreamUnit unit) {
    switch (unit) {
        case StreamUnit::m:
            return 1;
        case StreamUnit::cm:
            return 0.01;
        case StreamUnit::mm:
            return 0.001;
    }
    return 1;
}

/// Number of values per sample that describe a head.
size_t values_of(const TrackedHead& head) {
    return head.quaternion == StreamRotation::none ? 3 : 7;
}

}  // namespace

std::optional<HeadPose> head_pose(const TrackedHead& head, std::span<const float> values) {
    for (size_t i = 0; i < values_of(head); ++i) {
        if (!std::isfinite(values[i])) return std::nullopt;
    }
    const auto value = [&](size_t i) { return static_cast<double>(values[i]); };
    const Vec3 p_ST = size_of(head.unit) * Vec3(value(0), value(1), value(2));
    Quat R_ST = Quat::Identity();
    if (head.quaternion != StreamRotation::none) {
        R_ST = head.quaternion == StreamRotation::wxyz
                   ? Quat(value(3), value(4), value(5), value(6))
                   : Quat(value(6), value(3), value(4), value(5));
        constexpr double kOff = 0.1;  // largest deviation of a valid quaternion's length from 1
        if (std::abs(R_ST.norm() - 1) > kOff) return std::nullopt;
        R_ST.normalize();
    }
    const Quat R_WS = rotation_xyz(head.rotation);
    HeadPose out;
    out.R_WT = R_WS * R_ST;
    out.eyes = head.position + R_WS * p_ST + out.R_WT * head.eyes;
    out.along = out.R_WT * head.along.normalized();
    out.seen = true;
    return out;
}

HeadTracker::HeadTracker(const TrackedHead& head) : head_(head), thread_([this] { run(); }) {}

HeadTracker::~HeadTracker() {
    done_ = true;
    thread_.join();
}

std::optional<HeadPose> HeadTracker::newest() {
    return newest_.read();
}

std::vector<HeadTracker::Told> HeadTracker::take_told() {
    const std::lock_guard lock(guard_);
    return std::exchange(told_, {});
}

void HeadTracker::tell(std::string what, bool problem) {
    const std::lock_guard lock(guard_);
    told_.push_back({std::move(what), problem});
}

void HeadTracker::run() {
    try {
        receive();
    } catch (const Error& e) {
        tell(e.what(), true);
    }
}

void HeadTracker::receive() {
    lsl::Inlet inlet(head_.stream, head_.library, head_.place);
    const size_t needed = static_cast<size_t>(head_.first) + values_of(head_);
    bool told = false;
    while (!done_) {
        if (!inlet.find(kSearch)) {
            if (!std::exchange(told, true))
                tell(fmt::format(
                         "The network has no stream '{}' from a tracker: until it appears, "
                         "eyes are {}.",
                         head_.stream,
                         last_ ? "at their last position" : "at their position in the rig file"),
                     true);
            continue;
        }
        if (static_cast<size_t>(inlet.channels()) < needed)
            throw Error(head_.place, "first",
                        fmt::format("the stream '{}' has {} channels, but channels up to {} are "
                                    "needed",
                                    head_.stream, inlet.channels(), needed - 1),
                        "Correct first, or write quaternion: none.");
        tell(fmt::format("The head is tracked by the stream '{}'.", head_.stream), false);
        told = false;
        try {
            follow(inlet);
        } catch (const Error& e) {
            lose();
            tell(fmt::format("The tracker is lost: {}.", e.problems().front().what), true);
            std::this_thread::sleep_for(kSearch);
        }
    }
}

void HeadTracker::follow(lsl::Inlet& inlet) {
    std::vector<float> values(static_cast<size_t>(inlet.channels()));
    const std::span<const float> of_head =
        std::span<const float>(values).subspan(static_cast<size_t>(head_.first));
    auto heard = std::chrono::steady_clock::now();
    while (!done_) {
        const bool came = inlet.pull(values, kWait);
        const auto now = std::chrono::steady_clock::now();
        if (const auto pose = came ? head_pose(head_, of_head) : std::nullopt) {
            if (last_ && !last_->seen) tell("The tracker sees the head again.", false);
            newest_.publish(last_ = pose);
            heard = now;
        } else if (Seconds(now - heard).count() > kSilence && lose()) {
            tell("The tracker does not see the head: eyes are at their last position.", true);
        }
    }
}

bool HeadTracker::lose() {
    if (!last_ || !last_->seen) return false;
    last_->seen = false;
    newest_.publish(last_);
    return true;
}

}  // namespace dihaptic::outlets
