// Fills the Frame, which is the record of a tick.
#include <algorithm>
#include <cmath>
#include <utility>

#include "model/grasp.h"
#include "servo/servo.h"

namespace dihaptic::servo {
namespace {

uint32_t fault_status(FaultKind kind) noexcept {
    const StatusRow* const row = row_of(kind);
    return row != nullptr ? uint32_t{row->bit} : 0;
}

uint32_t step_status(dynamics::StepStatus step, const dynamics::World& world) noexcept {
    const contact::SolveStats& solve = world.solve_stats();
    uint32_t status = 0;
    if (step == dynamics::StepStatus::contacts_full) status |= kContactsFull;
    if (step == dynamics::StepStatus::diverged) status |= kNotFinite;
    if (solve.fallback) status |= kSolverFallback;
    if (solve.missed) status |= kSolverMissed;
    if (world.held_back()) status |= kHeldBack;
    return status;
}

void note_solver(const dynamics::World& world, frame::Frame& frame) noexcept {
    const contact::SolveStats& solve = world.solve_stats();
    frame.solver = world.solver();
    frame.solver_iterations = solve.iterations;
    frame.solver_residual = solve.residual;
    frame.solver_held_residual = world.held_residual();
    frame.solver_fallback = solve.fallback;
    frame.solver_route = static_cast<int32_t>(solve.route);
}

void note_balance(const dynamics::Balance& balance, frame::Frame& frame) noexcept {
    frame.kinetic_energy = balance.kinetic;
    frame.potential_energy = balance.potential;
    frame.work = balance.work;
    frame.dissipation = balance.dissipated;
    frame.energy_imbalance = balance.energy_imbalance;
    frame.momentum_imbalance = balance.momentum_imbalance;
    frame.angular_imbalance = balance.angular_imbalance;
    if (balance.unbalanced) frame.status |= kUnbalanced;
}

void note_motion(const devices::Reading& reading, const frame::Handle& handle,
                 const dynamics::BodyState& proxy, frame::FingerFrame& out) noexcept {
    out.p_DH = reading.p_DH;
    out.v_DH = reading.v_DH;
    out.p_WH = handle.p_WH;
    out.v_WH = handle.v_WH;
    out.p_WP = proxy.X_WB.p;
    out.v_WP = proxy.v_WB;
    out.R_WP = proxy.X_WB.R;
    const bool finite = out.p_WH.allFinite() && out.v_WH.allFinite() && out.p_WP.allFinite() &&
                        out.v_WP.allFinite();
    if (!finite) out.status |= kNotFinite;
}

void note_body(const dynamics::BodyState& state, uint16_t body, frame::Frame& frame) noexcept {
    frame::BodyFrame& out = frame.bodies[body];
    out.X_WB = state.X_WB;
    out.v_WB = state.v_WB;
    out.w_WB = state.w_WB;
    out.awake = state.awake ? 1 : 0;
    // squared norms are used because a value that would overflow in later computations has already
    // diverged
    const double size = out.X_WB.p.squaredNorm() + out.v_WB.squaredNorm() + out.w_WB.squaredNorm();
    if (!std::isfinite(size)) frame.status |= kNotFinite;
    frame.changed.push_back(body);
}

/// Lists the bodies that were stepped; bodies that stay asleep have not changed.
void note_bodies(const dynamics::World& world, frame::Frame& frame) noexcept {
    const auto states = world.states();
    const size_t count = frame.bodies.size();
    frame.changed.clear();
    if (frame.sequence == 0) {
        for (size_t i = 0; i < count; ++i) note_body(states[i], static_cast<uint16_t>(i), frame);
        return;
    }
    for (const size_t i : world.stepped()) {
        if (i < count) note_body(states[i], static_cast<uint16_t>(i), frame);
    }
}

void note_joints(std::span<const dynamics::JointState> states, frame::Frame& frame) noexcept {
    for (size_t i = 0; i < states.size(); ++i) {
        const dynamics::JointState& state = states[i];
        frame::JointFrame& out = frame.joints[i];
        const scene::JointKindRow& kind = scene::describe(state.kind);
        if (kind.coordinate == scene::Coordinate::angle) {
            out.angle = state.position;
            out.angular_velocity = state.velocity;
        } else if (kind.has_coordinate()) {
            out.displacement = state.position;
            out.velocity = state.velocity;
        }
        out.f_B_W = state.force_W;
        out.t_B_W = state.torque_W;
    }
}

}  // namespace

void Servo::make_frame(Time now, const frame::Commands& commands,
                       dynamics::StepStatus step) noexcept {
    ++frame_.sequence;
    frame_.time = now;
    frame_.trial = commands.trial;
    frame_.phase = commands.phase;
    frame_.task = commands.task;
    frame_.status = step_status(step, world_);
    if (late_.timing().overrun) frame_.status |= kOverrun;
    if (std::exchange(resumed_, false)) frame_.status |= kResumed;
    if (commands.rest) frame_.status |= kPaused;
    if (faults_.tripped()) frame_.status |= kForceOff;
    if (faults_.fault().time == now) frame_.status |= fault_status(faults_.fault().kind);
    if (!late_.is_real()) frame_.status |= fault_status(late_.fault().kind);
    if (in_force_.stiffness < commands.knobs.stiffness) frame_.status |= kSoftened;
    static_cast<frame::Knobs&>(frame_) = commands.knobs;  // corrected below where necessary
    frame_.set_coupling(in_force_);
    note_solver(world_, frame_);
    note_balance(world_.balance(), frame_);
    frame_.workspace_turn = turn_.angle();
    frame_.workspace_rate = turn_.rate();
    frame_.lateness = late_.timing().lateness;
    frame_.tick_duration = late_.timing().last_tick;
    for (size_t i = 0; i < loops_.size(); ++i) {
        frame::FingerFrame& out = frame_.fingers[i];
        const haptics::ProxyTouch& touch = loops_[i].finger.touch();
        const devices::Reading& reading = link_.reading(i);
        out.buttons = reading.buttons;
        out.status = reading.status | loops_[i].force.status | fault_status(loops_[i].device_fault);
        note_motion(reading, handles_[i], world_.state(loops_[i].finger.proxy()), out);
        out.f_asked_W = loops_[i].force.asked_W.force;
        out.f_sent_W = loops_[i].force.sent_W.force;
        out.f_contact_W = touch.f_P_W;
        out.normal_force = touch.normal_force;
        frame_.status |= out.status;
    }
    for (size_t n = 0; n < turning_.size(); ++n) {
        const size_t i = turning_[n];
        frame_.turns[n] = {link_.reading(i).R_DH,
                           link_.reading(i).w_DH,
                           handles_[i].R_WH,
                           handles_[i].w_WH,
                           world_.state(loops_[i].finger.proxy()).w_WB,
                           loops_[i].force.asked_W.torque,
                           loops_[i].force.sent_W.torque};
    }
    note_bodies(world_, frame_);
    note_joints(world_.joints(), frame_);
    merge_contacts();
    measure_grasp();
}

void Servo::merge_contacts() noexcept {
    frame_.contacts.clear();
    merge_contacts(world_.contacts());
    for (const Loop& loop : loops_) merge_contacts(loop.finger.contacts());
}

void Servo::merge_contacts(std::span<const contact::Contact> contacts) noexcept {
    // contact points of the same pair are adjacent
    double pressed = 0;
    for (const contact::Contact& c : contacts) {
        const bool same = !frame_.contacts.empty() && frame_.contacts.back().a == c.a.value &&
                          frame_.contacts.back().b == c.b.value;
        if (!same) {
            if (frame_.contacts.size() == frame_.contacts.capacity()) {
                frame_.status |= kContactsFull;
                break;
            }
            frame::ContactFrame& out = frame_.contacts.emplace_back();
            out.a = c.a.value;
            out.b = c.b.value;
            out.gap = c.gap;
            pressed = 0;
        }
        frame::ContactFrame& out = frame_.contacts.back();
        // running means, weighted by contact force; the small constant gives unloaded contacts some
        // weight
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
    for (const Loop& loop : loops_) {
        const haptics::ProxyTouch& touch = loop.finger.touch();
        const Vec3 tangential = touch.f_P_W - touch.f_P_W.dot(touch.n_W) * touch.n_W;
        frame_.load_force += tangential.dot(down);
    }
    if (loops_.size() < 2) return;
    const Vec3 axis = model::grasp_axis(
        loops_.size(), [&](size_t i) -> const Vec3& { return frame_.fingers[i].p_WP; });
    double squeeze = 0;
    for (size_t i = 0; i < loops_.size(); ++i) {
        const haptics::ProxyTouch& touch = loops_[i].finger.touch();
        squeeze += (i == 0 ? -1 : 1) * touch.normal_force * touch.n_W.dot(axis);
    }
    frame_.grip_force = squeeze / 2;
}

}  // namespace dihaptic::servo
