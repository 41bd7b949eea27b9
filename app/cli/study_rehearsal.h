// Rehearsing a study: simulated people are allocated to its groups and do all of its sessions.
#pragma once

#include <string>

#include "person/population.h"

namespace dihaptic::cli {

struct StudyRehearsal {
    std::string file;  ///< the study's file
    std::string out;   ///< folder; empty: rehearsal/ next to the study's file
    int people = 0;    ///< 0: as many as the study asks for
    int jobs = 1;
    uint64_t seed = 1;
    bool keep_recordings = false;
    person::Population population;
};

void rehearse_study(const StudyRehearsal& rehearsal);

}  // namespace dihaptic::cli
