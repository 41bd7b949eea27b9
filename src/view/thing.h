// A body or a finger as SceneView draws it: its triangles and their appearance. For the sources of
// this folder only.
#pragma once

#include <limits>

#include "view/gl.h"

namespace dihaptic::view {

constexpr double kPlaneSize = 6;  // [m]

/// Triangles that are drawn at one pose.
struct Thing {
    gl::Model model;
    double radius = 0;
    double lowest = 0;  // z at the start [m]
    double highest = -std::numeric_limits<double>::infinity();
    Vec3 low_B = Vec3::Constant(std::numeric_limits<double>::infinity());  // its box [m]
    Vec3 high_B = -low_B;
    Vec3 colour = Vec3::Ones();
    bool own_colours = false;  // the model's colours, in place of `colour`
    bool ground = false;       // whether other bodies stand on it
    double gloss = 1;          // gloss of its coat, 0 to 1
    double grid = 0;           // darkness of the lines on its upper side, 0 to 1
    double fade = 0;           // distance at which it has faded into the background; 0: never [m]
    bool metal = false;
    GLuint picture = 0;                                           // 0: none
    Eigen::Vector2d picture_size = Eigen::Vector2d::Constant(1);  // [m]

    Thing() = default;
    /// A thing drawn as `all`, in the colour `tone`; `X_WB` is its pose at the start.
    Thing(Triangles all, const Pose& X_WB, const Vec3& tone);

    /// Sets up a program to draw this thing. `tint`: the colour that an experiment currently gives
    /// it, in place of its colours and its picture; null: none.
    void set(const gl::Program& program, const Vec3* tint) const;
    /// Whether set() requires a program with metals, pictures and own colours (LOOKS).
    bool has_looks(const Vec3* tint) const;
};

/// A body's thing; `picture` is the texture of its picture, if it has one.
Thing thing_of(const scene::Scene& scene, size_t body, GLuint picture);

}  // namespace dihaptic::view
