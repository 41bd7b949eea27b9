// The rule for what identifies a participant, which studies, the command line and the window share.
#pragma once

#include <string>

namespace dihaptic::study {

constexpr size_t kLongestIdentifier = 40;  ///< as it is part of folders' names

enum class IdentifierFault {
    none,
    empty,
    sign,       ///< something other than the letters A to Z, digits, - and _
    too_long,   ///< more than kLongestIdentifier characters
    simulated,  ///< begins as the identifiers of simulated people do
    no_digit    ///< may be a person's name
};

/// Returns what keeps a text from identifying a participant.
IdentifierFault fault_of_identifier(const std::string& id);

/// Throws Error unless the text identifies a participant. `option`: where it comes from.
void check_identifier(const std::string& id, const char* option);

}  // namespace dihaptic::study
