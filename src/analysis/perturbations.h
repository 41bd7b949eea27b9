// Finds the perturbations in a session's frozen task, and those whose learning has no measure yet:
// their figures are left empty, with a reason, rather than wrong.
#pragma once

#include <map>
#include <string>

#include "base/table.h"
#include "rows/trial_row.h"
#include "task/file/task.h"

namespace dihaptic::analysis {

/// A session's frozen task, as far as it is readable: keys from another version are left out. An
/// empty task if the file is missing or is not YAML.
task::Task read_frozen_task(const std::string& file);

/// Maps the name of each perturbation whose learning is not measured to a description: "a force
/// field (curl)", "a force channel", "a mass that differs by direction". The learning of others is
/// measured by reaches, lifts or thresholds.
using Unmeasured = std::map<std::string, std::string>;
inline constexpr const char* kForceChannel = "a force channel";
Unmeasured unmeasured_perturbations(const task::Task& task);
/// The column of trials.csv with the errors to which adaptation is fitted; "" if the task names
/// none.
std::string column_of_errors(const task::Task& task);

/// Kind and size of each perturbation, as stated in a report: a row for each, and one for each
/// replacement in a round or condition.
Table perturbation_table(const task::Task& task);

/// Description of a trial's perturbation, if its learning is not measured; otherwise "". Several
/// descriptions are in the order of the perturbations' names. `named`: as in trials.csv, where
/// several are joined by " + ".
std::string unmeasured_in(const std::string& named, const Unmeasured& unmeasured);

/// The kind of a trial. Earlier versions wrote error_clamp for both kinds of clamp. It is read as
/// visual_clamp at first; such a trial is a force_channel if its perturbation is one.
rows::TrialKind kind_of(const rows::AskedRow& asked, const Unmeasured& unmeasured);

}  // namespace dihaptic::analysis
