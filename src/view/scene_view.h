// Draws a scene in the state that a Frame holds: bodies and proxies with the soft shadows of
// README.md and, on request, overlays of invisible quantities. It does not depend on the source of
// the Frame or the destination of the picture.
//
// SceneView needs OpenGL 3.3 core: the same context must be current whenever one of its functions
// is called, the destructor included. It draws to the framebuffer that is bound for drawing, which
// must have the format RGBA8 and must not be multisampled (SceneView smooths edges itself). It does
// not restore other state of the context.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>

#include "display/display.h"
#include "frame/frame.h"
#include "scene/scene.h"
#include "view/camera.h"
#include "view/panes.h"

namespace dihaptic::view {

/// The workspace of a device: a box about the origin of D.
struct Workspace {
    Pose X_WD;
    Vec3 size = Vec3::Zero();  ///< edges [m]
};

/// The present state of the rig's patch.
struct PatchLook {
    display::Patch patch;
    bool white = false;
};

/// Items drawn besides bodies and proxies.
struct Overlays {
    bool handles = false;                   ///< a ghost of each proxy at its handle
    bool forces = false;                    ///< contact forces on each finger, 25 mm/N
    bool contacts = false;                  ///< points of contact between bodies and fingers
    bool grip_axis = false;                 ///< line from the first finger to the others' middle
    bool joints = false;                    ///< axes, points and springs of joints
    std::span<const Vec3> path;             ///< path of a body, in W [m]
    std::span<const Workspace> workspaces;  ///< workspaces of devices
    std::optional<PatchLook> patch;         ///< drawn once, regardless of the panes
    bool drop_lines = false;                ///< line from each proxy down to the table
    bool hand = false;             ///< a hand with the proxies as its thumb and index finger
    std::optional<size_t> picked;  ///< a body marked by a box
};

/// The number and the time of the displayed frame.
struct Shown {
    int64_t sequence = 0;
    Time time{0};
};

enum class Shadows {
    variance,  ///< soft, and softer the higher the body that casts them
    plain,     ///< hard, from one comparison of depths; used to measure the cost of soft shadows
};

/// OpenGL's name of the renderer in the current context.
std::string renderer();
/// Whether a renderer with this name uses the processor, not a graphics card.
bool is_software(const std::string& renderer);

class SceneView {
  public:
    /// Makes models and shaders. Throws Error when the current context is older than OpenGL 3.3.
    explicit SceneView(const scene::Scene& scene, Shadows shadows = Shadows::variance);
    ~SceneView();
    SceneView(const SceneView&) = delete;
    SceneView& operator=(const SceneView&) = delete;

    /// Draws a frame of this scene, `width` x `height` pixels from the framebuffer's lower left,
    /// and returns its stamp.
    Shown draw(const frame::Frame& frame, const Camera& camera, int width, int height,
               const Overlays& overlays = {});
    /// Draws the frame as the eyes see it on a display.
    Shown draw(const frame::Frame& frame, const display::Display& display, int width, int height,
               const Overlays& overlays = {});
    /// Draws the frame in parts, each from its own viewpoint.
    Shown draw(const frame::Frame& frame, std::span<const Pane> panes, int width, int height,
               const Overlays& overlays = {});

    /// Share of their width and height at which pictures are drawn before they are enlarged, for
    /// machines that draw in software. Initially 1.
    void set_detail(double share);

    /// Unit vector toward the main light, in W.
    static Vec3 light();

  private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace dihaptic::view
