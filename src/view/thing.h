// A body or a finger, as drawn by SceneView: its triangles and their appearance. Only for use by
// the sources in this folder.
#pragma once

#include <limits>

#include "view/gl.h"

namespace dihaptic::view {

constexpr double kPlaneSize = 6;  // [m]

/// A set of triangles that share one pose.
struct Thing {
    gl::Model model;
    double radius = 0;
    double lowest = 0;  // lowest z at the initial pose [m]
    double highest = -std::numeric_limits<double>::infinity();
    Vec3 low_B = Vec3::Constant(std::numeric_limits<double>::infinity());  // bounding box [m]
    Vec3 high_B = -low_B;
    Vec3 colour = Vec3::Ones();
    bool own_colours = false;  // whether the model's colours replace `colour`
    bool ground = false;       // whether other bodies stand on it
    double gloss = 1;          // gloss of the clear coat, 0 to 1
    double grid = 0;           // darkness of the grid lines on the upper side, 0 to 1
    double fade = 0;           // distance at which it has faded into the background [m]; 0: never
    bool metal = false;
    GLuint picture = 0;                                           // 0: none
    Eigen::Vector2d picture_size = Eigen::Vector2d::Constant(1);  // [m]

    Thing() = default;
    /// Makes a thing from the triangles `all`, in the colour `tone`. `X_WB`: its pose at the start.
    Thing(Triangles all, const Pose& X_WB, const Vec3& tone);

    /// Sets up `program` to draw this thing. `tint`: the colour that an experiment currently gives
    /// to the thing, instead of its own colours and picture; null if there is none.
    void set(const gl::Program& program, const Vec3* tint) const;
    /// Whether set() requires a program that supports metals, pictures and own colours (LOOKS).
    bool has_looks(const Vec3* tint) const;
};

/// Makes the thing that shows a body. `picture`: the texture of the body's picture, if it has one.
Thing thing_of(const scene::Scene& scene, size_t body, GLuint picture);

}  // namespace dihaptic::view
