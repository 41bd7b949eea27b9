// The contents of the files in populations/, which the build embeds in the program.
#pragma once

#include <string_view>

namespace dihaptic::person {

extern const std::string_view kAdults;
extern const std::string_view kAdultsRealObjects;

}  // namespace dihaptic::person
