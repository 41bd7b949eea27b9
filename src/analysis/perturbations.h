// What a session's perturbations are, told from its frozen task.yaml. There is no measure yet of
// what is learned of some of them: of these, figures are left empty with a reason, rather than
// wrong.
#pragma once

#include <map>
#include <string>

namespace dihaptic::analysis {

/// By the name of a perturbation whose learning is not measured, what it is: "a force field
/// (curl)", "a force channel", "a mass that differs by direction". The others are measured by
/// reaches, by lifts or by thresholds. Empty where the file is not there, or cannot be read.
using Unmeasured = std::map<std::string, std::string>;
Unmeasured unmeasured_perturbations(const std::string& task_file);

}  // namespace dihaptic::analysis
