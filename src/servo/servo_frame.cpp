// What a tick leaves behind: the Frame.
#include <algorithm>
#include <cmath>
#include <utility>

#include "servo/servo.h"

namespace dihaptic::servo {
namespace {

uint32_t fault_status(haptics::FaultKind kind) {
    switch (kind) {
        case haptics::FaultKind::none:
            break;
        case haptics::FaultKind::bad_reading:
            return kBadReading;
        case haptics::FaultKind::not_answering:
            return kNotAnswering;
        case haptics::FaultKind::uncalibrated:
            return kUncalibrated;
        case haptics::FaultKind::device_fault:
            return kDeviceFault;
        case haptics::FaultKind::too_fast:
        case haptics::FaultKind::turned_too_fast:
            return kTooFast;
        case haptics::FaultKind::late:
            return kLate;
        case haptics::FaultKind::keeps_late:
            return kKeepsLate;
        case haptics::FaultKind::not_finite:
        case haptics::FaultKind::diverged:
            return kNotFinite;
        case haptics::FaultKind::active:
        case haptics::FaultKind::chatters:
            return kEnergyGenerated;
        case haptics::FaultKind::abandoned:
            return kAbandoned;
        case haptics::FaultKind::stopped:
            return kStopped;
    }
    return 0;
}

uint32_t finger_status(const devices::Reading& reading, unsigned limits) {
    uint32_t status = 0;
    if (reading.status & devices::kOutsideWorkspace) status |= kOutsideWorkspace;
    if (reading.status & devices::kForceClamped) status |= kForceClamped;
    if (reading.status & devices::kNoMoreData) status |= kNoMoreData;
    if (reading.status & devices::kNotAnswering) status |= kNotAnswering;
    if (reading.status & devices::kForceDropped) status |= kForceDropped;
    if (reading.status & devices::kNeedsCalibration) status |= kUncalibrated;
    if (reading.status & devices::kDeviceFault) status |= kDeviceFault;
    if (limits & haptics::kForceLimited) status |= kForceLimited;
    if (limits & haptics::kRateLimited) status |= kRateLimited;
    if (limits & haptics::kNotFinite) status |= kNotFinite;
    if (limits & haptics::kHeatLimited) status |= kHeatLimited;
    if (limits & haptics::kPushedInward) status |= kPushedInward;
    if (limits & haptics::kSoftStarted) status |= kSoftStarted;
    if (limits & haptics::kSwitchedOff) status |= kSwitchedOff;
    if (limits & haptics::kEnergyGenerated) status |= kEnergyGenerated;
    if (limits & haptics::kEnergyDamped) status |= kEnergyDamped;
    if (limits & haptics::kRiseBounded) status |= kSoftened;
    return status;
}

}  // namespace

void Servo::make_frame(Time now, const Commands& commands, dynamics::StepStatus step) noexcept {
    ++frame_.sequence;
    frame_.time = now;
    frame_.trial = commands.trial;
    frame_.phase = commands.phase;
    frame_.task = commands.task;
    frame_.status = step == dynamics::StepStatus::contacts_full ? kContactsFull : 0u;
    if (step == dynamics::StepStatus::diverged) frame_.status |= kNotFinite;
    if (overrun_) frame_.status |= kOverrun;
    if (std::exchange(resumed_, false)) frame_.status |= kResumed;
    if (commands.rest) frame_.status |= kPaused;
    if (world_.solve_stats().fallback) frame_.status |= kSolverFallback;
    if (world_.solve_stats().missed) frame_.status |= kSolverMissed;
    if (faults_.tripped()) frame_.status |= kForceOff;
    if (faults_.fault().time == now) frame_.status |= fault_status(faults_.fault().kind);
    frame_.solver = static_cast<int32_t>(world_.solver());
    if (!real_) frame_.status |= fault_status(lateness_fault_.kind);
    const haptics::Tuning tuning = in_force_.tuning();
    if (tuning.stiffness < settings_.coupling.stiffness) frame_.status |= kSoftened;
    frame_.coupling = static_cast<int32_t>(tuning.kind);
    frame_.stiffness = tuning.stiffness;
    frame_.damping = tuning.damping.value_or(kUnmeasured);
    frame_.smoothing = tuning.smoothing;
    frame_.proxy = static_cast<int32_t>(settings_.proxy.kind);
    frame_.friction_scale = world_.friction_scale();
    frame_.workspace_turn = turn_.angle();
    frame_.workspace_rate = turn_.rate();
    frame_.lateness = lateness_;
    frame_.tick_duration = last_tick_;
    frame_.solver_iterations = world_.solve_stats().iterations;
    frame_.solver_residual = world_.solve_stats().residual;
    frame_.solver_fallback = world_.solve_stats().fallback;
    frame_.solver_route = static_cast<int32_t>(world_.solve_stats().route);
    for (size_t i = 0; i < fingers_.size(); ++i) {
        FingerFrame& out = frame_.fingers[i];
        const dynamics::BodyState& proxy = world_.state(fingers_[i].proxy());
        const haptics::ProxyTouch& touch = fingers_[i].touch();
        out.p_DH = readings_[i].p_DH;
        out.v_DH = readings_[i].v_DH;
        out.buttons = readings_[i].buttons;
        out.status =
            finger_status(readings_[i], forces_[i].flags) | fault_status(device_faults_[i]);
        out.p_WH = handles_[i].p_WH;
        out.v_WH = handles_[i].v_WH;
        out.p_WP = proxy.X_WB.p;
        out.v_WP = proxy.v_WB;
        out.R_WP = proxy.X_WB.R;
        out.f_asked_W = forces_[i].asked_W.force;
        out.f_sent_W = forces_[i].sent_W.force;
        out.f_contact_W = touch.f_P_W;
        out.normal_force = touch.normal_force;
        const bool finite = out.p_WH.allFinite() && out.v_WH.allFinite() && out.p_WP.allFinite() &&
                            out.v_WP.allFinite();
        if (!finite) out.status |= kNotFinite;
        frame_.status |= out.status;
    }
    for (size_t n = 0; n < turning_.size(); ++n) {
        const size_t i = turning_[n];
        frame_.turns[n] = {readings_[i].R_DH,
                           readings_[i].w_DH,
                           handles_[i].R_WH,
                           handles_[i].w_WH,
                           world_.state(fingers_[i].proxy()).w_WB,
                           forces_[i].asked_W.torque,
                           forces_[i].sent_W.torque};
    }
    // bodies that were asleep and still are have not changed: only the awake ones are looked at
    const auto states = world_.states();
    const auto keep = [&](uint16_t i) {
        BodyFrame& out = frame_.bodies[i];
        out.X_WB = states[i].X_WB;
        out.v_WB = states[i].v_WB;
        out.w_WB = states[i].w_WB;
        out.awake = states[i].awake ? 1 : 0;
        // squares too: what overflows in the next computation has diverged already
        const double size =
            out.X_WB.p.squaredNorm() + out.v_WB.squaredNorm() + out.w_WB.squaredNorm();
        if (!std::isfinite(size)) frame_.status |= kNotFinite;
        frame_.changed.push_back(i);
    };
    frame_.changed.clear();
    if (frame_.sequence == 0) {
        for (size_t i = 0; i < frame_.bodies.size(); ++i) keep(static_cast<uint16_t>(i));
    } else {
        for (const size_t i : world_.stepped()) {
            if (i < frame_.bodies.size()) keep(static_cast<uint16_t>(i));
        }
    }
    merge_contacts();
    measure_grasp();
}

void Servo::merge_contacts() noexcept {
    frame_.contacts.clear();
    merge_contacts(world_.contacts());
    for (const haptics::Finger& finger : fingers_) merge_contacts(finger.contacts());
}

void Servo::merge_contacts(std::span<const contact::Contact> contacts) noexcept {
    // the points of a pair come one after the other
    double pressed = 0;
    for (const contact::Contact& c : contacts) {
        const bool same = !frame_.contacts.empty() && frame_.contacts.back().a == c.a.value &&
                          frame_.contacts.back().b == c.b.value;
        if (!same) {
            if (frame_.contacts.size() == frame_.contacts.capacity()) {
                frame_.status |= kContactsFull;
                break;
            }
            ContactFrame& out = frame_.contacts.emplace_back();
            out.a = c.a.value;
            out.b = c.b.value;
            out.gap = c.gap;
            pressed = 0;
        }
        ContactFrame& out = frame_.contacts.back();
        // running means, weighted by pressure; a floor of weight serves contacts that do not press
        const double weight = c.normal_force + 1e-12;
        pressed += weight;
        out.p_WC += weight / pressed * (c.p_WC - out.p_WC);
        out.n_W += weight / pressed * (c.n_W - out.n_W);
        out.gap = std::min(out.gap, c.gap);
        out.normal_force += c.normal_force;
        out.f_B_W += c.f_B_W;
        ++out.points;
    }
}

void Servo::measure_grasp() noexcept {
    const Vec3 down = world_.gravity().normalized();
    frame_.load_force = 0;
    for (const haptics::Finger& finger : fingers_) {
        const haptics::ProxyTouch& touch = finger.touch();
        const Vec3 tangential = touch.f_P_W - touch.f_P_W.dot(touch.n_W) * touch.n_W;
        frame_.load_force += tangential.dot(down);
    }
    if (fingers_.size() < 2) return;
    Vec3 others = Vec3::Zero();
    for (size_t i = 1; i < fingers_.size(); ++i) others += frame_.fingers[i].p_WP;
    const Vec3 axis =
        (others / static_cast<double>(fingers_.size() - 1) - frame_.fingers[0].p_WP).normalized();
    double squeeze = 0;
    for (size_t i = 0; i < fingers_.size(); ++i) {
        const haptics::ProxyTouch& touch = fingers_[i].touch();
        squeeze += (i == 0 ? -1 : 1) * touch.normal_force * touch.n_W.dot(axis);
    }
    frame_.grip_force = squeeze / 2;
}

}  // namespace dihaptic::servo
