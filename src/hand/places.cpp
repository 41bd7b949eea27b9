#include "hand/places.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "base/diagnostics.h"

namespace dihaptic::hand {
namespace {

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

std::vector<FingerPlace> finger_places(const HandSpec& spec,
                                       const std::vector<std::string>& fingers) {
    std::vector<FingerPlace> places = default_places(fingers);
    for (const FingerPlace& place : spec.fingers) {
        const auto found = std::find_if(places.begin(), places.end(),
                                        [&](const FingerPlace& f) { return f.name == place.name; });
        if (found == places.end()) {
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
                        "Write its direction from the hand's centre, e.g. side: [-1, 0, 0].");
        }
        *found = place;
        if (found->side.norm() > 0) found->side.normalize();
    }
    return places;
}

}  // namespace dihaptic::hand
