// What archives ask about a study besides its data: who did it, where, and what it is about. It is
// part of the experiment file and of the session's record, and changes nothing in a session.
#pragma once

#include <string>
#include <vector>

#include "base/field.h"

namespace dihaptic {

struct Study {
    std::vector<std::string> experimenters;  ///< e.g. "Johansson, R. S."; also a data set's authors
    std::string institution;
    std::string lab;
    std::vector<std::string> keywords;

    template <class Visitor>
    void visit(Visitor& v) {
        v("experimenters", experimenters);
        v("institution", institution);
        v("lab", lab);
        v("keywords", keywords);
    }
};

}  // namespace dihaptic
