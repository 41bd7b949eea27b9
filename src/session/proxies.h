// Determines which proxies a plan's fingers have.
#pragma once

#include <algorithm>

#include "session/plan.h"

namespace dihaptic::session {

inline scene::ProxyKind proxy_of(const Plan& plan, const scene::Finger& finger) {
    return plan.settings.proxy.of(finger.proxy);
}

inline bool any_finger(const Plan& plan, scene::ProxyKind kind) {
    return std::ranges::any_of(plan.scene.fingers, [&](const scene::Finger& finger) {
        return proxy_of(plan, finger) == kind;
    });
}

}  // namespace dihaptic::session
