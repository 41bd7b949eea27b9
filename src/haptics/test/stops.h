// Stops that a bar along x lies between.
#pragma once

#include "scene/scene.h"

namespace dihaptic::haptics {

/// Blocks 1 um above one end and below the other: a bar of 0.2 x 0.02 x 0.01 m does not turn about
/// +y, which would take its end at +x down.
inline scene::Scene stops() {
    scene::Scene out;
    for (const int side : {-1, 1}) {
        scene::Body stop;
        stop.name = side < 0 ? "left" : "right";
        stop.shape = scene::Shape::box({0.02, 0.04, 0.02});
        stop.position = {side * 0.09, 0, -side * (0.015 + 1e-6)};
        stop.fixed = true;
        out.bodies.push_back(stop);
    }
    return out;
}

}  // namespace dihaptic::haptics
