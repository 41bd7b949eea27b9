// A session's events as BIDS has them: events.tsv with a row for each attempt at a trial, with all
// that was asked for and measured in it, and a row for each moment, with the trial that it was in;
// events.json, which says what each column is.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/bids/tsv.h"
#include "recording/session.h"

namespace dihaptic::analysis::bids {

struct Events {
    std::vector<Row> rows;  ///< the header first
    std::string json;
};

/// From events.csv, trials.csv and lifts.csv; none without the first. Throws Error when one of them
/// cannot be read.
std::optional<Events> events_of(const recording::SessionFolder& session,
                                const recording::SessionInfo& info);

}  // namespace dihaptic::analysis::bids
