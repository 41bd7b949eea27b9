// The parts of the report, in its order.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "cli/doctor/finding.h"

namespace dihaptic::doctor {

struct Section {
    std::string heading;
    std::string name;  ///< of its own: several sections may stand under a heading
    std::function<Findings()> look;
    /// What to do when nothing can be found out; given for what sessions on simulated devices need.
    std::vector<std::string> otherwise = {};

    /// In place of what it finds: why nothing could be found out.
    Finding failed(const std::string& why) const {
        const bool needed = !otherwise.empty();
        return {needed ? Verdict::lacks : Verdict::note, name, why, otherwise, needed};
    }
};

std::vector<Section> sections();

/// What a section finds, in a process of its own: a driver that hangs or crashes there is a finding
/// like others.
Findings look_from_outside(const Section& section);

/// In that process: writes what the section of that name finds to standard output, for
/// look_from_outside().
void look_inside(const std::string& name);

}  // namespace dihaptic::doctor
