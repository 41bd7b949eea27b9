// Makes the tables over the people of several sessions: each person's figures, and their means.
#pragma once

#include <vector>

#include "analysis/report/session_tables.h"

namespace dihaptic::analysis {

using Sessions = std::vector<const FittedSession*>;

/// The sessions by experiment and by who moved the hands: simulated and real people, or two
/// populations, never form one sample.
std::vector<Sessions> samples_of(const std::vector<FittedSession>& sessions);

struct PopulationTables {
    Table people{};      ///< a row per session and round
    Table adaptation{};  ///< a row per round and trial; empty without reaches
    Table thresholds{};  ///< a row per session and procedure; empty without procedures
    Table lifts{};       ///< a row per experiment, group of trials and figure; empty without lifts
    Table measures{};    ///< a row per measure, round, condition and kind of trial
};
PopulationTables population_tables(const std::vector<Sessions>& samples);

}  // namespace dihaptic::analysis
