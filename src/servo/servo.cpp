#include "servo/servo.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace dihaptic::servo {
namespace {

constexpr double kElsewhere = 5e-3;  // of a handle after a pause [m]

/// What a device says is wrong with it.
haptics::FaultKind reported_by(const devices::Reading& reading) {
    if (reading.status & devices::kNotAnswering) return haptics::FaultKind::not_answering;
    if (reading.status & devices::kNeedsCalibration) return haptics::FaultKind::uncalibrated;
    if (reading.status & devices::kDeviceFault) return haptics::FaultKind::device_fault;
    return haptics::FaultKind::none;
}

}  // namespace

Servo::Servo(const scene::Scene& scene, const Settings& settings,
             std::unique_ptr<devices::DeviceGroup> devices, std::vector<Pose> X_WD,
             const std::optional<Eigen::AlignedBox3d>& wall)
    : settings_(settings),
      period_(from_seconds(settings.tick())),
      world_(scene, settings.dynamics),
      devices_(std::move(devices)),
      X_0D_(std::move(X_WD)),
      turn_(X_0D_),
      soft_start_(settings.safety.soft_start) {
    for (size_t i = 0; i < scene.fingers.size(); ++i) {
        const devices::DeviceInfo& info = devices_->info(static_cast<int>(i));
        std::optional<haptics::WorkspaceBox> box;
        if (wall) {
            box = {{Quat::Identity(), wall->center()}, wall->sizes()};
        } else if (info.workspace) {
            box = {X_0D_[i], *info.workspace};
        }
        force_guards_.emplace_back(
            settings.safety,
            haptics::DeviceLimits{info.peak_force, info.continuous_force, box, info.peak_torque,
                                  info.continuous_torque, info.scale},
            settings.tick());
        if (scene.fingers[i].name == settings.safety.dead_man_finger)
            dead_man_ = static_cast<int>(i);
        const scene::Finger& finger = scene.fingers[i];
        const haptics::ProxyKind kind = settings.proxy.of(finger);
        const bool is_point = kind == haptics::ProxyKind::point;
        if (info.measures_orientation) turning_.push_back(i);
        const bool changeable = settings.proxy.changeable && !finger.proxy;
        const bool turns = info.measures_orientation && (changeable || turns_with_handle(kind));
        const dynamics::BodyIndex proxy =
            changeable ? world_.add_changeable_proxy(finger, Vec3::Zero(), turns)
            : is_point ? world_.add_point(finger, Vec3::Zero(), turns)
                       : world_.add_proxy(finger, Vec3::Zero(), turns);
        fingers_.push_back(make_finger(scene, i, proxy, kind));
        spares_.emplace_back();
        if (changeable) {
            world_.set_point(proxy, is_point);
            spares_.back().emplace(make_finger(
                scene, i, proxy, is_point ? haptics::ProxyKind::rigid : haptics::ProxyKind::point));
        }
        X_D0_.push_back(X_0D_[i].inverse());
        guards_.emplace_back(settings.safety.max_speed * info.scale);
    }
    const size_t n = fingers_.size();
    readings_.resize(n);
    handles_.resize(n);
    unturned_.resize(n);
    device_faults_.resize(n);
    forces_.resize(n);
    sent_D_.resize(n);
}

Servo::~Servo() {
    deactivate();
}

/// A point apart has nothing that could turn a body.
bool Servo::turns_with_handle(haptics::ProxyKind kind) const noexcept {
    return kind == haptics::ProxyKind::rigid ||
           settings_.proxy.friction == haptics::PointFriction::together;
}

haptics::Finger Servo::make_finger(const scene::Scene& scene, size_t finger,
                                   dynamics::BodyIndex proxy, haptics::ProxyKind kind) const {
    const scene::Finger& of = scene.fingers[finger];
    const devices::DeviceInfo& info = devices_->info(static_cast<int>(finger));
    const auto made = [&] {
        if (kind == haptics::ProxyKind::rigid) {
            return haptics::Finger(of, proxy, settings_.coupling,
                                   settings_.safety.largest_force(info.peak_force, info.scale));
        }
        if (settings_.proxy.friction == haptics::PointFriction::together) {
            return haptics::Finger(
                haptics::SolvedPoint(scene, proxy, settings_.coupling, settings_.proxy), proxy);
        }
        return haptics::Finger(
            haptics::PointProxy(scene, finger, proxy, settings_.coupling, settings_.proxy), proxy);
    };
    haptics::Finger out = made();
    if (info.measures_orientation && turns_with_handle(kind)) {
        const double inertia = kind == haptics::ProxyKind::point ? 0 : world_.inertia(proxy);
        out.turn_with_handle(
            haptics::RotationalCoupling(settings_.coupling, inertia, rotation_xyz(of.rotation)));
    }
    return out;
}

void Servo::change_proxies(haptics::ProxyKind kind) noexcept {
    settings_.proxy.kind = kind;
    for (size_t i = 0; i < fingers_.size(); ++i) {
        if (!spares_[i]) continue;
        std::swap(fingers_[i], *spares_[i]);
        world_.set_point(fingers_[i].proxy(), kind == haptics::ProxyKind::point);
        fingers_[i].retune(settings_.coupling);
        fingers_[i].set_friction_scale(world_.friction_scale());
        fingers_[i].place(world_, handles_[i]);
    }
    soft_start_.restart();
}

