// Checks that the folder of a rehearsed person is as the rehearsal made it. Tables of a population
// join hundreds of folders, which were copied between machines and opened in spreadsheets: a folder
// that was cut, exchanged or taken from elsewhere would change a mean without a trace.
#pragma once

#include <string>
#include <vector>

#include "recording/session.h"
#include "session/rehearsal.h"

namespace dihaptic::session {

struct Rehearsed {
    std::string identity;           ///< identity of the session; "" if it cannot be read
    bool sealed = false;            ///< its tables have seals (recording/seal.h)
    std::vector<Problem> problems;  ///< all faults; empty if the folder is intact
};

/// Checks the session in `folder`/`id`: whether it is complete and unchanged, and belongs to this
/// person and this rehearsal.
Rehearsed look_at(const std::string& folder, const std::string& id, const Rehearsal& rehearsal);

}  // namespace dihaptic::session
