// An entry in the report of `dihaptic doctor`: the finding, its meaning for an experiment, and the
// commands that solve the problem.
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
    std::string found;                  ///< the finding and its consequence for an experiment
    std::vector<std::string> commands;  ///< commands that solve the problem, to be typed in order
    /// Whether the checked item is required even by sessions on simulated devices.
    bool needed = false;
};
using Findings = std::vector<Finding>;

/// The finding as printed, in one or several lines.
std::string to_text(const Finding& finding);

/// Encodes the findings in one line, for another process.
std::string to_json(const Findings& findings);
/// Decodes the text of to_json(). Throws std::exception when the text does not come from it.
Findings from_json(const std::string& text);

}  // namespace dihaptic::doctor
