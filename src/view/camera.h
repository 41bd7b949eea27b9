// The cameras that every scene has, and the functions with which the mouse rotates, moves and zooms
// a camera.
//
// A camera is at the distance d from the point that it looks at, turned by the azimuth about the
// vertical and raised by the elevation. If both angles are zero, the camera is on the person's side
// (-y):
//
//     position = look_at + d (sin azimuth cos elevation, -cos azimuth cos elevation, sin elevation)
//
// The upward axis of the picture is the derivative of the position with respect to the elevation,
// so that looking straight down is not a special case: the side away from the person is up.
#pragma once

#include <string>
#include <vector>

#include "scene/scene.h"

namespace dihaptic::view {

using scene::Camera;

/// Returns the scene's own cameras, followed by the standard cameras with names that the scene does
/// not use: front (the seated person's view), above, and side (from the person's right). Never
/// empty.
std::vector<Camera> cameras(const scene::Scene& scene);
/// Returns the camera with this name. If there is none, throws an Error that lists the available
/// names.
Camera find_camera(const std::vector<Camera>& cameras, const std::string& name);

/// Rotates the camera about the point that it looks at by these angles [rad]. The elevation stays
/// between straight up and straight down.
Camera orbited(const Camera& camera, double azimuth, double elevation);
/// Moves the camera and the point that it looks at, so that the scene at the depth of this point
/// follows a mouse movement to the right and up. The movement is given as shares of the picture's
/// height.
Camera panned(const Camera& camera, double right, double up);
/// Multiplies the distance of the camera by a factor, and limits it to between 1 cm and 100 m.
Camera zoomed(const Camera& camera, double factor);

/// The azimuth of a camera, as defined at the top of this file, from -pi to pi [rad].
double azimuth(const Camera& camera);
/// X_WV, where V is OpenGL's view frame: x points right, y up and z toward the eye.
Pose view_pose(const Camera& camera);
/// The matrix from W to clip coordinates, in which OpenGL's depth ranges from -1 to 1.
Eigen::Matrix4d projection(const Camera& camera, double aspect, double near, double far);

}  // namespace dihaptic::view
