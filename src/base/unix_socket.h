// UNIX sockets connect programs on the same machine. Programs that this program starts do not
// inherit its sockets. peer.h tells which program is at the other end.
#pragma once

#include <sys/socket.h>
#include <sys/un.h>

#include <optional>
#include <string>
#include <utility>

#include "base/descriptor.h"

namespace dihaptic {

/// The address of a socket.
class UnixAddress {
  public:
    /// An abstract address, which is not a file and becomes free as soon as its program has ended.
    /// Names that are too long are truncated, in the same way by all programs.
    static UnixAddress of_name(const std::string& name) noexcept;
    /// The address of a socket file; nullopt if the path is too long for an address.
    static std::optional<UnixAddress> of_file(const std::string& path) noexcept;

    /// These functions return false and set errno if they fail.
    bool bind(const Descriptor& socket) const noexcept;
    bool connect(const Descriptor& socket) const noexcept;

  private:
    UnixAddress() = default;
    const sockaddr* at() const noexcept { return reinterpret_cast<const sockaddr*>(&address_); }

    sockaddr_un address_{AF_UNIX, {}};
    socklen_t size_ = sizeof(sockaddr_un);
};

/// A new socket of the given type, e.g. SOCK_STREAM | SOCK_NONBLOCK. On failure the descriptor is
/// not open, and errno is set.
Descriptor unix_socket(int type) noexcept;
/// Like unix_socket(), for two sockets that are connected to each other.
std::pair<Descriptor, Descriptor> unix_socket_pair(int type) noexcept;

}  // namespace dihaptic
