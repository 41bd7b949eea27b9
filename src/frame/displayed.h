// Computes the displayed positions and appearance of the objects in a Frame. Drawing code and
// simulated people use only these functions.
#pragma once

#include "frame/frame.h"

namespace dihaptic::frame {

/// Returns the active visual map if it moves `what`, otherwise null.
inline const VisualMap* map_of(const Frame& frame, Moves what) noexcept {
    if (frame.task.visual.empty()) return nullptr;
    const VisualMap& map = frame.task.visual.front();
    return (map.moves & what) != 0 ? &map : nullptr;
}

/// Returns the item in a list of the TaskFrame that refers to this body or proxy, or null.
template <class Item>
const Item* item_of(const std::vector<Item>& list, size_t body) noexcept {
    for (const Item& item : list) {
        if (item.body == static_cast<int32_t>(body)) return &item;
    }
    return nullptr;
}

/// Returns the index of a finger's proxy in the list of bodies.
inline size_t proxy_of(const Frame& frame, size_t finger) noexcept {
    return frame.bodies.size() + finger;
}

/// Pose of a body of the scene with only the visual map applied, without delay or noise.
inline Pose mapped_body(const Frame& frame, size_t body) noexcept {
    const Pose& X_WB = frame.bodies[body].X_WB;
    const VisualMap* map = map_of(frame, kMovesObject);
    return map != nullptr && map->object == static_cast<int32_t>(body) ? map->displayed(X_WB)
                                                                       : X_WB;
}

/// Pose of a finger's proxy with only the visual map applied.
inline Pose mapped_proxy(const Frame& frame, size_t finger) noexcept {
    const Pose X_WP{frame.fingers[finger].R_WP, frame.fingers[finger].p_WP};
    const VisualMap* map = map_of(frame, kMovesProxies);
    return map != nullptr ? map->displayed(X_WP) : X_WP;
}

/// Displayed pose of a body of the scene.
inline Pose displayed_body(const Frame& frame, size_t body) noexcept {
    const DisplacedFrame* displaced = item_of(frame.task.displaced, body);
    return displaced != nullptr ? displaced->X_WB : mapped_body(frame, body);
}

/// Ratio of a body's displayed size to its true size.
inline double displayed_size(const Frame& frame, size_t body) noexcept {
    const VisualMap* map = map_of(frame, kMovesObject);
    const LookFrame* look = item_of(frame.task.looks, body);
    const double of_map =
        map != nullptr && map->object == static_cast<int32_t>(body) ? map->size : 1;
    return look != nullptr ? look->scale * of_map : of_map;
}

/// Whether a body of the scene, or a proxy (see proxy_of()), is shown.
inline bool is_displayed(const Frame& frame, size_t body) noexcept {
    const LookFrame* look = item_of(frame.task.looks, body);
    return look == nullptr || look->hidden == 0;
}

/// Displayed pose of a finger's proxy.
inline Pose displayed_proxy(const Frame& frame, size_t finger) noexcept {
    const DisplacedFrame* displaced = item_of(frame.task.displaced, proxy_of(frame, finger));
    return displaced != nullptr ? displaced->X_WB : mapped_proxy(frame, finger);
}

/// Displayed pose of a finger's handle, with the orientation of the proxy. If the proxy is
/// displaced, the handle is displaced with it.
inline Pose displayed_handle(const Frame& frame, size_t finger) noexcept {
    const DisplacedFrame* displaced = item_of(frame.task.displaced, proxy_of(frame, finger));
    if (displaced != nullptr) return displaced->X_WB;
    const Pose X_WH{frame.fingers[finger].R_WP, frame.fingers[finger].p_WH};
    const VisualMap* map = map_of(frame, kMovesProxies);
    return map != nullptr ? map->displayed(X_WH) : X_WH;
}

/// Displayed position of the midpoint between the handles of some fingers, whose true position is
/// p_W.
inline Vec3 displayed_hand(const Frame& frame, const scene::FingerSet& fingers,
                           const Vec3& p_W) noexcept {
    if (frame.task.displaced.empty()) {
        const VisualMap* map = map_of(frame, kMovesProxies);
        return map != nullptr ? map->displayed(p_W) : p_W;
    }
    Vec3 sum = Vec3::Zero();
    for (size_t i = 0; i < frame.fingers.size(); ++i) {
        if (scene::contains(fingers, i)) sum += displayed_handle(frame, i).p;
    }
    return sum / static_cast<double>(fingers.count());
}

/// Displayed centre of the frame's i-th target.
inline Vec3 displayed_target(const Frame& frame, size_t i) noexcept {
    const Vec3& p_WT = frame.task.targets[i].p_WT;
    const VisualMap* map = map_of(frame, kMovesTargets);
    return map != nullptr ? map->displayed(p_WT) : p_WT;
}

}  // namespace dihaptic::frame
