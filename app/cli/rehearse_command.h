// The command that runs the sessions of a rehearsal's people. It is kept in rehearsal.yaml so that
// `dihaptic collect` can print it when people are missing. That file may come from a stranger, and
// the command will be copied into a shell, so only a newly composed command of this form is ever
// shown.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "session/rehearsal.h"

namespace dihaptic::cli {

struct RehearseCommand {
    std::string file;  ///< experiment
    int people = 0;
    std::string seed;
    std::string out;         ///< folder
    std::string population;  ///< file; empty: the program's own
    bool real_objects = false;
    bool keep_recordings = false;
    int jobs = 1;
    std::string container;  ///< Apptainer file with the program; empty: this program

    /// The command to type in any folder. It starts this program, which may itself be in a
    /// container, or the program in `container`.
    std::string text() const;
};

/// The Python equivalent, in place of a command.
inline constexpr const char* kByPython = "dihaptic.rehearse() of Python, as before";

/// The command for all people of the rehearsal in `folder`, composed from its rehearsal.yaml;
/// nullopt if that has no command of this form.
std::optional<std::string> command_of(const std::string& folder,
                                      const session::Rehearsal& rehearsal);

}  // namespace dihaptic::cli
