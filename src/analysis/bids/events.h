// A session's events in BIDS form. events.tsv has a row for each trial attempt, with all its
// demands and measures, and a row for each momentary event, with the trial it belongs to.
// events.json describes the columns.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/bids/tsv.h"
#include "recording/session.h"

namespace dihaptic::analysis::bids {

struct Events {
    std::vector<Row> rows;  ///< rows of events.tsv, starting with the header
    std::string json;
};

/// Makes the events from events.csv, trials.csv and lifts.csv; returns nullopt if there is no
/// events.csv. Throws Error when one of these files cannot be read.
std::optional<Events> events_of(const recording::SessionFolder& session,
                                const recording::SessionInfo& info);

}  // namespace dihaptic::analysis::bids
