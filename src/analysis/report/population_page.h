// Makes the report's page of a folder of sessions: each person's figures, and means over people.
#pragma once

#include <string>
#include <vector>

#include "analysis/report/page.h"
#include "analysis/report/session_data.h"

namespace dihaptic::analysis {

struct PopulationPage {
    Page page;
    Table people{};      ///< a row per session and round
    Table adaptation{};  ///< a row per round and trial; empty without reaches
    Table thresholds{};  ///< a row per session and procedure; empty without procedures
    Table lifts{};       ///< a row per experiment, group of trials and figure; empty without lifts
    Table measures{};    ///< a row per measure, round, condition and kind of trials
};

PopulationPage population_page(const std::vector<SessionData>& sessions, const std::string& folder,
                               const std::string& command);

}  // namespace dihaptic::analysis
