// A session's events in BIDS form: events.tsv has a row for each attempt at a trial, with all its
// demands and measures, and a row for each momentary event, with its trial; events.json describes
// the columns.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/bids/tsv.h"
#include "recording/session.h"

namespace dihaptic::analysis::bids {

struct Events {
    std::vector<Row> rows;  ///< rows of events.tsv, the header first
    std::string json;
};

/// Makes the events from events.csv, trials.csv and lifts.csv; nullopt without events.csv. Throws
/// Error when one of these files cannot be read.
std::optional<Events> events_of(const recording::SessionFolder& session,
                                const recording::SessionInfo& info);

}  // namespace dihaptic::analysis::bids
