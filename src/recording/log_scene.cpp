#include "recording/log_scene.h"

#include <algorithm>

namespace dihaptic::recording {

bool fits(const LogHead& head, const scene::Scene& scene) {
    const auto same = [](const std::string& name, const scene::Body& body) {
        return name == body.name;
    };
    return head.fingers == scene::finger_names(scene) &&
           std::equal(head.bodies.begin(), head.bodies.end(), scene.bodies.begin(),
                      scene.bodies.end(), same);
}

void check_fits(const LogHead& head, const scene::Scene& scene, const std::string& file) {
    if (fits(head, scene)) return;
    throw Error({file, 0}, "", "has other fingers or bodies than the session's scene.yaml",
                "Put this session's own log back.");
}

}  // namespace dihaptic::recording
