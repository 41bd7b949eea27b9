#include "devices/device_claim.h"

#include <fmt/format.h>
#include <sys/socket.h>

#include <cerrno>
#include <cstring>
#include <thread>

#include "base/peer.h"
#include "base/unix_socket.h"

namespace dihaptic::devices {
namespace {

constexpr Time kPatience = std::chrono::seconds(2);
constexpr Time kLook = std::chrono::milliseconds(20);

Descriptor new_socket() {
    return unix_socket(SOCK_STREAM | SOCK_NONBLOCK);
}

/// Describes the owner of a claim in words.
std::string owner_of(const UnixAddress& address) {
    const Descriptor asking = new_socket();
    const auto owner = address.connect(asking) ? peer_of(asking.get()) : std::nullopt;
    return owner ? owner->describe() : "another program";
}

}  // namespace

DeviceClaim::DeviceClaim(const std::string& backend, const frame::DeviceInfo& info,
                         const Place& place, Time patience)
    : socket_(new_socket()) {
    const std::string& which = info.serial.empty() ? info.model : info.serial;
    const auto address = UnixAddress::of_name(fmt::format("dihaptic/device/{}/{}", backend, which));
    const auto end = std::chrono::steady_clock::now() + patience;
    int failed = socket_ ? 0 : errno;
    while (failed == 0 && !address.bind(socket_)) {
        if (errno != EADDRINUSE || std::chrono::steady_clock::now() > end) failed = errno;
        if (failed == 0) std::this_thread::sleep_for(kLook);
    }
    if (failed == 0 && listen(socket_.get(), 8) == 0) return;
    if (failed == EADDRINUSE) {
        throw Error(
            place, "serial", fmt::format("{} is in use by {}", info.model, owner_of(address)),
            "Wait until that program has ended, or end it: two programs must not move one device.");
    }
    throw Error(place, "serial",
                fmt::format("{} cannot be claimed: {}", info.model, std::strerror(failed)),
                "Close other programs, and start again.");
}

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
