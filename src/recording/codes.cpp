#include "recording/codes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <string_view>

#include "base/status.h"
#include "contact/route.h"
#include "frame/knobs.h"

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
    for_each_status(kAllStatus, [&](Status bit) {
        texts.push_back(fmt::format("{}: {}", static_cast<uint32_t>(bit), describe(bit).what));
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
    {"page", [](const LogHead& head) { return listed_or_none(head.pages); }},
    {"sound", [](const LogHead& head) { return listed(head.sounds); }},
    {"status", [](const LogHead&) { return bits(); }},
    {"solver_route", [](const LogHead&) { return listed<contact::Route>(); }},
};

std::string codes_of_knob(const std::string& name) {
    std::string out;
    frame::Knobs::visit([&]<class T>(T frame::Knobs::*, const frame::Knob& knob) {
        if constexpr (NamedEnum<T>) {
            if (name == knob.name) out = listed<T>();
        }
    });
    return out;
}

}  // namespace

std::string codes_of(const std::string& name, const LogHead& head) {
    for (const Coded& coded : kCoded) {
        if (coded.name == name) return coded.codes(head);
    }
    return codes_of_knob(name);
}

}  // namespace dihaptic::recording
