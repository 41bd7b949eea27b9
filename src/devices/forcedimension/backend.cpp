#include "devices/forcedimension/backend.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "base/json_schema.h"
#include "base/number.h"
#include "devices/claims.h"
#include "devices/forcedimension/group.h"

namespace dihaptic::devices::forcedimension {
namespace {

const char* const kNobody =
    "Check its power and its USB cable; an ordinary user needs a udev rule for USB vendor 1451 "
    "(Falcon: 0403): dihaptic doctor checks this rule, and gives the commands.";

std::vector<Options> read_options(const std::vector<DeviceConfig>& configs,
                                  Diagnostics& diagnostics) {
    std::vector<Options> options(configs.size());
    std::vector<std::string> serials;
    std::vector<std::string> libraries;
    for (size_t i = 0; i < configs.size(); ++i) {
        read_given_fields(options[i], configs[i].options, diagnostics);
        serials.push_back(options[i].serial_text());
        libraries.push_back(options[i].library);
    }
    check_distinct(configs, "serial", serials, configs.size() > 1, diagnostics);
    check_one_library(configs, libraries, diagnostics);
    return options;
}

frame::DeviceInfo info_of(const Options& options) {
    frame::DeviceInfo info;
    info.serial = options.serial_text();
    info.model = "Force Dimension device";
    if (!info.serial.empty()) info.model += " " + info.serial;
    if (options.continuous_force) info.continuous_force = *options.continuous_force;
    info.workspace = options.workspace;
    return info;
}

std::vector<frame::DeviceInfo> describe(const std::vector<DeviceConfig>& configs, const Context&,
                                        Diagnostics& diagnostics) {
    std::vector<frame::DeviceInfo> out;
    for (const Options& options : read_options(configs, diagnostics))
        out.push_back(info_of(options));
    return out;
}

/// Opens every device that can be opened. Throws the last Error if no device can be opened.
std::vector<Connection> open_all(const Dhd& dhd, const Place& place) {
    const int count = dhd.device_count();
    if (count <= 0) throw Error(place, "serial", "no Force Dimension device is connected", kNobody);
    std::vector<Connection> out;
    for (int n = 0; n < count; ++n) {
        try {
            out.emplace_back(dhd, n, place);
        } catch (const Error&) {
            if (n + 1 == count && out.empty()) throw;
        }
    }
    return out;
}

/// Removes the connection to one of the rig's devices from `there`, and returns it. Throws Error if
/// no connection fits the options, or if more than one does.
Connection take(std::vector<Connection>& there, const Options& options, const Place& place) {
    const bool chosen = options.serial != Options::kAny;
    std::vector<size_t> fits;
    std::vector<std::string> all;
    for (size_t i = 0; i < there.size(); ++i) {
        if (!chosen || there[i].serial() == options.serial) fits.push_back(i);
        all.push_back(fmt::format("{} {}", there[i].model(), there[i].serial()));
    }
    if (fits.empty()) {
        throw Error(place, "serial", fmt::format("no device has serial number {}", options.serial),
                    fmt::format("Those connected are {}. {}", fmt::join(all, ", "), kNobody));
    }
    if (fits.size() > 1 && chosen) {
        throw Error(place, "serial",
                    fmt::format("two devices have serial number {}: they cannot be told apart",
                                options.serial),
                    "Unplug one; its manufacturer can give it another number.");
    }
    if (fits.size() > 1) {
        throw Error(place, "serial", "is needed: several devices are connected",
                    fmt::format("Those connected are {}.", fmt::join(all, ", ")));
    }
    Connection out = std::move(there[fits[0]]);
    std::vector<Connection> rest;
    for (size_t i = 0; i < there.size(); ++i) {
        if (i != fits[0]) rest.push_back(std::move(there[i]));
    }
    there.swap(rest);
    return out;
}

/// Adds orientation and torque to `info`. A device that does not measure orientation does not
/// render torque.
void add_wrist(const Dhd& dhd, const Connection& connection, const Options& options,
               const Place& place, frame::DeviceInfo& info) {
    info.measures_orientation = options.orientation && dhd.has_wrist(connection.id());
    const bool turns = info.measures_orientation && dhd.has_active_wrist(connection.id());
    if (!turns && options.peak_torque) {
        throw Error(place, "peak_torque", fmt::format("{} renders no torque", info.model),
                    "Leave it out: torque needs a device with an active wrist, whose orientation "
                    "is used.");
    }
    if (!turns) return;
    const double stated = dhd.max_torque(connection.id());
    const bool known = std::isfinite(stated) && stated > 0;
    info.peak_torque = options.peak_torque.value_or(known ? stated : 0);
    if (known) info.peak_torque = std::min(info.peak_torque, stated);
    if (options.continuous_torque) info.continuous_torque = *options.continuous_torque;
}

frame::DeviceInfo info_of(const Dhd& dhd, const Connection& connection, const Options& options,
                          const Place& place) {
    frame::DeviceInfo info = info_of(options);
    info.serial = number_text(connection.serial());
    info.model = fmt::format("{}, serial {}", connection.model(), connection.serial());
    const double most = dhd.max_force(connection.id());
    if (std::isfinite(most) && most > 0) info.peak_force = most;
    if (options.peak_force) info.peak_force = std::min(info.peak_force, *options.peak_force);
    if (!std::isfinite(info.peak_force)) {
        throw Error(place, "peak_force",
                    fmt::format("{} does not state its largest force", info.model),
                    "Give options: peak_force_N, from its data sheet.");
    }
    add_wrist(dhd, connection, options, place, info);
    return info;
}

std::unique_ptr<DeviceGroup> make(const std::vector<DeviceConfig>& configs, const Context&) {
    Diagnostics diagnostics;
    const std::vector<Options> options = read_options(configs, diagnostics);
    diagnostics.throw_if_errors();

    const Dhd dhd = load_dhd(options.front().library, configs.front().place);
    std::vector<Connection> there = open_all(dhd, configs.front().place);
    std::vector<Group::Device> devices;
    for (size_t i = 0; i < configs.size(); ++i) {
        const Place& place = configs[i].place;
        Connection connection = take(there, options[i], place);
        const frame::DeviceInfo info = info_of(dhd, connection, options[i], place);
        devices.push_back({std::move(connection), info,
                           fmt::format("the {}'s device ({})", configs[i].finger, info.model),
                           place, options[i].watchdog});
    }
    return std::make_unique<Group>(dhd, std::move(devices));
}

Survey survey() {
    Survey out;
    try {
        const Dhd dhd = load_dhd("", {});
        const int count = dhd.device_count();
        if (count <= 0) throw Error("no Force Dimension device is connected", kNobody);
        for (int n = 0; n < count; ++n) {
            try {
                const Connection connection(dhd, n, {});
                DhdStatus status{};
                dhd.status(status.data(), connection.id());
                out.devices.push_back({number_text(connection.serial()), connection.model(),
                                       status[kDhdPower] == 0 ? "has no power: switch it on"
                                       : status[kDhdReset] != 0
                                           ? "needs calibration: move it into all its end stops"
                                           : "ready"});
            } catch (const Error& e) {
                out.devices.push_back({"", fmt::format("device {}", n + 1), in_words(e)});
            }
        }
    } catch (const Error& e) {
        out.missing = in_words(e);
    }
    return out;
}

}  // namespace

Backend backend() {
    return {.name = "forcedimension",
            .describe = describe,
            .make = make,
            .real = true,
            .survey = survey,
            .options = [](JsonSchema& schema) {
                schema.part_of_kind("options", "forcedimension", "Options.forcedimension",
                                    Options{});
            }};
}

}  // namespace dihaptic::devices::forcedimension
