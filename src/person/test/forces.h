// Runs a simulated person's reaches in force fields and in force channels between them, and
// computes from the recorded frames how the hand pressed against the channel walls.
#pragma once

#include "base/unit.h"
#include "person/test/sitting.h"

namespace dihaptic::person {

inline constexpr double kCurl = 13;          // damping of the force field [N*s/m]
inline constexpr double kChannel = 2000;     // stiffness of the channel walls [N/m]
inline constexpr double kTurnedTarget = 45;  // target direction in the condition 'turned' [degrees]

/// A task with reaches of 100 mm in the horizontal plane, away from the person or, in the condition
/// 'turned', 45 degrees further to the left.
inline std::string force_task(const std::string& blocks) {
    return R"(  perturbations:
    - name: curl
      field: { kind: curl, on: index, axis: [0, 0, 1], damping_Ns_m: 13 }
    - name: reversed
      field: { kind: curl, on: index, axis: [0, 0, 1], damping_Ns_m: -13 }
    - name: turned curl
      visual: { moves: [proxies], about: start, axis: [0, 0, 1], angle_deg: 30 }
      field: { kind: curl, on: index, axis: [0, 0, 1], damping_Ns_m: 13 }
    - name: viscous
      field: { kind: viscous, on: index, damping_Ns_m: 13 }
    - name: channel
      field: { kind: channel, on: index, from: start, to: target, stiffness_N_m: 2000, damping_Ns_m: 10 }
    - name: rotation
      visual: { moves: [proxies], about: start, axis: [0, 0, 1], angle_deg: 30 }
  states:
    - name: go to the start
      show: [start]
      perturbed: no
      exits:
        - { when: inside, region: start, hold_s: 0.2, to: reach }
        - { when: time, after_s: 20, outcome: no start }
      simulated_hand: [{ duration_s: 0.6, reach: start }]
    - name: reach
      show: [target]
      exits: [{ when: time, after_s: 1.2, outcome: reached }]
      simulated_hand: [{ duration_s: 0.5, reach: target }]
  conditions:
    - { name: away, regions: [{ name: target, position_mm: [0, 60, 120], radius_mm: 10 }] }
    - { name: turned, regions: [{ name: target, position_mm: [-70.7107, 30.7107, 120], radius_mm: 10 }] }
  blocks:
)" + blocks;
}

/// The measures of one reach, taken while its state lasts.
struct ForceReach {
    std::string perturbed;  ///< name of the perturbation; empty if there is none
    double index = NAN;     ///< slope of the lateral force against b v, through zero
    double likeness = NAN;  ///< correlation of the two, without subtracting means
    double deviation = 0;   ///< largest deviation from the path [m]; positive to the left
};

/// The reaches of all trials. The path leads from the start to the target. The curl field pushes to
/// the left of the path, by b times the speed along it.
inline std::vector<ForceReach> force_reaches(const session::Plan& plan) {
    struct Sums {
        double force_ideal = 0, ideal2 = 0, force2 = 0;
    };
    std::vector<ForceReach> out(plan.task->trials.size());
    std::vector<Sums> sums(out.size());
    run_trials(plan, [&](const frame::Frame& frame) {
        if (frame.trial < 1 || frame.phase != 2) return;
        const auto i = static_cast<size_t>(frame.trial - 1);
        const auto& trial = plan.task->trials[i];
        const auto& cell = plan.task->cell(trial);
        ForceReach& reach = out[i];
        if (!trial.perturb.empty())
            reach.perturbed =
                plan.task->task.perturbations[static_cast<size_t>(trial.perturb[0])].name;
        const Vec3 along = (cell.p_W[1] - cell.p_W[0]).normalized();
        const Vec3 left = Vec3::UnitZ().cross(along);
        const frame::FingerFrame& finger = frame.fingers[0];
        const double off = (finger.p_WH - cell.p_W[0]).dot(left);
        if (std::abs(off) > std::abs(reach.deviation)) reach.deviation = off;
        const double ideal = kCurl * finger.v_WH.dot(along);
        const double force = finger.f_sent_W.dot(left);
        sums[i].force_ideal += force * ideal;
        sums[i].ideal2 += ideal * ideal;
        sums[i].force2 += force * force;
    });
    for (size_t i = 0; i < out.size(); ++i) {
        out[i].index = sums[i].force_ideal / sums[i].ideal2;
        out[i].likeness = sums[i].force_ideal / std::sqrt(sums[i].ideal2 * sums[i].force2);
    }
    return out;
}

/// The share by which channel walls yield when the hand presses against them.
inline double yielding(const session::Plan& plan) {
    const double k = plan.hand.impedance.stiffness;
    return k / (k + kChannel);
}

/// The index that the adaptation model predicts for each trial. In a channel, the only error is due
/// to the yielding of the walls.
template <class Rates, class State>
std::vector<double> model_index(const Rates& rates, State state, auto&& output,
                                const std::vector<ForceReach>& reaches, double yields) {
    std::vector<double> out;
    for (const ForceReach& reach : reaches) {
        const double x = output(state);
        out.push_back((1 - yields) * x);
        const double error = reach.perturbed == "curl"      ? 1 - x
                             : reach.perturbed == "channel" ? -yields * x
                                                            : -x;
        state = next(rates, state, error);
    }
    return out;
}

}  // namespace dihaptic::person
