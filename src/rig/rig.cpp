#include "rig/rig.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "base/choices.h"
#include "base/field_writer.h"
#include "base/text_file.h"
#include "rig/corrected_devices.h"
#include "rig/libraries.h"

namespace dihaptic::rig {
namespace {

/// The path of a file that is named in a rig file.
std::string beside(const std::string& rig_file, const std::string& named) {
    return (std::filesystem::path(rig_file).parent_path() / named).string();
}

std::string stem(const std::string& file) {
    return std::filesystem::path(file).stem().string();
}

std::vector<std::string> backend_names() {
    std::vector<std::string> names;
    for (const devices::Backend& backend : devices::backends()) names.emplace_back(backend.name);
    return names;
}

devices::DeviceConfig config_of(const Device& device) {
    return {device.finger, device.X_WD(), device.options, device.place, device.scale};
}

void check_displays(const Rig& rig, Diagnostics& diagnostics) {
    std::set<std::string> names;
    for (const display::Display& display : rig.displays) {
        check(display, diagnostics);
        if (names.insert(display.name).second) continue;
        diagnostics.error(display.place, "name",
                          fmt::format("'{}' is the name of two displays", display.name),
                          "Give each display a name of its own.");
    }
}

void check_head(const Rig& rig, Diagnostics& diagnostics) {
    const auto tracked = std::ranges::find_if(
        rig.displays, [](const display::Display& display) { return display.eyes.tracked; });
    if (!rig.head && tracked != rig.displays.end())
        diagnostics.error(tracked->eyes.place, "tracked",
                          "needs a tracked head, but the rig has none",
                          "Add e.g. head: { stream: Head } to the rig file, or leave it out.");
    if (!rig.head) return;
    if (tracked == rig.displays.end())
        diagnostics.warning(rig.head->place, "head",
                            "moves no eyes, because no display has tracked eyes",
                            "Write tracked: yes in a display's eyes.");
    if (rig.head->along.norm() < 1e-9)
        diagnostics.error(rig.head->place, "along", "has no direction",
                          "Write e.g. along: [1, 0, 0].");
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
                                  fmt::format("Known: {}.", fmt::join(backend_names(), ", ")),
                                  choices_of(backend_names()));
            }
            continue;
        }
        backend->describe({config_of(device)}, {}, diagnostics);
        if (device.backend != rig.devices.front().backend) {
            diagnostics.error(device.place, "backend", "differs from the first device's",
                              "All devices of a rig must have the same backend.");
        }
    }
    if (rig.devices.empty())
        diagnostics.error(rig.place, "devices", "there are none", "List at least one device.");
    outlets::check(rig.outlets, diagnostics);
    check_displays(rig, diagnostics);
    check_head(rig, diagnostics);
}

/// Reads a file that a rig file names under a key. If the file cannot be read, reports this with
/// `remedy` and returns false.
template <class File>
bool read_named(const std::string& file, const Place& place, const char* key,
                const std::string& named, const char* remedy, File& out, Diagnostics& diagnostics) {
    try {
        read_fields(out, read_yaml(file), diagnostics);
        return true;
    } catch (const Error& e) {
        diagnostics.error(place, key, fmt::format("{} cannot be used", named), remedy);
        diagnostics.add(e.problems());
        return false;
    }
}

void check_date(const std::string& date, const Place& place, Diagnostics& diagnostics) {
    if (date.empty() || days_between(date, date)) return;
    diagnostics.error(place, "date", fmt::format("'{}' is not a date", date),
                      "Write it as 2026-11-21.");
}

void read_registration(const Rig& rig, display::Display& display, const std::string& file,
                       Diagnostics& diagnostics) {
    display::Registration registration;
    const bool read =
        read_named(file, display.place, "registration", display.registration,
                   "Register the display (dihaptic register), or leave out 'registration'.",
                   registration, diagnostics);
    if (!read || diagnostics.has_errors()) return;
    check_date(registration.date, registration.place, diagnostics);
    registration.move(-rig.moved_by);
    registration.place.file = file;
    display.set(registration);
    check(display, diagnostics);
}

