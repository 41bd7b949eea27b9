// Two stops for a bar that lies along x.
#pragma once

#include "scene/scene.h"

namespace dihaptic::haptics {

/// Two blocks, one 1 um above one end of a bar of 0.2 x 0.02 x 0.01 m, the other 1 um below its
/// other end. They prevent the bar from turning about +y, which would move its +x end down.
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
