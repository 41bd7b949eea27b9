#include "rig/libraries.h"

#include <fmt/format.h>

#include <filesystem>
#include <set>

#include "base/allowed_libraries.h"

namespace dihaptic::rig {
namespace {

namespace fs = std::filesystem;

/// Returns the path in the form used in the list of allowed libraries.
std::string whole(const std::string& path) {
    std::error_code failed;
    const fs::path out = fs::weakly_canonical(fs::absolute(path, failed), failed);
    return failed ? path : out.string();
}

Problem refusal(const Place& place, const std::string& path) {
    if (std::error_code unreadable; !fs::exists(path, unreadable)) {
        return {Severity::error, place, "library", fmt::format("'{}' does not exist", path),
                "Correct the path, or install the manufacturer's software."};
    }
    const std::string list = allowed_libraries_file();
    std::string remedy = "If you trust it, ";
    if (!list.empty()) remedy += fmt::format("add the line '- {}' to {}; or ", whole(path), list);
    return {Severity::error, place, "library",
            fmt::format("'{}' is not loaded: its code could do anything, and its name is in a file "
                        "that you did not name yourself",
                        path),
            remedy +
                "name the rig yourself, with --rig or under Rig in the window (not possible for a "
                "resumed session)."};
}

void look_at(const Place& place, const std::string& path, std::vector<Problem>& out) {
    if (is_system_library(path)) return;
    try {
        if (!is_allowed_library(path)) out.push_back(refusal(place, path));
    } catch (const Error& e) {
        out.insert(out.end(), e.problems().begin(), e.problems().end());
    }
}

void look_at(const Node& options, std::vector<Problem>& out) {
    if (const Node* library = options.find("library"))
        look_at(library->place, library->scalar, out);
}

}  // namespace

void find_libraries(Rig& rig, const std::string& rig_file) {
    const auto find = [&](std::string& path) {
        if (!path.empty() && !is_system_library(path) && !fs::path(path).is_absolute())
            path =
                fs::absolute(fs::path(rig_file).parent_path() / path).lexically_normal().string();
    };
    const auto find_in = [&](Node& options) {
        for (Node::Entry& option : options.entries) {
            if (option.key == "library") find(option.value.scalar);
        }
    };
    for (Device& device : rig.devices) find_in(device.options);
    for (outlets::OutletConfig& outlet : rig.outlets) find_in(outlet.options);
    if (rig.head) find(rig.head->library);
}

std::vector<Problem> strange_libraries(const Rig& rig) {
    std::vector<Problem> out;
    for (const Device& device : rig.devices) look_at(device.options, out);
    for (const outlets::OutletConfig& outlet : rig.outlets) look_at(outlet.options, out);
    if (rig.head) look_at(rig.head->place, rig.head->library, out);
    // two devices from the same manufacturer share a library
    std::set<std::string> told;
    std::erase_if(out, [&](const Problem& one) { return !told.insert(one.what).second; });
    return out;
}

void check_libraries(const Rig& rig) {
    if (rig.named_by == NamedBy::the_operator) return;
    if (std::vector<Problem> strange = strange_libraries(rig); !strange.empty())
        throw Error(std::move(strange));
}

}  // namespace dihaptic::rig
