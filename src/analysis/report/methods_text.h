// The part of a session's page that says in sentences what was done and found, with the figures of
// the page: a beginning for a paper's sections on methods and results.
#pragma once

#include <string>
#include <vector>

#include "analysis/report/session_page.h"

namespace dihaptic::analysis {

struct MethodsText {
    std::vector<std::string> methods;  ///< paragraphs
    std::vector<std::string> results;
};

/// `page`: its tables of fits and thresholds are made. `windows`: of adaptation, and `lifts`: of
/// the lifts' figures, as the page shows them.
MethodsText methods_text(const SessionData& session, const SessionPage& page, const Table& windows,
                         const Table& lifts);

}  // namespace dihaptic::analysis
