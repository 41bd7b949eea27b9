#include "cli/doctor/ports.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <filesystem>

#include "cli/doctor/machine.h"

namespace dihaptic::doctor {
namespace {

namespace fs = std::filesystem;

/// A device that this program opens directly through USB, not through its maker's service.
struct Known {
    const char* name;
    const char* vendor;
    const char* product;  ///< "" matches any product of the vendor

    std::string rule() const {
        return fmt::format(
            "SUBSYSTEM==\"usb\", ATTR{{idVendor}}==\"{}\", {}GROUP=\"{}\", MODE=\"0660\"", vendor,
            *product == '\0' ? "" : fmt::format("ATTR{{idProduct}}==\"{}\", ", product), kGroup);
    }
};
constexpr std::array kKnown{Known{"Force Dimension", "1451", ""}, Known{"Falcon", "0403", "cb48"}};

/// Sorted paths of the entries of a folder; empty if the folder does not exist.
std::vector<std::string> in(const std::string& folder) {
    std::vector<std::string> out;
    std::error_code failed;
    for (fs::directory_iterator i(folder, failed), end; !failed && i != end; i.increment(failed))
        out.push_back(i->path().string());
    std::sort(out.begin(), out.end());
    return out;
}

int number_in(const std::string& file) {
    const std::string text = text_of(file);
    int out = 0;
    std::from_chars(text.data(), text.data() + text.size(), out);
    return out;
}

/// Files through which plugged-in devices of this kind are opened.
std::vector<std::string> plugged_in(const std::string& root, const Known& known) {
    std::vector<std::string> out;
    for (const std::string& device : in(root + "/sys/bus/usb/devices")) {
        if (text_of(device + "/idVendor") != known.vendor) continue;
        if (*known.product != '\0' && text_of(device + "/idProduct") != known.product) continue;
        out.push_back(fmt::format("{}/dev/bus/usb/{:03}/{:03}", root, number_in(device + "/busnum"),
                                  number_in(device + "/devnum")));
    }
    return out;
}

/// The file that contains a udev rule for this device; "" if there is none.
std::string rule_file(const std::string& root, const Known& known) {
    for (const char* folder : {"/etc", "/run", "/usr/lib", "/lib"}) {
        for (const std::string& file : in(root + folder + "/udev/rules.d")) {
            const std::string rules = text_of(file);
            if (rules.find(fmt::format("\"{}\"", known.vendor)) == std::string::npos) continue;
            if (*known.product == '\0' || rules.find(known.product) != std::string::npos)
                return file.substr(root.size());
        }
    }
    return "";
}

Finding usb(const std::string& root, const Known& known, const MayOpen& may_open) {
    const auto finding = [&](Verdict verdict, const std::string& found) {
        return Finding{verdict, "USB", fmt::format("{}: {}", known.name, found), {}};
    };
    const std::vector<std::string> files = plugged_in(root, known);
    if (files.empty()) {
        const std::string rule = rule_file(root, known);
        return finding(Verdict::note,
                       rule.empty()
                           ? "not plugged in, and without a udev rule only root may open it: the "
                             "commands for a rule appear here once it is plugged in"
                           : fmt::format("not plugged in. {} has a rule for it", rule));
    }
    if (std::all_of(files.begin(), files.end(), may_open))
        return finding(Verdict::ok, "plugged in, and you may open it");
    Finding out =
        finding(Verdict::lacks, "plugged in, but you may not open it: no session can use it");
    out.commands = add_udev_rule(known.rule());
    for (const std::string& command : join_group()) out.commands.push_back(command);
    return out;
}

Finding serial(const std::string& root, const MayOpen& may_open) {
    std::vector<std::string> lines;
    std::vector<std::string> closed;
    for (const std::string& file : in(root + "/dev")) {
        const std::string name = file.substr(root.size());
        if (!name.starts_with("/dev/ttyUSB") && !name.starts_with("/dev/ttyACM")) continue;
        lines.push_back(name);
        if (!may_open(file)) closed.push_back(name);
    }
    if (lines.empty())
        return {Verdict::note,
                "serial lines",
                "none plugged in: outlets of kind 'serial' (event codes to other recording "
                "equipment) require one",
                {}};
    if (closed.empty())
        return {Verdict::ok,
                "serial lines",
                fmt::format("{}: you may open them", fmt::join(lines, ", ")),
                {}};
    return {Verdict::lacks,
            "serial lines",
            fmt::format("{}: you may not open it, so it receives no event codes",
                        fmt::join(closed, ", ")),
            {"sudo usermod -aG dialout $USER    # then log in again"}};
}

}  // namespace

Findings ports(const std::string& root, const MayOpen& may_open) {
    Findings out;
    for (const Known& known : kKnown) out.push_back(usb(root, known, may_open));
    out.push_back(serial(root, may_open));
    return out;
}

}  // namespace dihaptic::doctor
