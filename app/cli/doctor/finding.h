// An entry in the report of `dihaptic doctor`: the finding, its meaning for an experiment, and the
// commands that solve a problem.
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
    std::string found;                  ///< the finding, with its consequence for an experiment
    std::vector<std::string> commands;  ///< commands that solve the problem, in this order
    /// Whether sessions on simulated devices, too, require what was checked.
    bool needed = false;
};
using Findings = std::vector<Finding>;

/// The printed lines of the finding.
std::string to_text(const Finding& finding);

/// Encodes the finding in one line, for another process.
std::string to_json(const Findings& findings);
/// Throws std::exception when the text is not from to_json().
Findings from_json(const std::string& text);

}  // namespace dihaptic::doctor
