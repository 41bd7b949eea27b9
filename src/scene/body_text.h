// Finds bodies in the text of a scene file, and changes the text to move a body. Only the numbers
// of the body's position and rotation are replaced, in the unit used by the file; all other bytes
// remain unchanged.
#pragma once

#include <string>
#include <vector>

#include "base/geometry.h"
#include "base/written.h"

namespace dihaptic::scene {

/// Name of the body whose lines contain the byte at position `at`; empty if there is no such body,
/// or if the text is not valid YAML at the moment.
std::string body_at(const std::string& text, size_t at);

/// Returns the changes, in the order in which they occur in the text, that move the body called
/// `name` by `way` [m] and turn it by `turn` about the vertical [rad]. Changed coordinates are
/// rounded to 0.1 mm, and changed angles to 0.1 degrees. If the text gives no position or rotation,
/// it is added. If `way` is zero, nothing is changed, but the call shows whether the body can be
/// moved. Throws Error, with reason and remedy, if there is no such body or if its numbers are not
/// plain, i.e. have an alias or an anchor, are in quotes, or come from a lattice.
std::vector<TextChange> moved_body(const std::string& text, const std::string& name,
                                   const Vec3& way, double turn = 0);

}  // namespace dihaptic::scene
