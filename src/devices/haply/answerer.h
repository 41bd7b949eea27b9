// Whose program answers at a port of this machine: any user may open one where a service is
// expected that does not run, and would be told positions, and believed.
#pragma once

#include <sys/types.h>

#include <optional>

namespace dihaptic::devices::haply {

/// The user of the program at the other end of a TCP connection that stays within this machine,
/// once that program has accepted it. nullopt: it does not stay there, or the kernel does not tell.
std::optional<uid_t> user_at_other_end(int socket);

/// Whether a service of the machine may be this user's: root's, a system user's, or our own.
bool may_serve(uid_t user);

}  // namespace dihaptic::devices::haply
