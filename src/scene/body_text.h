// Where the text of a scene file has its bodies, and changes of that text that move one. Only the
// numbers of its position or rotation are replaced, in the unit that the file has them in;
// everything else stays as it is, to the byte.
#pragma once

#include <string>
#include <vector>

#include "base/geometry.h"
#include "base/written.h"

namespace dihaptic::scene {

/// Name of the body in whose lines of the text the byte `at` is; empty: in none's, or the text is
/// not YAML at the moment.
std::string body_at(const std::string& text, size_t at);

/// The changes by which the text has the body of this name moved by `way` [m] and turned by `turn`
/// about the vertical [rad]; what moves at all ends at whole 0.1 mm, what turns at whole 0.1
/// degrees. A position or rotation that the text does not have is added. In the order of the text.
/// A way of nothing changes nothing, and tells whether the body can be moved.
/// Throws Error, which says why and what to do, when the text does not have the body, or has its
/// numbers not as numbers that are its own: by an alias or an anchor, in quotes, from a lattice.
std::vector<TextChange> moved_body(const std::string& text, const std::string& name,
                                   const Vec3& way, double turn = 0);

}  // namespace dihaptic::scene
