#include "showing.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <filesystem>

#include "base/text_file.h"
#include "frame/displayed.h"
#include "recording/log_scene.h"
#include "recording/session.h"
#include "session/phase_director.h"
#include "session/plan.h"
#include "task/plan/shown_targets.h"

namespace dihaptic::cli {
namespace {

namespace fs = std::filesystem;

const std::vector<std::string> kLayers{"path",    "forces",    "contacts", "grip-axis",
                                       "handles", "workspace", "joints",   "hand"};

/// Adds the box to which a finger is confined: the rig's wall or, if there is none, the workspace
/// of the finger's device.
void add_workspace(Showing& showing, const std::string& finger, const std::optional<Vec3>& reach) {
    const rig::Rig& rig = showing.rig;
    if (rig.wall && showing.workspaces.empty())
        showing.workspaces.push_back({{Quat::Identity(), rig.wall->centre}, rig.wall->size});
    if (!rig.wall && reach)
        showing.workspaces.push_back({rig::device_of(rig, finger).X_WD(), *reach});
}

Showing open_session(const std::string& file) {
    const auto folder = recording::SessionFolder::open(file);
    auto log = std::make_shared<recording::RawLogReader>(folder.raw_log());
    const recording::LogHead& head = log->head();
    Diagnostics diagnostics(UnknownKeys::are_left_out);
    Showing out;
    out.title = head.title;
    out.recorded = true;
    out.duration = head.planned();
    out.scene = scene::read_scene(folder.file("scene.yaml"), diagnostics);
    out.rig = rig::read_rig(folder.file("rig.yaml"), diagnostics);
    diagnostics.throw_if_errors();
    recording::check_fits(head, out.scene, folder.raw_log());
    for (const recording::DeviceRecord& device : head.devices)
        add_workspace(out, device.finger, device.workspace);
    out.next = [log] { return log->next(); };
    return out;
}

Showing open_plan(const std::string& file) {
    struct Run {
        session::Plan plan;
        std::unique_ptr<servo::Servo> servo;
        std::optional<session::PhaseDirector> director;
        int64_t ticks = 0;
    };
    auto run = std::make_shared<Run>();
    session::Request request;
    request.order_number = 1;  // a picture needs some order of trials, whichever participant has it
    request.file = file;
    if (session::on_real_devices(request)) {
        throw Error({file, 0}, "rig", "pictures can be made only with simulated devices",
                    "Record a session, and give its folder.");
    }
    run->plan = session::make_plan(request);
    run->servo = session::make_servo(run->plan);
    std::vector<recording::PhaseInfo> phases;
    for (const hand::Driver::Phase& phase : run->plan.driver->phases())
        phases.push_back({phase.name, phase.start, phase.end});
    run->director.emplace(phases, run->plan.settings.tick());
    Showing out;
    out.title = run->plan.title;
    out.rig = run->plan.rig;
    out.scene = run->plan.scene;
    if (run->plan.task) out.targets = task::shown_targets(*run->plan.task);
    out.duration = phases.empty() ? 0 : phases.back().end;
    const devices::DeviceGroup& devices = run->servo->devices();
    for (size_t i = 0; i < out.scene.fingers.size(); ++i)
        add_workspace(out, out.scene.fingers[i].name, devices.info(static_cast<int>(i)).workspace);
    run->servo->activate();
    out.next = [run, end = out.duration]() -> const frame::Frame* {
        const Time now = run->ticks++ * run->servo->period();
        if (run->servo->stopped() || seconds(now) > end) return nullptr;
        return &run->servo->tick(now, *run->director);
    };
    return out;
}

std::pair<int, int> pixels(const std::string& size) {
    int width = 0;
    int height = 0;
    const char* const last = size.data() + size.size();
    const auto [x, first] = std::from_chars(size.data(), last, width);
    if (first == std::errc() && x != last && *x == 'x') {
        const auto [end, second] = std::from_chars(x + 1, last, height);
        if (second == std::errc() && end == last && std::min(width, height) >= 16 &&
            std::max(width, height) <= 8192)
            return {width, height};
    }
    throw Error({"--size", 0}, "", fmt::format("'{}' is not a valid picture size", size),
                "Give width and height in pixels, 16 to 8192 each, such as 1280x720.");
}

}  // namespace

Showing open_showing(const std::string& file) {
    std::error_code unreadable;  // ignored here, because reading the file reports the error
    return fs::is_directory(file, unreadable) || fs::path(file).filename() == "raw.log"
               ? open_session(file)
               : open_plan(file);
}

void add_view_options(CLI::App& command, const std::shared_ptr<ViewOptions>& options) {
    command.add_option("--camera", options->camera,
                       "camera: front, above, side, or one of the scene's own; default: the "
                       "scene's first, or front");
    command
        .add_option("--display", options->display,
                    "draw the scene as the person sees it on this display of the rig; empty: the "
                    "rig's only one")
        ->excludes("--camera");
    command.add_option("--size", options->size, "width and height in pixels")
        ->capture_default_str();
    command
        .add_option("--show", options->show,
                    fmt::format("further items to draw: {}", fmt::join(kLayers, ", ")))
        ->delimiter(',')
        ->check(CLI::IsMember(kLayers));
}

Drawer::Drawer(const Showing& showing, const ViewOptions& options)
    : targets_(showing.targets), object_(showing.scene.object_index()) {
    const std::vector<view::Camera> cameras = view::cameras(showing.scene);
    camera_ = options.camera.empty() ? cameras.front() : view::find_camera(cameras, options.camera);
    if (options.display) display_ = rig::display_of(showing.rig, *options.display);
    const auto wanted = [&](const char* layer) {
        return std::find(options.show.begin(), options.show.end(), layer) != options.show.end();
    };
    path_wanted_ = wanted("path");
    overlays_.forces = wanted("forces");
    overlays_.contacts = wanted("contacts");
    overlays_.grip_axis = wanted("grip-axis");
    overlays_.handles = wanted("handles");
    overlays_.joints = wanted("joints");
    overlays_.hand = wanted("hand");
    if (wanted("workspace")) overlays_.workspaces = showing.workspaces;
    const auto [width, height] = pixels(options.size);
    offscreen_.emplace(width, height);
    view_.emplace(showing.scene);
}

void Drawer::follow(const frame::Frame& frame) {
    if (!path_wanted_) return;
    const Vec3 p = object_ < 0 ? frame::displayed_proxy(frame, 0).p
                               : frame::displayed_body(frame, static_cast<size_t>(object_)).p;
    constexpr double kStep = 5e-4;  // least distance between points of the path [m]
    if (p.allFinite() && (path_.empty() || (p - path_.back()).norm() > kStep)) path_.push_back(p);
}

Image Drawer::draw(const frame::Frame& frame) {
    overlays_.path = path_;
    if (targets_.empty()) return draw_as_it_is(frame);
    frame::Frame with_targets = frame;
    with_targets.task.targets = targets_;
    return draw_as_it_is(with_targets);
}

Image Drawer::draw_as_it_is(const frame::Frame& frame) {
    const int width = offscreen_->width(), height = offscreen_->height();
    if (display_) {
        view_->draw(frame, *display_, width, height, overlays_);
    } else {
        view_->draw(frame, camera_, width, height, overlays_);
    }
    return offscreen_->read();
}

}  // namespace dihaptic::cli
