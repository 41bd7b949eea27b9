#include "cli/doctor/finding.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "base/field.h"

namespace dihaptic::doctor {
namespace {

constexpr size_t kWidth = 110;
constexpr size_t kIndent = 24;  // indentation of all lines but the first

/// Wraps the text into lines no longer than `width`, unless a single word is longer.
std::string wrapped(const std::string& text, size_t width, const std::string& indent) {
    std::istringstream words(text);
    std::string out;
    size_t length = 0;
    for (std::string word; words >> word;) {
        if (length > 0 && length + 1 + word.size() > width) {
            out += "\n" + indent;
            length = 0;
        }
        out += (length > 0 ? " " : "") + word;
        length += (length > 0 ? 1 : 0) + word.size();
    }
    return out;
}

}  // namespace

std::string to_text(const Finding& finding) {
    const std::string indent(kIndent, ' ');
    std::string out = fmt::format("  {:5}  {:14} {}\n", enum_name(finding.verdict), finding.what,
                                  wrapped(finding.found, kWidth - kIndent, indent));
    for (const std::string& command : finding.commands)
        out += fmt::format("{}    {}\n", indent, command);
    return out;
}

std::string to_json(const Findings& findings) {
    auto all = nlohmann::json::array();
    for (const Finding& f : findings)
        all.push_back({static_cast<int>(f.verdict), f.what, f.found, f.commands, f.needed});
    // names reported by drivers may be invalid UTF-8
    return all.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

Findings from_json(const std::string& text) {
    Findings out;
    for (const nlohmann::json& f : nlohmann::json::parse(text))
        out.push_back(
            {static_cast<Verdict>(f.at(0).get<int>()), f.at(1), f.at(2), f.at(3), f.at(4)});
    return out;
}

}  // namespace dihaptic::doctor
