#include "servo/servo.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace dihaptic::servo {
namespace {

constexpr double kElsewhere = 5e-3;  // a proxy is reset if its handle moves this far in a pause [m]

/// Converts a device's reading into the fault that it reports.
FaultKind reported_by(const devices::Reading& reading) {
    FaultKind reported = FaultKind::none;
    for_each_status(reading.status, [&](Status bit) {
        if (reported == FaultKind::none) reported = describe(bit).faults[0].kind;
    });
    return reported;
}

/// Returns the box in which a hand is kept: the wall or, if there is no wall, the device's
/// workspace, if stated.
std::optional<haptics::WorkspaceBox> box_of(const frame::DeviceInfo& info, const Pose& X_0D,
                                            const std::optional<Eigen::AlignedBox3d>& wall) {
    if (wall) return haptics::WorkspaceBox{{Quat::Identity(), wall->center()}, wall->sizes()};
    if (info.workspace) return haptics::WorkspaceBox{X_0D, *info.workspace};
    return {};
}

dynamics::BodyIndex add_proxy(dynamics::World& world, const scene::Finger& finger,
                              scene::ProxyKind kind, bool changeable, bool turns) {
    const bool is_point = kind == scene::ProxyKind::point;
    if (!changeable) {
        return is_point ? world.add_point(finger, Vec3::Zero(), turns)
                        : world.add_proxy(finger, Vec3::Zero(), turns);
    }
    const dynamics::BodyIndex proxy = world.add_changeable_proxy(finger, Vec3::Zero(), turns);
    world.set_point(proxy, is_point);
    return proxy;
}

scene::ProxyKind other_than(scene::ProxyKind kind) {
    return kind == scene::ProxyKind::point ? scene::ProxyKind::rigid : scene::ProxyKind::point;
}

void scale_friction(double scale, dynamics::World& world) noexcept {
    if (!frame::Knobs::same(scale, world.friction_scale())) world.set_friction_scale(scale);
}

}  // namespace

Servo::Servo(const scene::Scene& scene, const frame::Settings& settings,
             std::unique_ptr<devices::DeviceGroup> devices, std::vector<Pose> X_WD,
             const std::optional<Eigen::AlignedBox3d>& wall)
    : settings_(settings),
      period_(from_seconds(settings.tick())),
      world_(scene, settings.dynamics),
      link_(std::move(devices), scene.fingers, settings.safety),
      turn_(X_WD),
      late_(settings),
      in_force_(settings.coupling),
      soft_start_(settings.safety.soft_start) {
    for (size_t i = 0; i < scene.fingers.size(); ++i) {
        const frame::DeviceInfo& info = link_.info(i);
        late_.add(info);
        const scene::Finger& finger = scene.fingers[i];
        const scene::ProxyKind kind = settings.proxy.of(finger.proxy);
        if (info.measures_orientation) turning_.push_back(i);
        const bool changeable = settings.proxy.changeable && !finger.proxy;
        const bool turns = info.measures_orientation && (changeable || turns_with_handle(kind));
        const dynamics::BodyIndex proxy = add_proxy(world_, finger, kind, changeable, turns);
        loops_.push_back({make_finger(scene, i, proxy, kind),
                          std::nullopt,
                          X_WD[i],
                          X_WD[i].inverse(),
                          haptics::HandleGuard(settings.safety.max_speed * info.scale),
                          {settings.safety, info, box_of(info, X_WD[i], wall), settings.tick()}});
        if (changeable) loops_[i].spare.emplace(make_finger(scene, i, proxy, other_than(kind)));
    }
    commands_.knobs = frame::Knobs::of(settings);
    handles_.resize(loops_.size());
}

/// A point proxy with friction of the kind "apart" cannot turn a body.
bool Servo::turns_with_handle(scene::ProxyKind kind) const noexcept {
    return kind == scene::ProxyKind::rigid ||
           settings_.proxy.friction == frame::PointFriction::together;
}

haptics::Finger Servo::make_finger(const scene::Scene& scene, size_t finger,
                                   dynamics::BodyIndex proxy, scene::ProxyKind kind) const {
    const scene::Finger& of = scene.fingers[finger];
    const frame::DeviceInfo& info = link_.info(finger);
    const auto made = [&] {
        if (kind == scene::ProxyKind::rigid) {
            return haptics::Finger(of, proxy, settings_.coupling,
                                   settings_.safety.largest_force(info.peak_force, info.scale));
        }
        if (settings_.proxy.friction == frame::PointFriction::together) {
            return haptics::Finger(
                haptics::SolvedPoint(scene, proxy, settings_.coupling, settings_.proxy), proxy);
        }
        return haptics::Finger(
            haptics::PointProxy(scene, proxy, settings_.coupling, settings_.proxy), proxy);
    };
    haptics::Finger out = made();
    if (info.measures_orientation && turns_with_handle(kind)) {
        const double inertia = kind == scene::ProxyKind::point ? 0 : world_.inertia(proxy);
        out.turn_with_handle(
            haptics::RotationalCoupling(settings_.coupling, inertia, rotation_xyz(of.rotation)));
    }
    return out;
}

