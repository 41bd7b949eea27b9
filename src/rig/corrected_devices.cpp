#include "rig/corrected_devices.h"

namespace dihaptic::rig {
namespace {

std::vector<frame::DeviceInfo> infos(const devices::DeviceGroup& devices,
                                     const std::vector<Adjustment>& adjustments) {
    std::vector<frame::DeviceInfo> out;
    for (size_t i = 0; i < adjustments.size(); ++i)
        out.push_back(devices.descriptions()[i].scaled(adjustments[i].scale));
    return out;
}

class CorrectedGroup final : public devices::DeviceGroup {
  public:
    CorrectedGroup(std::unique_ptr<devices::DeviceGroup> devices,
                   std::vector<Adjustment> adjustments)
        : DeviceGroup(infos(*devices, adjustments)),
          inner_(std::move(devices)),
          adjustments_(std::move(adjustments)),
          slopes_(adjustments_.size(), Mat3::Identity()),
          wrenches_(adjustments_.size()) {}

    bool paces() const override { return inner_->paces(); }
    std::string explain(int device) const override { return inner_->explain(device); }
    bool can_stop() const override { return inner_->can_stop(); }

  private:
    void do_activate() override { inner_->activate(); }
    void do_deactivate() override { inner_->deactivate(); }
    void do_pace(const std::function<bool()>& tick) override { inner_->pace(tick); }
    bool do_stop() noexcept override { return inner_->stop(); }
    void do_limit(int device, double force, double torque) noexcept override {
        inner_->limit(device, force / adjustments_[static_cast<size_t>(device)].scale, torque);
    }

    void do_read(Time now, std::span<devices::Reading> readings) noexcept override {
        inner_->read(now, readings);
        for (size_t i = 0; i < readings.size(); ++i) {
            const auto& [correction, scale] = adjustments_[i];
            devices::Reading& reading = readings[i];
            const Quat& R = correction.X.R;
            slopes_[i] = correction.slope(reading.joints);
            reading.p_DH = scale * correction.position(reading.p_DH, reading.joints);
            reading.v_DH = scale * (slopes_[i] * reading.v_DH);
            reading.R_DH = R * reading.R_DH * R.conjugate();
            reading.w_DH = R * reading.w_DH;
        }
    }
    void do_write(std::span<const Wrench> wrenches_D) noexcept override {
        for (size_t i = 0; i < wrenches_.size(); ++i) {
            const auto& [correction, scale] = adjustments_[i];
            wrenches_[i] = {slopes_[i].transpose() * wrenches_D[i].force / scale,
                            correction.X.R.conjugate() * wrenches_D[i].torque};
        }
        inner_->write(wrenches_);
    }

    std::unique_ptr<devices::DeviceGroup> inner_;
    std::vector<Adjustment> adjustments_;
    std::vector<Mat3> slopes_;  // A at the last reading, indexed by device
    std::vector<Wrench> wrenches_;
};

}  // namespace

std::unique_ptr<devices::DeviceGroup> make_corrected(std::unique_ptr<devices::DeviceGroup> devices,
                                                     std::vector<Adjustment> adjustments) {
    return std::make_unique<CorrectedGroup>(std::move(devices), std::move(adjustments));
}

}  // namespace dihaptic::rig
