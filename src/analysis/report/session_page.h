// Makes the report's page of one session.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "analysis/report/page.h"
#include "analysis/report/session_data.h"

namespace dihaptic::analysis {

/// Text below every chart: who moved the hand, session, program, seed.
std::string origin_of(const SessionData& session);

struct SessionPage {
    Page page;
    Table adaptation{};              ///< a row per reach; empty without reaches
    Table fits{};                    ///< a row per round
    Table blocks{};                  ///< a row per block of reaches
    Table thresholds{};              ///< a row per procedure
    Table generalisation{};          ///< a row per direction
    std::vector<std::string> log{};  ///< faults of raw.log, in sentences
};

/// Throws Error when the session's log cannot be read.
SessionPage session_page(const SessionData& session, const std::string& command,
                         const std::function<void(double)>& progress);

}  // namespace dihaptic::analysis
