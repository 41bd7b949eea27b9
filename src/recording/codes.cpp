#include "recording/codes.h"

#include <fmt/format.h>

#include <string_view>
#include <utility>

#include "contact/route.h"
#include "contact/solver_settings.h"
#include "haptics/settings.h"
#include "servo/frame.h"

namespace dihaptic::recording {
namespace {

std::string listed(const std::vector<std::string>& names) {
    std::string out;
    for (size_t i = 0; i < names.size(); ++i)
        out += fmt::format("{}{}: {}", i == 0 ? "" : ", ", i, names[i]);
    return out;
}

template <class Enum>
std::string listed() {
    std::vector<std::string> names;
    for (const char* name : enum_names(Enum{})) names.emplace_back(name);
    return listed(names);
}

std::string bits() {
    std::vector<std::string> texts;
    servo::for_each_status(servo::kAllStatus, [&](servo::Status bit) {
        texts.push_back(
            fmt::format("{}: {}", static_cast<uint32_t>(bit), servo::describe(bit).what));
    });
    return fmt::format("a sum of {}", fmt::join(texts, "; "));
}

std::string listed_or_none(const std::vector<std::string>& names) {
    return std::string("-1: none") + (names.empty() ? "" : ", ") + listed(names);
}

std::string phase_codes(const LogHead& head) {
    std::vector<std::string> names;
    for (const PhaseInfo& phase : head.phases) names.push_back(phase.name);
    return listed(names);
}

struct Coded {
    std::string_view name;
    std::string (*codes)(const LogHead& head);
};
constexpr Coded kCoded[] = {
    {"phase", phase_codes},
    {"outcome", [](const LogHead& head) { return listed_or_none(head.outcomes); }},
    {"message", [](const LogHead& head) { return listed_or_none(head.messages); }},
    {"status", [](const LogHead&) { return bits(); }},
    {"solver", [](const LogHead&) { return listed<contact::Solver>(); }},
    {"coupling", [](const LogHead&) { return listed<haptics::CouplingKind>(); }},
    {"proxy", [](const LogHead&) { return listed<haptics::ProxyKind>(); }},
    {"solver_route", [](const LogHead&) { return listed<contact::Route>(); }},
};
constexpr std::pair<std::string_view, const char*> kAlwaysCoded[] = {
    {"solver_fallback", "0: the solver answered, 1: another one did"},
    {"marker", "0: none"},
    {"trial", "0: none"},
    {"awake", "0: the body sleeps, 1: it does not"},
    {"buttons", "a sum of: 1, 2, 4, ... a button that is pressed"},
};

}  // namespace

std::string codes_of(const std::string& name, const LogHead& head) {
    for (const Coded& coded : kCoded) {
        if (coded.name == name) return coded.codes(head);
    }
    for (const auto& [coded, codes] : kAlwaysCoded) {
        if (coded == name) return codes;
    }
    return "";
}

}  // namespace dihaptic::recording
