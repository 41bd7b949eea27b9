// The function behind `dihaptic resume`, for use by other commands.
#pragma once

#include <string>

namespace dihaptic::cli {

/// Continues an interrupted session. `out`: folder for the new session; if empty, the new session
/// is placed next to the old one. `sync`: interval at which the recording is synchronised to the
/// disk [s]; 0 to synchronise only at the session's end.
void resume_session(const std::string& folder, const std::string& out, double sync);

}  // namespace dihaptic::cli
