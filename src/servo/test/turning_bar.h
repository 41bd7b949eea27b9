// A bar along x between two stops, and a hand that turns the bar about y, against the stops.
#pragma once

#include "hand/script.h"
#include "haptics/test/stops.h"

namespace dihaptic::servo {

/// Returns the scene. The bar is the shape of the finger "hand".
inline scene::Scene turning_bar() {
    scene::Scene out = haptics::stops();
    scene::Finger bar;
    bar.name = "hand";
    bar.shape = scene::Shape::box({0.2, 0.02, 0.01});
    out.fingers = {bar};
    return out;
}

/// Returns a hand that turns by `turn` [rad] in 0.4 s.
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
