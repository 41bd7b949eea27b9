// Exports a session into a BIDS data set (Motion-BIDS 1.x; Jeung et al. 2024). Each finger is a
// separate tracking system, with its motion.tsv (a row per tick), the list of its channels and its
// description. The session's events and the participant's row are exported as well. Existing files
// are not replaced: a second session of the same task becomes another run.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "recording/session.h"

namespace dihaptic::analysis {

/// Columns of events.tsv that are defined by BIDS or by this program.
inline constexpr std::array kEventColumns = {"onset",         "duration", "trial_type", "value",
                                             "response_time", "HED",      "stim_file",  "sample"};

struct Exported {
    std::string folder;            ///< folder of the exported files
    std::vector<Problem> changed;  ///< warnings about tables changed after the session ended
    std::vector<std::string> log;  ///< faults found in raw.log, as sentences
};

/// Exports the session to the folder `data_set`. The files get their final names once all of them
/// are complete, the first finger's motion file last, so a run without that file is incomplete.
/// Throws Error when the session has not ended, or when a file cannot be written.
Exported export_bids(const recording::SessionFolder& session, const std::string& data_set,
                     const std::function<void(double)>& progress);

/// Whether the data set contains a recording of the session. Throws Error when its tables cannot be
/// read.
bool is_exported(const recording::SessionFolder& session, const std::string& data_set);

}  // namespace dihaptic::analysis
