// UNIX sockets connect programs on one machine. Programs that this one starts do not inherit them.
// peer.h tells who is at the other end.
#pragma once

#include <sys/socket.h>
#include <sys/un.h>

#include <optional>
#include <string>
#include <utility>

#include "base/descriptor.h"

namespace dihaptic {

/// Where a socket can be found.
class UnixAddress {
  public:
    /// An abstract address is not a file, and is free again as soon as its program has ended. A
    /// name that is too long is cut, in the same way by all programs.
    static UnixAddress of_name(const std::string& name) noexcept;
    /// nullopt if the path is too long for an address.
    static std::optional<UnixAddress> of_file(const std::string& path) noexcept;

    /// Return false, and set errno, if they fail.
    bool bind(const Descriptor& socket) const noexcept;
    bool connect(const Descriptor& socket) const noexcept;

  private:
    UnixAddress() = default;
    const sockaddr* at() const noexcept { return reinterpret_cast<const sockaddr*>(&address_); }

    sockaddr_un address_{AF_UNIX, {}};
    socklen_t size_ = sizeof(sockaddr_un);
};

/// A new socket, of a type such as SOCK_STREAM | SOCK_NONBLOCK. On failure the descriptor is not
/// open, and errno is set.
Descriptor unix_socket(int type) noexcept;
/// The same for two sockets that are connected with each other.
std::pair<Descriptor, Descriptor> unix_socket_pair(int type) noexcept;

}  // namespace dihaptic