void read_calibration(Rig& rig, const std::string& file, Diagnostics& diagnostics) {
    Calibration calibration;
    if (!read_named(file, rig.place, "calibration", rig.calibration,
                    "Calibrate the rig (dihaptic calibrate), or leave out 'calibration'.",
                    calibration, diagnostics))
        return;
    check_date(calibration.date, calibration.place, diagnostics);
    std::set<std::string> parts;
    for (const DeviceCalibration& part : calibration.devices) {
        if (parts.insert(part.finger).second) continue;
        diagnostics.error(calibration.place, "devices",
                          fmt::format("has two parts for the {}'s device", part.finger),
                          "Calibrate the rig again.");
    }
    for (const Device& device : rig.devices) {
        if (calibration.find(device.finger) != nullptr) continue;
        diagnostics.error(calibration.place, "devices",
                          fmt::format("has no part for the {}'s device", device.finger),
                          "Calibrate the rig again.");
    }
    rig.calibrated = calibration;
}

/// Moves all positions so that the `origin` of the file becomes the world's origin.
void place_world(Rig& rig) {
    for (Device& device : rig.devices) device.position -= rig.origin;
    for (JigPoint& point : rig.jig) point.position -= rig.origin;
    if (rig.wall) rig.wall->centre -= rig.origin;
    for (display::Display& display : rig.displays) display.move(-rig.origin);
    if (rig.head) rig.head->position -= rig.origin;
    if (rig.headset) rig.headset->position -= rig.origin;
    rig.moved_by = rig.origin;
    rig.origin = Vec3::Zero();
}

/// The adjustment to a device's readings; nullopt if they need none.
std::optional<Adjustment> adjustment(const Rig& rig, const Device& device,
                                     const frame::DeviceInfo& info) {
    Adjustment out;
    out.scale = device.scale;
    const DeviceCalibration* part = rig.calibrated ? rig.calibrated->find(device.finger) : nullptr;
    if (part == nullptr) {
        if (device.scale == 1) return {};
        return out;
    }
    if (part->joint_offset && !info.arm) {
        throw Error(device.place, "calibration",
                    fmt::format("has joint offsets for the {}'s device ({}), which reports no "
                                "joint angles",
                                device.finger, info.model),
                    "Calibrate the rig again.");
    }
    if (!part->serial.empty() && !info.serial.empty() && part->serial != info.serial) {
        throw Error(device.place, "calibration",
                    fmt::format("belongs to device {}, but the {} holds {}", part->serial,
                                device.finger, info.serial),
                    "Calibrate the rig again, or connect that device.");
    }
    out.correction = part->correction(info.arm);
    return out;
}

}  // namespace

std::vector<std::string> held_fingers(const Rig& rig) {
    std::vector<std::string> out;
    for (const Device& device : rig.devices) out.push_back(device.finger);
    return out;
}

const Device& device_of(const Rig& rig, const std::string& finger) {
    const auto found = std::find_if(rig.devices.begin(), rig.devices.end(),
                                    [&](const Device& d) { return d.finger == finger; });
    if (found != rig.devices.end()) return *found;
    throw Error(rig.place, "devices",
                fmt::format("the scene's finger '{}' holds no device", finger),
                fmt::format("The rig has devices for {}: add one, or choose another rig.",
                            fmt::join(held_fingers(rig), ", ")));
}

Rig read_rig_to_calibrate(const std::string& file, Diagnostics& diagnostics, NamedBy named_by) {
    Rig rig;
    rig.named_by = named_by;
    try {
        read_fields(rig, read_yaml(file), diagnostics);
    } catch (const Error& e) {
        diagnostics.add(e.problems());
        return rig;
    }
    find_libraries(rig, file);
    place_world(rig);
    if (!diagnostics.has_errors()) check(rig, diagnostics);
    return rig;
}

Rig read_rig_to_register(const std::string& file, Diagnostics& diagnostics, NamedBy named_by) {
    Rig rig = read_rig_to_calibrate(file, diagnostics, named_by);
    if (!rig.calibration.empty()) read_calibration(rig, beside(file, rig.calibration), diagnostics);
    return rig;
}

