// The sections of the report, in order.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "cli/doctor/finding.h"

namespace dihaptic::doctor {

struct Section {
    std::string heading;
    std::string name;  ///< unique name: several sections may share a heading
    std::function<Findings()> look;
    /// The remedy when the check fails; given for requirements of sessions on simulated devices.
    std::vector<std::string> otherwise = {};

    /// A finding that replaces the section's own: the reason why the check failed.
    Finding failed(const std::string& why) const {
        const bool needed = !otherwise.empty();
        return {needed ? Verdict::lacks : Verdict::note, name, why, otherwise, needed};
    }
};

std::vector<Section> sections();

/// The findings of a section, from a separate process: a driver that hangs or crashes there is a
/// finding like any other.
Findings look_from_outside(const Section& section);

/// In that process: writes the findings of the section with this name to standard output, for
/// look_from_outside().
void look_inside(const std::string& name);

}  // namespace dihaptic::doctor
