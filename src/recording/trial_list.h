// Columns of trial-list.csv, in which the trials of a task are frozen; trials.csv repeats them for
// each trial. In trial-list.csv, columns on how a reach is measured follow them.
#pragma once

#include <vector>

#include "base/table.h"

namespace dihaptic::recording {

inline const std::vector<Table::Column> kTrialListColumns = {
    {"trial_num", "number in the session, from 1"},
    {"block_num", "number, from 1"},
    {"block", "name"},
    {"trial_num_in_block", "number, from 1"},
    {"kind", "practice, baseline, perturbed, catch, error_clamp or washout"},
    {"round", "name"},
    {"condition", "name"},
    {"perturbation", "name; empty: none"},
    {"share", "of the perturbation that acts; empty: the procedure's to say"},
    {"procedure", "name; empty: none"}};

}  // namespace dihaptic::recording
