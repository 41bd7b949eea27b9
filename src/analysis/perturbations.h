// Finds the perturbations in a session's frozen task, and those for which learning has no measure
// yet: the figures of these perturbations are left empty, with a reason, rather than wrong.
#pragma once

#include <map>
#include <string>

#include "base/table.h"
#include "rows/trial_row.h"
#include "task/file/task.h"

namespace dihaptic::analysis {

/// Reads a session's frozen task as far as it is readable: keys from other versions are ignored.
/// Returns an empty task if the file is missing or is not YAML.
task::Task read_frozen_task(const std::string& file);

/// Maps the name of each perturbation whose learning is not measured to a description: "a force
/// field (curl)", "a force channel", "a mass that differs by direction". The learning of all other
/// perturbations is measured by reaches, lifts or thresholds.
using Unmeasured = std::map<std::string, std::string>;
inline constexpr const char* kForceChannel = "a force channel";
Unmeasured unmeasured_perturbations(const task::Task& task);
/// Name of the column in trials.csv that holds the errors to which adaptation is fitted; "" if the
/// task names none.
std::string column_of_errors(const task::Task& task);

/// Kind and size of each perturbation, as stated in a report. The table has a row for each
/// perturbation, and for each of its replacements in a round or condition.
Table perturbation_table(const task::Task& task);

/// Returns a description of a trial's perturbation if its learning is not measured, otherwise "".
/// Several descriptions are ordered by the names of the perturbations. `named`: names as in
/// trials.csv, where several names are joined by " + ".
std::string unmeasured_in(const std::string& named, const Unmeasured& unmeasured);

/// Returns the kind of a trial. Earlier versions wrote error_clamp for both kinds of clamp. Such a
/// trial is first read as a visual_clamp; it is a force_channel if its perturbation is a force
/// channel.
rows::TrialKind kind_of(const rows::AskedRow& asked, const Unmeasured& unmeasured);

}  // namespace dihaptic::analysis
