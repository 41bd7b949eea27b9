// Files that every page carries within it; the build makes them from the charting library's
// (dygraphs) and from those beside this one.
#pragma once

#include <string_view>

namespace dihaptic::analysis {

extern const std::string_view kDygraphScript;
extern const std::string_view kDygraphStyle;
extern const std::string_view kPageScript;
extern const std::string_view kPageStyle;

}  // namespace dihaptic::analysis
