// Checks that the folder of a simulated person is as the rehearsal wrote it. The tables of a
// population combine hundreds of folders, which may have been copied between machines and opened in
// spreadsheet programs. If a folder were truncated, exchanged or taken from elsewhere, a mean would
// change without anyone noticing.
#pragma once

#include <string>
#include <vector>

#include "recording/session.h"
#include "session/rehearsal.h"

namespace dihaptic::session {

struct Rehearsed {
    std::string identity;           ///< identity of the session; "" if unreadable
    bool sealed = false;            ///< whether its tables have seals (recording/seal.h)
    std::vector<Problem> problems;  ///< all faults; empty if the folder is intact
};

/// Checks the session in `folder`/`id`: whether it is complete and unchanged, and whether it
/// belongs to this person and this rehearsal.
Rehearsed look_at(const std::string& folder, const std::string& id, const Rehearsal& rehearsal);

}  // namespace dihaptic::session
