// Enforces the rig's safety limits, which protect the person whatever the scene, experiment or
// command line may say. Those three may make a limit stricter, but an attempt to relax a limit is
// an error.
//
// A value under `settings: safety:` in a rig file is a limit. If the rig has real devices, the
// default value is the limit for each setting that the file leaves out. All other settings are
// free, and later sources override earlier ones: default < rig < scene < experiment < command line.
#pragma once

#include <string>
#include <vector>

#include "session/plan.h"

namespace dihaptic::session {

/// Settings whose `safety:` sections are applied, from the lowest to the highest precedence. A null
/// node has no such section.
struct SafetySources {
    const Node& rig;
    std::vector<const Node*> others;
};

/// Sets plan.settings.safety and the origins of its values from `sources`. A value that relaxes a
/// limit of plan.rig is an error. Unreadable values are skipped, because they have already been
/// reported.
void limit_safety(Plan& plan, const SafetySources& sources, Diagnostics& diagnostics);

/// Describes each limit that differs from the default, with its key, value and origin.
std::vector<std::string> describe_safety(const Plan& plan);

}  // namespace dihaptic::session
