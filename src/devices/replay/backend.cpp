#include "devices/replay/backend.h"

namespace dihaptic::devices::replay {
namespace {

class ReplayGroup final : public DeviceGroup {
  public:
    explicit ReplayGroup(const Context::Recording& recording)
        : DeviceGroup(recording.devices), read_(recording.read) {}

  private:
    void do_activate() override {}
    void do_deactivate() override {}
    void do_read(Time now, std::span<Reading> readings) noexcept override {
        if (read_(now, readings)) return;
        for (Reading& reading : readings) reading.status |= kNoMoreData;
    }
    void do_write(std::span<const Wrench>) noexcept override {}

    std::function<bool(Time, std::span<Reading>)> read_;
};

constexpr const char* kNoRecording = "devices of the backend 'replay' need a recording";
constexpr const char* kRemedy = "Use dihaptic replay SESSION, or backend: simulated.";

/// Throws Error, because a rig file contains no recording.
std::vector<frame::DeviceInfo> describe(const std::vector<DeviceConfig>& configs,
                                        const Context& context, Diagnostics& diagnostics) {
    for (const DeviceConfig& config : configs)
        diagnostics.error(config.place, "backend", kNoRecording, kRemedy);
    return context.recording.devices;
}

std::unique_ptr<DeviceGroup> make(const std::vector<DeviceConfig>&, const Context& context) {
    if (!context.recording.read) throw Error(kNoRecording, kRemedy);
    return std::make_unique<ReplayGroup>(context.recording);
}

}  // namespace

Backend backend() {
    return {.name = "replay", .describe = describe, .make = make};
}

}  // namespace dihaptic::devices::replay
