// Writes session.nwb: the session as an NWB 2 file (Neurodata Without Borders, based on HDF5),
// which h5py, MATLAB's h5read and NWB tools can open without this program. The file is made from
// raw.log, which stays unchanged.
//
//   acquisition/                       SpatialSeries and TimeSeries, see docs/quantities.md
//   intervals/trials, phases, events   TimeIntervals
//   general/subject, general/devices
//   scratch/settings                   settings, each with its origin
//   scratch/items                      names of fingers, bodies and joints, in order
//
// The NWB schema (/specifications) is not included: readers use their own copy of the schema
// version stated in the file.
#pragma once

#include <array>
#include <functional>

#include "base/table.h"
#include "recording/session.h"

namespace dihaptic::recording {

/// The contents of the file other than frames.
struct NwbContent {
    SessionInfo info;
    Table trials;    ///< the first columns are start_time and stop_time
    Table phases;    ///< the first columns are start_time and stop_time
    Table events;    ///< the first columns are start_time and stop_time
    Table settings;  ///< the columns are name, value and origin
};

/// Names that a column of an NWB table must not have, because the table's other members have them.
inline constexpr std::array kReservedColumns = {
    "id", "colnames", "description", "tags", "tags_index", "timeseries", "timeseries_index"};

/// Writes session.nwb from the folder's raw.log; an old file is replaced only once the new one is
/// complete. `progress` is called with the fraction done. Throws Error when the file cannot be
/// written.
void write_nwb(const SessionFolder& folder, const NwbContent& content,
               const std::function<void(double)>& progress);

/// Number of ticks in the folder's session.nwb; -1 if the file is missing or cannot be read.
int64_t ticks_in_nwb(const SessionFolder& folder);

}  // namespace dihaptic::recording
