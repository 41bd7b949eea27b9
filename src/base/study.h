// Information about a study that archives request in addition to the data: experimenters,
// laboratory and subject. It is part of the experiment file and of the session's record, but has no
// effect on the session itself.
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
        v("experimenters", experimenters,
          says("Names of the experimenters, who are also the authors of a BIDS data set."));
        v("institution", institution, says("Institution where the study was done."));
        v("lab", lab, says("Laboratory."));
        v("keywords", keywords, says("Subjects of the study."));
    }
};

}  // namespace dihaptic
