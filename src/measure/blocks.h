// Makes boxes and tables for the scenes of the benchmarks.
#pragma once

#include <string>

#include "scene/scene.h"

namespace dihaptic::measure {

inline scene::Body box(const std::string& name, const Vec3& size, const Vec3& position,
                       double friction) {
    scene::Body body;
    body.name = name;
    body.shape = scene::Shape::box(size);
    body.position = position;
    body.friction = friction;
    return body;
}

/// Returns a fixed table with its top at z = 0.
inline scene::Body table(double width, double friction) {
    scene::Body body = box("table", {width, width, 0.1}, {0, 0, -0.05}, friction);
    body.fixed = true;
    return body;
}

}  // namespace dihaptic::measure
