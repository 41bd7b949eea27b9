// Draws a scene as a Frame shows it: bodies and proxies with the soft shadows of README.md, and on
// top of them, if asked for, what is not to be seen in the world. It knows neither who made the
// Frame nor where the picture goes.
//
// It works in OpenGL 3.3 core: the same context has to be current whenever one of its functions is
// called, its end included. What it draws goes to the framebuffer that is bound for drawing, which
// must not be multisampled (edges are smoothed by SceneView itself) and has to be of the format
// RGBA8. Other state of the context is left as draw() needed it.
#pragma once

#include <memory>
#include <span>

#include "scene/scene.h"
#include "servo/frame.h"
#include "view/camera.h"

namespace dihaptic::view {

/// Where a device can go: a box about the device's origin.
struct Workspace {
    Pose X_WD;
    Vec3 size = Vec3::Zero();  ///< edges [m]
};

/// What is drawn besides bodies and proxies.
struct Overlays {
    bool handles = false;                   ///< a ghost of each proxy where its handle is
    bool forces = false;                    ///< on each finger, from what it touches: 25 mm/N
    bool contacts = false;                  ///< where bodies and fingers touch
    bool grip_axis = false;                 ///< from the first finger to the middle of the others
    std::span<const Vec3> path;             ///< of a body, in W [m]
    std::span<const Workspace> workspaces;  ///< of devices
};

/// Which frame was shown, and its time.
struct Shown {
    int64_t sequence = 0;
    Time time{0};
};

enum class Shadows {
    variance,  ///< soft, and softer the higher what throws them
    plain,     ///< hard: one comparison of depths, to measure the cost of the other
};

class SceneView {
  public:
    /// Makes models and shaders. Throws Error when the current context is older than OpenGL 3.3.
    explicit SceneView(const scene::Scene& scene, Shadows shadows = Shadows::variance);
    ~SceneView();
    SceneView(const SceneView&) = delete;
    SceneView& operator=(const SceneView&) = delete;

    /// Draws a frame of this scene, `width` x `height` pixels from the framebuffer's lower left,
    /// and returns its stamp.
    Shown draw(const servo::Frame& frame, const Camera& camera, int width, int height,
               const Overlays& overlays = {});

    /// Direction to the main light, in W, of unit length.
    static Vec3 light();

  private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace dihaptic::view
