// Wraps another group of devices so that a test can replace readings and inspect the forces sent.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>

#include "devices/device_group.h"

namespace dihaptic::servo {

class PlantedGroup : public devices::DeviceGroup {
  public:
    /// `simulated` states whether the devices count as simulated; with real devices, a pause of the
    /// loop is a fault.
    PlantedGroup(std::unique_ptr<devices::DeviceGroup> inner, bool simulated)
        : DeviceGroup(infos(*inner, simulated)),
          told(static_cast<size_t>(inner->size())),
          inner_(std::move(inner)) {}

    std::function<void(std::span<devices::Reading>)> plant;  ///< may change the readings of a tick
    std::vector<Wrench> told;  ///< wrenches sent last, in each device's frame D
    bool fails = false;        ///< whether the next activation fails

    /// Largest force sent last [N]; NaN if any force is not a number.
    double largest_told() const {
        double out = 0;
        for (const Wrench& wrench : told) {
            const double force = wrench.force.norm();
            if (std::isnan(force)) return force;
            out = std::max(out, force);
        }
        return out;
    }

  private:
    static std::vector<frame::DeviceInfo> infos(const devices::DeviceGroup& inner, bool simulated) {
        std::vector<frame::DeviceInfo> out;
        for (int i = 0; i < inner.size(); ++i) {
            out.push_back(inner.info(i));
            out.back().simulated = simulated;
        }
        return out;
    }
    void do_activate() override {
        if (fails) throw Error({}, "devices", "are switched off", "Switch them on.");
        inner_->activate();
    }
    void do_deactivate() override { inner_->deactivate(); }
    void do_read(Time now, std::span<devices::Reading> readings) noexcept override {
        inner_->read(now, readings);
        if (plant) plant(readings);
    }
    void do_write(std::span<const Wrench> wrenches_D) noexcept override {
        std::copy(wrenches_D.begin(), wrenches_D.end(), told.begin());
        inner_->write(wrenches_D);
    }

    std::unique_ptr<devices::DeviceGroup> inner_;
};

}  // namespace dihaptic::servo
