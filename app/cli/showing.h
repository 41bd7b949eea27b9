// The content shown by the commands `picture` and `video`: a recorded session, or a scene or an
// experiment with the simulated hand.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "command.h"
#include "frame/frame.h"
#include "rig/rig.h"
#include "scene/scene.h"
#include "view/offscreen.h"
#include "view/scene_view.h"

namespace dihaptic::cli {

struct Showing {
    std::string title;
    scene::Scene scene;
    rig::Rig rig;
    std::vector<view::Workspace> workspaces;  ///< workspaces of devices, where they are known
    /// Targets of an experiment, drawn in all of its pictures; a recorded session has its own.
    std::vector<frame::TargetFrame> targets;
    double duration = 0;                        ///< planned duration [s]; 0 if unknown
    bool recorded = false;                      ///< whether the content is a recorded session
    std::function<const frame::Frame*()> next;  ///< returns the next frame; null at the end
};

/// Opens a scene, an experiment or a session's folder. Throws Error with all faults of the file.
Showing open_showing(const std::string& file);

/// The options common to both commands.
struct ViewOptions {
    std::string file;
    std::string camera;
    std::optional<std::string> display;
    std::string size = "1280x720";
    std::vector<std::string> show;
    std::string out;
};
void add_view_options(CLI::App& command, const std::shared_ptr<ViewOptions>& options);

/// Draws frames as the options request.
class Drawer {
  public:
    Drawer(const Showing& showing, const ViewOptions& options);
    /// Extends the drawn path of the object; must be called for every frame.
    void follow(const frame::Frame& frame);
    Image draw(const frame::Frame& frame);
    int width() const { return offscreen_->width(); }
    int height() const { return offscreen_->height(); }

  private:
    Image draw_as_it_is(const frame::Frame& frame);

    view::Camera camera_;
    std::optional<display::Display> display_;  // drawn instead of the camera's view
    view::Overlays overlays_;
    std::vector<frame::TargetFrame> targets_;
    bool path_wanted_ = false;
    int object_ = -1;
    std::vector<Vec3> path_;
    std::optional<view::Offscreen> offscreen_;
    std::optional<view::SceneView> view_;
};

}  // namespace dihaptic::cli
