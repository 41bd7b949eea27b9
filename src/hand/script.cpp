#include "hand/script.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "hand/places.h"
#include "model/minimum_jerk.h"

namespace dihaptic::hand {

ScriptDriver::ScriptDriver(const HandSpec& spec, const std::vector<std::string>& fingers) {
    fingers_ = finger_places(spec, fingers);
    if (spec.tremor.low > spec.tremor.high) {
        throw Error(spec.place, "tremor",
                    fmt::format("its lowest frequency, {:g} Hz, is above its highest, {:g} Hz",
                                spec.tremor.low, spec.tremor.high),
                    "Give the lower frequency as low_Hz.");
    }
    Segment start;
    for (const FingerPlace& place : fingers_) {
        Motion& motion = start.motions.emplace_back();
        motion.aperture0 = motion.aperture1 = place.aperture.value_or(spec.aperture);
        motion.centre0 = motion.centre1 = place.centre.value_or(spec.centre);
    }
    segments_.push_back(start);
    for (const ScriptStep& step : spec.script) add(step, fingers);
    const double time = phases_.empty() ? 0 : phases_.back().end;
    if (time > kLongestScript) {
        throw Error(
            spec.place, "script",
            fmt::format("lasts {:.6g} s, but at most {:g} s are allowed", time, kLongestScript),
            "Split it into several experiments.");
    }
    if (spec.script.empty()) {
        segments_.front().duration = 1;
        phases_.push_back({"rest", 0, 1});
    } else {
        segments_.erase(segments_.begin());
    }
}

/// Appends a step that starts at the end of the last segment.
void ScriptDriver::add(const ScriptStep& step, const std::vector<std::string>& fingers) {
    const Segment& last = segments_.back();
    Segment segment;
    segment.start = last.start + last.duration;
    segment.duration = step.duration;
    segment.steady = step.steady;
    if (step.steady && !step.end_velocity.isZero()) {
        throw Error(step.place, "end_velocity",
                    fmt::format("'{}' is 'steady', so its speed is constant", step.name),
                    "Leave out one of the two.");
    }
    for (const std::string& name : step.fingers) {
        if (std::find(fingers.begin(), fingers.end(), name) != fingers.end()) continue;
        throw Error(
            step.place, "fingers",
            fmt::format("'{}' moves '{}', which is not among the scene's fingers", step.name, name),
            fmt::format("Known: {}.", fmt::join(fingers, ", ")));
    }
    for (size_t i = 0; i < fingers.size(); ++i) {
        const Motion& before = last.motions[i];
        Motion motion;
        motion.aperture0 = motion.aperture1 = before.aperture1;
        motion.centre0 = motion.centre1 = before.centre1;
        motion.v0 = before.v1;
        motion.R0 = Quat(Eigen::AngleAxisd(before.angle, before.axis)) * before.R0;
        if (step.fingers.empty() ||
            std::find(step.fingers.begin(), step.fingers.end(), fingers[i]) != step.fingers.end()) {
            motion.aperture1 = step.aperture.value_or(motion.aperture0);
            motion.centre1 = motion.centre0 + step.move;
            motion.v1 = step.end_velocity;
            motion.angle = step.turn.norm();
            if (motion.angle > 0) motion.axis = step.turn / motion.angle;
        }
        segment.motions.push_back(motion);
    }
    phases_.push_back({step.name, segment.start, segment.start + segment.duration});
    segments_.push_back(std::move(segment));
}

FingerTarget ScriptDriver::do_target(int finger, double t) const noexcept {
    const Segment* segment = &segments_.front();
    for (const Segment& s : segments_) {
        if (t >= s.start) segment = &s;
    }
    const Motion& motion = segment->motions[static_cast<size_t>(finger)];
    const double T = segment->duration;
    const double s = (t - segment->start) / T;
    // if a motion does not start or end at rest, it has this speed only inside the segment
    const bool inside = segment->steady ? s > 0 && s < 1 : s >= 0 && s < 1;
    const model::MinimumJerk step =
        segment->steady ? model::MinimumJerk{std::clamp(s, 0.0, 1.0), 1.0} : model::minimum_jerk(s);
    const double rate = inside ? step.rate / T : 0.0;

    const double aperture_change = motion.aperture1 - motion.aperture0;
    const Vec3 centre_change = motion.centre1 - motion.centre0;
    Vec3 centre = motion.centre0 + step.share * centre_change;
    Vec3 v = rate * centre_change;
    if (!segment->steady) {
        const model::MinimumJerk from = model::start_speed_part(s);
        const model::MinimumJerk to = model::end_speed_part(s);
        centre += T * (from.share * motion.v0 + to.share * motion.v1);
        if (inside) v += from.rate * motion.v0 + to.rate * motion.v1;
    }
    const FingerPlace& place = fingers_[static_cast<size_t>(finger)];
    const Quat R = Quat(Eigen::AngleAxisd(step.share * motion.angle, motion.axis)) * motion.R0;
    const Vec3 arm =
        R * (place.offset + (motion.aperture0 + step.share * aperture_change) / 2 * place.side);
    FingerTarget target;
    target.p_WT = centre + arm;
    target.v_WT =
        v + rate * (aperture_change / 2 * (R * place.side) + motion.angle * motion.axis.cross(arm));
    target.R_WT = R;
    target.w_WT = rate * motion.angle * motion.axis;
    return target;
}

}  // namespace dihaptic::hand
