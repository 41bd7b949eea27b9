// Finds the owner of the program that answers at a port of this machine. If a service is not
// running, any user may open its port; that user would receive positions, and would be trusted.
#pragma once

#include <sys/types.h>

#include <optional>

namespace dihaptic::devices::haply {

/// The user of the program at the other end of a TCP connection within this machine,
/// once that program has accepted it. nullopt if the connection leaves the machine, or the kernel
/// does not report it.
std::optional<uid_t> user_at_other_end(int socket);

/// Whether a user may run a service of the machine: root, a system user, or the present user.
bool may_serve(uid_t user);

}  // namespace dihaptic::devices::haply
