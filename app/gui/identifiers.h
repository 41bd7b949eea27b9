// Judges an identifier that is typed for a participant, so that nobody is recorded as somebody
// else.
#pragma once

#include <QString>
#include <string>
#include <vector>

namespace dihaptic::gui {

/// Returns why the text cannot identify a participant, with the remedy; "" if it can.
/// `needs_number`: whether it must end in a number.
QString fault_of_identifier(const std::string& typed, bool needs_number);

/// Returns the known identifier for which `typed` may be a slip of the keyboard: in other letter
/// case, with other zeros, O for 0, a sign or a part too many, one character changed, or two
/// swapped. Returns "" if there is none, or if `typed` itself is known.
std::string resembled(const std::string& typed, const std::vector<std::string>& known);

/// Returns the identifier of the next new participant: one more than the largest number, in the
/// form that most of the known identifiers have. Returns "S01" if nobody is known.
std::string next_identifier(const std::vector<std::string>& known);

/// Whether an identifier skips numbers or takes up a missing one: it has the form of the known
/// ones, and is neither known nor the next.
bool out_of_turn(const std::string& typed, const std::vector<std::string>& known);

}  // namespace dihaptic::gui
