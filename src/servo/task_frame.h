// TaskFrame describes what a task does in a tick: what it shows, what it perturbs, and how the
// trial ended. The task's director orders it, the Frame records it, and a replay orders it again.
//
// Perturbations act at three places:
//   visual map        from true to displayed pose, of the things it names
//   body properties   inertia and weight independently, and friction; scale those of the scene
//   loads             of force fields, on handles and bodies
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "base/geometry.h"

namespace dihaptic::servo {

/// What a visual map moves: a sum of these.
enum Moves : uint32_t { kMovesProxies = 1, kMovesObject = 2, kMovesTargets = 4 };

/// The difference between what is shown and what is there. A point p is shown at
///
///     c + R S (p - c),   S = diag(scale)         or, on a ray,     c + |p - c| along
///
/// A body is also turned by R, so that a rotated hand still touches what is rotated with it.
struct VisualMap {
    uint32_t moves = 0;           ///< Moves
    int32_t object = -1;          ///< the body that kMovesObject means
    Vec3 p_WC = Vec3::Zero();     ///< centre c [m]
    Vec3 scale = Vec3::Ones();    ///< along the world's axes
    Quat R = Quat::Identity();    ///< after scaling
    Vec3 along_W = Vec3::Zero();  ///< unit direction of the ray; zero: no ray
    double size = 1;              ///< the object's displayed size over its true one

    Vec3 displayed(const Vec3& p_W) const noexcept {
        const Vec3 arm = p_W - p_WC;
        if (along_W != Vec3::Zero()) return p_WC + arm.norm() * along_W;
        return p_WC + R * scale.cwiseProduct(arm);
    }
    Pose displayed(const Pose& X_W) const noexcept { return {R * X_W.R, displayed(X_W.p)}; }

    template <class Self, class Visitor>
    static void visit(Self& m, Visitor& v) {
        v("moves", m.moves, "1");
        v("object", m.object, "1");
        v("centre", m.p_WC, "m");
        v("scale", m.scale, "1");
        v("rotation", m.R, "1");
        v("along", m.along_W, "1");
        v("size", m.size, "1");
    }
};

/// A target that is shown as a sphere.
struct TargetFrame {
    int32_t region = -1;  ///< of the task
    Vec3 p_WT = Vec3::Zero();
    double radius = 0;

    template <class Self, class Visitor>
    static void visit(Self& t, Visitor& v) {
        v("region", t.region, "1");
        v("position", t.p_WT, "m");
        v("radius", t.radius, "m");
    }
};

/// Properties of a body, relative to those of the scene.
struct PropertiesFrame {
    int32_t body = -1;
    Vec3 mass_scale = Vec3::Ones();  ///< of its inertia along the world's axes
    double weight_scale = 1;
    double turning_scale = 1;   ///< of its moments of inertia
    double friction_scale = 1;  ///< of its coefficients with all others

    template <class Self, class Visitor>
    static void visit(Self& p, Visitor& v) {
        v("body", p.body, "1");
        v("mass_scale", p.mass_scale, "1");
        v("weight_scale", p.weight_scale, "1");
        v("turning_scale", p.turning_scale, "1");
        v("friction_scale", p.friction_scale, "1");
    }
};

/// A force on a body of the scene at its centre of mass, or, with the index of a proxy, on its
/// finger's handle.
struct LoadFrame {
    int32_t body = -1;
    Vec3 force_W = Vec3::Zero();   ///< [N]
    Vec3 torque_W = Vec3::Zero();  ///< bodies only [N*m]

    template <class Self, class Visitor>
    static void visit(Self& l, Visitor& v) {
        v("body", l.body, "1");
        v("force", l.force_W, "N");
        v("torque", l.torque_W, "N*m");
    }
};

/// Puts a body at a pose, at rest.
struct PlacementFrame {
    int32_t body = -1;
    Pose X_WB;

    template <class Self, class Visitor>
    static void visit(Self& p, Visitor& v) {
        v("body", p.body, "1");
        v("position", p.X_WB.p, "m");
        v("orientation", p.X_WB.R, "1");
    }
};

struct TaskFrame {
    /// Limits of the numbers in a tick; there may be as many placements as bodies.
    static constexpr size_t kMostTargets = 16;
    static constexpr size_t kMostProperties = 8;
    static constexpr size_t kMostLoads = 16;

    int32_t attempt = 0;   ///< of the trial, from 1
    int32_t outcome = -1;  ///< of the trial, in its last frame: index into the session's outcomes
    int32_t message = -1;  ///< shown now: index into the session's messages
    int32_t marker = 0;    ///< event code of this tick, 1 to 255; 0: none
    double share = 0;      ///< share of the trial's perturbation that acts
    std::vector<VisualMap> visual;  ///< empty: everything is shown where it is
    std::vector<TargetFrame> targets;
    std::vector<PropertiesFrame> properties;
    std::vector<LoadFrame> loads;
    std::vector<PlacementFrame> placements;

    void reserve(size_t bodies) {
        visual.reserve(1);
        targets.reserve(kMostTargets);
        properties.reserve(kMostProperties);
        loads.reserve(kMostLoads);
        placements.reserve(bodies);
    }
    /// Resets to no orders; keeps the memory.
    void clear() noexcept {
        attempt = 0;
        outcome = message = -1;
        marker = 0;
        share = 0;
        visual.clear();
        targets.clear();
        properties.clear();
        loads.clear();
        placements.clear();
    }

    template <class Self, class Visitor>
    static void visit(Self& t, Visitor& v) {
        v("attempt", t.attempt, "1");
        v("outcome", t.outcome, "1");
        v("message", t.message, "1");
        v("marker", t.marker, "1");
        v("share", t.share, "1");
        v.each("visual", t.visual);
        v.each("targets", t.targets);
        v.each("properties", t.properties);
        v.each("loads", t.loads);
        v.each("placements", t.placements);
    }
};

/// Adds an item to a list of a TaskFrame unless the list is full, so that the tick allocates
/// nothing.
template <class T>
void add(std::vector<T>& list, const T& item) noexcept {
    if (list.size() < list.capacity()) list.push_back(item);
}

}  // namespace dihaptic::servo
