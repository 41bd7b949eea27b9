// A session's events in BIDS form: events.tsv has a row for each attempt at a trial, with all that
// was asked for and measured in it, and a row for each momentary event, with the trial that it was
// in; events.json describes the columns.
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

/// Makes them from events.csv, trials.csv and lifts.csv; nullopt without events.csv. Throws Error
/// when one of these files cannot be read.
std::optional<Events> events_of(const recording::SessionFolder& session,
                                const recording::SessionInfo& info);

}  // namespace dihaptic::analysis::bids
