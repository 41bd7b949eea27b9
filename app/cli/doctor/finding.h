// A line of the report of `dihaptic doctor`: what was found, what that means for an experiment, and
// the commands that mend it.
#pragma once

#include <array>
#include <string>
#include <vector>

namespace dihaptic::doctor {

enum class Verdict { ok, lacks, note };
constexpr auto enum_names(Verdict) {
    return std::array{"ok", "lacks", "note"};
}

struct Finding {
    Verdict verdict = Verdict::note;
    std::string what;                   ///< e.g. "kernel"
    std::string found;                  ///< what there is, and what follows for an experiment
    std::vector<std::string> commands;  ///< that mend it, in this order
    /// Sessions on simulated devices need it too.
    bool needed = false;
};
using Findings = std::vector<Finding>;

/// The lines that are printed of it.
std::string to_text(const Finding& finding);

/// From one process to another, in a line.
std::string to_json(const Findings& findings);
/// Throws std::exception when the text is none of to_json().
Findings from_json(const std::string& text);

}  // namespace dihaptic::doctor
