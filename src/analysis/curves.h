// Exports the recorded data of each tick as one wide table (CSV): a row for each tick, with
//
//   t_s                    time of the tick, since activation
//   trial                  trial number, from 1; 0 between trials
//   grip_force_N, ...      requested quantities, in SI units
//
// Quantities are named as in docs/quantities.md. The name of a finger, body or joint comes before
// the quantity, and a component comes after it, separated by dots: block.position.z. A vector
// requested without a component gets one column for each component. Unmeasured values are empty
// cells. Ticks are read from raw.log one at a time, so that memory use does not grow with the
// length of the session.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "recording/session.h"

namespace dihaptic::analysis {

/// The first two columns of every table of curves.
inline constexpr std::string_view kBeginOfCurves = "t_s,trial";

/// Returns the name of a quantity's column, i.e. the quantity followed by its unit as usually
/// written, e.g. damping_Ns_m.
std::string column_name(const std::string& quantity, const std::string& unit);

/// Writes the file and returns the faults found in raw.log, as sentences. `names`: names of
/// quantities, in column order. Throws Error when the session has not ended or has no recording,
/// when a name is not that of a recorded quantity, or when the file cannot be written.
std::vector<std::string> export_curves(const recording::SessionFolder& session,
                                       const std::vector<std::string>& names,
                                       const std::string& file,
                                       const std::function<void(double)>& progress);

}  // namespace dihaptic::analysis
