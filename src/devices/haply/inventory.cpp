#include "devices/haply/inventory.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace dihaptic::devices::haply {
namespace {

/// The reason why a device cannot be used, and the remedy; both are empty if it can be used.
std::pair<std::string, std::string> trouble(const DeviceState& state) {
    if (state.power_supply == false) return {"has no power", "Plug in its power supply."};
    if (state.calibrated == false) {
        return {"is not calibrated", "Calibrate it according to Haply's guide."};
    }
    if (state.ready == false) {
        return {"is not ready", "Wait until it has started, or unplug it and plug it in again."};
    }
    return {};
}

template <class States>
std::string list_ids(const States& states) {
    std::vector<std::string_view> ids;
    for (const auto& state : states) ids.push_back(state.id);
    return ids.empty() ? "none" : fmt::format("{}", fmt::join(ids, ", "));
}

}  // namespace

void receive_first(Connection& connection, StateReader& reader, StateMessage& message,
                   const char* what) {
    const std::string_view text = connection.receive(kSetUpTime);
    if (text.empty()) {
        throw Error(
            fmt::format("the Inverse Service sent no {} within {:g} s", what, seconds(kSetUpTime)),
            "Restart it (sudo systemctl restart haply-inverse-service); only versions "
            "from 3.1 on answer at port 10001.");
    }
    if (!reader.read(text, message)) {
        throw Error(
            fmt::format("the Inverse Service's {} is not a complete JSON object", what),
            "Correct 'url': another program may have the port; or restart the service (sudo "
            "systemctl restart haply-inverse-service).");
    }
}

void check_inventory(const StateMessage& message, std::span<const Wanted> devices) {
    Diagnostics diagnostics;
    for (const Wanted& device : devices) {
        const std::string& id = device.options.device_id;
        const auto same = std::count_if(message.devices().begin(), message.devices().end(),
                                        [&](const DeviceState& state) { return state.id == id; });
        if (same == 0) {
            diagnostics.error(
                device.place, "device_id",
                fmt::format("the Inverse Service does not list an Inverse3 '{}'", id),
                fmt::format("It lists: {}. Plug the device in, or correct the serial number.",
                            list_ids(message.devices())));
        } else if (same > 1) {
            diagnostics.error(device.place, "device_id",
                              fmt::format("the Inverse Service lists {} devices '{}'", same, id),
                              "Unplug one, since a force could go to either. Then ask Haply for "
                              "another serial number.");
        } else if (const auto [what, remedy] = trouble(*message.device(id)); !what.empty()) {
            diagnostics.error(device.place, "device_id",
                              fmt::format("the Inverse3 '{}' {}", id, what), remedy);
        }
        if (device.grip && message.grip(device.grip->kind, device.grip->id) == nullptr) {
            diagnostics.error(
                device.place, std::string(enum_name(device.grip->kind)),
                fmt::format("the Inverse Service lists no grip '{}' of this kind, or more than one",
                            device.grip->id),
                fmt::format("It lists: {}. Switch the grip on and pair it, or correct the "
                            "serial number.",
                            list_ids(message.grips())));
        }
    }
    diagnostics.throw_if_errors();
}

void check_answer(const StateMessage& message, std::span<const Wanted> devices) {
    for (const Wanted& device : devices) {
        if (message.error.empty() && message.device(device.options.device_id) != nullptr) continue;
        const ForceKey key = device.options.force_key;
        throw Error(
            device.place, "force_key",
            message.error.empty()
                ? fmt::format("the Inverse Service's answer to a command does not contain '{}'",
                              device.options.device_id)
                : fmt::format("the Inverse Service refuses a command: {}", message.error),
            fmt::format("Its versions spell the force differently: try force_key: {}.",
                        enum_name(key == ForceKey::vector ? ForceKey::values : ForceKey::vector)));
    }
}

Survey survey_of(const std::string& url) {
    Survey survey;
    try {
        Connection connection;
        StateReader reader(Connection::kMostBytes);
        StateMessage message;
        connection.open(Url::parse(url).value(), kSetUpTime);
        receive_first(connection, reader, message, "list of devices");
        for (const DeviceState& state : message.devices()) {
            const auto [what, remedy] = trouble(state);
            survey.devices.push_back(
                {std::string(state.id), "Haply Inverse3",
                 what.empty() ? "ready" : fmt::format("{}: {}", what, remedy)});
        }
        for (const GripState& state : message.grips())
            survey.devices.push_back(
                {std::string(state.id), std::string(enum_name(state.kind)), "ready"});
        if (message.devices().empty()) {
            survey.missing = fmt::format(
                "the Inverse Service at {} lists no Inverse3. Plug one in, with its power supply.",
                url);
        }
    } catch (const Error& e) {
        const Problem& problem = e.problems().front();
        survey.missing = problem.what + ". " + problem.remedy;
    }
    return survey;
}

}  // namespace dihaptic::devices::haply
