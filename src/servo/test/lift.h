// The grasp used by the servo's tests: two fingers close on a block on a table and lift it.
#pragma once

#include "devices/device_group.h"
#include "hand/script.h"
#include "scene/scene.h"

namespace dihaptic::servo {

inline scene::Scene block_on_table() {
    scene::Scene out;
    scene::Body table;
    table.name = "table";
    table.shape = scene::Shape::box({1, 1, 0.1});
    table.position = {0, 0, -0.05};
    table.fixed = true;
    scene::Body block;
    block.name = "block";
    block.shape = scene::Shape::box({0.04, 0.04, 0.04});
    block.position = {0, 0, 0.02};
    block.mass = 0.1;
    out.bodies = {table, block};
    Diagnostics diagnostics;
    scene::complete(out, "", diagnostics);
    return out;
}

/// Returns a hand that closes within 0.3 s, then lifts for 0.5 s.
inline hand::HandSpec lifting_hand() {
    hand::HandSpec out;
    out.centre = {0, 0, 0.02};
    out.aperture = 0.06;
    out.script = {{"close", 0.3, 0.03, Vec3::Zero(), false},
                  {"lift", 0.5, {}, {0, 0, 0.05}, false}};
    return out;
}

}  // namespace dihaptic::servo
