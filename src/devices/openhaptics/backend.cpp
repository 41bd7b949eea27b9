#include "devices/openhaptics/backend.h"

#include <fmt/format.h>

#include "base/json_schema.h"
#include "devices/claims.h"
#include "devices/openhaptics/group.h"

namespace dihaptic::devices::openhaptics {
namespace {

std::vector<Options> read_options(const std::vector<DeviceConfig>& configs,
                                  Diagnostics& diagnostics) {
    std::vector<Options> options(configs.size());
    for (size_t i = 0; i < configs.size(); ++i)
        read_given_fields(options[i], configs[i].options, diagnostics);
    const auto all = [&](std::string Options::*option) {
        std::vector<std::string> out;
        out.reserve(options.size());
        for (const Options& one : options) out.push_back(one.*option);
        return out;
    };
    check_distinct(configs, "name", all(&Options::name), configs.size() > 1, diagnostics);
    check_distinct(configs, "serial", all(&Options::serial), false, diagnostics);
    check_one_library(configs, all(&Options::library), diagnostics);
    return options;
}

std::vector<frame::DeviceInfo> describe(const std::vector<DeviceConfig>& configs, const Context&,
                                        Diagnostics& diagnostics) {
    std::vector<frame::DeviceInfo> out;
    for (const Options& options : read_options(configs, diagnostics)) {
        out.push_back(options.info());
        out.back().model = options.name.empty() ? "the driver's first device" : options.name;
    }
    return out;
}

std::unique_ptr<DeviceGroup> make(const std::vector<DeviceConfig>& configs,
                                  const Context& context) {
    Diagnostics diagnostics;
    const std::vector<Options> options = read_options(configs, diagnostics);
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
            throw Error(
                configs[i].place, "name",
                fmt::format("{} and {} have the same serial number: they are one device under "
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
        // HD cannot list devices: without a name, only the first device can be found
        const Connection connection(hd, {}, {});
        out.devices.push_back(
            {connection.serial(), connection.model(),
             "the driver's first device; the driver's configuration names the others"});
    } catch (const Error& e) {
        out.missing = in_words(e);
    }
    return out;
}

}  // namespace

Backend backend() {
    return {.name = "openhaptics",
            .describe = describe,
            .make = make,
            .real = true,
            .survey = survey,
            .options = [](JsonSchema& schema) {
                schema.part_of_kind("options", "openhaptics", "Options.openhaptics", Options{});
            }};
}

}  // namespace dihaptic::devices::openhaptics
