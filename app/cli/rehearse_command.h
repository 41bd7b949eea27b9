// The command that does a rehearsal's people, which rehearsal.yaml keeps so that `dihaptic collect`
// can say what to type when somebody is missing. What stands in that file may be a stranger's, and
// what is to be typed is copied into a shell: only a command of this form is ever shown, made anew.
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
    std::string container;  ///< file of Apptainer's whose program does it; empty: this one

    /// What to type, from any folder, with the path of this very program, which may be in a
    /// container itself, or of `container`.
    std::string text() const;
};

/// What is typed into Python, in place of a command.
inline constexpr const char* kByPython = "dihaptic.rehearse() of Python, as before";

/// What does all people of the rehearsal in `folder`, made from its rehearsal.yaml; nullopt if that
/// has no command of this form.
std::optional<std::string> command_of(const std::string& folder,
                                      const session::Rehearsal& rehearsal);

}  // namespace dihaptic::cli
