// Tells from a session's frozen task what its perturbations are, and for the learning of which
// there is no measure yet: their figures are left empty, with a reason, rather than wrong.
#pragma once

#include <map>
#include <string>

#include "base/table.h"
#include "rows/trial_row.h"
#include "task/file/task.h"

namespace dihaptic::analysis {

/// A session's frozen task, as far as it can be read: keys that another version had are left out.
/// A task of nothing if the file is missing or is no YAML.
task::Task read_frozen_task(const std::string& file);

/// Maps the name of each perturbation whose learning is not measured to a description: "a force
/// field (curl)", "a force channel", "a mass that differs by direction". The others are measured by
/// reaches, by lifts or by thresholds.
using Unmeasured = std::map<std::string, std::string>;
inline constexpr const char* kForceChannel = "a force channel";
Unmeasured unmeasured_perturbations(const task::Task& task);
/// The column of trials.csv to whose errors adaptation is fitted; "" if the task names none.
std::string column_of_errors(const task::Task& task);

/// Kind and size of each perturbation, as a report states them: a row for each, and for each of a
/// round or condition that replaces it.
Table perturbation_table(const task::Task& task);

/// What the perturbation of a trial is, if its learning is not measured; otherwise "". Several are
/// in the order of their names. `named`: as trials.csv has it, several joined by " + ".
std::string unmeasured_in(const std::string& named, const Unmeasured& unmeasured);

/// The kind of a trial. Earlier versions called both kinds of clamp error_clamp, which is read as
/// visual_clamp; it was a force_channel if its perturbation is one.
rows::TrialKind kind_of(const rows::AskedRow& asked, const Unmeasured& unmeasured);

}  // namespace dihaptic::analysis
