// Rehearses a study: simulated people are allocated to its groups and do all of its sessions.
#pragma once

#include <string>

#include "person/population.h"

namespace dihaptic::cli {

struct StudyRehearsal {
    std::string file;  ///< path of the study file
    std::string out;   ///< output folder; if empty, rehearsal/ next to the study file
    int people = 0;    ///< number of people; 0 for as many as the study plans
    int jobs = 1;
    uint64_t seed = 1;
    bool keep_recordings = false;
    person::Population population;
};

void rehearse_study(const StudyRehearsal& rehearsal);

}  // namespace dihaptic::cli
