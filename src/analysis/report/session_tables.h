// Makes the tables of one session's learning and thresholds, including the fits.
#pragma once

#include <optional>
#include <vector>

#include "analysis/report/session_data.h"

namespace dihaptic::analysis {

/// A session with all of its fits, which are computed once and used both for its own tables and for
/// the tables over people.
struct FittedSession {
    explicit FittedSession(SessionData session);

    SessionData data;
    std::vector<std::optional<AdaptationFits>> adaptation;  ///< one fit for each curve
    std::vector<ThresholdFit> thresholds;                   ///< one fit for each track
};

/// The tables of a session, without the columns that state who moved the hand
/// (recording::marked()).
struct SessionTables {
    Table adaptation{};      ///< a row per reach; empty if there are no reaches
    Table fits{};            ///< a row per round
    Table blocks{};          ///< a row per block of reaches
    Table generalisation{};  ///< a row per direction
    Table thresholds{};      ///< a row per procedure
};
SessionTables session_tables(const FittedSession& session);

}  // namespace dihaptic::analysis
