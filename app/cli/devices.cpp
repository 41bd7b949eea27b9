#include <fmt/format.h>

#include "command.h"
#include "devices/device_group.h"

namespace dihaptic::cli {
namespace {

void list_devices() {
    for (const devices::Backend& backend : devices::backends()) {
        if (backend.survey == nullptr) continue;
        fmt::print("{}\n", backend.name);
        const devices::Survey found = backend.survey();
        for (const devices::Survey::Device& device : found.devices)
            fmt::print("    {}{}: {}\n", device.model,
                       device.serial.empty() ? "" : ", serial " + device.serial, device.state);
        if (!found.missing.empty()) fmt::print("    {}\n", found.missing);
    }
    fmt::print("simulated\n    always available: rigs/premium-pair.yaml and others\n");
}

}  // namespace

void add_devices(CLI::App& app) {
    auto* command = app.add_subcommand(
        "devices", "List this machine's haptic devices, and the parts that are missing for others");
    command->footer(
        "\nNothing moves. A device listed here can be named in a rig file "
        "(docs/files.md).\n\nExample:\n  dihaptic devices");
    command->callback([] { list_devices(); });
}

}  // namespace dihaptic::cli
