// The command that runs the sessions of a rehearsal's simulated people. It is kept in
// rehearsal.yaml so that `dihaptic collect` can print it when people are missing. That file may
// come from a stranger, and the user will copy the command into a shell, so the printed command is
// always composed from the checked parts of the stored one.
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
    std::string population;  ///< population file; empty for the program's own
    int laboratories = 0;    ///< 0 for as many as the population says
    bool real_objects = false;
    bool keep_recordings = false;
    int jobs = 1;
    std::string container;  ///< Apptainer file with the program; empty for this program

    /// The command as text that can be typed in any folder. The command starts this program, which
    /// may itself be in a container, or the program in `container`.
    std::string text() const;
};

/// Printed in place of a command when the rehearsal was started from Python.
inline constexpr const char* kByPython = "dihaptic.rehearse() of Python, as before";

/// The command for all people of the rehearsal in `folder`, composed from its rehearsal.yaml;
/// nullopt if rehearsal.yaml contains no command of this form.
std::optional<std::string> command_of(const std::string& folder,
                                      const session::Rehearsal& rehearsal);

}  // namespace dihaptic::cli
