#include "recording/log_scene.h"

#include <algorithm>

namespace dihaptic::recording {

bool fits(const LogHead& head, const scene::Scene& scene) {
    const auto same = [](const std::vector<std::string>& names, const auto& things) {
        return std::equal(
            names.begin(), names.end(), things.begin(), things.end(),
            [](const std::string& name, const auto& thing) { return name == thing.name; });
    };
    return head.fingers == scene::finger_names(scene) && same(head.bodies, scene.bodies) &&
           same(head.joints, scene::recorded_joints(scene));
}

void check_fits(const LogHead& head, const scene::Scene& scene, const std::string& file) {
    if (fits(head, scene)) return;
    throw Error({file, 0}, "",
                "has different fingers, bodies or joints from the session's scene.yaml",
                "Restore this session's own log.");
}

}  // namespace dihaptic::recording
