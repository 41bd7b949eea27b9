// Runs the reaches of a simulated person in experiments/rotation-reversal.yaml, and measures them
// on the hand's path.
#pragma once

#include "base/unit.h"
#include "person/test/sitting.h"

namespace dihaptic::person {

inline constexpr double kRotation = 30;  // [degrees]

struct Curve {
    std::vector<double> hand;   ///< compensation by trial, at the reach distance [degrees]
    std::vector<double> shown;  ///< displayed error by trial, at the same distance [degrees]
    std::vector<std::string> outcome;
};

inline double angle_about_z(const Vec3& from, const Vec3& to) {
    return std::atan2(from.cross(to).z(), from.head<2>().dot(to.head<2>()));
}

/// The angles of the first finger about z after the state "go to the start", in the last attempt of
/// each trial.
inline Curve reaches(const session::Plan& plan) {
    const task::ReachMeasure& measure = *plan.task->task.reach;
    const size_t trials = plan.task->trials.size();
    Curve curve{std::vector<double>(trials, NAN), std::vector<double>(trials, NAN),
                std::vector<std::string>(trials)};
    std::vector<int> measured(trials, 0);  // last measured attempt of each trial
    run_trials(plan, [&](const frame::Frame& frame) {
        if (frame.trial < 1) return;
        const auto i = static_cast<size_t>(frame.trial - 1);
        if (frame.task.outcome >= 0)
            curve.outcome[i] = plan.task->outcomes[static_cast<size_t>(frame.task.outcome)].name;
        if (frame.phase < 2 || measured[i] == frame.task.attempt) return;
        const auto& cell = plan.task->cell(plan.task->trials[i]);
        const Vec3 arm = frame.fingers[0].p_WH - cell.p_W[0];
        if (arm.norm() < measure.distance) return;
        measured[i] = frame.task.attempt;
        const Vec3 way = cell.p_W[1] - cell.p_W[0];
        curve.hand[i] = -angle_about_z(way, arm) / kDegree;
        const Vec3 shown = frame::displayed_handle(frame, 0).p - cell.p_W[0];
        curve.shown[i] = angle_about_z(way, shown) / kDegree;
    });
    return curve;
}

/// The plan's schedule in the form that the adaptation models take.
inline std::vector<model::AdaptationTrial> schedule(const session::Plan& plan) {
    std::vector<model::AdaptationTrial> out;
    for (const task::Trial& trial : plan.task->trials) {
        const std::string& name =
            trial.perturb.empty()
                ? ""
                : plan.task->task.perturbations[static_cast<size_t>(trial.perturb[0])].name;
        out.push_back({name == "rotation"   ? kRotation
                       : name == "reversal" ? -kRotation
                                            : 0,
                       name == "clamp"});
    }
    return out;
}

}  // namespace dihaptic::person
