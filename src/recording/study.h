// What archives ask of a study beside its data: who did it, where, and what it is about. It stands
// in the experiment file, and nothing here depends on it.
#pragma once

#include <string>
#include <vector>

#include "base/field.h"

namespace dihaptic::recording {

struct Study {
    std::vector<std::string> experimenters;  ///< "Johansson, R. S."; authors of a data set, too
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

}  // namespace dihaptic::recording
