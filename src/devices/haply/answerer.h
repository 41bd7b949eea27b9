// Finds the owner of the program that answers on a port of this machine. If a service is not
// running, any user can open its port; that user's program would then receive the service's
// messages, and its answers would be trusted.
#pragma once

#include <sys/types.h>

#include <optional>

namespace dihaptic::devices::haply {

/// The user who runs the program at the other end of a TCP connection within this machine, once
/// that program has accepted the connection. nullopt if the connection leaves the machine, or if
/// the kernel does not report the user.
std::optional<uid_t> user_at_other_end(int socket);

/// Whether a user may run a service on this machine, i.e. is root, a system user or the present
/// user.
bool may_serve(uid_t user);

}  // namespace dihaptic::devices::haply
