// What of a Frame is shown: the only place where drawing reads poses. They are the true ones until
// a visual map moves what is seen away from what is felt.
#pragma once

#include "servo/frame.h"

namespace dihaptic::view {

/// Pose of a body of the scene as it is shown.
inline Pose displayed_body(const servo::Frame& frame, size_t body) {
    return frame.bodies[body].X_WB;
}

/// Pose of a finger's proxy as it is shown.
inline Pose displayed_proxy(const servo::Frame& frame, size_t finger) {
    return {frame.fingers[finger].R_WP, frame.fingers[finger].p_WP};
}

/// Pose of a finger's handle as it is shown, turned as its proxy is.
inline Pose displayed_handle(const servo::Frame& frame, size_t finger) {
    return {frame.fingers[finger].R_WP, frame.fingers[finger].p_WH};
}

}  // namespace dihaptic::view
