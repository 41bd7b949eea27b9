// Draws a scene in the state described by a Frame: bodies and proxies with soft shadows (see
// README.md) and, on request, overlays that show invisible quantities. SceneView does not depend on
// where the Frame comes from or where the picture goes.
//
// SceneView needs OpenGL 3.3 core, and the same context must be current whenever one of its
// functions, including the destructor, is called. It draws to the framebuffer that is bound for
// drawing, which must have the format RGBA8 and must not be multisampled (SceneView smooths edges
// itself). Other state of the context is not restored.
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

/// The workspace of a device: a box centred at the origin of D.
struct Workspace {
    Pose X_WD;
    Vec3 size = Vec3::Zero();  ///< edges [m]
};

/// The current state of the rig's patch.
struct PatchLook {
    display::Patch patch;
    bool white = false;
};

/// Items drawn in addition to bodies and proxies.
struct Overlays {
    bool handles = false;                   ///< a ghost of each proxy at the position of its handle
    bool forces = false;                    ///< contact forces on each finger, drawn at 25 mm/N
    bool contacts = false;                  ///< contact points between bodies and fingers
    bool grip_axis = false;                 ///< line from the first finger to the others' middle
    bool joints = false;                    ///< axes, points and springs of the joints
    std::span<const Vec3> path;             ///< path of a body to draw, in W [m]
    std::span<const Workspace> workspaces;  ///< device workspaces to draw
    std::optional<PatchLook> patch;         ///< patch, drawn only once, regardless of the panes
    bool drop_lines = false;                ///< line from each proxy down to the table
    bool hand = false;                      ///< hand whose thumb and index finger are the proxies
    std::optional<size_t> picked;           ///< index of the body to mark with a box
};

/// The number and the time of the displayed frame.
struct Shown {
    int64_t sequence = 0;
    Time time{0};
};

enum class Shadows {
    variance,  ///< soft shadows, which are softer the higher the body is
    plain,     ///< hard shadows from one depth comparison; used to measure the cost of soft ones
};

/// OpenGL's name for the renderer of the current context.
std::string renderer();
/// Whether a renderer with this name draws in software, without a graphics card.
bool is_software(const std::string& renderer);

class SceneView {
  public:
    /// Creates models and shaders. Throws Error when the current context is older than OpenGL 3.3.
    explicit SceneView(const scene::Scene& scene, Shadows shadows = Shadows::variance);
    ~SceneView();
    SceneView(const SceneView&) = delete;
    SceneView& operator=(const SceneView&) = delete;

    /// Draws a frame of the scene into the lower left `width` x `height` pixels of the framebuffer.
    /// Returns the frame's number and time.
    Shown draw(const frame::Frame& frame, const Camera& camera, int width, int height,
               const Overlays& overlays = {});
    /// Draws the frame as the person's eyes see it on a display.
    Shown draw(const frame::Frame& frame, const display::Display& display, int width, int height,
               const Overlays& overlays = {});
    /// Draws the frame in several panes, each with its own viewpoint.
    Shown draw(const frame::Frame& frame, std::span<const Pane> panes, int width, int height,
               const Overlays& overlays = {});

    /// Sets the resolution at which pictures are drawn before being enlarged, as a share of their
    /// width and height, for machines that draw in software. The default is 1.
    void set_detail(double share);

    /// Unit vector toward the main light source, in W.
    static Vec3 light();

  private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace dihaptic::view
