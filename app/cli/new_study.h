// The contents of the files in new_study/, which the build embeds in the program.
#pragma once

#include <string_view>

namespace dihaptic::cli {

extern const std::string_view kStudyScene;
extern const std::string_view kStudyRig;
extern const std::string_view kStudyExperiment;
extern const std::string_view kStudyReadme;

}  // namespace dihaptic::cli
