// Solids that are drawn over the picture of a scene: tubes, arrows and balls.
#pragma once

#include <array>
#include <deque>
#include <vector>

#include "view/colours.h"
#include "view/gl.h"
#include "view/triangles.h"

namespace dihaptic::view {

/// The linear colour for a text of the form "#rrggbb".
inline Vec3 ink(const char* hex) {
    return linear_colour(hex);
}

class Solids {
  public:
    struct Solid {
        const gl::Model* model;
        Eigen::Matrix4d world_from_model;
        Vec3 colour;
    };
    /// `model` must outlive this object.
    void add(const gl::Model& model, const Eigen::Matrix4d& world_from_model, const Vec3& tint) {
        all_.push_back({&model, world_from_model, tint});
    }
    void add(const Triangles& what, const Pose& X, const Vec3& tint) {
        add(made_.emplace_back(what), gl::matrix(X), tint);
    }
    /// `ball`: a model of a ball of radius 1.
    void add_ball(const gl::Model& ball, const Vec3& p, double radius, const Vec3& tint) {
        Eigen::Matrix4d world_from_ball = gl::matrix({Quat::Identity(), p});
        world_from_ball.topLeftCorner<3, 3>() *= radius;
        add(ball, world_from_ball, tint);
    }
    void add_line(const Vec3& a, const Vec3& b, double radius, const Vec3& tint) {
        add(tube(std::array{a, b}, radius), {}, tint);
    }
    const std::vector<Solid>& all() const { return all_; }

  private:
    std::deque<gl::Model> made_;  // a deque, because all_ points into it while it grows
    std::vector<Solid> all_;
};

}  // namespace dihaptic::view
