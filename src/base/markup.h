// Text in HTML and SVG.
#pragma once

#include <string>

namespace dihaptic {

/// Shown as it is, between tags and within quoted attributes.
std::string escaped_markup(const std::string& text);

}  // namespace dihaptic
