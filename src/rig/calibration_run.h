// Takes the samples for a calibration: the part that guided and simulated runs share, and the
// simulated hand that moves simulated devices.
#pragma once

#include <functional>
#include <memory>

#include "rig/device_reader.h"
#include "rig/rig.h"

namespace dihaptic::rig {

/// Collects samples of a rig's devices, without corrections and scales, and with forces off.
class CalibrationSampler {
  public:
    /// Opens the rig's devices; `driver` moves them if they are simulated. Throws Error in the same
    /// cases as make_devices().
    CalibrationSampler(const Rig& rig, const hand::Driver* driver);

    void activate() { devices_->activate(); }
    void deactivate() { devices_->deactivate(); }
    DeviceReader& reader() { return reader_; }

    /// Adds a sample of two endpoints joined by the link, those of the first device and of device
    /// `other`, as they were at the last tick.
    void add_link(size_t other);
    /// Adds a sample of two endpoints held together, those of the first device and of device
    /// `other`, as they were at the last tick.
    void add_together(size_t other);
    /// Largest minus smallest distance between endpoints held together, from sample `from` onwards
    /// [m].
    double moved_apart(size_t from) const;
    void forget_together(size_t from) { input_.together_samples.resize(from); }
    /// Adds a sample of a device's endpoint touching a point of the jig, as it was at the last
    /// tick.
    void add_touch(size_t device, size_t point);
    /// Extents of the cloud of endpoints that a device has reached with the link so far, smallest
    /// first [m].
    Vec3 cloud(size_t device) const;
    const CalibrationInput& input() const { return input_; }

  private:
    CalibrationReading reading(size_t device) const {
        const devices::Reading& last = reader_.readings()[device];
        return {last.p_DH, last.joints};
    }

    std::unique_ptr<devices::DeviceGroup> devices_;
    std::vector<devices::DeviceClaim> claims_;
    DeviceReader reader_;
    CalibrationInput input_;
};

/// Lets a firm simulated hand carry a link of 50 mm through the common workspace of all devices,
/// with slips for a twentieth of the time, and touch the jig. Throws Error if the rig's devices are
/// not simulated. `progress` is called with the fraction done, and returns false to cancel.
CalibrationInput simulate_calibration(const Rig& rig, uint64_t seed,
                                      const std::function<bool(double share)>& progress);

}  // namespace dihaptic::rig
