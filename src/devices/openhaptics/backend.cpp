#include "devices/openhaptics/backend.h"

#include <fmt/format.h>

#include "devices/openhaptics/group.h"

namespace dihaptic::devices::openhaptics {
namespace {

Options read_options(const DeviceConfig& config, Diagnostics& diagnostics) {
    Options options;
    if (config.options.kind != Node::Kind::null) read_fields(options, config.options, diagnostics);
    return options;
}

void check(const DeviceConfig& config, Diagnostics& diagnostics) {
    read_options(config, diagnostics);
}

/// Mistakes that are seen without a device.
void check_pairs(const std::vector<DeviceConfig>& configs, const std::vector<Options>& options,
                 Diagnostics& diagnostics) {
    for (size_t i = 0; i < options.size(); ++i) {
        const Options& a = options[i];
        if (a.name.empty() && options.size() > 1) {
            diagnostics.error(configs[i].place, "name", "is needed where there are several devices",
                              "Give options: name, as in the driver's configuration.");
        }
        if (a.library != options.front().library) {
            diagnostics.error(configs[i].place, "library", "differs from the first device's",
                              "One OpenHaptics serves all devices.");
        }
        for (size_t j = 0; j < i; ++j) {
            const Options& b = options[j];
            if (!a.name.empty() && a.name == b.name) {
                diagnostics.error(
                    configs[i].place, "name",
                    fmt::format("'{}' is the {}'s device too", a.name, configs[j].finger),
                    "Give each device a name of its own.");
            }
            if (!a.serial.empty() && a.serial == b.serial) {
                diagnostics.error(
                    configs[i].place, "serial",
                    fmt::format("{} is that of the {}'s device too", a.serial, configs[j].finger),
                    "Each device has its own: look at its type plate.");
            }
        }
    }
}

std::unique_ptr<DeviceGroup> make(const std::vector<DeviceConfig>& configs,
                                  const Context& context) {
    Diagnostics diagnostics;
    std::vector<Options> options;
    options.reserve(configs.size());
    for (const DeviceConfig& config : configs) options.push_back(read_options(config, diagnostics));
    check_pairs(configs, options, diagnostics);
    diagnostics.throw_if_errors();

    const Hd hd = load_hd(options.front().library, configs.front().place);
    std::vector<Connection> connections;
    connections.reserve(configs.size());
    for (size_t i = 0; i < configs.size(); ++i) {
        connections.emplace_back(hd, configs[i], options[i]);
        for (size_t j = 0; j < i; ++j) {
            if (connections[i].serial().empty() ||
                connections[i].serial() != connections[j].serial())
                continue;
            throw Error(configs[i].place, "name",
                        fmt::format("{} and {} have one serial number: they are one device, under "
                                    "two names",
                                    connections[i].who(), connections[j].who()),
                        "Correct the ports in the driver's configuration.");
        }
    }
    return std::make_unique<Group>(hd, std::move(connections), context.tick);
}

Survey survey() {
    Survey out;
    try {
        const Hd hd = load_hd("", {});
        // HD lists no devices: the first is all that can be found without a name
        const Connection connection(hd, {}, {});
        Survey::Device device{connection.serial(), connection.info().model,
                              "ready. Others are reached by their names in the driver's "
                              "configuration"};
        out.devices.push_back(device);
    } catch (const Error& e) {
        out.missing = e.problems().front().text();
    }
    return out;
}

}  // namespace

Backend backend() {
    return {"openhaptics", check, make, true, survey};
}

}  // namespace dihaptic::devices::openhaptics
