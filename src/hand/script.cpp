#include "hand/script.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "model/minimum_jerk.h"

namespace dihaptic::hand {
namespace {

/// Without a word on it, fingers stand on alternate sides along x; a single finger is the hand.
std::vector<FingerPlace> default_places(const std::vector<std::string>& names) {
    std::vector<FingerPlace> places;
    for (size_t i = 0; i < names.size(); ++i) {
        FingerPlace place;
        place.name = names[i];
        if (names.size() > 1) place.side = i % 2 == 0 ? Vec3(-1, 0, 0) : Vec3(1, 0, 0);
        places.push_back(place);
    }
    return places;
}

}  // namespace

ScriptDriver::ScriptDriver(const HandSpec& spec, const std::vector<std::string>& fingers) {
    fingers_ = default_places(fingers);
    for (const FingerPlace& place : spec.fingers) {
        const auto found = std::find_if(fingers_.begin(), fingers_.end(),
                                        [&](const FingerPlace& f) { return f.name == place.name; });
        if (found == fingers_.end()) {
            throw Error(
                place.place, "name",
                fmt::format("the hand's finger '{}' is not among the scene's fingers", place.name),
                fmt::format("Known: {}.", fmt::join(fingers, ", ")));
        }
        if (const auto same = std::count_if(spec.fingers.begin(), spec.fingers.end(),
                                            [&](const auto& f) { return f.name == place.name; });
            same > 1) {
            throw Error(place.place, "name", fmt::format("'{}' is given twice", place.name),
                        "Keep one of the two.");
        }
        if (fingers.size() > 1 && place.side.norm() == 0) {
            throw Error(place.place, "side", fmt::format("'{}' has no direction", place.name),
                        "Write where it is from the hand's centre, e.g. side: [-1, 0, 0].");
        }
        *found = place;
        if (found->side.norm() > 0) found->side.normalize();
    }
    if (spec.tremor.low > spec.tremor.high) {
        throw Error(spec.place, "tremor",
                    fmt::format("its band goes from {:g} Hz down to {:g} Hz", spec.tremor.low,
                                spec.tremor.high),
                    "Give the lower frequency as low_Hz.");
    }
    double time = 0;
    double aperture = spec.aperture;
    Vec3 centre = spec.centre;
    for (const ScriptStep& step : spec.script) {
        Segment segment;
        segment.start = time;
        segment.duration = step.duration;
        segment.aperture0 = aperture;
        segment.aperture1 = step.aperture.value_or(aperture);
        segment.centre0 = centre;
        segment.centre1 = centre + step.move;
        segment.steady = step.steady;
        segments_.push_back(segment);
        phases_.push_back({step.name, time, time + step.duration});
        time += step.duration;
        aperture = segment.aperture1;
        centre = segment.centre1;
    }
    if (time > kLongestScript) {
        throw Error(spec.place, "script",
                    fmt::format("lasts {:.6g} s, where {:g} s are the most", time, kLongestScript),
                    "Make it several experiments.");
    }
    if (segments_.empty()) {
        Segment rest;
        rest.duration = 1;
        rest.aperture0 = rest.aperture1 = aperture;
        rest.centre0 = rest.centre1 = centre;
        segments_.push_back(rest);
        phases_.push_back({"rest", 0, 1});
    }
}

FingerTarget ScriptDriver::do_target(int finger, double t) const noexcept {
    const Segment* segment = &segments_.front();
    for (const Segment& s : segments_) {
        if (t >= s.start) segment = &s;
    }
    const double s = (t - segment->start) / segment->duration;
    const bool inside = s > 0 && s < 1;
    const model::MinimumJerk step =
        segment->steady ? model::MinimumJerk{std::clamp(s, 0.0, 1.0), inside ? 1.0 : 0.0}
                        : model::minimum_jerk(s);
    const double per_second = step.rate / segment->duration;

    const FingerPlace& place = fingers_[static_cast<size_t>(finger)];
    const double aperture_change = segment->aperture1 - segment->aperture0;
    const Vec3 centre_change = segment->centre1 - segment->centre0;
    FingerTarget target;
    target.p_WT = segment->centre0 + step.share * centre_change + place.offset +
                  (segment->aperture0 + step.share * aperture_change) / 2 * place.side;
    target.v_WT = per_second * (centre_change + aperture_change / 2 * place.side);
    return target;
}

}  // namespace dihaptic::hand
