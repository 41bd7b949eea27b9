// The page of a folder of sessions: each person's figures, and what they have in common.
#pragma once

#include <string>
#include <vector>

#include "analysis/report/page.h"
#include "analysis/report/session_data.h"

namespace dihaptic::analysis {

struct PopulationPage {
    Page page;
    Table people{};      ///< a row a session and round
    Table adaptation{};  ///< a row a round and trial; empty without reaches
    Table thresholds{};  ///< a row a session and procedure; empty without
    Table lifts{};       ///< a row an experiment, group of trials and figure; empty without lifts
};

PopulationPage population_page(const std::vector<SessionData>& sessions, const std::string& folder,
                               const std::string& command);

}  // namespace dihaptic::analysis