void Servo::change_proxies(scene::ProxyKind kind) noexcept {
    settings_.proxy.kind = kind;
    for (size_t i = 0; i < loops_.size(); ++i) {
        Loop& loop = loops_[i];
        if (!loop.spare) continue;
        std::swap(loop.finger, *loop.spare);
        world_.set_point(loop.finger.proxy(), kind == scene::ProxyKind::point);
        loop.finger.retune(in_force_);
        loop.finger.place(world_, handles_[i]);
    }
    soft_start_.restart();
}

void Servo::activate() {
    world_.activate();
    frame_ = {};
    frame_.sequence = -1;
    reserve(frame_);
    commands_.task.reserve({frame_.bodies.size(), frame_.fingers.size()});
    link_.activate();
    stopped_ = false;
}

void Servo::reserve(frame::Frame& frame) const {
    frame.fingers.resize(loops_.size());
    frame.turns.resize(turning_.size());
    frame.bodies.resize(static_cast<size_t>(world_.scene_size()));
    frame.joints.resize(world_.joints().size());
    frame.changed.reserve(frame.bodies.size());
    frame.task.reserve({frame.bodies.size(), frame.fingers.size()});
    frame.contacts.reserve(64 + 8 * static_cast<size_t>(world_.size()));
}

void Servo::resume() {
    // devices that the watchdog stopped in the last tick before a pause are still stopped
    const bool were_stopped = link_.take_stop();
    if (faults_.tripped() || were_stopped) {
        link_.reactivate();
        // positions computed from a value that was not a number are lost
        const haptics::FaultKind kind = faults_.fault().kind;
        anew_ = world_.diverged() || kind == haptics::FaultKind::not_finite;
        if (world_.diverged()) world_.mend();
        faults_ = {};
    }
    for (size_t i = 0; i < loops_.size(); ++i) {
        const double scale = link_.info(i).scale;
        loops_[i].handle_guard = haptics::HandleGuard(settings_.safety.max_speed * scale);
        loops_[i].force_guard.restart();
    }
    soft_start_.restart();
    late_.restart();
    stopped_ = false;
    resting_ = false;
    resumed_ = true;
}

const frame::Frame& Servo::tick(Time now, const frame::Director& director) noexcept {
    measure(now);
    commands_.clear();
    if (director) director(frame_, handles_, commands_);
    turn_knobs();
    if (commands_.force_off) faults_.trip({haptics::FaultKind::stopped, -1, now});
    if (commands_.abandoned > 0)
        faults_.trip({haptics::FaultKind::abandoned, -1, now, commands_.abandoned});

    const dynamics::StepStatus step = advance_world();
    if (world_.diverged()) faults_.trip({haptics::FaultKind::diverged, -1, now});
    make_forces(now);
    link_.write();
    make_frame(now, commands_, step);
    const bool grace_over = faults_.tripped() && now - faults_.fault().time >= kGrace;
    const bool over =
        commands_.stop || commands_.force_off || grace_over || (frame_.status & kNoMoreData) != 0;
    resting_ = commands_.rest && !over;
    stopped_ = over || resting_;
    return frame_;
}

void Servo::turn_knobs() noexcept {
    const frame::Knobs& knobs = commands_.knobs;
    retune();
    if (knobs.proxy != settings_.proxy.kind) change_proxies(knobs.proxy);
    scale_friction(knobs.friction_scale, world_);
    turn_workspaces(knobs.workspace_rate);
}

dynamics::StepStatus Servo::advance_world() noexcept {
    if (world_.diverged()) return dynamics::StepStatus::diverged;
    order_bodies();
    order_joints();
    const double h = settings_.step();
    for (size_t i = 0; i < loops_.size(); ++i) loops_[i].finger.begin_tick(world_, handles_[i], h);
    if (!steps_now()) return dynamics::StepStatus::ok;
    world_.set_solver(commands_.knobs.solver);
    apply_loads();
    for (size_t i = 0; i < loops_.size(); ++i) loops_[i].finger.before_step(world_, handles_[i], h);
    const dynamics::StepStatus status = world_.step(h);
    if (status == dynamics::StepStatus::diverged) return status;
    for (size_t i = 0; i < loops_.size(); ++i) loops_[i].finger.after_step(world_, handles_[i]);
    return status;
}

