// The rig's safety limits: whoever sits at it is kept by them, whatever a scene, an experiment or a
// command line says. These may tighten a limit, and are refused when they would widen one.
//
// What a rig file says of `settings: safety:` is its limit; of a rig of real devices, what it
// leaves out is limited by the default. Elsewhere each of the others may choose, the later one
// first: default < rig < scene < experiment < command line.
#pragma once

#include <string>
#include <vector>

#include "experiment/plan.h"

namespace dihaptic::experiment {

/// Settings of which `safety:` counts, in the order of their precedence; null where there is none.
struct SafetySources {
    const Node& rig;
    std::vector<const Node*> others;
};

/// Sets plan.settings.safety and its origins from `sources`; what widens a limit of plan.rig is an
/// error. What cannot be read has been told of.
void limit_safety(Plan& plan, const SafetySources& sources, Diagnostics& diagnostics);

/// Each limit that is not the default's: key, value, and who set it.
std::vector<std::string> describe_safety(const Plan& plan);

}  // namespace dihaptic::experiment
