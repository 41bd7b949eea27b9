// Whether the folder of a rehearsed person has what the rehearsal made. Tables of a population join
// hundreds of folders, which were copied between machines and opened in spreadsheets: one that was
// cut, exchanged or taken from elsewhere would change a mean without a trace.
#pragma once

#include <string>
#include <vector>

#include "recording/session.h"
#include "session/rehearsal.h"

namespace dihaptic::session {

struct Rehearsed {
    std::string identity;           ///< of the session; "" if it cannot be read
    bool sealed = false;            ///< its tables have seals (recording/seal.h)
    std::vector<Problem> problems;  ///< all that is wrong; empty if the folder is whole
};

/// Looks at the session in `folder`/`id`: whether it is complete, unchanged, that person's, and of
/// that rehearsal.
Rehearsed look_at(const std::string& folder, const std::string& id, const Rehearsal& rehearsal);

}  // namespace dihaptic::session