Rig read_rig(const std::string& file, Diagnostics& diagnostics, NamedBy named_by) {
    Rig rig = read_rig_to_register(file, diagnostics, named_by);
    for (display::Display& display : rig.displays) {
        if (display.registration.empty()) continue;
        read_registration(rig, display, beside(file, display.registration), diagnostics);
    }
    return rig;
}

std::string calibration_file(const Rig& rig, const std::string& rig_file) {
    if (!rig.calibration.empty()) return beside(rig_file, rig.calibration);
    return beside(rig_file, fmt::format("{}-calibration.yaml", stem(rig_file)));
}

namespace {
std::string picture_of(const std::string& calibration_file) {
    return std::filesystem::path(calibration_file).replace_extension(".svg").string();
}
}  // namespace

void check_calibration_file(const std::string& rig_file, const std::string& file) {
    if (picture_of(file) == file) {
        throw Error({file, 0}, "", "is the name of the picture next to the calibration",
                    "Name the calibration *.yaml.");
    }
    for (const std::string& out : {file, picture_of(file)})
        check_output(out, rig_file, "the rig file");
}

std::string store_calibration(const Rig& rig, const CalibrationResult& result,
                              const std::string& file) {
    const std::string picture = picture_of(file);
    write_file(to_yaml(write_fields(result.calibration)), file);
    write_file(residual_picture(result, rig.title), picture);
    return picture;
}

namespace {
/// The form in which a rig file names another file.
std::string named_in(const std::string& rig_file, const std::string& file) {
    const auto folder = std::filesystem::path(rig_file).parent_path();
    return std::filesystem::path(file).lexically_proximate(folder).string();
}
}  // namespace

std::string calibration_line(const std::string& rig_file, const std::string& calibration_file) {
    return "calibration: " + named_in(rig_file, calibration_file);
}

std::string registration_line(const std::string& rig_file, const std::string& registration_file) {
    return "registration: " + named_in(rig_file, registration_file);
}

void name_calibration(const std::string& rig_file, const std::string& calibration_file) {
    std::string text = read_text_file(rig_file);
    if (!text.empty() && text.back() != '\n') text += '\n';
    text += calibration_line(rig_file, calibration_file) + "\n";
    write_file(text, rig_file);
}

void check_jig(const Rig& rig) {
    if (rig.jig.empty() && rig.devices.size() > 1) return;
    std::vector<Vec3> points;
    for (const JigPoint& point : rig.jig) points.push_back(point.position);
    if (points.empty()) {
        throw Error(rig.place, "jig",
                    "a single device is calibrated with a jig, but the rig has none",
                    "Give the rig file a jig, or two devices.");
    }
    if (across(points) >= kLeastJig) return;
    throw Error(
        rig.place, "jig", "its points are on a line, or too near to each other",
        fmt::format("Give three or more, {:.0f} mm apart in two directions.", kLeastJig * 1e3));
}

const display::Display& display_of(const Rig& rig, const std::string& name) {
    std::vector<std::string> names;
    for (const display::Display& display : rig.displays) {
        if (display.name == name || (name.empty() && rig.displays.size() == 1)) return display;
        names.push_back(display.name);
    }
    if (names.empty())
        throw Error(rig.place, "displays", "there are none",
                    "Add one to the rig file (see docs/files.md).");
    throw Error(rig.place, "displays",
                name.empty() ? "there are several" : fmt::format("none is named '{}'", name),
                fmt::format("Known: {}.", fmt::join(names, ", ")));
}

std::string registration_file(const display::Display& display, const std::string& rig_file) {
    if (!display.registration.empty()) return beside(rig_file, display.registration);
    return beside(rig_file, fmt::format("{}-{}-registration.yaml", stem(rig_file), display.name));
}

void store_registration(const Rig& rig, const display::Registration& registration,
                        const std::string& file) {
    display::Registration out = registration;
    out.move(rig.moved_by);
    write_file(to_yaml(write_fields(out)), file);
}

