// Makes the tables over all people of several sessions: the figures of each person, and the means
// of these figures.
#pragma once

#include <vector>

#include "analysis/report/session_tables.h"

namespace dihaptic::analysis {

using Sessions = std::vector<const FittedSession*>;

/// Groups the sessions by experiment and by who moved the hands. Simulated and real people, or two
/// different populations, are never in the same sample.
std::vector<Sessions> samples_of(const std::vector<FittedSession>& sessions);

struct PopulationTables {
    Table people{};      ///< a row per session and round
    Table adaptation{};  ///< a row per round and trial; empty if there are no reaches
    Table thresholds{};  ///< a row per session and procedure; empty if there are no procedures
    Table lifts{};       ///< a row per experiment, group of trials and figure; empty if no lifts
    Table measures{};    ///< a row per measure, round, condition and kind of trial
};
PopulationTables population_tables(const std::vector<Sessions>& samples);

}  // namespace dihaptic::analysis
