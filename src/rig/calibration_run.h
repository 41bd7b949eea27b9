// Takes the samples of a calibration: the part common to guided and simulated runs, and the
// simulated hand that moves simulated devices.
#pragma once

#include <functional>
#include <memory>

#include "rig/device_reader.h"
#include "rig/rig.h"

namespace dihaptic::rig {

/// Collects samples of a rig's devices, uncorrected and unscaled, with forces off.
class CalibrationSampler {
  public:
    /// Throws Error like make_devices(). `driver`: for simulated devices.
    CalibrationSampler(const Rig& rig, const hand::Driver* driver);

    void activate() { devices_->activate(); }
    void deactivate() { devices_->deactivate(); }
    DeviceReader& reader() { return reader_; }

    /// Adds the endpoints, at the last tick, of the first device and of device `other`, which the
    /// link joins.
    void add_link(size_t other);
    /// Adds the endpoints, at the last tick, of the first device and of device `other`, which are
    /// held together.
    void add_together(size_t other);
    /// Largest minus smallest distance of endpoints held together, from sample `from` on [m].
    double moved_apart(size_t from) const;
    void forget_together(size_t from) { input_.together_samples.resize(from); }
    /// Adds the last tick's endpoint of a device, on a point of the jig.
    void add_touch(size_t device, size_t point);
    /// Extents of the cloud of a device's joined endpoints so far, the smallest first [m].
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

/// A firm simulated hand carries a link of 50 mm through the common workspace of all devices, with
/// slips in a twentieth of the time, and touches the jig. Throws Error if the rig's devices are
/// not simulated. `progress` gets the fraction done, and returns false to cancel.
CalibrationInput simulate_calibration(const Rig& rig, uint64_t seed,
                                      const std::function<bool(double share)>& progress);

}  // namespace dihaptic::rig
