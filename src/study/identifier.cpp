#include "study/identifier.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "base/diagnostics.h"
#include "base/text_file.h"
#include "recording/moved_by.h"

namespace dihaptic::study {
namespace {

bool is_simulated(std::string id) {
    for (char& c : id) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return id.starts_with(recording::kSimulatedPrefix);
}

}  // namespace

IdentifierFault fault_of_identifier(const std::string& id) {
    if (id.empty()) return IdentifierFault::empty;
    const auto allowed = [](unsigned char c) {
        return c < 128 && (std::isalnum(c) != 0 || c == '-' || c == '_');
    };
    if (!std::ranges::all_of(id, allowed) || id.front() == '-') return IdentifierFault::sign;
    if (id.size() > kLongestIdentifier) return IdentifierFault::too_long;
    if (is_simulated(id)) return IdentifierFault::simulated;
    const auto digit = [](unsigned char c) { return std::isdigit(c) != 0; };
    return std::ranges::any_of(id, digit) ? IdentifierFault::none : IdentifierFault::no_digit;
}

void check_identifier(const std::string& id, const char* option) {
    const auto fault = [&](const std::string& what, const std::string& remedy) {
        return Error({option, 0}, shortened(id), what, remedy);
    };
    switch (fault_of_identifier(id)) {
        case IdentifierFault::none:
            return;
        case IdentifierFault::simulated:
            throw fault("is the identifier of a simulated person", "Use e.g. S07.");
        case IdentifierFault::no_digit:
            throw fault("has no digit, and may be a person's name",
                        "Use an identifier, e.g. S07, and keep the list of names elsewhere.");
        default:
            throw fault("is not an identifier",
                        fmt::format("Use at most {} letters, digits, - and _, e.g. S07.",
                                    kLongestIdentifier));
    }
}

}  // namespace dihaptic::study
