#include "scene/body_checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "base/unit.h"
#include "scene/colour.h"

namespace dihaptic::scene {
namespace {

/// Limits of plausible values: anything on a tabletop is smaller and lighter, so beyond these
/// limits a unit is probably wrong.
constexpr double kImplausibleSize = 3.0;      // [m]
constexpr double kImplausibleMass = 20.0;     // [kg]
constexpr double kImplausiblyLight = 1e-5;    // [kg]
constexpr double kImplausibleDistance = 3.0;  // of a body that moves, from the origin [m]
constexpr double kImplausibleTurn = 4 * std::numbers::pi;  // [rad]

/// Whether the volume integrals of the shape are known. They are unknown if its mesh could not be
/// loaded.
bool has_volume(const Shape& shape) {
    return shape.kind != ShapeKind::plane && integrate(shape).volume > 0;
}

/// Checks the mass of a body that can move. Returns false if the mass is impossible.
bool check_weight(const Body& body, Diagnostics& diagnostics) {
    if (!body.mass && !body.density) {
        if (body.weighed) return false;  // the wrong key has already been reported
        diagnostics.error(body.place, body.name, "has neither mass nor density",
                          "Add mass_g or density_g_cm3, or fixed: yes.");
        return false;
    }
    if (has_volume(body.shape) && (mass(body) < kLightest || mass(body) > kHeaviest)) {
        diagnostics.error(body.place, body.name, fmt::format("weighs {:g} kg", mass(body)),
                          "Check the units of its size and its density.");
        return false;
    }
    if (mass(body) > kImplausibleMass ||
        (has_volume(body.shape) && mass(body) < kImplausiblyLight)) {
        diagnostics.warning(body.place, body.name, fmt::format("weighs {:g} kg", mass(body)),
                            "Check the unit of its mass or density.");
    }
    return true;
}

void check_driven(const Body& body, Diagnostics& diagnostics) {
    if (!body.fixed && !body.weighed) return;
    diagnostics.error(body.place, body.fixed ? "fixed" : "mass", "does not apply to a driven body",
                      "Leave it out.");
}

void check_plausible_pose(const Body& body, Diagnostics& diagnostics) {
    if (body.moves_at_all() && body.position.norm() > kImplausibleDistance) {
        diagnostics.warning(body.place, body.name,
                            fmt::format("begins {:g} m from the origin", body.position.norm()),
                            "Check the unit of its position.");
    }
    if (body.rotation.cwiseAbs().maxCoeff() > kImplausibleTurn) {
        diagnostics.warning(body.place, body.name,
                            fmt::format("is turned by {:.0f} degrees",
                                        body.rotation.cwiseAbs().maxCoeff() / kDegree),
                            "Check the unit of its rotation.");
    }
}

/// The shortest edge of a body's bounding box [m].
double thickness(const Body& body) {
    const Bounds box = bounds(body.shape);
    return (box.high - box.low).minCoeff();
}

/// Radius of a sphere around the body's origin that contains the body [m].
double reach(const Body& body) {
    if (body.shape.kind == ShapeKind::plane) return std::numeric_limits<double>::infinity();
    const Bounds box = bounds(body.shape);
    return box.low.cwiseAbs().cwiseMax(box.high.cwiseAbs()).norm();
}

}  // namespace

void check_parts(const Shape& shape, const Place& place, Diagnostics& diagnostics) {
    if (shape.kind != ShapeKind::compound) return;
    if (shape.parts.empty()) {
        diagnostics.error(place, "parts", "there are none",
                          "List at least one, each with a shape.");
    }
    for (const Part& part : shape.parts) {
        if (part.shape.kind != ShapeKind::plane && part.shape.kind != ShapeKind::compound) continue;
        diagnostics.error(part.place, "shape",
                          fmt::format("a part cannot be a {}", enum_name(part.shape.kind)),
                          "Use a box, sphere, capsule, cylinder, cone or mesh.");
    }
}

void check_plausible(const Shape& shape, const Place& place, Diagnostics& diagnostics) {
    if (extent(shape) > kImplausibleSize) {
        diagnostics.warning(place, "", fmt::format("this shape measures {:g} m", extent(shape)),
                            "Check the unit of its size; a tabletop is about 1 m.");
    }
}

void check_body(const Body& body, Diagnostics& diagnostics) {
    check_plausible_pose(body, diagnostics);
    check_plausible(body.shape, body.place, diagnostics);
    read_colour(body.colour, body.place, diagnostics);
    if (body.driven) check_driven(body, diagnostics);
    if (body.shape.kind == ShapeKind::plane && (body.moves_at_all() || body.driven)) {
        diagnostics.error(body.place, "fixed", "a plane is infinite and cannot move",
                          "Add fixed: yes.");
    }
    if (body.mass && body.density) {
        diagnostics.error(body.place, "density", "both mass and density are given",
                          "Keep one of the two.");
    }
    if (body.fixed || body.driven || !check_weight(body, diagnostics)) return;
    const bool two_axes =
        body.turns == Axes::xy || body.turns == Axes::xz || body.turns == Axes::yz;
    if (two_axes) {
        diagnostics.error(body.place, "turns", "a body cannot turn about exactly two axes",
                          "Use none, x, y, z or xyz.");
    }
}

void check_softness(const Scene& scene, Diagnostics& diagnostics) {
    constexpr double kDeep = 0.2;  // fraction of the body's thickness
    for (const Body& body : scene.bodies) {
        if (!body.surface.stiffness || !body.moves_at_all()) continue;
        const double depth = mass(body) * scene.gravity.norm() / *body.surface.stiffness;
        if (depth < kDeep * thickness(body)) continue;
        diagnostics.warning(
            body.surface.place, "stiffness",
            fmt::format(
                "lets {} sink by {:.3g} mm under its own weight; its thickness is {:.3g} mm",
                body.name, depth * 1e3, thickness(body) * 1e3),
            "Make it stiffer or lighter: a body that sinks too deep comes out on another side.");
    }
}

void check_surfaces(const Scene& scene, Diagnostics& diagnostics) {
    for (const Body& body : scene.bodies) check(body.surface, body.friction, diagnostics);
    const auto has_no_texture = [&](const Surface& surface) {
        if (surface.texture)
            diagnostics.error(surface.texture->place, "texture", "is allowed for bodies only",
                              "Give it to the body that the finger touches.");
    };
    for (const Finger& finger : scene.fingers) {
        check(finger.surface, finger.friction, diagnostics);
        has_no_texture(finger.surface);
    }
    for (const Pair& pair : scene.pairs) {
        has_no_texture(pair.surface);
        check(pair.surface, pair.friction, diagnostics);
        if (!pair.friction && pair.surface == Surface{})
            diagnostics.error(pair.place, "friction", "is missing, and there is no surface",
                              "Give a property of the pair, or leave the pair out.");
    }
}

void check_overlaps(const Scene& scene, Diagnostics& diagnostics) {
    constexpr double kDeep = 1e-3;  // [m]
    std::vector<double> reaches;
    for (const Body& body : scene.bodies) reaches.push_back(reach(body));
    for (size_t i = 0; i < scene.bodies.size(); ++i) {
        const Body& body = scene.bodies[i];
        if (!body.moves_at_all()) continue;
        for (size_t j = 0; j < scene.bodies.size(); ++j) {
            const Body& fixed = scene.bodies[j];
            if (fixed.moves_at_all()) continue;
            if ((body.position - fixed.position).norm() > reaches[i] + reaches[j]) continue;
            double deepest = 0;
            const auto sink = [&](const Body& of, const Body& in) {
                for (const Vec3& p : marks(of.shape)) {
                    deepest =
                        std::max(deepest, depth(in.shape, in.pose().inverse() * (of.pose() * p)));
                }
            };
            sink(body, fixed);
            sink(fixed, body);
            if (deepest < kDeep) continue;
            diagnostics.warning(body.place, body.name,
                                fmt::format("starts {:.3g} mm deep inside the fixed body {}",
                                            deepest * 1e3, fixed.name),
                                "Move it, or expect contact forces to push it out.");
        }
    }
}

}  // namespace dihaptic::scene
