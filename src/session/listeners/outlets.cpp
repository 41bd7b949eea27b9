#include "session/listeners/outlets.h"

#include <fmt/format.h>

#include <filesystem>

#include "outlets/station.h"
#include "rig/libraries.h"
#include "session/plan.h"
#include "task/run/task_director.h"

namespace dihaptic::session {
namespace {

/// Returns the rig's outlets, after checking that their libraries may be loaded.
const std::vector<outlets::OutletConfig>& outlets_of(const Plan& plan) {
    rig::check_libraries(plan.rig);
    return plan.rig.outlets;
}

outlets::About about(const Plan& plan, const std::string& session) {
    outlets::About out{session, 1 / plan.settings.tick(), {}};
    for (const scene::Finger& finger : plan.scene.fingers) {
        for (const auto& [what, unit] : {std::pair("position", "m"), std::pair("force", "N")}) {
            for (const char* axis : {"x", "y", "z"})
                out.channels.push_back({fmt::format("{}_{}_{}", finger.name, what, axis), unit});
        }
    }
    return out;
}

class Outlets : public Listener {
  public:
    Outlets(const Plan& plan, const std::string& session)
        : station_(outlets_of(plan), about(plan, session)) {
        if (station_.wants_samples()) values_.resize(6 * plan.scene.fingers.size());
    }

    void steer(const Steering& steering) noexcept override {
        const int code = station_.take_trigger();
        if (code != 0 && steering.task != nullptr) steering.task->trigger(code);
    }
    void take(const frame::Frame& frame) noexcept override;
    std::vector<std::string> finish() override { return station_.finish(); }

  private:
    outlets::Station station_;
    std::vector<float> values_;  // one value per channel
};

void Outlets::take(const frame::Frame& frame) noexcept {
    for (size_t i = 0; i < values_.size() / 6; ++i) {
        const frame::FingerFrame& finger = frame.fingers[i];
        for (int k = 0; k < 3; ++k) {
            values_[6 * i + static_cast<size_t>(k)] = static_cast<float>(finger.p_WH[k]);
            values_[6 * i + 3 + static_cast<size_t>(k)] = static_cast<float>(finger.f_sent_W[k]);
        }
    }
    station_.send(frame.task.marker, values_);
}

}  // namespace

std::unique_ptr<Listener> open_outlets(const Opening& opening) {
    if (!opening.real || opening.plan.rig.outlets.empty()) return nullptr;
    return std::make_unique<Outlets>(
        opening.plan, std::filesystem::path(opening.folder.path()).filename().string());
}

}  // namespace dihaptic::session