void Servo::measure(Time now) noexcept {
    link_.read(now);
    const double elapsed = frame_.sequence < 0 ? 0 : seconds(now - frame_.time);
    late_.judge(now, elapsed, frame_.sequence < 0);
    // a device reports one position per period, even if two ticks come closer together
    const double moved_for = elapsed > 0 ? std::max(elapsed, settings_.tick()) : 0;
    if ((late_.is_real() && late_.fault()) || faults_.tripped()) turn_.stop();
    turn_.advance(elapsed);
    for (size_t i = 0; i < loops_.size(); ++i) {
        Loop& loop = loops_[i];
        const Quat& R_0D = loop.X_0D.R;
        const devices::Reading& reading = link_.reading(i);
        frame::Handle read{loop.X_0D * reading.p_DH, R_0D * reading.v_DH};
        const bool orientation = link_.info(i).measures_orientation;
        if (orientation) {
            // the same rotation, expressed in the world's axes
            read.R_WH = R_0D * reading.R_DH * R_0D.conjugate();
            read.w_WH = R_0D * reading.w_DH;
        }
        haptics::Fault fault;
        fault.device = static_cast<int>(i);
        fault.time = now;
        const frame::Handle before = loop.unturned;
        loop.unturned = loop.handle_guard.accept(read, reported_by(reading), moved_for, fault);
        loop.move = {loop.unturned.p_WH - before.p_WH,
                     rotation_vector(loop.unturned.R_WH * before.R_WH.conjugate())};
        loop.device_fault = fault.kind;
        faults_.trip(fault);
        handles_[i] = turn_.turned(loop.unturned, orientation);
        // a hand that moved during a pause must not fling away the objects in its path
        const bool elsewhere =
            resumed_ && (handles_[i].p_WH - frame_.fingers[i].p_WH).norm() > kElsewhere;
        if (frame_.sequence < 0 || elsewhere || anew_) loop.finger.place(world_, handles_[i]);
    }
    anew_ = false;
    // judged after the devices' reports, which say more than the pauses that they cause
    if (late_.is_real()) faults_.trip(late_.fault());
}

void Servo::retune() noexcept {
    const frame::CouplingSettings next =
        late_.softened(commands_.knobs.coupled(settings_.coupling));
    if (next == in_force_) return;
    in_force_ = next;
    for (Loop& loop : loops_) loop.finger.retune(in_force_);
}

void Servo::bound_rise(size_t finger, double share) noexcept {
    Force& force = loops_[finger].force;
    const Wrench asked = force.felt_0;
    force.felt_0 = late_.bounded(asked, force.last_0, loops_[finger].move, share, in_force_);
    if (force.felt_0.force != asked.force || force.felt_0.torque != asked.torque)
        force.status |= kSoftened;
}

void Servo::turn_workspaces(double rate) noexcept {
    if (faults_.tripped()) {
        turn_.stop();
    } else {
        turn_.order(rate, std::max(late_.elapsed(), settings_.tick()));
    }
    if (turn_.rate() == 0 && frame_.workspace_rate == 0) return;
    for (const Loop& loop : loops_) loop.finger.carry(world_, turn_.R(), turn_.angular_velocity());
}

