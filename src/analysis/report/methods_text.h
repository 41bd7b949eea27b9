// The part of a session's page that describes methods and results in sentences, with the figures of
// the page: a start for the corresponding sections of a paper.
#pragma once

#include <string>
#include <vector>

#include "analysis/report/session_page.h"

namespace dihaptic::analysis {

struct MethodsText {
    std::vector<std::string> methods;  ///< paragraphs
    std::vector<std::string> results;
};

/// `page`: must have its tables of fits and thresholds. `windows`: table of adaptation; `lifts`:
/// table of the lifts' figures; both as on the page.
MethodsText methods_text(const SessionData& session, const SessionPage& page, const Table& windows,
                         const Table& lifts);

}  // namespace dihaptic::analysis
