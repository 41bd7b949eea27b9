#include "devices/device_claim.h"

#include <fmt/format.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <thread>
#include <utility>

#include "base/peer.h"

namespace dihaptic::devices {
namespace {

constexpr Time kPatience = std::chrono::seconds(2);
constexpr Time kLook = std::chrono::milliseconds(20);

/// An abstract address; a name that is too long is cut, in the same way by all programs.
struct Address {
    sockaddr_un address{};
    socklen_t size = 0;

    explicit Address(const std::string& name) {
        address.sun_family = AF_UNIX;
        const size_t length = std::min(name.size(), sizeof(address.sun_path) - 1);
        std::memcpy(address.sun_path + 1, name.data(), length);
        size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + length);
    }
    const sockaddr* get() const { return reinterpret_cast<const sockaddr*>(&address); }
};

int new_socket() {
    return socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
}

/// The owner of the claim, in words.
std::string owner_of(const Address& address) {
    const int asking = new_socket();
    if (asking < 0) return "another program";
    const bool connected = connect(asking, address.get(), address.size) == 0;
    const auto owner = connected ? peer_of(asking) : std::nullopt;
    close(asking);
    return owner ? owner->describe() : "another program";
}

}  // namespace

DeviceClaim::DeviceClaim(const std::string& backend, const frame::DeviceInfo& info,
                         const Place& place, Time patience)
    : socket_(new_socket()) {
    const std::string& which = info.serial.empty() ? info.model : info.serial;
    const Address address(fmt::format("dihaptic/device/{}/{}", backend, which));
    const auto end = std::chrono::steady_clock::now() + patience;
    int failed = socket_ < 0 ? errno : 0;
    while (failed == 0 && bind(socket_, address.get(), address.size) != 0) {
        if (errno != EADDRINUSE || std::chrono::steady_clock::now() > end) failed = errno;
        if (failed == 0) std::this_thread::sleep_for(kLook);
    }
    if (failed == 0 && listen(socket_, 8) == 0) return;
    if (socket_ >= 0) close(socket_);
    if (failed == EADDRINUSE) {
        throw Error(
            place, "serial", fmt::format("{} is in use by {}", info.model, owner_of(address)),
            "Wait until that program has ended, or end it: two programs must not move one device.");
    }
    throw Error(place, "serial",
                fmt::format("{} cannot be claimed: {}", info.model, std::strerror(failed)),
                "Close other programs, and start again.");
}

DeviceClaim::~DeviceClaim() {
    if (socket_ >= 0) close(socket_);
}

DeviceClaim::DeviceClaim(DeviceClaim&& other) noexcept
    : socket_(std::exchange(other.socket_, -1)) {}

std::vector<DeviceClaim> claim_devices(const std::string& backend, const DeviceGroup& devices,
                                       const std::vector<Place>& places) {
    std::vector<DeviceClaim> out;
    for (size_t i = 0; i < places.size(); ++i) {
        const frame::DeviceInfo& info = devices.descriptions()[i];
        if (!info.simulated) out.emplace_back(backend, info, places[i], kPatience);
    }
    return out;
}

}  // namespace dihaptic::devices
