#include "devices/forcedimension/group.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <utility>

namespace dihaptic::devices::forcedimension {
namespace {

std::vector<DeviceInfo> infos(const std::vector<Group::Device>& devices) {
    std::vector<DeviceInfo> out;
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
            return "Its watchdog had no force for too long: close other programs.";
        case kDhdBySoftware:
            return "A program switched its force off.";
        case kDhdByUsb:
            return "Its USB connection failed: look at its cable.";
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
        throw Error(place, "serial",
                    fmt::format("device {} of those that are connected cannot be opened: {}", n + 1,
                                dhd.last_error()),
                    "Close other programs that use it, and see src/devices/forcedimension for the "
                    "udev rule that lets ordinary users open it.");
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
            "Look at its power and its cable, and switch it off and on."};
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
                        "Switch it on, and look at its power supply.");
        }
        if (status[kDhdReset] != 0) {
            throw Error(device.place, "serial", device.who + " needs calibration",
                        "Move it into all its end stops, or run its maker's calibration program.");
        }
        if (dhd_.compensate_gravity(1, id) < 0) throw error(device, "cannot bear its own weight");
        if (dhd_.set_force(0, 0, 0, id) < 0 || dhd_.enable_force(1, id) < 0)
            throw error(device, "cannot switch its force on");
    }
}

void Group::do_deactivate() {
    for (const Device& device : devices_) {
        dhd_.set_force(0, 0, 0, device.connection.id());
        dhd_.enable_force(0, device.connection.id());
    }
}

uint32_t Group::read(size_t i, Time now, Reading& reading) noexcept {
    const char id = devices_[i].connection.id();
    Running& running = running_[i];
    running.dropped = false;
    DhdStatus status{};
    if (dhd_.position(&reading.p_DH[0], &reading.p_DH[1], &reading.p_DH[2], id) < 0 ||
        dhd_.velocity(&reading.v_DH[0], &reading.v_DH[1], &reading.v_DH[2], id) < 0 ||
        dhd_.status(status.data(), id) < 0) {
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
    if (status[kDhdReset] != 0) return kNeedsCalibration;
    uint32_t out = running.saturated ? uint32_t{kForceClamped} : 0;
    if (const auto& box = devices_[i].info.workspace;
        box && (reading.p_DH.array().abs() > box->array() / 2).any())
        out |= kOutsideWorkspace;
    if (status[kDhdForce] != 0 || stopped_.load(std::memory_order_relaxed)) return out;
    if (running.cause == kDhdByUsb) return kNotAnswering;
    running.dropped = true;
    // as long as a person wishes it off it is no fault
    if (running.cause == kDhdByButton || running.cause == kDhdByDeadMan) return out | kForceDropped;
    return out | running.drops.status(now, true);
}

void Group::do_read(Time now, std::span<Reading> readings) noexcept {
    for (size_t i = 0; i < devices_.size(); ++i) {
        readings[i] = {};
        readings[i].status = read(i, now, readings[i]);
    }
}

void Group::do_write(std::span<const Wrench> wrenches_D) noexcept {
    const bool stopped = stopped_.load(std::memory_order_relaxed);
    for (size_t i = 0; i < devices_.size(); ++i) {
        const char id = devices_[i].connection.id();
        Running& running = running_[i];
        const Vec3 force = stopped || running.dropped ? Vec3::Zero() : wrenches_D[i].force;
        const int done = dhd_.set_force(force.x(), force.y(), force.z(), id);
        running.saturated = done == 2;
        if (running.dropped && !stopped) dhd_.enable_force(1, id);
        // that the connection is lost shows in the next reading
        if (done < 0) keep_last_error(running);
    }
}

void Group::do_stop() noexcept {
    stopped_.store(true);
    // the library may be called from several threads at once
    for (const Device& device : devices_) dhd_.enable_force(0, device.connection.id());
}

}  // namespace dihaptic::devices::forcedimension
