// The cameras that every scene has, and the functions by which a mouse turns, moves and zooms a
// camera.
//
// A camera stands at the distance d from the point that it looks at, turned by the azimuth about
// the vertical and raised by the elevation; with both zero it is on the person's side (-y):
//
//     position = look_at + d (sin azimuth cos elevation, -cos azimuth cos elevation, sin elevation)
//
// The picture's upward axis is the derivative of this with respect to the elevation, so that
// looking straight down is not a special case: the side away from the person is up.
#pragma once

#include <string>
#include <vector>

#include "scene/scene.h"

namespace dihaptic::view {

using scene::Camera;

/// The scene's own cameras, followed by the standard cameras whose names it does not use: front,
/// the seated person's view; above; and side, from the person's right. Never empty.
std::vector<Camera> cameras(const scene::Scene& scene);
/// The camera with this name. Throws an Error that lists the names if there is none.
Camera find_camera(const std::vector<Camera>& cameras, const std::string& name);

/// The camera, turned by these angles about the point that it looks at [rad]; the elevation stays
/// between straight up and straight down.
Camera orbited(const Camera& camera, double azimuth, double elevation);
/// The camera and the point that it looks at, moved so that the scene at that depth follows a mouse
/// movement to the right and up, given as shares of the picture's height.
Camera panned(const Camera& camera, double right, double up);
/// The camera with its distance multiplied by a factor, between 1 cm and 100 m.
Camera zoomed(const Camera& camera, double factor);

/// Azimuth of a camera, as above, from -pi to pi [rad].
double azimuth(const Camera& camera);
/// X_WV: V is OpenGL's view frame, with x right, y up and z toward the eye.
Pose view_pose(const Camera& camera);
/// The matrix from W to clip coordinates, with OpenGL's depth from -1 to 1.
Eigen::Matrix4d projection(const Camera& camera, double aspect, double near, double far);

}  // namespace dihaptic::view
