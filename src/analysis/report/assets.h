// Scripts and styles in every page; the build makes them from the charting library's files
// (dygraphs) and the files in this folder.
#pragma once

#include <string_view>

namespace dihaptic::analysis {

extern const std::string_view kDygraphScript;
extern const std::string_view kDygraphStyle;
extern const std::string_view kPageScript;
extern const std::string_view kPageStyle;

}  // namespace dihaptic::analysis
