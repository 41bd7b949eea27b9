// The tables of all participants and sessions of a study, joined.
#pragma once

#include <string>

namespace dihaptic::cli {

struct StudyCollection {
    std::string file;       ///< of the study
    std::string rehearsed;  ///< folder of a rehearsal; empty: the study's own participants
    std::string out;        ///< folder; empty: tables/ beside the participants
    bool reveal_groups = false;
};

/// Whether a file is a study.
bool is_study(const std::string& file);

void collect_study(const StudyCollection& collection);

}  // namespace dihaptic::cli
