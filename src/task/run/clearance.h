// Tests whether fingers are clear of bodies, using the box around each body and the sphere around
// each finger. This is accurate enough to decide whether a body can be placed.
#pragma once

#include "frame/frame.h"
#include "scene/scene.h"

namespace dihaptic::task {

constexpr double kClearance = 2e-3;  // [m]

/// Returns the radius of a sphere that contains a finger's shape in any orientation [m].
inline double reach_of(const scene::Finger& finger) {
    return scene::extent(finger.shape) * std::sqrt(3.0) / 2;
}

/// Whether a sphere at p_W with the given radius [m] overlaps the box of a body.
inline bool in_the_way(const Pose& X_WB, const scene::Bounds& box, const Vec3& p_W,
                       double radius) noexcept {
    const Vec3 p_B = X_WB.inverse() * p_W;
    const double margin = radius + kClearance;
    return (p_B.array() > box.low.array() - margin).all() &&
           (p_B.array() < box.high.array() + margin).all();
}

/// The boxes of a scene's bodies and the spheres of its fingers, precomputed for use in each tick.
class Clearance {
  public:
    Clearance() = default;
    explicit Clearance(const scene::Scene& scene) {
        for (const scene::Body& body : scene.bodies) boxes_.push_back(scene::bounds(body.shape));
        for (const scene::Finger& finger : scene.fingers) radius_.push_back(reach_of(finger));
    }
    /// Whether all proxies and handles are clear of all bodies.
    bool all_clear(const frame::Frame& frame) const noexcept {
        for (size_t i = 0; i < frame.fingers.size(); ++i) {
            const frame::FingerFrame& finger = frame.fingers[i];
            for (size_t b = 0; b < boxes_.size(); ++b) {
                const Pose& X_WB = frame.bodies[b].X_WB;
                if (in_the_way(X_WB, boxes_[b], finger.p_WP, radius_[i]) ||
                    in_the_way(X_WB, boxes_[b], finger.p_WH, radius_[i]))
                    return false;
            }
        }
        return true;
    }

  private:
    std::vector<scene::Bounds> boxes_;
    std::vector<double> radius_;  // radius of the sphere of each finger [m]
};

}  // namespace dihaptic::task