namespace {
void check_registrations(const Rig& rig, const std::string& today, Diagnostics& diagnostics) {
    for (const display::Display& display : rig.displays) {
        if (!display.registered) {
            if (is_real(rig))
                diagnostics.warning(display.place, "registration",
                                    fmt::format("{} was never registered: objects may be seen "
                                                "away from their felt positions",
                                                display.name),
                                    "Register it: dihaptic register.");
            continue;
        }
        const std::optional<int> days = days_between(display.registered->date, today);
        if (!days || *days <= kOldCalibration) continue;
        diagnostics.warning(display.registered->place, "date",
                            fmt::format("{} was registered {} days ago", display.name, *days),
                            "Register it again: dihaptic register.");
    }
}
}  // namespace

void check_age(const Rig& rig, const std::string& today, Diagnostics& diagnostics) {
    check_registrations(rig, today, diagnostics);
    if (!rig.calibrated) return;
    const std::optional<int> days = days_between(rig.calibrated->date, today);
    if (!days || *days <= kOldCalibration) return;
    diagnostics.warning(rig.calibrated->place, "date",
                        fmt::format("the rig was calibrated {} days ago", *days),
                        "Calibrate it again: dihaptic calibrate.");
}

Rig uncorrected(const Rig& rig) {
    Rig out = rig;
    out.calibration.clear();
    out.calibrated.reset();
    for (Device& device : out.devices) device.scale = 1;
    return out;
}

namespace {
/// The backend of the fingers' devices, and the devices themselves in the order of the fingers.
std::pair<const devices::Backend&, std::vector<devices::DeviceConfig>> held_by(
    const Rig& rig, const std::vector<std::string>& fingers) {
    std::vector<devices::DeviceConfig> configs;
    const devices::Backend* backend = nullptr;
    for (const std::string& finger : fingers) {
        const Device& device = device_of(rig, finger);
        backend = devices::find_backend(device.backend);
        configs.push_back(config_of(device));
    }
    if (backend == nullptr)
        throw Error(rig.place, "devices", "there are none", "List at least one device.");
    return {*backend, configs};
}
}  // namespace

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

std::vector<frame::DeviceInfo> describe(const Rig& rig, const std::vector<std::string>& fingers,
                                        const devices::Context& context) {
    const auto [backend, configs] = held_by(rig, fingers);
    Diagnostics diagnostics;
    std::vector<frame::DeviceInfo> out = backend.describe(configs, context, diagnostics);
    diagnostics.throw_if_errors();
    for (size_t i = 0; i < fingers.size(); ++i) {
        const Device& device = device_of(rig, fingers[i]);
        adjustment(rig, device, out[i]);
        out[i] = out[i].scaled(device.scale);
    }
    return out;
}

std::unique_ptr<devices::DeviceGroup> make_devices(const Rig& rig,
                                                   const std::vector<std::string>& fingers,
                                                   const devices::Context& context,
                                                   const std::optional<host::Hosting>& hosting) {
    check_libraries(rig);
    const auto [backend, configs] = held_by(rig, fingers);
    auto group = backend.real && hosting
                     ? host::host_devices({backend.name, configs, context.tick, *hosting})
                     : backend.make(configs, context);
    std::vector<Adjustment> adjustments;
    bool adjusted = false;
    for (size_t i = 0; i < fingers.size(); ++i) {
        const auto own = adjustment(rig, device_of(rig, fingers[i]), group->descriptions()[i]);
        adjusted = adjusted || own;
        adjustments.push_back(own.value_or(Adjustment{}));
    }
    if (adjusted) return make_corrected(std::move(group), std::move(adjustments));
    return group;
}

std::vector<devices::DeviceClaim> claim_devices(const Rig& rig,
                                                const std::vector<std::string>& fingers,
                                                const devices::DeviceGroup& devices) {
    const auto [backend, configs] = held_by(rig, fingers);
    if (!backend.real) return {};
    std::vector<Place> places;
    for (const devices::DeviceConfig& config : configs) places.push_back(config.place);
    return devices::claim_devices(backend.name, devices, places);
}

std::optional<Eigen::AlignedBox3d> wall_box(const Rig& rig) {
    if (!rig.wall) return std::nullopt;
    return rig.wall->box();
}

std::vector<Pose> poses(const Rig& rig, const std::vector<std::string>& fingers) {
    std::vector<Pose> out;
    out.reserve(fingers.size());
    for (const std::string& finger : fingers) out.push_back(device_of(rig, finger).X_WD());
    return out;
}

}  // namespace dihaptic::rig
