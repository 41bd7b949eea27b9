#include "rig/rig.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

#include "base/field_writer.h"

namespace dihaptic::rig {
namespace {

std::vector<std::string> backend_names() {
    std::vector<std::string> names;
    for (const devices::Backend& backend : devices::backends()) names.emplace_back(backend.name);
    return names;
}

void check(const Rig& rig, Diagnostics& diagnostics) {
    std::set<std::string> fingers;
    for (const Device& device : rig.devices) {
        if (!device.finger.empty() && !fingers.insert(device.finger).second) {
            diagnostics.error(device.place, "finger",
                              fmt::format("'{}' holds two devices", device.finger),
                              "Give each device a finger of its own.");
        }
        const devices::Backend* backend = devices::find_backend(device.backend);
        if (backend == nullptr) {
            if (!device.backend.empty()) {
                diagnostics.error(device.place, "backend",
                                  fmt::format("'{}' is not known", device.backend),
                                  fmt::format("Known: {}.", fmt::join(backend_names(), ", ")));
            }
            continue;
        }
        backend->check({device.finger, device.X_WD(), device.options}, diagnostics);
        if (device.backend != rig.devices.front().backend) {
            diagnostics.error(device.place, "backend", "differs from the first device's",
                              "All devices of a rig are of one backend.");
        }
    }
    if (rig.devices.empty())
        diagnostics.error(rig.place, "devices", "there are none", "List at least one device.");
    outlets::check(rig.outlets, diagnostics);
}

}  // namespace

const Device& device_of(const Rig& rig, const std::string& finger) {
    const auto found = std::find_if(rig.devices.begin(), rig.devices.end(),
                                    [&](const Device& d) { return d.finger == finger; });
    if (found != rig.devices.end()) return *found;
    std::vector<std::string> held;
    for (const Device& device : rig.devices) held.push_back(device.finger);
    throw Error(rig.place, "devices",
                fmt::format("no device is held by the scene's finger '{}'", finger),
                fmt::format("The rig has devices for {}: add one, or choose another rig.",
                            fmt::join(held, ", ")));
}

Rig read_rig(const std::string& file, Diagnostics& diagnostics) {
    Rig rig;
    try {
        read_fields(rig, read_yaml(file), diagnostics);
    } catch (const Error& e) {
        diagnostics.add(e.problems());
        return rig;
    }
    if (!diagnostics.has_errors()) check(rig, diagnostics);
    return rig;
}

bool is_real(const Rig& rig) {
    return std::any_of(rig.devices.begin(), rig.devices.end(), [](const Device& device) {
        const devices::Backend* const backend = devices::find_backend(device.backend);
        return backend != nullptr && backend->real;
    });
}

Rig simulated_rig(const std::vector<std::string>& fingers, bool orientation) {
    Rig rig;
    rig.title = "Ideal simulated devices";
    for (const std::string& finger : fingers) {
        Device device;
        device.finger = finger;
        device.backend = "simulated";
        if (orientation) {
            FieldWriter options;
            options("orientation", true);
            device.options = options.take();
        }
        rig.devices.push_back(device);
    }
    return rig;
}

std::unique_ptr<devices::DeviceGroup> make_devices(const Rig& rig,
                                                   const std::vector<std::string>& fingers,
                                                   const devices::Context& context) {
    std::vector<devices::DeviceConfig> configs;
    const devices::Backend* backend = nullptr;
    for (const std::string& finger : fingers) {
        const Device& device = device_of(rig, finger);
        backend = devices::find_backend(device.backend);
        configs.push_back({finger, device.X_WD(), device.options, device.place});
    }
    if (backend == nullptr)
        throw Error(rig.place, "devices", "there are none", "List at least one device.");
    return backend->make(configs, context);
}

std::vector<Pose> poses(const Rig& rig, const std::vector<std::string>& fingers) {
    std::vector<Pose> out;
    out.reserve(fingers.size());
    for (const std::string& finger : fingers) out.push_back(device_of(rig, finger).X_WD());
    return out;
}

}  // namespace dihaptic::rig
