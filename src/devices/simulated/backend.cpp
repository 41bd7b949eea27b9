#include "devices/simulated/backend.h"

#include <fmt/format.h>

#include <atomic>

#include "devices/simulated/plant.h"

namespace dihaptic::devices::simulated {
namespace {

Options read_options(const DeviceConfig& config, Diagnostics& diagnostics) {
    Options options;
    if (config.options.kind != Node::Kind::null) read_fields(options, config.options, diagnostics);
    return options;
}

struct Device {
    Options options;
    Pose X_WD;
    Plant plant;
    Encoder encoder;
    uint32_t clamped = 0;
};

std::vector<DeviceInfo> infos(const std::vector<Options>& options, const Context& context) {
    std::vector<DeviceInfo> out;
    for (const Options& option : options) {
        DeviceInfo info;
        info.model = std::string("simulated ") + std::string(enum_name(option.preset));
        info.peak_force = option.peak_force;
        if (option.continuous_force) info.continuous_force = *option.continuous_force;
        info.damping = context.impedance.damping;
        info.mass = option.mass + context.impedance.mass;
        info.delay = option.delay_ticks * context.tick;
        info.workspace = option.workspace;
        out.push_back(info);
    }
    return out;
}

class SimulatedGroup final : public DeviceGroup {
  public:
    SimulatedGroup(const std::vector<DeviceConfig>& configs, const std::vector<Options>& options,
                   const Context& context)
        : DeviceGroup(infos(options, context)) {
        for (size_t i = 0; i < configs.size(); ++i) {
            devices_.push_back({options[i], configs[i].X_WD,
                                Plant(options[i], context.impedance, context.tremor, context.seed,
                                      static_cast<int>(i), *context.driver),
                                Encoder(options[i])});
        }
    }

    bool can_stop() const override { return true; }

  private:
    void do_activate() override {
        for (Device& device : devices_) device.plant.reset();
        stopped_.store(false);
    }
    void do_deactivate() override {}
    void do_read(Time now, std::span<Reading> readings) noexcept override {
        for (size_t i = 0; i < devices_.size(); ++i) {
            Device& device = devices_[i];
            if (stopped_.load(std::memory_order_relaxed)) device.plant.release();
            device.plant.advance(now);
            const Pose X_DW = device.X_WD.inverse();
            const Encoder::Measured measured = device.encoder.measure(
                now, X_DW * device.plant.p_WH(), X_DW.R * device.plant.v_WH());
            readings[i] = {measured.p, measured.v, static_cast<uint32_t>(device.options.buttons),
                           device.clamped};
            if (const auto& box = device.options.workspace;
                box && (measured.p.array().abs() > box->array() / 2).any()) {
                readings[i].status |= kOutsideWorkspace;
            }
        }
    }
    void do_write(std::span<const Vec3> f_D) noexcept override {
        for (size_t i = 0; i < devices_.size(); ++i) {
            Device& device = devices_[i];
            device.clamped =
                device.plant.hold(device.X_WD.R * f_D[i]) ? uint32_t{kForceClamped} : 0;
        }
    }

    void do_stop() noexcept override { stopped_.store(true); }

    std::vector<Device> devices_;
    std::atomic<bool> stopped_{false};
};

void check(const DeviceConfig& config, Diagnostics& diagnostics) {
    read_options(config, diagnostics);
}

std::unique_ptr<DeviceGroup> make(const std::vector<DeviceConfig>& configs,
                                  const Context& context) {
    if (context.driver == nullptr) {
        throw Error("simulated devices need a hand that moves them",
                    "Give the scene or the experiment a hand.");
    }
    Diagnostics diagnostics;
    std::vector<Options> options;
    options.reserve(configs.size());
    for (const DeviceConfig& config : configs) options.push_back(read_options(config, diagnostics));
    for (const Options& option : options) {
        if (Plant::holds(option, context.impedance)) continue;
        diagnostics.error(
            context.impedance.place, "impedance",
            fmt::format("the hand is stiffer or more damped than a simulated device of {:g} g can "
                        "follow",
                        (option.mass + context.impedance.mass) * 1e3),
            "A finger has about 300 N/m and 3 N*s/m: check the units.");
        break;
    }
    diagnostics.throw_if_errors();
    return std::make_unique<SimulatedGroup>(configs, options, context);
}

}  // namespace

Backend backend() {
    return {"simulated", check, make};
}

}  // namespace dihaptic::devices::simulated
