// A bar along x between two stops, and a hand that turns it about y against them.
#pragma once

#include "hand/script.h"
#include "scene/scene.h"

namespace dihaptic::servo {

/// The bar is the finger "hand".
inline scene::Scene turning_bar() {
    scene::Scene out;
    for (const int side : {-1, 1}) {
        scene::Body stop;
        stop.name = side < 0 ? "left" : "right";
        stop.shape = scene::Shape::box({0.02, 0.04, 0.02});
        stop.position = {side * 0.09, 0, -side * (0.015 + 1e-6)};
        stop.fixed = true;
        out.bodies.push_back(stop);
    }
    scene::Finger bar;
    bar.name = "hand";
    bar.shape = scene::Shape::box({0.2, 0.02, 0.01});
    out.fingers = {bar};
    return out;
}

/// By `turn` [rad] in 0.4 s.
inline hand::HandSpec turning_hand(double turn) {
    hand::HandSpec spec;
    hand::ScriptStep step;
    step.name = "turn";
    step.duration = 0.4;
    step.turn = {0, turn, 0};
    spec.script = {step};
    return spec;
}

}  // namespace dihaptic::servo
