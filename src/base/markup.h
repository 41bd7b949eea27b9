// Escapes text for use in HTML and SVG.
#pragma once

#include <string>

namespace dihaptic {

/// Returns the text with its markup characters escaped, for use between tags and in quoted
/// attributes.
std::string escaped_markup(const std::string& text);

}  // namespace dihaptic
