// Finds a session's perturbations for whose learning there is no measure yet, from its frozen
// task.yaml: their figures are left empty, with a reason, rather than wrong.
#pragma once

#include <map>
#include <string>

namespace dihaptic::analysis {

/// Maps the name of each perturbation whose learning is not measured to a description: "a force
/// field (curl)", "a force channel", "a mass that differs by direction". The others are measured by
/// reaches, by lifts or by thresholds. Empty if the file is missing or cannot be read.
using Unmeasured = std::map<std::string, std::string>;
Unmeasured unmeasured_perturbations(const std::string& task_file);

}  // namespace dihaptic::analysis
