// Computes where the things of a Frame are shown; drawing and simulated people use only these
// functions.
#pragma once

#include "servo/frame.h"

namespace dihaptic::servo {

/// The visual map in force if it moves `what`, or null.
inline const VisualMap* map_of(const Frame& frame, Moves what) noexcept {
    if (frame.task.visual.empty()) return nullptr;
    const VisualMap& map = frame.task.visual.front();
    return (map.moves & what) != 0 ? &map : nullptr;
}

/// Pose of a body of the scene as it is shown.
inline Pose displayed_body(const Frame& frame, size_t body) noexcept {
    const Pose& X_WB = frame.bodies[body].X_WB;
    const VisualMap* map = map_of(frame, kMovesObject);
    return map != nullptr && map->object == static_cast<int32_t>(body) ? map->displayed(X_WB)
                                                                       : X_WB;
}

/// Displayed size of a body over its true one.
inline double displayed_size(const Frame& frame, size_t body) noexcept {
    const VisualMap* map = map_of(frame, kMovesObject);
    return map != nullptr && map->object == static_cast<int32_t>(body) ? map->size : 1;
}

/// Pose of a finger's proxy as it is shown.
inline Pose displayed_proxy(const Frame& frame, size_t finger) noexcept {
    const Pose X_WP{frame.fingers[finger].R_WP, frame.fingers[finger].p_WP};
    const VisualMap* map = map_of(frame, kMovesProxies);
    return map != nullptr ? map->displayed(X_WP) : X_WP;
}

/// Pose of a finger's handle as it is shown; it has the proxy's orientation.
inline Pose displayed_handle(const Frame& frame, size_t finger) noexcept {
    const Pose X_WH{frame.fingers[finger].R_WP, frame.fingers[finger].p_WH};
    const VisualMap* map = map_of(frame, kMovesProxies);
    return map != nullptr ? map->displayed(X_WH) : X_WH;
}

/// Centre of the frame's i-th target as it is shown.
inline Vec3 displayed_target(const Frame& frame, size_t i) noexcept {
    const Vec3& p_WT = frame.task.targets[i].p_WT;
    const VisualMap* map = map_of(frame, kMovesTargets);
    return map != nullptr ? map->displayed(p_WT) : p_WT;
}

}  // namespace dihaptic::servo
