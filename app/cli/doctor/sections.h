// The sections of the doctor's report, in order.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "cli/doctor/finding.h"

namespace dihaptic::doctor {

struct Section {
    std::string heading;
    std::string name;  ///< unique name, because several sections may share a heading
    std::function<Findings()> look;
    /// The remedy when the check itself fails; given only for checks that sessions on simulated
    /// devices require.
    std::vector<std::string> otherwise = {};

    /// The finding that replaces the section's own when the check fails. `why`: the reason.
    Finding failed(const std::string& why) const {
        const bool needed = !otherwise.empty();
        return {needed ? Verdict::lacks : Verdict::note, name, why, otherwise, needed};
    }
};

std::vector<Section> sections();

/// Checks a section in a separate process and returns its findings: a driver that hangs or crashes
/// there is reported like any other finding.
Findings look_from_outside(const Section& section);

/// Runs in that process: writes the findings of the section with this name to standard output,
/// where look_from_outside() reads them.
void look_inside(const std::string& name);

}  // namespace dihaptic::doctor
