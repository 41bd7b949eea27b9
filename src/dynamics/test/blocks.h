// Boxes and tables for tests of World.
#pragma once

#include <string>

#include "dynamics/world.h"

namespace dihaptic::dynamics {

constexpr double kStep = 1e-3;     // [s]
constexpr double kGravity = 9.81;  // [m/s^2]

/// A box, which is fixed if its mass is zero.
inline scene::Body box(const std::string& name, const Vec3& size, const Vec3& position, double mass,
                       double friction = 0.8) {
    scene::Body body;
    body.name = name;
    body.shape = scene::Shape::box(size);
    body.position = position;
    body.friction = friction;
    if (mass > 0) {
        body.mass = mass;
    } else {
        body.fixed = true;
    }
    return body;
}
inline scene::Body table(double friction = 0.8) {
    return box("table", {2, 2, 0.1}, {0, 0, -0.05}, 0, friction);
}
inline scene::Body plane(double friction = 0.8) {
    scene::Body body;
    body.name = "plane";
    body.shape.kind = scene::ShapeKind::plane;
    body.fixed = true;
    body.friction = friction;
    return body;
}
inline scene::Body block(const Vec3& position, double friction = 0.8) {
    return box("block", Vec3::Constant(0.04), position, 0.1, friction);
}

inline scene::Joint joint(scene::JointKind kind, std::vector<std::string> between,
                          const Vec3& position, const Vec3& axis = Vec3::UnitY()) {
    scene::Joint out;
    out.name = "joint";
    out.kind = kind;
    out.between = std::move(between);
    out.position = position;
    out.axis = axis;
    return out;
}

/// Reads a body from text in the format of a scene file in scenes/.
inline scene::Body body_from(const std::string& yaml) {
    scene::Scene scene;
    Diagnostics diagnostics;
    read_fields(scene, parse_yaml("bodies:\n  - " + yaml, "test"), diagnostics);
    scene::complete(scene, "scenes", diagnostics);
    diagnostics.throw_if_errors();
    return scene.bodies.at(0);
}

/// Settings with which no body falls asleep.
inline frame::DynamicsSettings awake() {
    frame::DynamicsSettings settings;
    settings.sleeping = false;
    return settings;
}

inline World make(std::vector<scene::Body> bodies, const frame::DynamicsSettings& settings = {}) {
    scene::Scene scene;
    scene.bodies = std::move(bodies);
    World world(scene, settings);
    world.activate();
    return world;
}

}  // namespace dihaptic::dynamics