void Servo::make_forces(Time now) noexcept {
    bool asked = false;
    const bool stepped = steps_now();
    const auto judge_shaking = [&](haptics::FaultKind kind, size_t i, double by) {
        if (by > 0 && !late_.is_harmless()) faults_.trip({kind, static_cast<int>(i), now, by});
    };
    for (size_t i = 0; i < loops_.size(); ++i) {
        Loop& loop = loops_[i];
        Force& force = loop.force;
        const Wrench last_0 = force.sent_0;
        force = {};
        force.last_0 = last_0;
        if (world_.diverged()) continue;  // a diverged world no longer determines a force
        force.asked_W.force = loop.finger.force(world_, handles_[i], settings_.tick());
        force.asked_W.torque = loop.finger.torque();
        const Pose& X_WP = world_.state(loop.finger.proxy()).X_WB;
        force.felt_W = loop.force_guard.shape(force.asked_W, handles_[i], X_WP,
                                              loop.finger.stored(), stepped, force.status);
        judge_shaking(haptics::FaultKind::active, i, loop.force_guard.feeding());
        add_loads(i, force.felt_W);
        force.felt_0 = turn_.unturned(force.felt_W);
        force.felt_0.force += loop.force_guard.push(loop.unturned, force.status);
        asked = asked || !force.felt_0.is_zero();
    }
    const bool held = link_.switch_held();
    // if a device drops its force, only half a grasp is left, so all forces stay off until they can
    // return gently
    const bool allowed = held && !link_.any_force_dropped() && !commands_.rest;
    const double rising = soft_start_.share(allowed, asked, settings_.tick());
    const double share = resumed_ ? 0 : rising;  // zero after a pause, even without a soft start
    for (size_t i = 0; i < loops_.size(); ++i) {
        haptics::ForceGuard& guard = loops_[i].force_guard;
        Force& force = loops_[i].force;
        bound_rise(i, share);
        force.sent_0 = guard.limit(force.felt_0, allowed, share, force.status);
        if (held) force.status &= ~uint32_t{kSwitchedOff};
        judge_shaking(haptics::FaultKind::chatters, i, guard.chatter());
        if (force.status & kNotFinite)
            faults_.trip({haptics::FaultKind::not_finite, static_cast<int>(i), now});
    }
    // a fault of one finger switches all fingers off: half a grasp would throw the hand aside
    for (size_t i = 0; i < loops_.size(); ++i) {
        Loop& loop = loops_[i];
        if (faults_.tripped()) {
            loop.force.sent_0 = {};
            loop.force_guard.drop();
        }
        const Wrench& sent_0 = loop.force.sent_0;
        link_.set(i, {loop.X_D0.R * sent_0.force, loop.X_D0.R * sent_0.torque});
        loop.force.sent_W = turn_.turned(sent_0);
    }
}

namespace {

/// Calls `act` for each object that received orders in the last tick but receives none now.
template <class Order, class Act>
void for_each_lapsed(const std::vector<Order>& before, const std::vector<Order>& now,
                     int32_t Order::*of, const Act& act) {
    for (const Order& last : before) {
        const bool ordered = std::any_of(now.begin(), now.end(),
                                         [&](const Order& other) { return other.*of == last.*of; });
        if (!ordered) act(last.*of);
    }
}

}  // namespace

void Servo::order_bodies() noexcept {
    const frame::TaskFrame& task = commands_.task;
    for (const frame::PlacementFrame& placement : task.placements)
        world_.set_pose({placement.body}, placement.X_WB);
    for (const frame::PlacementFrame& placement : task.placements) {
        if (!placement.v_WB.isZero(0) || !placement.w_WB.isZero(0))
            world_.set_motion({placement.body}, placement.v_WB, placement.w_WB);
    }
    for (const frame::DriveFrame& drive : task.drives) world_.drive({drive.body}, drive.X_WB);
    for_each_lapsed(frame_.task.properties, task.properties, &frame::PropertiesFrame::body,
                    [&](int32_t body) { world_.set_properties({body}, {}); });
    for (const frame::PropertiesFrame& now : task.properties) {
        world_.set_properties(
            {now.body}, {now.mass_scale, now.weight_scale, now.turning_scale, now.friction_scale,
                         now.stiffness_scale, now.restitution_scale, now.texture_wavelength_scale,
                         now.texture_height_scale, now.texture_friction_scale});
    }
}

void Servo::order_joints() noexcept {
    const frame::TaskFrame& task = commands_.task;
    for_each_lapsed(
        frame_.task.joint_properties, task.joint_properties, &frame::JointPropertiesFrame::joint,
        [&](int32_t joint) { world_.set_joint_properties(static_cast<size_t>(joint), {}); });
    for (const frame::JointPropertiesFrame& now : task.joint_properties) {
        world_.set_joint_properties(static_cast<size_t>(now.joint),
                                    {now.stiffness_scale, now.damping_scale, now.friction_scale});
    }
}

void Servo::apply_loads() noexcept {
    for (const frame::LoadFrame& load : commands_.task.loads) {
        if (load.body < world_.scene_size()) world_.apply({load.body}, load.force_W, load.torque_W);
    }
    for (const frame::MotorFrame& ordered : commands_.task.motors) {
        dynamics::Motor motor{{}, ordered.most_force, ordered.push};
        if (ordered.follows != 0) motor.position = ordered.position;
        world_.drive_joint(static_cast<size_t>(ordered.joint), motor);
    }
}

void Servo::add_loads(size_t finger, Wrench& felt_W) const noexcept {
    Wrench sum;
    for (const frame::LoadFrame& load : commands_.task.loads) {
        if (load.body != loops_[finger].finger.proxy().value) continue;
        sum.force += load.force_W;
        sum.torque += load.torque_W;
    }
    felt_W.force += sum.force;
    if (sum.torque != Vec3::Zero()) felt_W.torque += sum.torque;
}

}  // namespace dihaptic::servo
