// Each eye's view of a display: its part of the picture, and the frustum from the eye through the
// screen's corners.
//
// A point X is drawn where the line from the eye E to it passes through the screen. With the
// corner C and the edges a and b from it to the right and upward,
//
//     X - E = alpha a + beta b + gamma (C - E)
//
// has the position alpha / gamma, beta / gamma in shares of the edges, from the corner; gamma is
// the depth of X over that of the screen (R. Kooima, "Generalized Perspective Projection", 2008,
// derives this for rectangles).
#pragma once

#include <vector>

#include "display/display.h"

namespace dihaptic::view {

/// The view of one eye, and the part of the picture that shows it.
struct Viewpoint {
    Vec3 eye_W = Vec3::Zero();                                      ///< [m]
    Eigen::Matrix4d clip_from_world = Eigen::Matrix4d::Identity();  ///< OpenGL's clip coordinates
    bool flipped = false;  ///< whether the picture is mirrored
};

/// A part of a picture, in shares of its width and height from its lower left.
struct Pane {
    Viewpoint viewpoint;
    double left = 0, bottom = 0, width = 1, height = 1;
    bool red = true, green_blue = true;  ///< colours that are drawn
};

/// The panes of a display: without stereo, or with alternating pictures, a single pane, seen from
/// the middle between the eyes; otherwise one for the left eye and one for the right. `beyond`:
/// largest distance behind the screen at which things are drawn [m].
std::vector<Pane> panes(const display::Display& display, double beyond);

/// The field of view of a headset's eye to each side, from straight ahead; left and down are
/// negative, and all are within a quarter turn [rad].
struct FieldOfView {
    double left = 0, right = 0, up = 0, down = 0;
};
/// The view of a headset's eye at X_WE: E has x right, y up, and z backward, as in OpenXR. Things
/// between these distances in front of the eye are drawn [m].
Viewpoint viewpoint(const Pose& X_WE, const FieldOfView& sees, double nearest, double furthest);

}  // namespace dihaptic::view
