#include "devices/replay/backend.h"

namespace dihaptic::devices::replay {
namespace {

/// The limits on force that held when the recording was made, and the device's properties then.
struct Options {
    double peak_force = std::numeric_limits<double>::infinity();  ///< [N]
    std::optional<double> continuous_force;                       ///< [N]
    std::optional<Vec3> workspace;                                ///< edges of the box [m]
    bool orientation = false;
    double peak_torque = 0;                   ///< [N*m]
    std::optional<double> continuous_torque;  ///< [N*m]
    double scale = 1;                         ///< DeviceInfo::scale
    bool simulated = false;                   ///< DeviceInfo::simulated
    /// Of handle and hand together [N*s/m]; infinite: late ticks softened nothing.
    double damping = std::numeric_limits<double>::infinity();

    template <class Visitor>
    void visit(Visitor& v) {
        v("peak_force", peak_force, Field::of(Quantity::force).positive().at_most(1e6));
        v("continuous_force", continuous_force, Field::of(Quantity::force).positive().at_most(1e6));
        v("workspace", workspace, Field::length().positive().at_most(1e4));
        v("orientation", orientation);
        v("peak_torque", peak_torque, Field::of(Quantity::torque).within(0, 1e4));
        v("continuous_torque", continuous_torque,
          Field::of(Quantity::torque).positive().at_most(1e4));
        v("scale", scale, Field::number().within(0.01, 100));
        v("simulated", simulated);
        v("damping", damping, Field::of(Quantity::damping).positive().at_most(1e4));
    }
};

std::vector<DeviceInfo> infos(const std::vector<DeviceConfig>& configs) {
    std::vector<DeviceInfo> out;
    Diagnostics diagnostics;
    for (const DeviceConfig& config : configs) {
        Options options;
        read_given_fields(options, config.options, diagnostics);
        DeviceInfo info;
        info.model = "recording";
        info.peak_force = options.peak_force;
        if (options.continuous_force) info.continuous_force = *options.continuous_force;
        info.workspace = options.workspace;
        info.measures_orientation = options.orientation;
        info.peak_torque = options.peak_torque;
        info.scale = options.scale;
        info.simulated = options.simulated;
        info.damping = options.damping;
        if (options.continuous_torque) info.continuous_torque = *options.continuous_torque;
        out.push_back(info);
    }
    diagnostics.throw_if_errors();
    return out;
}

class ReplayGroup final : public DeviceGroup {
  public:
    ReplayGroup(const std::vector<DeviceConfig>& configs, const Context& context)
        : DeviceGroup(infos(configs)), recording_(context.recording) {}

  private:
    void do_activate() override {}
    void do_deactivate() override {}
    void do_read(Time now, std::span<Reading> readings) noexcept override {
        if (recording_(now, readings)) return;
        for (Reading& reading : readings) reading.status |= kNoMoreData;
    }
    void do_write(std::span<const Wrench>) noexcept override {}

    std::function<bool(Time, std::span<Reading>)> recording_;
};

void check(const DeviceConfig& config, Diagnostics& diagnostics) {
    try {
        infos({config});
    } catch (const Error& e) {
        diagnostics.add(e.problems());
    }
}

std::unique_ptr<DeviceGroup> make(const std::vector<DeviceConfig>& configs,
                                  const Context& context) {
    if (!context.recording) {
        throw Error(configs.empty() ? Place{} : configs.front().place, "backend",
                    "devices of the backend 'replay' need a recording",
                    "Use dihaptic replay SESSION, or backend: simulated.");
    }
    return std::make_unique<ReplayGroup>(configs, context);
}

}  // namespace

Backend backend() {
    return {"replay", check, make};
}

}  // namespace dihaptic::devices::replay
