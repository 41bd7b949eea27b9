// A session as a part of a BIDS data set (Motion-BIDS 1.x; Jeung et al. 2024): for each finger, as
// a tracking system of its own, motion.tsv with a row a tick, its channels and its description;
// the session's events; the participant's row. Nothing that is there is replaced: a second session
// of the same task is another run.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "recording/session.h"

namespace dihaptic::analysis {

struct Exported {
    std::string folder;            ///< of the session's files
    std::vector<std::string> log;  ///< what is wrong with raw.log, in sentences
};

/// The files get their names when all of them are whole, that of the first finger's motion last:
/// without it there is no such run. Throws Error when the session has not ended, or a file cannot
/// be written.
Exported export_bids(const recording::SessionFolder& session, const std::string& data_set,
                     const std::function<void(double)>& progress);

}  // namespace dihaptic::analysis
