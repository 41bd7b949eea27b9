// Where a scene is looked at from: the cameras that every scene has, and what a hand on the mouse
// does to one. All are plain functions from one camera to another.
//
// A camera stands at the distance d from what it looks at, turned by the azimuth about the vertical
// and raised by the elevation: from the person's side (-y) with both zero,
//
//     position = look_at + d (sin azimuth cos elevation, -cos azimuth cos elevation, sin elevation)
//
// and the picture's upward axis is the derivative of this by the elevation, so that looking
// straight down is nothing special: the person's far side is up.
#pragma once

#include <string>
#include <vector>

#include "scene/scene.h"

namespace dihaptic::view {

using scene::Camera;

/// The scene's own cameras, then those that every scene has unless it has one of that name: front,
/// as the seated person sees it, above, and side, from the person's right. Never empty.
std::vector<Camera> cameras(const scene::Scene& scene);
/// The named one. Throws Error that lists the names.
Camera find_camera(const std::vector<Camera>& cameras, const std::string& name);

/// Turned about what it looks at [rad]; the elevation stays between straight up and straight down.
Camera orbited(const Camera& camera, double azimuth, double elevation);
/// Moved with what it looks at, by shares of the picture's height: the scene at that depth follows
/// the mouse when it went right and up so far.
Camera panned(const Camera& camera, double right, double up);
/// The distance multiplied by a factor, but neither below a centimetre nor above 100 m.
Camera zoomed(const Camera& camera, double factor);

/// Of a camera, as above, from -pi to pi [rad].
double azimuth(const Camera& camera);
/// X_WV: V has x right, y up, and z toward the eye, as OpenGL has it.
Pose view_pose(const Camera& camera);
/// Clip coordinates from W, with OpenGL's depth from -1 to 1.
Eigen::Matrix4d projection(const Camera& camera, double aspect, double near, double far);

}  // namespace dihaptic::view
