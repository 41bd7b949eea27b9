#include "session/readiness.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>
#include <set>

#include "servo/real_time.h"

namespace dihaptic::session {
namespace {

namespace fs = std::filesystem;

constexpr double kBytesPerFrame = 450;  // size of a frame with two fingers
constexpr double kHour = 3600;          // [s]
constexpr double kGigabyte = 1e9;
constexpr double kLeastHours = 2;  // minimum recording time for which the disk must have room

Finding devices_of(const Plan& plan) {
    std::set<std::string> models;
    for (const frame::DeviceInfo& device : plan.devices) models.insert(device.model);
    const bool real = rig::is_real(plan.rig);
    return {"devices",
            fmt::format("{}{}", fmt::join(models, ", "),
                        real ? "; they are opened when the session starts" : ": no device moves"),
            true, Remedy::none, ""};
}

Finding calibration_of(const Plan& plan, const std::string& today) {
    if (!plan.rig.calibrated && !rig::is_real(plan.rig))
        return {"calibration", "simulated devices need none", true, Remedy::none, ""};
    Finding out{"calibration", "", true, Remedy::calibrate, ""};
    if (!plan.rig.calibrated) {
        out.found = "the rig has none: positions are as reported by the devices";
        out.how = "Calibrate the rig.";
        out.good = false;
        return out;
    }
    const std::optional<int> days = rig::days_between(plan.rig.calibrated->date, today);
    out.found = fmt::format("of {}", plan.rig.calibrated->date);
    if (days && *days > rig::kOldCalibration) {
        out.found += fmt::format(", {} days ago", *days);
        out.how = "Calibrate the rig again.";
        out.good = false;
    }
    return out;
}

Finding display_of(const display::Display& display, bool real, const std::string& today) {
    Finding out{fmt::format("display {}", display.name), "", true, Remedy::register_display, ""};
    if (!display.registered) {
        out.found = "its corners are those given in the rig file";
        out.how = "Register the display.";
        out.good = !real;
        return out;
    }
    const std::optional<int> days = rig::days_between(display.registered->date, today);
    out.found = fmt::format("registered on {}, {:.1f} mm rms", display.registered->date,
                            1e3 * display.registered->rms);
    if (days && *days > rig::kOldCalibration) {
        out.how = "Register the display again.";
        out.good = false;
    }
    return out;
}

Finding real_time_of(const Plan& plan) {
    const int priority = plan.settings.real_time_priority;
    const servo::RealTime::Refusals refusals = servo::try_real_time(priority);
    Finding out{"real time", "the system grants the servo's requests", true,
                Remedy::allow_real_time, ""};
    if (!refusals.any()) return out;
    out.found = servo::describe(refusals, priority);
    out.good = false;
    out.how = "Until then keep hands out of real devices: docs/safety.md.";
    return out;
}

}  // namespace

double bytes_per_hour(size_t fingers, double tick) {
    return kBytesPerFrame * std::max(1.0, static_cast<double>(fingers) / 2) * kHour / tick;
}

double bytes_per_hour(const Plan& plan) {
    return bytes_per_hour(plan.scene.fingers.size(), plan.settings.tick());
}

Finding disk(const std::string& folder, double bytes_per_hour) {
    Finding out{"disk", "", true, Remedy::choose_folder, ""};
    fs::path existing = fs::absolute(folder);
    std::error_code failed;
    while (!fs::exists(existing, failed) && existing != existing.root_path())
        existing = existing.parent_path();
    const fs::space_info space = fs::space(existing, failed);
    if (failed) {
        out.found = fmt::format("{} cannot be checked: {}", folder, failed.message());
        out.good = false;
    } else {
        const auto free = static_cast<double>(space.available);
        const double hours = free / bytes_per_hour;
        out.found = fmt::format("{:.1f} GB free in the folder for sessions, {} of recording",
                                free / kGigabyte,
                                hours > 100 ? "days" : fmt::format("about {:.1f} hours", hours));
        out.good = hours >= kLeastHours;
    }
    if (!out.good) out.how = "Free some space, or choose another folder.";
    return out;
}

std::vector<Finding> readiness(const Plan& plan, const std::string& out, const std::string& today) {
    std::vector<Finding> all{devices_of(plan), calibration_of(plan, today)};
    for (const display::Display& display : plan.rig.displays)
        all.push_back(display_of(display, rig::is_real(plan.rig), today));
    all.push_back(real_time_of(plan));
    all.push_back(disk(out, bytes_per_hour(plan)));
    return all;
}

}  // namespace dihaptic::session
