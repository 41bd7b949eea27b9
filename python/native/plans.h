// Shared by worlds and sittings: they plan a session, and name the items in its frames.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "session/plan.h"

namespace dihaptic::python {

/// For each list of a frame whose items have names: the list, and the names in order.
using Items = std::vector<std::pair<std::string, std::vector<std::string>>>;

inline session::Request request_of(const std::string& file, const std::string& rig,
                                   const std::vector<std::string>& set, uint64_t seed) {
    session::Request request;
    request.file = file;
    request.rig = rig;
    request.set = set;
    request.seed = seed;
    return request;
}

inline Items items_of(const session::Plan& plan) {
    const auto names = [](const auto& list) {
        std::vector<std::string> out;
        for (const auto& item : list) out.push_back(item.name);
        return out;
    };
    const std::vector<std::string> fingers = names(plan.scene.fingers);
    std::vector<std::string> turning;
    for (size_t i = 0; i < fingers.size(); ++i) {
        if (plan.devices[i].measures_orientation) turning.push_back(fingers[i]);
    }
    return {{"fingers", fingers},
            {"turns", turning},
            {"bodies", names(plan.scene.bodies)},
            {"joints", names(scene::recorded_joints(plan.scene))}};
}

}  // namespace dihaptic::python
