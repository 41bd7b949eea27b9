// Exports the recorded data of each tick as one wide table (CSV): a row for each tick, with
//
//   t_s                    time of the tick, since activation
//   trial                  its number, from 1; 0: none
//   grip_force_N, ...      requested quantities, in SI units
//
// Quantities are named as in docs/quantities.md; for a finger, body or joint, the quantity follows
// its name and a dot, and a component follows another dot: block.position.z. Without a component, a
// vector has a column for each. Unmeasured values are empty cells. Ticks are read from raw.log one
// after the other, so that memory does not grow with the session's length.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "recording/session.h"

namespace dihaptic::analysis {

/// The name of a quantity's column: the quantity followed by its unit as usually written,
/// damping_Ns_m.
std::string column_name(const std::string& quantity, const std::string& unit);

/// Writes the file and returns the faults of raw.log, in sentences. `names`: names of quantities,
/// in the order of their columns. Throws Error when the session has not ended or has no recording,
/// when it recorded no quantity with such a name, or when the file cannot be written.
std::vector<std::string> export_curves(const recording::SessionFolder& session,
                                       const std::vector<std::string>& names,
                                       const std::string& file,
                                       const std::function<void(double)>& progress);

}  // namespace dihaptic::analysis
