// Scripts and styles that every page contains; the build makes them from the charting library's
// files (dygraphs) and from the files in this folder.
#pragma once

#include <string_view>

namespace dihaptic::analysis {

extern const std::string_view kDygraphScript;
extern const std::string_view kDygraphStyle;
extern const std::string_view kPageScript;
extern const std::string_view kPageStyle;

}  // namespace dihaptic::analysis
