// Tests which owner is reported for a program that answers on a port of this machine.
#include "devices/haply/answerer.h"

#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>

namespace dihaptic::devices::haply::answerer_test {
namespace {

/// Listens on a port of this machine, either over IPv4 or with an IPv6 socket that accepts both
/// protocols.
int listening(bool v6) {
    const int out = socket(v6 ? AF_INET6 : AF_INET, SOCK_STREAM, 0);
    sockaddr_in6 wide{};
    wide.sin6_family = AF_INET6;
    sockaddr_in narrow{};
    narrow.sin_family = AF_INET;
    narrow.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    const auto* const at =
        v6 ? reinterpret_cast<const sockaddr*>(&wide) : reinterpret_cast<const sockaddr*>(&narrow);
    if (bind(out, at, v6 ? sizeof(wide) : sizeof(narrow)) != 0 || listen(out, 1) != 0) {
        close(out);
        return -1;
    }
    return out;
}

/// Connects to the listening program over IPv4.
int connected_to(int listener, bool v6) {
    sockaddr_in6 wide{};
    sockaddr_in at{};
    socklen_t size = v6 ? sizeof(wide) : sizeof(at);
    auto* const name = v6 ? reinterpret_cast<sockaddr*>(&wide) : reinterpret_cast<sockaddr*>(&at);
    EXPECT_EQ(getsockname(listener, name, &size), 0);
    if (v6) at.sin_port = wide.sin6_port;
    at.sin_family = AF_INET;
    at.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    const int out = socket(AF_INET, SOCK_STREAM, 0);
    EXPECT_EQ(connect(out, reinterpret_cast<const sockaddr*>(&at), sizeof(at)), 0);
    return out;
}

TEST(Answerer, IsFoundWhetherItListensByOneProtocolOrBoth) {
    for (const bool v6 : {false, true}) {
        const int listener = listening(v6);
        if (listener < 0) continue;  // without IPv6
        const int mine = connected_to(listener, v6);
        const int other = accept(listener, nullptr, nullptr);
        EXPECT_EQ(user_at_other_end(mine), geteuid()) << v6;
        for (const int socket : {listener, mine, other}) close(socket);
    }
    EXPECT_FALSE(user_at_other_end(-1));
}

TEST(Answerer, OfAnotherUserIsFound) {
    if (geteuid() != 0) GTEST_SKIP() << "only root can become another user";
    constexpr uid_t kNobody = 65534;
    const int listener = listening(false);
    ASSERT_GE(listener, 0);
    int ready[2];
    ASSERT_EQ(pipe(ready), 0);
    const pid_t child = fork();
    if (child == 0) {
        // a socket belongs to the user who created it, so this user creates its own
        if (setuid(kNobody) != 0) _exit(1);
        const int own = listening(false);
        if (write(ready[1], &own, sizeof(own)) < 0) _exit(1);
        sockaddr_in at{};
        socklen_t size = sizeof(at);
        getsockname(own, reinterpret_cast<sockaddr*>(&at), &size);
        if (write(ready[1], &at, sizeof(at)) < 0) _exit(1);
        accept(own, nullptr, nullptr);
        pause();
    }
    int number = 0;
    sockaddr_in at{};
    ASSERT_EQ(read(ready[0], &number, sizeof(number)), static_cast<ssize_t>(sizeof(number)));
    ASSERT_EQ(read(ready[0], &at, sizeof(at)), static_cast<ssize_t>(sizeof(at)));
    const int mine = socket(AF_INET, SOCK_STREAM, 0);
    EXPECT_EQ(connect(mine, reinterpret_cast<const sockaddr*>(&at), sizeof(at)), 0);
    std::optional<uid_t> user;
    for (int i = 0; i < 500 && user != kNobody; ++i) {  // until the program accepts
        usleep(10'000);
        user = user_at_other_end(mine);
    }
    EXPECT_EQ(user, kNobody);
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    for (const int socket : {listener, mine, ready[0], ready[1]}) close(socket);
}

TEST(Answerer, MayBeTheMachinesOrOurOwn) {
    EXPECT_TRUE(may_serve(0));
    EXPECT_TRUE(may_serve(geteuid()));
    EXPECT_TRUE(may_serve(101));
    EXPECT_TRUE(may_serve(62000));
    EXPECT_FALSE(may_serve(geteuid() == 1234 ? 1235 : 1234));
    EXPECT_FALSE(may_serve(65534));
}

}  // namespace
}  // namespace dihaptic::devices::haply::answerer_test
