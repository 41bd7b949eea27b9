// Finds bodies in the text of a scene file, and changes the text to move a body. Only the
// numbers of its position or rotation are replaced, in the file's own unit; everything else remains
// unchanged, to the byte.
#pragma once

#include <string>
#include <vector>

#include "base/geometry.h"
#include "base/written.h"

namespace dihaptic::scene {

/// Name of the body whose lines contain the byte `at`; empty if no body does, or if the text is
/// not valid YAML at the moment.
std::string body_at(const std::string& text, size_t at);

/// The changes to the text, in its order, that move the body with this name by `way` [m] and turn
/// it by `turn` about the vertical [rad]. Coordinates that change are rounded to 0.1 mm, angles to
/// 0.1 degrees. A position or rotation that the text lacks is added. A zero `way` changes nothing
/// but shows whether the body can be moved. Throws Error, with reason and remedy, when the text
/// lacks the body, or when its numbers are not plain: they have an alias or an anchor, are in
/// quotes, or come from a lattice.
std::vector<TextChange> moved_body(const std::string& text, const std::string& name,
                                   const Vec3& way, double turn = 0);

}  // namespace dihaptic::scene
