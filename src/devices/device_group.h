// The interface to haptic devices. All devices of one backend are read and written together.
//
// The constructor of a group configures it, and may allocate and throw an Error with the remedy.
// Then activate() is called, followed by any number of pairs of read() and write(), one pair per
// tick, and finally deactivate(). read() and write() do not allocate or throw; they report problems
// in the status of each reading.
#pragma once

#include <cassert>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/clock.h"
#include "base/field_reader.h"
#include "base/geometry.h"
#include "base/status.h"
#include "frame/device_info.h"
#include "hand/driver.h"
#include "hand/spec.h"

namespace dihaptic {
class JsonSchema;
}

namespace dihaptic::devices {

/// State of one device, in its base frame D.
struct Reading {
    Vec3 p_DH = Vec3::Zero();  ///< endpoint [m]
    Vec3 v_DH = Vec3::Zero();  ///< [m/s]
    uint32_t buttons = 0;
    /// Bits of kStatusByDevice. With kNotAnswering, the rest of the reading is meaningless; with
    /// kUncalibrated, only the positions are meaningless. kForceDropped means that the device cut
    /// its force, but that force can be switched on again.
    uint32_t status = 0;
    /// For devices that measure orientation: rotation of the endpoint from the device's neutral
    /// orientation, and its angular velocity [rad/s].
    Quat R_DH = Quat::Identity();
    Vec3 w_DH = Vec3::Zero();
    /// For devices with a DeviceInfo::arm: the joint angles of the arm [rad].
    Vec3 joints = Vec3::Zero();
};

/// One device, as described in the rig file.
struct DeviceConfig {
    std::string finger;
    Pose X_WD;
    Node options;  ///< options, read by the backend
    Place place{};
    double scale = 1;  ///< ratio of movement in the world to movement of the hand, about D's origin
};

/// Data from the rest of the program that some backends need.
struct Context {
    double tick = 1e-3;                    ///< [s]
    const hand::Driver* driver = nullptr;  ///< moves the simulated fingers; must outlive the group
    hand::Impedance impedance;
    hand::TremorSpec tremor;
    uint64_t seed = 0;
    /// For replay: the recorded devices, and a function that provides the readings of each tick and
    /// returns false after the last tick.
    struct Recording {
        std::vector<frame::DeviceInfo> devices;
        std::function<bool(Time, std::span<Reading>)> read;
    };
    Recording recording;
};

/// All devices of one backend.
class DeviceGroup {
  public:
    virtual ~DeviceGroup() = default;

    bool active() const { return active_; }
    int size() const { return static_cast<int>(infos_.size()); }
    const frame::DeviceInfo& info(int device) const { return infos_[static_cast<size_t>(device)]; }
    const std::vector<frame::DeviceInfo>& descriptions() const { return infos_; }

    void activate() {
        assert(!active_);
        for (Output& output : outputs_) output.clamped = false;
        do_activate();
        active_ = true;
    }
    void deactivate() {
        if (active_) do_deactivate();
        active_ = false;
    }
    /// Reads the states of all devices at time `now`, one reading for each device.
    void read(Time now, std::span<Reading> readings) noexcept {
        assert(active_ && readings.size() == infos_.size());
        do_read(now, readings);
        for (size_t i = 0; i < readings.size(); ++i) {
            if (outputs_[i].clamped) readings[i].status |= kForceClamped;
        }
    }
    /// Commands the forces and torques on the endpoints, in the axes of D, with one wrench for each
    /// device, to be held until the next write. Torques are zero for devices that cannot render
    /// them. No device is ever sent more than its peak or limit(): a larger vector is scaled down
    /// to that limit, which is reported in the status of the next reading. A vector that is not
    /// finite is replaced with zero.
    void write(std::span<const Wrench> wrenches_D) noexcept;
    /// Sets limits for the commands to a device from now on [N], [N*m]. The device's peaks still
    /// apply.
    void limit(int device, double force, double torque) noexcept;
    /// The last problem that the manufacturer's library reported for a device, in words; "" if
    /// there is none. Must not be called during a tick.
    virtual std::string explain(int /*device*/) const { return ""; }
    /// Whether the devices determine when a tick is due, in which case pace() is called.
    virtual bool paces() const { return false; }
    /// Calls `tick`, which does one read() and one write(), whenever the devices are ready, until
    /// `tick` returns false. The calls come from this thread or from a thread of the manufacturer's
    /// library, but never two at a time.
    void pace(const std::function<bool()>& tick) {
        assert(active_ && paces());
        do_pace(tick);
    }
    /// Whether stop() may be called. If so, it may be called from any thread, even while another
    /// thread is in read() or write().
    virtual bool can_stop() const { return false; }
    /// Switches force off on all devices at once, until they are activated again, whatever forces
    /// are written. Returns whether force is known to be off.
    bool stop() noexcept {
        assert(can_stop());
        return do_stop();
    }

  protected:
    explicit DeviceGroup(std::vector<frame::DeviceInfo> infos);

  private:
    virtual void do_activate() = 0;
    virtual void do_deactivate() = 0;
    virtual void do_read(Time now, std::span<Reading> readings) noexcept = 0;
    virtual void do_write(std::span<const Wrench> wrenches_D) noexcept = 0;
    virtual void do_pace(const std::function<bool()>&) {}
    virtual bool do_stop() noexcept { return false; }
    /// For a group that wraps another group: passes the limit on in the units of the wrapped group.
    virtual void do_limit(int /*device*/, double /*force*/, double /*torque*/) noexcept {}

    struct Output {
        double most_force;   // [N]
        double most_torque;  // [N*m]
        bool clamped = false;
    };

    std::vector<frame::DeviceInfo> infos_;
    std::vector<Output> outputs_;
    std::vector<Wrench> told_;
    bool active_ = false;
};

/// A backend's findings on this machine, as shown by `dihaptic devices`.
struct Survey {
    struct Device {
        std::string serial;
        std::string model;
        std::string state;  ///< state in words, with a remedy if the device cannot be used
    };
    std::vector<Device> devices;
    std::string missing;  ///< why the backend cannot be used, and the remedy; "" if it can be
};

/// The first problem of an error with its remedy, but without the place in a file; used for
/// Survey::missing.
std::string in_words(const Error& error);

/// An entry in the table of backends. Each backend has a subfolder of this folder.
struct Backend {
    const char* name;
    /// Reads and checks the devices' options without touching hardware, and returns the device
    /// information that follows from them. Values that only an open device can report keep their
    /// defaults.
    std::vector<frame::DeviceInfo> (*describe)(const std::vector<DeviceConfig>& configs,
                                               const Context& context, Diagnostics& diagnostics);
    std::unique_ptr<DeviceGroup> (*make)(const std::vector<DeviceConfig>& configs,
                                         const Context& context);
    /// Whether the devices are real, i.e. move a person's hand and run only in real time.
    bool real = false;
    /// Looks for devices without moving them; null for a backend that is always available.
    Survey (*survey)() = nullptr;
    /// Adds the backend's options to the schema of rig files (base/json_schema.h); null for a
    /// backend that rig files cannot name.
    void (*options)(JsonSchema& schema) = nullptr;
};

/// All backends.
std::span<const Backend> backends();
/// The backend with this name; null if there is none.
const Backend* find_backend(const std::string& name);

}  // namespace dihaptic::devices
