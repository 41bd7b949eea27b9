// Shapes for tests of point proxies.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

#include "base/random.h"
#include "scene/shape.h"

namespace dihaptic::haptics {

constexpr double kMicron = 1e-6;

inline scene::Shape round(scene::ShapeKind kind, double radius, double length) {
    scene::Shape shape;
    shape.kind = kind;
    shape.radius = radius;
    shape.length = length;
    return shape;
}

inline scene::Shape mesh(const std::vector<Vec3>& points) {
    scene::Shape shape;
    shape.kind = scene::ShapeKind::mesh;
    shape.hull = scene::convex_hull(points);
    return shape;
}

/// A wedge that is 40 mm long along y and 30 mm wide, from its 2 mm thick foot at x = 0 to its
/// sharp edge at x = 30 mm.
inline scene::Shape thin_wedge() {
    return mesh({{0, -0.02, 0.001},
                 {0, 0.02, 0.001},
                 {0, -0.02, -0.001},
                 {0, 0.02, -0.001},
                 {0.03, -0.02, 0},
                 {0.03, 0.02, 0}});
}

inline Vec3 random_vector(Random& random) {
    return {random.normal(), random.normal(), random.normal()};
}

/// A straight path of a handle through a shape, in strides of up to 8 mm.
struct Press {
    Vec3 from, way, stride;  ///< [m]
};
inline Press random_press(Random& random, scene::ShapeKind kind) {
    Press press;
    press.from = 0.08 * random_vector(random).normalized();
    if (kind == scene::ShapeKind::plane) press.from.z() = std::abs(press.from.z());
    press.way = (0.01 * random_vector(random) - press.from).normalized() * 0.14;
    press.stride = press.way * random.uniform(0.005, 0.06);
    return press;
}

/// Number of test shapes; shape(i) returns one of them.
constexpr int kShapes = 8;
inline scene::Shape shape(int i) {
    Random random(77, "test");
    switch (i) {
        case 0:
            return scene::Shape::box({0.04, 0.02, 0.06});
        case 1:
            return scene::Shape::sphere(0.015);
        case 2:
            return round(scene::ShapeKind::capsule, 0.01, 0.03);
        case 3:
            return round(scene::ShapeKind::cylinder, 0.02, 0.03);
        case 4:
            return round(scene::ShapeKind::cone, 0.02, 0.03);
        case 5:
            return round(scene::ShapeKind::plane, 0, 0);
        case 6:
            return thin_wedge();
        default: {
            std::vector<Vec3> points;
            for (int k = 0; k < 40; ++k)
                points.push_back(0.03 * random_vector(random).normalized());
            return mesh(points);
        }
    }
}

inline std::string shape_name(const ::testing::TestParamInfo<int>& instance) {
    constexpr std::array kNames{"box",  "sphere", "capsule", "cylinder",
                                "cone", "plane",  "wedge",   "hull"};
    return kNames[static_cast<size_t>(instance.param)];
}

}  // namespace dihaptic::haptics