void Servo::activate() {
    world_.activate();
    frame_ = {};
    frame_.sequence = -1;
    reserve(frame_);
    commands_.task.reserve(frame_.bodies.size());
    devices_->activate();
    active_ = true;
    stopped_ = false;
}

void Servo::reserve(Frame& frame) const {
    frame.fingers.resize(fingers_.size());
    frame.turns.resize(turning_.size());
    frame.bodies.resize(static_cast<size_t>(world_.scene_size()));
    frame.changed.reserve(frame.bodies.size());
    frame.task.reserve(frame.bodies.size());
    frame.contacts.reserve(64 + 8 * static_cast<size_t>(world_.size()));
}

void Servo::rest() noexcept {
    std::fill(sent_D_.begin(), sent_D_.end(), Wrench{});
    devices_->write(sent_D_);
}

void Servo::resume() {
    if (faults_.tripped()) {
        devices_->deactivate();
        active_ = false;
        devices_->activate();
        active_ = true;
        faults_ = {};
    }
    for (size_t i = 0; i < guards_.size(); ++i) {
        guards_[i] = haptics::HandleGuard(settings_.safety.max_speed *
                                          devices_->info(static_cast<int>(i)).scale);
    }
    soft_start_.restart();
    stopped_ = false;
    resumed_ = true;
}

void Servo::deactivate() {
    if (!active_) return;
    rest();
    devices_->deactivate();
    active_ = false;
}

bool Servo::stop_devices() noexcept {
    if (!devices_->can_stop()) return false;
    devices_->stop();
    return true;
}

void Servo::note_timing(double lateness, double last_tick, bool overrun) noexcept {
    lateness_ = lateness;
    last_tick_ = last_tick;
    overrun_ = overrun;
}

const Frame& Servo::tick(Time now, const Director& director) noexcept {
    measure(now);
    commands_.task.clear();
    commands_.stop = false;
    commands_.force_off = false;
    commands_.tuning.reset();
    commands_.proxy.reset();
    commands_.friction_scale.reset();
    commands_.workspace_rate = 0;
    if (director) director(frame_, handles_, commands_);
    if (commands_.tuning && *commands_.tuning != settings_.coupling.tuning()) {
        settings_.coupling.set(*commands_.tuning);
        for (haptics::Finger& finger : fingers_) finger.retune(settings_.coupling);
    }
    if (commands_.proxy && *commands_.proxy != settings_.proxy.kind)
        change_proxies(*commands_.proxy);
    if (commands_.friction_scale && *commands_.friction_scale != world_.friction_scale()) {
        world_.set_friction_scale(*commands_.friction_scale);
        for (haptics::Finger& finger : fingers_)
            finger.set_friction_scale(*commands_.friction_scale);
    }
    turn_workspaces(commands_.workspace_rate);
    if (commands_.force_off) faults_.trip({haptics::FaultKind::stopped, -1, now});

    order_bodies();
    for (size_t i = 0; i < fingers_.size(); ++i)
        fingers_[i].begin_tick(world_, handles_[i], settings_.step());
    dynamics::StepStatus step = dynamics::StepStatus::ok;
    if (steps_now()) {
        const double h = settings_.step();
        if (commands_.solver) world_.set_solver(*commands_.solver);
        for (const LoadFrame& load : commands_.task.loads) {
            if (load.body < world_.scene_size())
                world_.apply({load.body}, load.force_W, load.torque_W);
        }
        for (size_t i = 0; i < fingers_.size(); ++i)
            fingers_[i].before_step(world_, handles_[i], h);
        step = world_.step(h);
        for (size_t i = 0; i < fingers_.size(); ++i) fingers_[i].after_step(world_, handles_[i]);
    }
    make_forces(now);
    devices_->write(sent_D_);
    make_frame(now, commands_, step);
    const bool grace_over = faults_.tripped() && now - faults_.fault().time >= kGrace;
    stopped_ =
        commands_.stop || commands_.force_off || grace_over || (frame_.status & kNoMoreData) != 0;
    return frame_;
}

