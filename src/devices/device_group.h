// The interface to haptic devices: all devices of one backend, read and written together.
//
// The construction of a group configures it, and may allocate and throw an Error with the remedy.
// Then come activate(), any number of pairs of read() and write(), one pair a tick, and
// deactivate(). The pair neither allocates nor throws; problems are reported in each reading's
// status.
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
    /// Bits of kStatusByDevice. With kNotAnswering the rest of the reading is meaningless; with
    /// kUncalibrated only the positions are; kForceDropped is for a force that can be switched on
    /// again.
    uint32_t status = 0;
    /// Rotation of the endpoint from the device's neutral orientation, and its angular velocity
    /// [rad/s]; for devices that measure orientation.
    Quat R_DH = Quat::Identity();
    Vec3 w_DH = Vec3::Zero();
    /// Angles of the arm's joints [rad]; for devices with a DeviceInfo::arm.
    Vec3 joints = Vec3::Zero();
};

/// One device, as described in the rig file.
struct DeviceConfig {
    std::string finger;
    Pose X_WD;
    Node options;  ///< read by the backend
    Place place{};
    double scale = 1;  ///< ratio of movement in the world to the hand's, about D's origin
};

/// Data that some backends need from the rest of the program.
struct Context {
    double tick = 1e-3;                    ///< [s]
    const hand::Driver* driver = nullptr;  ///< moves the simulated fingers; outlives the group
    hand::Impedance impedance;
    hand::TremorSpec tremor;
    uint64_t seed = 0;
    /// For replay: the recorded devices, and a function that gives the readings of a tick, or
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
    /// Reads the states at time `now`, one for each device.
    void read(Time now, std::span<Reading> readings) noexcept {
        assert(active_ && readings.size() == infos_.size());
        do_read(now, readings);
        for (size_t i = 0; i < readings.size(); ++i) {
            if (outputs_[i].clamped) readings[i].status |= kForceClamped;
        }
    }
    /// Commands forces and torques on the endpoints, in the axes of D, one wrench for each device,
    /// to hold until the next write. Torques are zero for devices that render none. No device is
    /// ever sent more than its peak or limit(): a larger vector is scaled down to that limit, and
    /// the next reading's status reports this; a vector that is not finite becomes zero.
    void write(std::span<const Wrench> wrenches_D) noexcept;
    /// Limits the commands to a device from now on [N], [N*m]; its peaks remain in effect.
    void limit(int device, double force, double torque) noexcept;
    /// The last report of the manufacturer's library on a device, in words; "" if none. Not to be
    /// called in the cycle.
    virtual std::string explain(int /*device*/) const { return ""; }
    /// Whether the devices determine when a tick is due; then pace() is called.
    virtual bool paces() const { return false; }
    /// Calls `tick`, which does one read() and one write(), whenever the devices are ready, until
    /// `tick` returns false. The calls come from this thread or one of the manufacturer's, but
    /// never two at a time.
    void pace(const std::function<bool()>& tick) {
        assert(active_ && paces());
        do_pace(tick);
    }
    /// Whether stop() may be called. If so, any thread may call it, even while another is in read()
    /// or write().
    virtual bool can_stop() const { return false; }
    /// Switches force off at once on all devices, whatever is written, until they are activated
    /// again. Returns whether force is known to be off.
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
    /// For a group that wraps another: passes the limit on, in that group's units.
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

/// A backend's findings on this machine, shown by `dihaptic devices`.
struct Survey {
    struct Device {
        std::string serial;
        std::string model;
        std::string state;  ///< in words, with a remedy if it cannot be used
    };
    std::vector<Device> devices;
    std::string missing;  ///< the obstacle to the backend, and the remedy; "" if none
};

/// The first problem of an error and its remedy, without the place in a file: for Survey::missing.
std::string in_words(const Error& error);

/// An entry of the table of backends, one for each subfolder of this folder.
struct Backend {
    const char* name;
    /// Reads and checks the options of devices, without touching hardware, and returns the
    /// resulting information. Values that only an open device can report keep their defaults.
    std::vector<frame::DeviceInfo> (*describe)(const std::vector<DeviceConfig>& configs,
                                               const Context& context, Diagnostics& diagnostics);
    std::unique_ptr<DeviceGroup> (*make)(const std::vector<DeviceConfig>& configs,
                                         const Context& context);
    /// Whether its devices are real: they move a person's hand and run only in real time.
    bool real = false;
    /// Looks for devices without moving them; null for a backend that is always available.
    Survey (*survey)() = nullptr;
    /// Adds its options to the schema of rig files (base/json_schema.h); null for a backend that
    /// rig files cannot name.
    void (*options)(JsonSchema& schema) = nullptr;
};

/// All backends.
std::span<const Backend> backends();
/// The backend with that name; null if there is none.
const Backend* find_backend(const std::string& name);

}  // namespace dihaptic::devices
