// Who is at the other end of a UNIX socket, as the kernel says: names and paths of sockets can be
// taken by other users, who then would be believed.
#pragma once

#include <sys/types.h>

#include <optional>
#include <string>

namespace dihaptic {

struct Peer {
    pid_t pid = 0;
    uid_t uid = 0;

    /// Whether it is this user's, or root's, who could do everything anyway.
    bool is_trusted() const;
    /// "dihaptic-keeper (process 1234 of user jane, since 2026-01-31 09:30)", as far as the machine
    /// tells.
    std::string describe() const;
};

/// nullopt: there is none.
std::optional<Peer> peer_of(int socket);

}  // namespace dihaptic
