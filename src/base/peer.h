// Asks the kernel which process is at the other end of a UNIX socket. The name or path of a socket
// proves nothing, because other users can create sockets with that name.
#pragma once

#include <sys/types.h>

#include <optional>
#include <string>

namespace dihaptic {

struct Peer {
    pid_t pid = 0;
    uid_t uid = 0;

    /// Whether the process belongs to this user or to root, who has access to everything anyway.
    bool is_trusted() const;
    /// A description such as "dihaptic-host (process 1234 of user jane, since 2026-01-31 09:30)",
    /// with as much detail as is known.
    std::string describe() const;
};

/// The process at the other end of the socket; nullopt if there is none.
std::optional<Peer> peer_of(int socket);

}  // namespace dihaptic