void Servo::measure(Time now) noexcept {
    devices_->read(now, readings_);
    const double elapsed = frame_.sequence < 0 ? 0 : seconds(now - frame_.time);
    const bool late = elapsed > settings_.safety.max_pause;
    // a device has one position a period, however near to each other two ticks come
    const double moved_for = elapsed > 0 ? std::max(elapsed, settings_.tick()) : 0;
    if (late || faults_.tripped()) turn_.stop();
    turn_.advance(elapsed);
    for (size_t i = 0; i < fingers_.size(); ++i) {
        haptics::Handle read{X_0D_[i] * readings_[i].p_DH, X_0D_[i].R * readings_[i].v_DH};
        const bool orientation = devices_->info(static_cast<int>(i)).measures_orientation;
        if (orientation) {
            // the same turn, about the world's axes
            const Quat& R_0D = X_0D_[i].R;
            read.R_WH = R_0D * readings_[i].R_DH * R_0D.conjugate();
            read.w_WH = R_0D * readings_[i].w_DH;
        }
        haptics::Fault fault;
        fault.device = static_cast<int>(i);
        fault.time = now;
        unturned_[i] = guards_[i].accept(read, reported_by(readings_[i]), moved_for, fault);
        device_faults_[i] = fault.kind;
        faults_.trip(fault);
        handles_[i] = turn_.turned(unturned_[i], orientation);
        // a hand that moved in a pause does not throw about what lies between
        const bool elsewhere =
            resumed_ && (handles_[i].p_WH - frame_.fingers[i].p_WH).norm() > kElsewhere;
        if (frame_.sequence < 0 || elsewhere) fingers_[i].place(world_, handles_[i]);
    }
    // last: a device that says what is wrong with it says more than the pause that it made
    if (late)
        faults_.trip({haptics::FaultKind::late, -1, now, elapsed, settings_.safety.max_pause});
}

void Servo::turn_workspaces(double rate) noexcept {
    if (faults_.tripped()) {
        turn_.stop();
    } else {
        turn_.order(rate, settings_.tick());
    }
    if (turn_.rate() == 0 && frame_.workspace_rate == 0) return;
    for (const haptics::Finger& finger : fingers_)
        finger.carry(world_, turn_.R(), turn_.angular_velocity());
}

void Servo::make_forces(Time now) noexcept {
    bool asked = false;
    const bool stepped = steps_now();
    for (size_t i = 0; i < fingers_.size(); ++i) {
        Force& force = forces_[i];
        force.flags = 0;
        force.asked_W.force = fingers_[i].force(world_, handles_[i], settings_.tick());
        force.asked_W.torque = fingers_[i].torque();
        const Pose& X_WP = world_.state(fingers_[i].proxy()).X_WB;
        force.felt_W = force_guards_[i].shape(force.asked_W, handles_[i], X_WP,
                                              fingers_[i].stored(), stepped, force.flags);
        force.felt_W.force += field_on(i);
        force.felt_0 = turn_.unturned(force.felt_W);
        force.felt_0.force += force_guards_[i].push(unturned_[i], force.flags);
        asked = asked || !force.felt_0.is_zero();
    }
    // a device without force leaves half a grasp: the others wait with it, and all come on softly
    const bool dropped =
        std::any_of(readings_.begin(), readings_.end(), [](const devices::Reading& reading) {
            return (reading.status & devices::kForceDropped) != 0;
        });
    const bool held = switch_held();
    const bool allowed = held && !dropped;
    const double share = soft_start_.share(allowed, asked, settings_.tick());
    for (size_t i = 0; i < fingers_.size(); ++i) {
        Force& force = forces_[i];
        force.sent_0 = force_guards_[i].limit(force.felt_0, allowed, share, force.flags);
        if (held) force.flags &= ~static_cast<unsigned>(haptics::kSwitchedOff);
        if (force.flags & haptics::kNotFinite)
            faults_.trip({haptics::FaultKind::not_finite, static_cast<int>(i), now});
    }
    // one finger's fault is every finger's: half a grasp would throw the hand aside
    for (size_t i = 0; i < fingers_.size(); ++i) {
        if (faults_.tripped()) forces_[i].sent_0 = {};
        const Wrench& sent_0 = forces_[i].sent_0;
        sent_D_[i] = {X_D0_[i].R * sent_0.force, X_D0_[i].R * sent_0.torque};
        forces_[i].sent_W = turn_.turned(sent_0);
    }
}

void Servo::order_bodies() noexcept {
    const TaskFrame& task = commands_.task;
    for (const PlacementFrame& placement : task.placements)
        world_.set_pose({placement.body}, placement.X_WB);
    const auto ordered = [&](const PropertiesFrame& before) {
        return std::any_of(task.properties.begin(), task.properties.end(),
                           [&](const PropertiesFrame& now) { return now.body == before.body; });
    };
    for (const PropertiesFrame& before : frame_.task.properties) {
        if (!ordered(before)) world_.set_properties({before.body}, {});
    }
    for (const PropertiesFrame& now : task.properties) {
        world_.set_properties(
            {now.body}, {now.mass_scale, now.weight_scale, now.turning_scale, now.friction_scale});
    }
}

Vec3 Servo::field_on(size_t finger) const noexcept {
    Vec3 force = Vec3::Zero();
    for (const LoadFrame& load : commands_.task.loads) {
        if (load.body == fingers_[finger].proxy().value) force += load.force_W;
    }
    return force;
}

bool Servo::switch_held() const noexcept {
    if (settings_.safety.dead_man_finger.empty()) return true;
    if (dead_man_ < 0) return false;  // nobody holds a switch that is not there
    const devices::Reading& reading = readings_[static_cast<size_t>(dead_man_)];
    return (reading.buttons >> settings_.safety.dead_man_button & 1u) != 0;
}

}  // namespace dihaptic::servo
