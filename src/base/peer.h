// Asks the kernel for the process at the other end of a UNIX socket. Names and paths of sockets
// prove nothing, because other users can create them.
#pragma once

#include <sys/types.h>

#include <optional>
#include <string>

namespace dihaptic {

struct Peer {
    pid_t pid = 0;
    uid_t uid = 0;

    /// Whether the process belongs to this user, or to root, who can do everything anyway.
    bool is_trusted() const;
    /// "dihaptic-host (process 1234 of user jane, since 2026-01-31 09:30)", as far as
    /// it is known.
    std::string describe() const;
};

/// nullopt if there is none.
std::optional<Peer> peer_of(int socket);

}  // namespace dihaptic
