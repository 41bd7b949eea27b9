#include "devices/forcedimension/group.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <utility>

namespace dihaptic::devices::forcedimension {
namespace {

std::vector<frame::DeviceInfo> infos(const std::vector<Group::Device>& devices) {
    std::vector<frame::DeviceInfo> out;
    out.reserve(devices.size());
    for (const Group::Device& device : devices) out.push_back(device.info);
    return out;
}

const char* describe_cause(int cause) {
    switch (cause) {
        case kDhdByButton:
            return "Its force button is off: press it.";
        case kDhdByVelocity:
            return "It moved faster than its velocity threshold: move more slowly.";
        case kDhdByWatchdog:
            return "It received no command for 32 ms: close other programs.";
        case kDhdBySoftware:
            return "A program switched its force off.";
        case kDhdByUsb:
            return "Its USB connection failed: check its cable.";
        case kDhdByDeadMan:
            return "Nobody held its dead-man switch.";
        default:
            return "";
    }
}

}  // namespace

Connection::Connection(const Dhd& dhd, int n, const Place& place) : dhd_(dhd) {
    const int opened = dhd.open_id(static_cast<char>(n));
    if (opened < 0) {
        throw Error(
            place, "serial",
            fmt::format("connected device {} cannot be opened: {}", n + 1, dhd.last_error()),
            "Close other programs that use it. To see whether you have permission to open it, run "
            "dihaptic doctor.");
    }
    id_ = static_cast<char>(opened);
    const char* const name = dhd.system_name(id_);
    model_ = name == nullptr ? "Force Dimension device" : name;
    unsigned short serial = 0;
    if (dhd.serial_number(&serial, id_) >= 0) serial_ = serial;
}

Connection::~Connection() {
    if (id_ >= 0) dhd_.close(id_);
}

Connection::Connection(Connection&& other) noexcept
    : dhd_(std::move(other.dhd_)),
      id_(std::exchange(other.id_, static_cast<char>(-1))),
      model_(std::move(other.model_)),
      serial_(other.serial_) {}

Group::Group(const Dhd& dhd, std::vector<Device> devices)
    : DeviceGroup(infos(devices)),
      dhd_(dhd),
      devices_(std::move(devices)),
      running_(devices_.size()) {}

std::string Group::explain(int device) const {
    const Running& running = running_[static_cast<size_t>(device)];
    if (running.said[0] != '\0') return fmt::format("{}.", running.said.data());
    return describe_cause(running.cause);
}

void Group::keep_last_error(Running& running) noexcept {
    const char* const said = dhd_.last_error();
    if (said != nullptr) std::strncpy(running.said.data(), said, running.said.size() - 1);
}

Error Group::error(const Device& device, const std::string& doing) const {
    return {device.place, "serial", fmt::format("{} {}: {}", device.who, doing, dhd_.last_error()),
            "Check its power and its cable, and switch it off and on."};
}

/// Sets the device's watchdog, which switches its force off when the program crashes, is stopped or
/// hangs.
void Group::set_watchdog(const Device& device) const {
    dhd_.enable_expert_mode();
    const int done = dhd_.set_watchdog(kDhdLongestWatchdog, device.connection.id());
    const std::string said = dhd_.last_error();
    dhd_.disable_expert_mode();
    if (done >= 0) return;
    throw Error(device.place, "watchdog",
                fmt::format("{} has no usable watchdog: {}", device.who, said),
                "Without a watchdog the force may stay on if this program crashes. To continue "
                "anyway, with a hand near the device's switch, set options: watchdog: no.");
}

void Group::do_activate() {
    stopped_.store(false);
    for (size_t i = 0; i < devices_.size(); ++i) {
        const Device& device = devices_[i];
        const char id = device.connection.id();
        running_[i] = {};
        DhdStatus status{};
        if (dhd_.status(status.data(), id) < 0) throw error(device, "does not answer");
        if (status[kDhdPower] == 0) {
            throw Error(device.place, "serial", device.who + " has no power",
                        "Switch it on, and check its power supply.");
        }
        if (status[kDhdReset] != 0) {
            throw Error(
                device.place, "serial", device.who + " needs calibration",
                "Move it into all its end stops, or run its manufacturer's calibration program.");
        }
        if (dhd_.compensate_gravity(1, id) < 0)
            throw error(device, "cannot compensate its own weight");
        if (device.watchdog) set_watchdog(device);
        if (tell(device, {}) < 0 || dhd_.enable_force(1, id) < 0)
            throw error(device, "cannot switch its force on");
    }
}

void Group::do_deactivate() {
    for (const Device& device : devices_) {
        tell(device, {});
        dhd_.enable_force(0, device.connection.id());
    }
}

bool Group::read_motion(const Device& device, Reading& reading) noexcept {
    const char id = device.connection.id();
    Vec3& p = reading.p_DH;
    Vec3& v = reading.v_DH;
    if (dhd_.position(&p[0], &p[1], &p[2], id) < 0 || dhd_.velocity(&v[0], &v[1], &v[2], id) < 0)
        return false;
    if (!device.info.measures_orientation) return true;
    double rows[3][3] = {};
    Vec3& w = reading.w_DH;
    if (dhd_.orientation(rows, id) < 0 || dhd_.angular_velocity(&w[0], &w[1], &w[2], id) < 0)
        return false;
    Mat3 R_DH;
    for (int row = 0; row < 3; ++row) R_DH.row(row) = Eigen::RowVector3d(rows[row]);
    reading.R_DH = Quat(R_DH);
    return true;
}

uint32_t Group::read(size_t i, Time now, Reading& reading) noexcept {
    const char id = devices_[i].connection.id();
    Running& running = running_[i];
    running.off = false;
    DhdStatus status{};
    if (!read_motion(devices_[i], reading) || dhd_.status(status.data(), id) < 0) {
        keep_last_error(running);
        return kNotAnswering;
    }
    reading.buttons = dhd_.buttons(id);
    if (status[kDhdForce] == 0) running.cause = status[kDhdForceOffCause];
    if (status[kDhdPower] == 0 || status[kDhdConnected] == 0) return kNotAnswering;
    if (status[kDhdErrorIndex] != 0) {
        keep_last_error(running);
        return kDeviceFault;
    }
    if (status[kDhdReset] != 0) return kUncalibrated;
    uint32_t out = running.saturated ? uint32_t{kForceClamped} : 0;
    if (const auto& box = devices_[i].info.workspace;
        box && (reading.p_DH.array().abs() > box->array() / 2).any())
        out |= kOutsideWorkspace;
    if (status[kDhdForce] != 0 || stopped_.load(std::memory_order_relaxed)) return out;
    if (running.cause == kDhdByUsb) return kNotAnswering;
    running.off = true;
    return out | drop_status(running, now);
}

uint32_t Group::drop_status(Running& running, Time now) noexcept {
    // in a pause, nothing is written, so there is no force on the hand that could be lost
    if (running.cause == kDhdByWatchdog && running.quiet) {
        running.cause = 0;
        return 0;
    }
    // however long a person keeps force off in this way, it is not a fault
    if (running.cause == kDhdByButton || running.cause == kDhdByDeadMan) return kForceDropped;
    return running.drops.status(now, true);
}

void Group::do_read(Time now, std::span<Reading> readings) noexcept {
    for (size_t i = 0; i < devices_.size(); ++i) {
        readings[i] = {};
        readings[i].status = read(i, now, readings[i]);
    }
}

int Group::tell(const Device& device, const Wrench& wrench_D) noexcept {
    const Vec3& f = wrench_D.force;
    const Vec3& t = wrench_D.torque;
    const char id = device.connection.id();
    if (device.info.peak_torque == 0) return dhd_.set_force(f[0], f[1], f[2], id);
    return dhd_.set_force_and_torque(f[0], f[1], f[2], t[0], t[1], t[2], id);
}

void Group::do_write(std::span<const Wrench> wrenches_D) noexcept {
    const bool stopped = stopped_.load(std::memory_order_relaxed);
    for (size_t i = 0; i < devices_.size(); ++i) {
        Running& running = running_[i];
        const Wrench wrench = stopped || running.off ? Wrench{} : wrenches_D[i];
        const int done = tell(devices_[i], wrench);
        running.quiet = wrench.is_zero();
        running.saturated = done == 2;
        if (running.off && !stopped) dhd_.enable_force(1, devices_[i].connection.id());
        // if the connection is lost, the next reading reports it
        if (done < 0) keep_last_error(running);
    }
}

bool Group::do_stop() noexcept {
    stopped_.store(true);
    bool off = true;
    // several threads may call the library at the same time
    for (const Device& device : devices_)
        off = dhd_.enable_force(0, device.connection.id()) >= 0 && off;
    return off;
}

}  // namespace dihaptic::devices::forcedimension
