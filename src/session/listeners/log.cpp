#include "session/listeners/log.h"

#include "session/plan.h"
#include "session/session_run.h"

namespace dihaptic::session {
namespace {

recording::LogHead log_head(const Opening& opening) {
    const scene::Scene& scene = opening.plan.scene;
    recording::LogHead head;
    static_cast<recording::Setup&>(head) = opening.info;
    head.tick = opening.plan.settings.tick();
    head.fingers = scene::finger_names(scene);
    for (const scene::Body& body : scene.bodies) head.bodies.push_back(body.name);
    for (const scene::Joint& joint : recorded_joints(scene)) head.joints.push_back(joint.name);
    return head;
}

}  // namespace

Log::Log(const Opening& opening) {
    const RunOptions& options = opening.options;
    if (options.in_place_of_log) {
        sink_ = options.in_place_of_log(opening.folder, opening.info, log_head(opening));
        return;
    }
    using recording::Writing;
    recorder_.emplace(opening.folder.raw_log(), log_head(opening),
                      opening.real ? Writing::in_thread : Writing::in_place, options.sync);
}

void Log::take(const frame::Frame& frame) noexcept {
    if (failed_) return;
    try {
        recorder_ ? recorder_->record(frame) : sink_(frame);
        ++frames_;
    } catch (...) {
        error_ = std::current_exception();
        failed_ = true;
    }
}

std::vector<std::string> Log::finish() {
    if (error_) std::rethrow_exception(error_);
    if (recorder_) recorder_->finish();
    return {};
}

}  // namespace dihaptic::session
