#include "recording/codes.h"

#include <fmt/format.h>

#include "contact/solver.h"
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
    std::string out = "a sum of";
    for (int bit = 0; bit < servo::kStatusBits; ++bit) {
        const auto status = static_cast<servo::Status>(1u << bit);
        out +=
            fmt::format("{} {}: {}", bit == 0 ? "" : ";", 1u << bit, servo::describe(status).what);
    }
    return out;
}

}  // namespace

std::string codes_of(const std::string& name, const LogHead& head) {
    if (name == "phase") {
        std::vector<std::string> names;
        for (const PhaseInfo& phase : head.phases) names.push_back(phase.name);
        return listed(names);
    }
    const std::string none = "-1: none";
    if (name == "outcome" || name == "message") {
        const auto& names = name == "outcome" ? head.outcomes : head.messages;
        return none + (names.empty() ? "" : ", ") + listed(names);
    }
    if (name == "status") return bits();
    if (name == "solver") return listed<contact::Solver>();
    if (name == "coupling") return listed<haptics::CouplingKind>();
    if (name == "proxy") return listed<haptics::ProxyKind>();
    if (name == "solver_route") return listed<contact::Route>();
    if (name == "solver_fallback") return "0: the solver answered, 1: another one did";
    if (name == "marker") return "0: none";
    if (name == "trial") return "0: none";
    if (name == "awake") return "0: the body sleeps, 1: it does not";
    if (name == "buttons") return "a sum of: 1, 2, 4, ... a button that is pressed";
    return "";
}

}  // namespace dihaptic::recording
