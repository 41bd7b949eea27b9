#include "analysis/plausibility.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace dihaptic::analysis {
namespace {

constexpr double kArm = 0.7;     // reach of an arm [m]
constexpr double kFastest = 10;  // largest speed at which a drive moves a body on purpose [m/s]

}  // namespace

Plausibility::Plausibility(bool person_simulated, std::vector<std::string> bodies, double tick)
    : person_simulated_(person_simulated), bodies_(std::move(bodies)), tick_(tick) {}

void Plausibility::add(const frame::Frame& frame) {
    follow_drives(frame);
    if (person_simulated_) follow_hand(frame);
}

void Plausibility::follow_drives(const frame::Frame& frame) {
    for (const frame::DriveFrame& drive : frame.task.drives) {
        const auto body = static_cast<size_t>(drive.body);
        const bool placed = std::ranges::any_of(
            frame.task.placements, [&](const auto& of) { return of.body == drive.body; });
        if (placed || body >= before_.size() || frame.sequence != sequence_ + 1) continue;
        const double way = (drive.X_WB.p - before_[body]).norm();
        if (!(way > jumped_.way)) continue;
        jumped_ = {way, seconds(frame.time)};
        jumper_ = body;
    }
    sequence_ = frame.sequence;
    before_.clear();
    for (const frame::BodyFrame& body : frame.bodies) before_.push_back(body.X_WB.p);
}

void Plausibility::follow_hand(const frame::Frame& frame) {
    for (size_t i = 0; i < frame.fingers.size(); ++i) {
        const Vec3& p_WH = frame.fingers[i].p_WH;
        if (i == began_.size()) began_.push_back(p_WH);
        const double way = (p_WH - began_[i]).norm();
        if (way > strayed_.way) strayed_ = {way, seconds(frame.time)};
    }
}

std::vector<std::string> Plausibility::findings() const {
    std::vector<std::string> out;
    if (strayed_.way > kArm)
        out.push_back(fmt::format(
            "the simulated hand was {:.2g} m from where it began, at {:.1f} s, which is further "
            "than an arm reaches: simulated people cannot do this task, and their trials say "
            "nothing about people",
            strayed_.way, strayed_.time));
    if (jumped_.way > kFastest * tick_)
        out.push_back(
            fmt::format("'{}' jumped by {:.3g} mm in one tick at {:.3f} s, when a drive moved it: "
                        "displacements are measured from where it was when the state began, so "
                        "'along' has to begin at 0 then (use time_in_state, not time_in_trial)",
                        bodies_[jumper_], 1e3 * jumped_.way, jumped_.time));
    return out;
}

}  // namespace dihaptic::analysis
