// session.nwb: the session as an NWB 2 file (Neurodata Without Borders, HDF5), which h5py, MATLAB's
// h5read and NWB tools open without this program. It is made from raw.log, which stays unchanged.
//
//   acquisition/                       SpatialSeries and TimeSeries, see docs/quantities.md
//   intervals/trials, phases, events   TimeIntervals
//   general/subject, general/devices
//   scratch/settings                   settings, each with its origin
//   scratch/items                      names of fingers, bodies and joints, in order
//
// The schema (/specifications) is not included: readers use their own copy of the version stated.
#pragma once

#include <array>
#include <functional>

#include "base/table.h"
#include "recording/session.h"

namespace dihaptic::recording {

/// The content of the file besides the frames.
struct NwbContent {
    SessionInfo info;
    Table trials;    ///< its first columns are start_time and stop_time
    Table phases;    ///< its first columns are start_time and stop_time
    Table events;    ///< its first columns are start_time and stop_time
    Table settings;  ///< columns name, value and origin
};

/// Names that a column of an NWB table cannot have: those of the table's other members.
inline constexpr std::array kReservedColumns = {
    "id", "colnames", "description", "tags", "tags_index", "timeseries", "timeseries_index"};

/// Writes the file from the folder's raw.log; an old file is replaced only once the new one is
/// complete. `progress` receives the share done. Throws Error when the file cannot be written.
void write_nwb(const SessionFolder& folder, const NwbContent& content,
               const std::function<void(double)>& progress);

/// Number of ticks in the folder's session.nwb; -1 if there is no readable one.
int64_t ticks_in_nwb(const SessionFolder& folder);

}  // namespace dihaptic::recording
