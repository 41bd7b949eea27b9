#include "base/unix_socket.h"

#include <algorithm>
#include <cstddef>

namespace dihaptic {

UnixAddress UnixAddress::of_name(const std::string& name) noexcept {
    UnixAddress out;
    const size_t length = std::min(name.size(), sizeof(out.address_.sun_path) - 1);
    std::copy_n(name.begin(), length, out.address_.sun_path + 1);  // zero byte: abstract address
    out.size_ = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + length);
    return out;
}

std::optional<UnixAddress> UnixAddress::of_file(const std::string& path) noexcept {
    UnixAddress out;
    if (path.size() >= sizeof(out.address_.sun_path)) return std::nullopt;
    std::copy(path.begin(), path.end(), out.address_.sun_path);
    return out;
}

bool UnixAddress::bind(const Descriptor& socket) const noexcept {
    return ::bind(socket.get(), at(), size_) == 0;
}

bool UnixAddress::connect(const Descriptor& socket) const noexcept {
    return ::connect(socket.get(), at(), size_) == 0;
}

Descriptor unix_socket(int type) noexcept {
    return Descriptor(::socket(AF_UNIX, type | SOCK_CLOEXEC, 0));
}

std::pair<Descriptor, Descriptor> unix_socket_pair(int type) noexcept {
    int ends[2] = {-1, -1};  // these values stay unchanged if the call fails
    ::socketpair(AF_UNIX, type | SOCK_CLOEXEC, 0, ends);
    return {Descriptor(ends[0]), Descriptor(ends[1])};
}

}  // namespace dihaptic
