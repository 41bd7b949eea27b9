// Tests the reported process at the other end of a socket.
#include "base/peer.h"
#include "base/number.h"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>

namespace dihaptic::peer_test {
namespace {

TEST(Peers, AreWhoMadeTheSocket) {
    std::array<int, 2> ends{};
    ASSERT_EQ(socketpair(AF_UNIX, SOCK_SEQPACKET, 0, ends.data()), 0);
    const auto peer = peer_of(ends[0]);
    ASSERT_TRUE(peer);
    EXPECT_EQ(peer->pid, getpid());
    EXPECT_TRUE(peer->is_trusted());
    EXPECT_NE(peer->describe().find("process " + number_text(getpid()) + " of user "),
              std::string::npos)
        << peer->describe();
    EXPECT_NE(peer->describe().find(", since 20"), std::string::npos) << peer->describe();
    for (const int end : ends) close(end);
}

TEST(Peers, OfOtherUsersAreNotTrusted) {
    EXPECT_FALSE((Peer{1, geteuid() + 1}).is_trusted());
    EXPECT_TRUE((Peer{1, 0}).is_trusted());
}

TEST(Peers, ThatAreGoneAreToldAsFarAsTheyAreKnown) {
    EXPECT_EQ((Peer{-1, 4'000'000}).describe(), "a program (process -1 of user 4000000)");
    EXPECT_FALSE(peer_of(-1));
}

}  // namespace
}  // namespace dihaptic::peer_test
