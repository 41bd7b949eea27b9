// Makes the tables of one session's learning and thresholds, and of what is fitted to them.
#pragma once

#include <optional>
#include <vector>

#include "analysis/report/session_data.h"

namespace dihaptic::analysis {

/// A session with all that is fitted to it, which is computed once for its own tables and for those
/// over people.
struct FittedSession {
    explicit FittedSession(SessionData session);

    SessionData data;
    std::vector<std::optional<AdaptationFits>> adaptation;  ///< of each of its curves
    std::vector<ThresholdFit> thresholds;                   ///< of each of its tracks
};

/// The tables, without the columns that state who moved the hand (recording::marked()).
struct SessionTables {
    Table adaptation{};      ///< a row per reach; empty without reaches
    Table fits{};            ///< a row per round
    Table blocks{};          ///< a row per block of reaches
    Table generalisation{};  ///< a row per direction
    Table thresholds{};      ///< a row per procedure
};
SessionTables session_tables(const FittedSession& session);

}  // namespace dihaptic::analysis
