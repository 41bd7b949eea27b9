// Tests which process is reported to be at the other end of a socket.
#include "base/peer.h"
#include "base/number.h"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include "base/unix_socket.h"

namespace dihaptic::peer_test {
namespace {

TEST(Peers, AreWhoMadeTheSocket) {
    const auto [one, other] = unix_socket_pair(SOCK_SEQPACKET);
    const auto peer = peer_of(one.get());
    ASSERT_TRUE(peer);
    EXPECT_EQ(peer->pid, getpid());
    EXPECT_TRUE(peer->is_trusted());
    EXPECT_NE(peer->describe().find("process " + number_text(getpid()) + " of user "),
              std::string::npos)
        << peer->describe();
    EXPECT_NE(peer->describe().find(", since 20"), std::string::npos) << peer->describe();
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
