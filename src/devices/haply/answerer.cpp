#include "devices/haply/answerer.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cstring>
#include <fstream>
#include <sstream>
#include <string>

namespace dihaptic::devices::haply {
namespace {

constexpr const char* kMapped = "0000000000000000FFFF0000";  // precedes an IPv4 address in tcp6

/// One end of a connection in the format of /proc/net/tcp and tcp6: the words of the address as
/// they are in memory, and the port.
struct End {
    bool local = false;  // whether this end is on this machine
    bool v6 = false;
    std::string text;
};

std::optional<End> end_of(int socket, decltype(getsockname)* name) {
    sockaddr_storage storage{};
    socklen_t size = sizeof(storage);
    auto* const any = reinterpret_cast<sockaddr*>(&storage);
    if (name(socket, any, &size) != 0) return std::nullopt;
    End out;
    if (any->sa_family == AF_INET) {
        const auto& in = *reinterpret_cast<const sockaddr_in*>(any);
        out.local = (ntohl(in.sin_addr.s_addr) >> 24) == IN_LOOPBACKNET;
        out.text = fmt::format("{:08X}:{:04X}", in.sin_addr.s_addr, ntohs(in.sin_port));
        return out;
    }
    if (any->sa_family != AF_INET6) return std::nullopt;
    const auto& in = *reinterpret_cast<const sockaddr_in6*>(any);
    std::array<uint32_t, 4> words{};
    std::memcpy(words.data(), &in.sin6_addr, sizeof(words));
    out.v6 = true;
    out.local = IN6_IS_ADDR_LOOPBACK(&in.sin6_addr);
    for (const uint32_t word : words) out.text += fmt::format("{:08X}", word);
    out.text += fmt::format(":{:04X}", ntohs(in.sin6_port));
    return out;
}

/// The user who owns the socket with these ends.
std::optional<uid_t> user_of(const char* table, const std::string& from, const std::string& to) {
    std::ifstream in(table);
    std::string line;
    while (std::getline(in, line)) {
        std::istringstream words(line);
        std::string number, local, remote, state, queues, timer, retries;
        uid_t user = 0;
        if (words >> number >> local >> remote >> state >> queues >> timer >> retries >> user &&
            local == from && remote == to)
            return user;
    }
    return std::nullopt;
}

}  // namespace

std::optional<uid_t> user_at_other_end(int socket) {
    const auto mine = end_of(socket, getsockname);
    const auto other = end_of(socket, getpeername);
    if (!mine || !other || !other->local) return std::nullopt;
    if (!other->v6) {
        if (const auto user = user_of("/proc/net/tcp", other->text, mine->text)) return user;
        return user_of("/proc/net/tcp6", kMapped + other->text, kMapped + mine->text);
    }
    return user_of("/proc/net/tcp6", other->text, mine->text);
}

bool may_serve(uid_t user) {
    // first number of an ordinary user on Debian
    constexpr uid_t kFirstPerson = 1000;
    constexpr uid_t kFirstOfService = 61184, kLastOfService = 65519;  // systemd's DynamicUser
    return user == geteuid() || user < kFirstPerson ||
           (user >= kFirstOfService && user <= kLastOfService);
}

}  // namespace dihaptic::devices::haply
