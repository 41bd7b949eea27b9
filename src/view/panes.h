// The view of a display by each eye: the eye's part of the picture, and the frustum from the eye
// through the corners of the screen.
//
// A point X is drawn where the line from the eye E to X passes through the screen. With the lower
// left corner C of the screen, and the edges a to the right and b upward from C,
//
//     X - E = alpha a + beta b + gamma (C - E)
//
// is drawn at alpha / gamma and beta / gamma, measured from C as shares of the edges. gamma is the
// ratio of the depth of X to that of the screen (R. Kooima, "Generalized Perspective Projection",
// 2008, derives this for rectangles).
#pragma once

#include <vector>

#include "display/display.h"

namespace dihaptic::view {

/// The view of one eye, and whether the picture that shows it is mirrored.
struct Viewpoint {
    Vec3 eye_W = Vec3::Zero();                                      ///< [m]
    Eigen::Matrix4d clip_from_world = Eigen::Matrix4d::Identity();  ///< OpenGL's clip coordinates
    bool flipped = false;  ///< whether the picture is mirrored
};

/// A part of a picture. Its size and its lower left corner are given as shares of the picture's
/// width and height.
struct Pane {
    Viewpoint viewpoint;
    double left = 0, bottom = 0, width = 1, height = 1;
    bool red = true, green_blue = true;  ///< colour channels that are drawn
};

/// Returns the panes of a display. Without stereo, or when pictures alternate between the eyes,
/// there is a single pane, seen from the midpoint between the eyes; otherwise there is one pane for
/// the left eye and one for the right. `beyond`: largest distance behind the screen at which things
/// are drawn [m].
std::vector<Pane> panes(const display::Display& display, double beyond);

/// The field of view of a headset's eye, as angles from straight ahead to each side; left and down
/// are negative, and all angles are smaller than a quarter turn [rad].
struct FieldOfView {
    double left = 0, right = 0, up = 0, down = 0;
};
/// The view of a headset's eye at X_WE, where E has x right, y up, and z backward, as in OpenXR.
/// Things are drawn if their distance in front of the eye is between `nearest` and `furthest` [m].
Viewpoint viewpoint(const Pose& X_WE, const FieldOfView& sees, double nearest, double furthest);

}  // namespace dihaptic::view
