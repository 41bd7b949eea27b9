// Exports what a session recorded in each tick as one wide table (CSV): a row for each tick, with
//
//   t_s                    time of the tick, since activation
//   trial                  its number, from 1; 0: none
//   grip_force_N, ...      what was asked for, in SI units
//
// Quantities have the names of docs/quantities.md; behind a dot stands what belongs to a finger,
// body or joint, and behind another a component: block.position.z. Without it, a vector has a
// column for each component. What was not measured is an empty cell. Ticks are read from raw.log
// one after the other, so that a session of any length needs no more memory.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "recording/session.h"

namespace dihaptic::analysis {

/// The name of a quantity's column: with its unit (as people write it) behind it, damping_Ns_m.
std::string column_name(const std::string& quantity, const std::string& unit);

/// Writes the file and returns what is wrong with raw.log, in sentences. `names`: of quantities, in
/// the order of their columns. Throws Error when the session has not ended or has no recording,
/// when it recorded nothing of such a name, or when the file cannot be written.
std::vector<std::string> export_curves(const recording::SessionFolder& session,
                                       const std::vector<std::string>& names,
                                       const std::string& file,
                                       const std::function<void(double)>& progress);

}  // namespace dihaptic::analysis
