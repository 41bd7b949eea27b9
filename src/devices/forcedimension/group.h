// A group of DHD devices. Our own thread keeps time. D is the maker's own frame: x toward the
// person, y right, z up, its origin in the middle of the workspace.
#pragma once

#include <atomic>

#include "devices/device_group.h"
#include "devices/force_drops.h"
#include "devices/forcedimension/dhd.h"

namespace dihaptic::devices::forcedimension {

/// A device of the rig file.
struct Options {
    int serial = kAny;                        ///< kAny: the only one that is there
    std::string library;                      ///< libdhd.so, where it is not found by itself
    std::optional<double> peak_force;         ///< that it may be asked for [N]
    std::optional<double> continuous_force;   ///< that it can hold for long [N]
    std::optional<Vec3> workspace;            ///< edges of the box around D's origin [m]
    bool orientation = true;                  ///< whether it is used, of devices that measure it
    std::optional<double> peak_torque;        ///< that it may be asked for [N*m]
    std::optional<double> continuous_torque;  ///< that it can hold for long [N*m]
    /// Whether the device shall end its force by itself when it hears nothing; no: as it is.
    bool watchdog = true;

    template <class Visitor>
    void visit(Visitor& v) {
        v("serial", serial, Field::number().within(0, 65535));
        v("library", library);
        v("peak_force", peak_force, Field::of(Quantity::force).within(0.01, 1000));
        v("continuous_force", continuous_force, Field::of(Quantity::force).within(0.01, 1000));
        v("workspace", workspace, Field::length().within(1e-3, 100));
        v("orientation", orientation);
        v("peak_torque", peak_torque, Field::of(Quantity::torque).within(1e-4, 100));
        v("continuous_torque", continuous_torque, Field::of(Quantity::torque).within(1e-4, 100));
        v("watchdog", watchdog);
    }

    static constexpr int kAny = -1;
};

/// A device that was opened, until this ends.
class Connection {
  public:
    /// Throws Error, for `place`, when the n-th device that is there cannot be opened.
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
        DeviceInfo info;
        std::string who;  ///< for messages
        Place place{};
        bool watchdog = true;
    };
    Group(const Dhd& dhd, std::vector<Device> devices);

    bool can_stop() const override { return true; }
    std::string explain(int device) const override;

  private:
    struct Running {
        ForceDrops drops;
        bool off = false;        // it had no force on in this tick's reading
        bool quiet = true;       // it was last told no force
        bool saturated = false;  // a motor gave what it can
        int cause = 0;           // DhdForceOff, the last
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
    /// Of a device that has no force on.
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
