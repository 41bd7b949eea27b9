// Enforces the rig's safety limits, which protect the person regardless of a scene, an experiment
// or the command line. These may tighten a limit, but are refused if they would widen one.
//
// A value under `settings: safety:` in a rig file is the limit. On a rig of real devices, the
// default is the limit for each setting that the file leaves out. All other settings are free, and
// the later source wins: default < rig < scene < experiment < command line.
#pragma once

#include <string>
#include <vector>

#include "session/plan.h"

namespace dihaptic::session {

/// Settings whose `safety:` sections apply, in rising order of precedence; a null node has none.
struct SafetySources {
    const Node& rig;
    std::vector<const Node*> others;
};

/// Sets plan.settings.safety and its origins from `sources`. A value that widens a limit of
/// plan.rig is an error. Unreadable values are skipped: they have been reported before.
void limit_safety(Plan& plan, const SafetySources& sources, Diagnostics& diagnostics);

/// Describes each limit that differs from the default: key, value, and origin.
std::vector<std::string> describe_safety(const Plan& plan);

}  // namespace dihaptic::session
