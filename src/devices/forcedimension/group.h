// A group of DHD devices. The servo's own thread paces the tick. D is the manufacturer's frame: x
// points toward the person, y to the right, z upwards, and the origin is in the middle of the
// workspace.
#pragma once

#include <atomic>

#include "base/number.h"
#include "devices/device_group.h"
#include "devices/force_drops.h"
#include "devices/forcedimension/dhd.h"

namespace dihaptic::devices::forcedimension {

/// Options for a device in the rig file.
struct Options {
    int serial = kAny;                        ///< kAny stands for the only connected device
    std::string library;                      ///< path of libdhd.so, if the system does not find it
    std::optional<double> peak_force;         ///< force limit for this device [N]
    std::optional<double> continuous_force;   ///< force that the device can sustain [N]
    std::optional<Vec3> workspace;            ///< edge lengths of the box around D's origin [m]
    bool orientation = true;                  ///< whether orientation is used, if it is measured
    std::optional<double> peak_torque;        ///< torque limit for this device [N*m]
    std::optional<double> continuous_torque;  ///< torque that the device can sustain [N*m]
    /// Whether to set the watchdog with which the device switches off its force when commands stop
    /// arriving; if false, the watchdog is left unchanged.
    bool watchdog = true;

    template <class Visitor>
    void visit(Visitor& v) {
        v("serial", serial,
          Field::number().within(0, 65535).says(
              "Serial number; if left out, the only connected device."));
        v("library", library, says("Path of libdhd.so, if the system does not find it."));
        v("peak_force", peak_force,
          Field::of(Quantity::force)
              .within(0.01, 1000)
              .says("Largest force requested from the device."));
        v("continuous_force", continuous_force,
          Field::of(Quantity::force).within(0.01, 1000).says("Force that the device can sustain."));
        v("workspace", workspace,
          Field::length().within(1e-3, 100).says(
              "Edges of the reachable box around the device's origin."));
        v("orientation", orientation,
          says("Whether the device's orientation is used, if measured."));
        v("peak_torque", peak_torque,
          Field::of(Quantity::torque)
              .within(1e-4, 100)
              .says("Largest torque requested from the device."));
        v("continuous_torque", continuous_torque,
          Field::of(Quantity::torque)
              .within(1e-4, 100)
              .says("Torque that the device can sustain."));
        v("watchdog", watchdog,
          says("Whether to set the watchdog by which the device ends its force when it receives "
               "nothing."));
    }

    static constexpr int kAny = -1;
    /// The serial number as text; "" stands for any device.
    std::string serial_text() const { return serial == kAny ? "" : number_text(serial); }
};

/// An open device, which the destructor closes.
class Connection {
  public:
    /// Opens the n-th connected device, counted from 0. Throws Error at `place` if the device
    /// cannot be opened.
    Connection(const Dhd& dhd, int n, const Place& place);
    ~Connection();
    Connection(Connection&& other) noexcept;
    Connection(const Connection&) = delete;

    char id() const { return id_; }
    const std::string& model() const { return model_; }
    int serial() const { return serial_; }

  private:
    Dhd dhd_;
    char id_ = -1;
    std::string model_;
    int serial_ = Options::kAny;
};

class Group final : public DeviceGroup {
  public:
    struct Device {
        Connection connection;
        frame::DeviceInfo info;
        std::string who;  ///< description of the device for use in messages
        Place place{};
        bool watchdog = true;
    };
    Group(const Dhd& dhd, std::vector<Device> devices);

    bool can_stop() const override { return true; }
    std::string explain(int device) const override;

  private:
    struct Running {
        ForceDrops drops;
        bool off = false;        // whether force was off in the reading of this tick
        bool quiet = true;       // whether the last force written was zero
        bool saturated = false;  // whether a motor has reached its limit
        int cause = 0;           // the last reason for which force was off, a DhdForceOff
        std::array<char, 160> said{};
    };

    void do_activate() override;
    void do_deactivate() override;
    void do_read(Time now, std::span<Reading> readings) noexcept override;
    void do_write(std::span<const Wrench> wrenches_D) noexcept override;
    bool do_stop() noexcept override;

    void set_watchdog(const Device& device) const;
    bool read_motion(const Device& device, Reading& reading) noexcept;
    uint32_t read(size_t i, Time now, Reading& reading) noexcept;
    /// The Status of a device whose force is off.
    static uint32_t drop_status(Running& running, Time now) noexcept;
    int tell(const Device& device, const Wrench& wrench_D) noexcept;
    void keep_last_error(Running& running) noexcept;
    Error error(const Device& device, const std::string& doing) const;

    Dhd dhd_;
    std::vector<Device> devices_;
    std::vector<Running> running_;
    std::atomic<bool> stopped_{false};
};

}  // namespace dihaptic::devices::forcedimension
