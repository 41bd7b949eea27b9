// A group of devices served in one callback of HD's scheduler, which paces the tick. First, each
// device's frame is started and its state is read; then the tick is computed; finally, each
// device's force is set and its frame is ended.
//
// D has HD's axes (x right, y up, z toward the person). Its origin is the middle of the usable
// workspace stated by the device or, if the device's joint angles are used, HD's own origin.
#pragma once

#include <array>
#include <atomic>

#include "devices/device_group.h"
#include "devices/force_drops.h"
#include "devices/openhaptics/hd.h"

namespace dihaptic::devices::openhaptics {

/// Options for a device in the rig file.
struct Options {
    /// Name in the driver's configuration; if empty, the first device found is used.
    std::string name;
    std::string serial;   ///< required serial number; empty if any will do
    std::string library;  ///< path of libHD.so, if the system does not find it
    /// Whether the encoders are reset at each activation, with the arm in its neutral pose.
    bool encoder_reset = false;
    bool orientation = true;  ///< whether orientation is used if the device measures it
    /// A value below the device's own limit, or the limit itself if the device states none [N*m].
    std::optional<double> peak_torque;
    std::optional<double> continuous_torque;  ///< replaces the value that the device states [N*m]
    bool joint_angles = false;                ///< whether a Premium's joint angles are read, for a
                                              ///< calibration
    model::PhantomLinks links;                ///< link lengths, if joint angles are read
    std::optional<double> max_stiffness;      ///< replaces the value that the device states [N/m]
    std::optional<double> max_damping;        ///< replaces the value that the device states [N*s/m]

    template <class Visitor>
    void visit(Visitor& v) {
        v("name", name,
          says("Name in the driver's configuration; if left out, the first device found."));
        v("serial", serial, says("Required serial number; if left out, any."));
        v("library", library, says("Path of libHD.so, if the system does not find it."));
        v("encoder_reset", encoder_reset,
          says("Whether the encoders are reset at each start, with the arm in its neutral pose."));
        v("orientation", orientation,
          says("Whether the device's orientation is used, if measured."));
        v("peak_torque", peak_torque,
          Field::of(Quantity::torque)
              .within(1e-4, 100)
              .says("Limit to which larger torques are reduced: below the device's own limit, or "
                    "used where the device states none."));
        v("continuous_torque", continuous_torque,
          Field::of(Quantity::torque)
              .within(1e-4, 100)
              .says("Torque that the device can sustain, in place of the value it states."));
        v("joint_angles", joint_angles,
          says("Whether the joint angles of a Premium are read, for a calibration."));
        links.visit(v);
        v("max_stiffness", max_stiffness,
          Field::of(Quantity::stiffness)
              .within(1, 1e6)
              .says("Largest stiffness that the device renders stably, in place of the value it "
                    "states."));
        v("max_damping", max_damping,
          Field::of(Quantity::damping)
              .within(1e-3, 1e4)
              .says("Largest damping that the device renders stably, in place of the value it "
                    "states."));
    }

    /// The device information that follows from the options.
    frame::DeviceInfo info() const;
};

/// An initialised device, which the destructor disables.
class Connection {
  public:
    /// Initialises the device. Throws Error, at the device's place in the rig file, if that fails.
    Connection(const Hd& hd, const DeviceConfig& config, const Options& options);
    ~Connection();
    Connection(Connection&& other) noexcept;
    Connection(const Connection&) = delete;

    HdHandle handle() const { return handle_; }
    const Options& options() const { return options_; }
    /// A description such as "the thumb's device 'PHANToM 1' (PHANToM Premium 1.0, serial 40123)".
    std::string who() const;
    const std::string& model() const { return model_; }
    const std::string& serial() const { return serial_; }
    const Place& place() const { return place_; }
    const Vec3& centre() const { return centre_; }
    const frame::DeviceInfo& info() const { return info_; }

    /// Calibrates the device if it can calibrate itself. Throws Error if its positions are still
    /// meaningless afterwards.
    void calibrate() const;
    /// Empties the error stack, and throws Error for the newest error on it, if there is any.
    void check(const std::string& doing, const char* key) const;

  private:
    void forget_errors() const;
    double number(HdValue value) const;
    std::string text(HdValue value) const;
    void read_info();
    void check_joints() const;
    void read_limits_of_turning();

    Hd hd_;
    Options options_;
    std::string finger_;
    Place place_;
    HdHandle handle_ = kNoHandle;
    std::string model_;
    std::string serial_;
    Vec3 centre_ = Vec3::Zero();  // D's origin in HD's frame [m]
    frame::DeviceInfo info_;
};

class Group final : public DeviceGroup {
  public:
    Group(const Hd& hd, std::vector<Connection> connections, double tick);

    bool paces() const override { return true; }
    std::string explain(int device) const override;

  private:
    struct Device {
        Connection connection;
        bool framed = false;   // whether the device's frame has been started
        uint32_t trouble = 0;  // Status bits that remain set until the next activation
        bool dropped = false;  // whether the device cut its force in this tick
        ForceDrops drops;
        unsigned said = kHdSuccess;  // the device's last error
    };

    void do_activate() override;
    void do_deactivate() override;
    void do_read(Time now, std::span<Reading> readings) noexcept override;
    void do_write(std::span<const Wrench> wrenches_D) noexcept override;
    void do_pace(const std::function<bool()>& tick) override;

    void read(Device& device, Reading& reading) noexcept;
    void take_errors() noexcept;
    static unsigned on_tick(void* group) noexcept;
    bool wait_for_end();

    Hd hd_;
    std::vector<Device> devices_;
    double tick_;  // [s]

    // For pace(): `free` if the scheduler's thread may start a tick, `inside` if it is in one, and
    // `closed` if it may start no more.
    enum class Turn : int { free, inside, closed };
    const std::function<bool()>* paced_ = nullptr;
    std::atomic<Turn> turn_{Turn::closed};
    std::atomic<uint64_t> ticks_{0};
    std::atomic<bool> ended_{false};
    bool silent_ = false;
};

}  // namespace dihaptic::devices::openhaptics
