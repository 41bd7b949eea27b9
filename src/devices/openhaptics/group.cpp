#include "devices/openhaptics/group.h"

#include <fmt/format.h>

#include <cmath>
#include <thread>

namespace dihaptic::devices::openhaptics {
namespace {

using Steady = std::chrono::steady_clock;

/// Times without a call after which the scheduler is given up: kSilence once it has started,
/// kBeginning before that.
constexpr auto kSilence = std::chrono::milliseconds(100);
constexpr auto kBeginning = std::chrono::seconds(2);
constexpr auto kLook = std::chrono::milliseconds(5);

std::vector<frame::DeviceInfo> infos(const std::vector<Connection>& connections) {
    std::vector<frame::DeviceInfo> out;
    out.reserve(connections.size());
    for (const Connection& connection : connections) out.push_back(connection.info());
    return out;
}

}  // namespace

Group::Group(const Hd& hd, std::vector<Connection> connections, double tick)
    : DeviceGroup(infos(connections)), hd_(hd), tick_(tick) {
    for (Connection& connection : connections)
        devices_.push_back({std::move(connection), false, 0, false, {}, kHdSuccess});
}

std::string Group::explain(int device) const {
    const unsigned code = devices_[static_cast<size_t>(device)].said;
    if (code == kHdSuccess) return "";
    const HdErrorText text = describe_error(code);
    return fmt::format("{}. {}.", text.what, text.remedy);
}

void Group::do_activate() {
    const double hz = 1 / tick_;
    hd_.set_scheduler_rate(static_cast<unsigned long>(std::lround(hz)));
    devices_.front().connection.check(fmt::format("does not run at {:g} ticks per second", hz),
                                      "rate");
    for (Device& device : devices_) {
        device.connection.calibrate();
        hd_.enable(kHdForceRamping);
        hd_.enable(kHdForceOutput);
        device.connection.check("cannot switch its force on", "name");
        device.framed = false;
        device.trouble = 0;
        device.drops.reset();
        device.said = kHdSuccess;
    }
    silent_ = false;
}

void Group::do_deactivate() {
    for (Device& device : devices_) {
        hd_.make_current(device.connection.handle());
        hd_.disable(kHdForceOutput);
    }
}

void Group::read(Device& device, Reading& reading) noexcept {
    hd_.begin_frame(device.connection.handle());
    device.framed = true;
    Vec3 position = Vec3::Zero();
    Vec3 velocity = Vec3::Zero();
    int buttons = 0;
    hd_.get_doubles(kHdPosition, position.data());
    hd_.get_doubles(kHdVelocity, velocity.data());
    hd_.get_integers(kHdButtons, &buttons);
    reading.p_DH = position * kPerMm - device.connection.centre();
    reading.v_DH = velocity * kPerMm;
    reading.buttons = static_cast<uint32_t>(buttons);
    if (device.connection.info().arm) {
        Vec3 joints = Vec3::Zero();
        hd_.get_doubles(kHdJointAngles, joints.data());
        reading.joints = {-joints[0], joints[1], joints[2]};  // positive to the right here
    }
    if (device.connection.info().measures_orientation) {
        Eigen::Matrix4d transform = Eigen::Matrix4d::Identity();
        hd_.get_doubles(kHdTransform, transform.data());
        hd_.get_doubles(kHdAngularVelocity, reading.w_DH.data());
        const Mat3 turn = transform.topLeftCorner<3, 3>();
        reading.R_DH = Quat(turn);
    }
    const Vec3& edges = *device.connection.info().workspace;
    if ((reading.p_DH.array().abs() > edges.array() / 2).any()) reading.status |= kOutsideWorkspace;
}

void Group::take_errors() noexcept {
    for (int i = 0; i < kMostErrors; ++i) {
        const HdErrorInfo error = hd_.get_error();
        const HdErrorClass kind = error_class(error.code);
        if (kind == HdErrorClass::none) return;
        bool named = false;
        for (const Device& device : devices_)
            named = named || device.connection.handle() == error.device;
        for (Device& device : devices_) {
            if (named && device.connection.handle() != error.device) continue;
            device.said = error.code;
            if (kind == HdErrorClass::force) device.dropped = true;
            if (kind == HdErrorClass::scheduler) device.trouble |= kNotAnswering;
            if (kind == HdErrorClass::device) device.trouble |= kDeviceFault;
        }
    }
}

void Group::do_read(Time now, std::span<Reading> readings) noexcept {
    for (Device& device : devices_) device.dropped = false;
    for (size_t i = 0; i < devices_.size(); ++i) {
        readings[i] = {};
        if (silent_) readings[i].status = kNotAnswering;
        if (!silent_ && devices_[i].trouble == 0) read(devices_[i], readings[i]);
    }
    if (silent_) return;
    take_errors();
    for (size_t i = 0; i < devices_.size(); ++i) {
        Device& device = devices_[i];
        readings[i].status |= device.trouble | device.drops.status(now, device.dropped);
    }
}

void Group::do_write(std::span<const Wrench> wrenches_D) noexcept {
    for (size_t i = 0; i < devices_.size(); ++i) {
        Device& device = devices_[i];
        // outside a tick, the scheduler is stopped and no force acts
        if (!device.framed) continue;
        device.framed = false;
        hd_.make_current(device.connection.handle());
        if (device.dropped && hd_.is_enabled(kHdForceOutput) == 0) hd_.enable(kHdForceOutput);
        const bool well = device.trouble == 0 && !device.dropped;
        const Wrench wrench = well ? wrenches_D[i] : Wrench{};
        hd_.set_doubles(kHdForce, wrench.force.data());
        if (device.connection.info().peak_torque > 0) {
            const Vec3 torque = wrench.torque / kPerMm;
            hd_.set_doubles(kHdTorque, torque.data());
        }
        hd_.end_frame(device.connection.handle());
    }
}

unsigned Group::on_tick(void* group) noexcept {
    Group& self = *static_cast<Group*>(group);
    Turn free = Turn::free;
    if (!self.turn_.compare_exchange_strong(free, Turn::inside)) return kHdDone;
    const bool on = (*self.paced_)();
    self.ticks_.fetch_add(1);
    self.turn_.store(on ? Turn::free : Turn::closed);
    if (on) return kHdContinue;
    self.ended_.store(true);
    return kHdDone;
}

/// Waits until the ticks have ended. Returns false if the scheduler stopped calling.
bool Group::wait_for_end() {
    uint64_t seen = 0;
    auto since = Steady::now();
    while (!ended_.load()) {
        std::this_thread::sleep_for(kLook);
        const auto now = Steady::now();
        const uint64_t ticks = ticks_.load();
        if (ticks != seen) since = now;
        seen = ticks;
        Turn free = Turn::free;
        // if a tick is blocked, the servo's watchdog deals with it: turn_ stays `inside`, so that
        // no other tick can start in the meantime
        if (now - since > (seen == 0 ? Steady::duration(kBeginning) : Steady::duration(kSilence)) &&
            turn_.compare_exchange_strong(free, Turn::closed))
            return false;
    }
    return true;
}

void Group::do_pace(const std::function<bool()>& tick) {
    paced_ = &tick;
    ticks_.store(0);
    ended_.store(false);
    turn_.store(Turn::free);
    const unsigned long handle = hd_.schedule(&Group::on_tick, this, kHdHighestPriority);
    hd_.start_scheduler();
    silent_ = !wait_for_end();
    hd_.stop_scheduler();
    if (silent_) hd_.unschedule(handle);
    for (Device& device : devices_) device.framed = false;
    if (!silent_) return;
    take_errors();
    // for an orderly end, the servo keeps ticking and recording until it finds that no device
    // answers and ends the session
    while (tick()) std::this_thread::sleep_for(std::chrono::duration<double>(tick_));
}

}  // namespace dihaptic::devices::openhaptics
