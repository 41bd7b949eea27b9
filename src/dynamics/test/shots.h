// Shots of convex shapes at thin plates, into cups and at each other, at up to 100 m/s. A check
// that is independent of World detects passage: points spread over a body give its depth in another
// body.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "base/random.h"
#include "dynamics/test/blocks.h"

namespace dihaptic::dynamics {

/// A random vector from the centre of a cube with sides of length 2 to any point in the cube.
inline Vec3 any_direction(Random& random) {
    return {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
}

/// Depth of the point p_B below the surface of a shape [m]; negative outside.
inline double depth_in(const scene::Shape& shape, const Vec3& p_B) {
    const double across = std::hypot(p_B.x(), p_B.y());
    const double half = shape.length / 2;
    switch (shape.kind) {
        case scene::ShapeKind::box:
            return (shape.size / 2 - p_B.cwiseAbs()).minCoeff();
        case scene::ShapeKind::sphere:
            return shape.radius - p_B.norm();
        case scene::ShapeKind::cylinder:
            return std::min(shape.radius - across, half - std::abs(p_B.z()));
        case scene::ShapeKind::capsule: {
            const double off = p_B.z() - std::clamp(p_B.z(), -half, half);
            return shape.radius - std::hypot(across, off);
        }
        case scene::ShapeKind::cone: {
            const double slant = std::hypot(shape.radius, shape.length);
            const double side = (shape.radius * (half - p_B.z()) - shape.length * across) / slant;
            return std::min(side, p_B.z() + half);
        }
        default:
            return 0;
    }
}

/// Points in and on a shape, in the frame of the shape.
inline std::vector<Vec3> points_of(const scene::Shape& shape, Random& random) {
    const double half = shape.length / 2;
    const double round = shape.kind == scene::ShapeKind::capsule ? half + shape.radius : half;
    Vec3 bounds(shape.radius, shape.radius, round);
    if (shape.kind == scene::ShapeKind::sphere) bounds.z() = shape.radius;
    if (shape.kind == scene::ShapeKind::box) bounds = shape.size / 2;
    std::vector<Vec3> out;
    while (out.size() < 200) {
        const Vec3 p = any_direction(random);
        const Vec3 inside = p.cwiseProduct(bounds);
        if (depth_in(shape, inside) < 0) continue;
        // move the point as far out as the shape allows
        double low = 1, high = 100;
        for (int i = 0; i < 40; ++i) {
            const double middle = (low + high) / 2;
            (depth_in(shape, middle * inside) < 0 ? high : low) = middle;
        }
        out.push_back(low * inside);
    }
    out.push_back(Vec3::Zero());
    return out;
}

/// A body of any convex shape, which may be thin, about 2 to 40 mm across.
inline scene::Body any_body(const std::string& name, Random& random) {
    scene::Body body;
    body.name = name;
    body.mass = random.uniform(0.001, 0.1);
    body.friction = random.uniform(0, 1);
    body.surface.restitution = std::max(0.0, random.uniform(-0.5, 0.9));
    body.rotation = 3 * any_direction(random);
    scene::Shape& shape = body.shape;
    const auto size = [&](double from, double to) {
        return from * std::pow(to / from, random.uniform(0, 1));
    };
    switch (static_cast<int>(random.uniform(0, 6))) {
        case 0:
            shape = scene::Shape::box({size(2e-3, 4e-2), size(2e-3, 4e-2), size(1e-3, 2e-2)});
            break;
        case 1:
            shape.kind = scene::ShapeKind::sphere;
            shape.radius = size(1e-3, 2e-2);
            break;
        case 2:
            shape.kind = scene::ShapeKind::capsule;
            shape.radius = size(1e-3, 1e-2);
            shape.length = size(2e-3, 1e-1);
            break;
        case 3:  // a disc
            shape.kind = scene::ShapeKind::cylinder;
            shape.radius = size(4e-3, 3e-2);
            shape.length = size(1e-3, 4e-3);
            break;
        case 4:  // a pen
            shape.kind = scene::ShapeKind::cylinder;
            shape.radius = size(1e-3, 1e-2);
            shape.length = size(1e-2, 1e-1);
            break;
        default:
            shape.kind = scene::ShapeKind::cone;
            shape.radius = size(2e-3, 3e-2);
            shape.length = size(2e-3, 4e-2);
    }
    return body;
}

/// Largest depth of any point of one body in the other body [m], or the negative distance if all
/// are outside.
inline double overlap_of(const scene::Body& a, const Pose& X_WA, const std::vector<Vec3>& of_a,
                         const scene::Body& b, const Pose& X_WB, const std::vector<Vec3>& of_b) {
    double out = -1;
    const Pose X_BA = X_WB.inverse() * X_WA;
    const Pose X_AB = X_BA.inverse();
    for (const Vec3& p : of_a) out = std::max(out, depth_in(b.shape, X_BA * p));
    for (const Vec3& p : of_b) out = std::max(out, depth_in(a.shape, X_AB * p));
    return out;
}

struct Shot {
    enum class At { plate, cup, each_other };
    At at = At::plate;
    scene::ShapeKind shape = scene::ShapeKind::box;
    double speed = 0;  ///< [m/s]
    bool passed = false;
    bool silent = false;  ///< whether a body was held back without a report
    double deepest = 0;   ///< largest overlap at the end of a step [m]
};

struct Shots {
    int passed = 0;
    int deep = 0;        ///< number of shots that were more than 0.5 mm deep in their target at the
                         ///< end of a step
    double deepest = 0;  ///< [m]
};

class Shooting {
  public:
    Shooting(uint64_t seed, Shot::At at, contact::Solver solver)
        : random_(seed, "shot"), solver_(solver) {
        shot_.at = at;
        shot_.speed = 100 * std::pow(random_.uniform(0.1, 1), 2);
    }
    Shot shoot() {
        scene::Body body = any_body("shot", random_);
        points_ = points_of(body.shape, random_);
        shot_.shape = body.shape.kind;
        if (shot_.at == Shot::At::plate) at_plate(body);
        if (shot_.at == Shot::At::cup) into_cup(body);
        if (shot_.at == Shot::At::each_other) at_another(body);
        return shot_;
    }

  private:
    World weightless(std::vector<scene::Body> bodies) {
        scene::Scene scene;
        scene.gravity.setZero();
        for (const scene::Body& body : bodies)
            is_plain_ = is_plain_ && body.shape.kind != scene::ShapeKind::cone &&
                        body.surface.restitution.value_or(0) == 0;
        scene.bodies = std::move(bodies);
        frame::DynamicsSettings settings;
        settings.solver = solver_;
        settings.sleeping = false;
        World world(scene, settings);
        world.activate();
        return world;
    }
    /// Does one step, and checks that bodies which were held back are reported: these are not at
    /// the position given by their velocity. Bouncing bodies and cones are excluded, since a
    /// bouncing body has its next velocity, and a cone's velocity is that of a point other than its
    /// centre of rotation.
    void step(World& world) {
        const std::vector<BodyState> before(world.states().begin(), world.states().end());
        world.step(kStep);
        for (size_t i = 0; i < before.size() && is_plain_; ++i) {
            const BodyState& after = world.states()[i];
            const Vec3 short_of = before[i].X_WB.p + kStep * after.v_WB - after.X_WB.p;
            shot_.silent = shot_.silent || (short_of.norm() > 1e-9 && !world.held_back());
        }
    }
    void at_plate(scene::Body body) {
        const double thickness = random_.uniform(5e-4, 3e-3);
        scene::Body plate =
            box("plate", {4, 4, thickness}, {0, 0, -thickness / 2}, 0, random_.uniform(0, 1));
        body.position = {0, 0, 0.15};
        World world = weightless({plate, body});
        const Vec3 way = (Vec3(0, 0, -1) + 0.5 * any_direction(random_)).normalized();
        world.set_velocity({1}, shot_.speed * way);
        const auto steps = static_cast<int>(0.2 / (shot_.speed * kStep)) + 20;
        for (int i = 0; i < steps; ++i) {
            step(world);
            const Pose& X_WB = world.states()[1].X_WB;
            shot_.passed = shot_.passed || X_WB.p.z() < 0;
            for (const Vec3& p : points_) shot_.deepest = std::max(shot_.deepest, -(X_WB * p).z());
        }
    }
    void into_cup(scene::Body body) {
        constexpr double kInner = 0.028, kFloor = 0.004, kTop = 0.08;  // [m], cup with 12 sides
        static const scene::Body cup = body_from(
            "{name: cup, shape: mesh, file: ../meshes/cup.obj, unit: mm, concave: yes, fixed: "
            "yes}");
        scene::Shape& shape = body.shape;
        const double scale = std::min(1.0, 0.02 / furthest());
        shape.size *= scale;
        shape.radius *= scale;
        shape.length *= scale;
        for (Vec3& p : points_) p *= scale;
        body.position = {random_.uniform(-0.005, 0.005), random_.uniform(-0.005, 0.005), 0.13};
        World world = weightless({cup, body});
        world.set_velocity(
            {1}, shot_.speed * (Vec3(0, 0, -1) + 0.1 * any_direction(random_)).normalized());
        bool inside = false;
        for (int i = 0; i < static_cast<int>(0.2 / (shot_.speed * kStep)) + 20; ++i) {
            step(world);
            const Pose& X_WB = world.states()[1].X_WB;
            for (const Vec3& p : points_) {
                const Vec3 at = X_WB * p;
                const double across = std::hypot(at.x(), at.y());
                if (at.z() < 0.9 * kTop && at.z() > kFloor && across < kInner) inside = true;
                if (!inside || at.z() > 0.95 * kTop) continue;
                shot_.deepest = std::max({shot_.deepest, kFloor - at.z(), across - kInner});
            }
            const Vec3& p = X_WB.p;
            shot_.passed = shot_.passed || (inside && p.z() < 0.95 * kTop &&
                                            (p.z() < kFloor || std::hypot(p.x(), p.y()) > kInner));
        }
    }
    void at_another(scene::Body body) {
        scene::Body other = any_body("other", random_);
        const Vec3 way = any_direction(random_).normalized();
        const double reach = furthest();
        std::vector<Vec3> of_other = points_of(other.shape, random_);
        double reach_of_other = 0;
        for (const Vec3& p : of_other) reach_of_other = std::max(reach_of_other, p.norm());
        body.position = -0.06 * way;
        other.position = (0.06 + reach + reach_of_other) * way +
                         0.3 * (reach + reach_of_other) * any_direction(random_);
        World world = weightless({body, other});
        const double share = random_.uniform(0, 1);
        const Vec3 v = shot_.speed * way;
        world.set_velocity({0}, share * v);
        world.set_velocity({1}, (share - 1) * v);
        const double ideal = deepest_on(body, other, of_other, v);
        // with this overlap, the centre of one body is beyond that of the other
        const double passed = (thickness(points_) + thickness(of_other)) / 2;
        bool met = false;
        for (int i = 0; i < static_cast<int>(0.25 / (shot_.speed * kStep)) + 10; ++i) {
            step(world);
            const auto& states = world.states();
            met = met || (states[0].v_WB - share * v).norm() > 1e-6 * shot_.speed;
            const double deep =
                overlap_of(body, states[0].X_WB, points_, other, states[1].X_WB, of_other);
            shot_.deepest = std::max(shot_.deepest, deep);
            shot_.passed = shot_.passed || deep > passed;
        }
        shot_.passed = shot_.passed || (!met && ideal > 5e-4);
    }
    /// Extent of a body along the axes of its frame, given its points [m].
    static double thickness(const std::vector<Vec3>& points) {
        Vec3 half = Vec3::Zero();
        for (const Vec3& p : points) half = half.cwiseMax(p.cwiseAbs());
        return 2 * half.minCoeff();
    }
    double furthest() const {
        double out = 0;
        for (const Vec3& p : points_) out = std::max(out, p.norm());
        return out;
    }
    /// Largest depth of two bodies in each other if nothing stopped them.
    double deepest_on(const scene::Body& a, const scene::Body& b, const std::vector<Vec3>& of_b,
                      const Vec3& v) const {
        double out = -1;
        Pose X_WA{rotation_xyz(a.rotation), a.position};
        const Pose X_WB{rotation_xyz(b.rotation), b.position};
        for (double way = 0; way < 0.3; way += 5e-4) {
            X_WA.p = a.position + way * v.normalized();
            out = std::max(out, overlap_of(a, X_WA, points_, b, X_WB, of_b));
        }
        return out;
    }
    Random random_;
    contact::Solver solver_;
    Shot shot_;
    bool is_plain_ = true;
    std::vector<Vec3> points_;
};

/// Fires shots with the given seeds, using each solver in turn.
inline Shots shots(Shot::At at, uint64_t from, uint64_t count) {
    Shots out;
    for (uint64_t seed = from; seed < from + count; ++seed) {
        const Shot shot = Shooting(seed, at, contact::Solver(seed % contact::kSolvers)).shoot();
        EXPECT_FALSE(shot.silent) << "seed " << seed << ": " << enum_name(shot.shape);
        EXPECT_FALSE(shot.passed) << "seed " << seed << ": " << enum_name(shot.shape) << " at "
                                  << shot.speed << " m/s, " << shot.deepest << " m deep";
        out.passed += shot.passed ? 1 : 0;
        out.deep += shot.deepest > 5e-4 ? 1 : 0;
        out.deepest = std::max(out.deepest, shot.deepest);
    }
    return out;
}

}  // namespace dihaptic::dynamics
