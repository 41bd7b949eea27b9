// Tests that sockets connect at their addresses, and that no other program inherits them.
#include "base/unix_socket.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cerrno>

#include "base/number.h"
#include "base/temporary_folder.h"

namespace dihaptic::unix_socket_test {
namespace {

/// Expects that a socket can connect to one that listens at this address, and can receive data from
/// it.
void expect_meeting(const UnixAddress& address) {
    const Descriptor early = unix_socket(SOCK_STREAM);
    EXPECT_FALSE(address.connect(early));

    const Descriptor listening = unix_socket(SOCK_STREAM);
    ASSERT_TRUE(address.bind(listening));
    ASSERT_EQ(listen(listening.get(), 1), 0);
    const Descriptor asking = unix_socket(SOCK_STREAM);
    ASSERT_TRUE(address.connect(asking));
    const Descriptor answering(accept(listening.get(), nullptr, nullptr));
    ASSERT_EQ(write(answering.get(), "x", 1), 1);
    char letter = 0;
    EXPECT_EQ(read(asking.get(), &letter, 1), 1);
    EXPECT_EQ(letter, 'x');

    const Descriptor late = unix_socket(SOCK_STREAM);
    EXPECT_FALSE(address.bind(late));
    EXPECT_EQ(errno, EADDRINUSE);
}

std::string name() {
    return "dihaptic/test/" + number_text(getpid());
}

TEST(UnixSocket, IsFoundByItsNameWhileItIsThere) {
    expect_meeting(UnixAddress::of_name(name()));
    expect_meeting(UnixAddress::of_name(name()));  // no old file blocks the second socket
}

TEST(UnixSocket, HasANameThatIsCutTheSameWayEverywhere) {
    const std::string most(107, 'n');
    const Descriptor first = unix_socket(SOCK_STREAM);
    const std::string cut = (name() + most).substr(0, most.size());
    ASSERT_TRUE(UnixAddress::of_name(name() + most).bind(first));
    const Descriptor second = unix_socket(SOCK_STREAM);
    EXPECT_FALSE(UnixAddress::of_name(cut).bind(second));
    EXPECT_EQ(errno, EADDRINUSE);
    EXPECT_TRUE(UnixAddress::of_name(cut.substr(1)).bind(second));
}

TEST(UnixSocket, IsFoundByItsFile) {
    const TemporaryFolder folder;
    const auto address = UnixAddress::of_file(folder.file("socket"));
    ASSERT_TRUE(address);
    expect_meeting(*address);
}

TEST(UnixSocket, HasNoFileWithTooLongAPath) {
    EXPECT_TRUE(UnixAddress::of_file(std::string(107, 'p')));
    EXPECT_FALSE(UnixAddress::of_file(std::string(108, 'p')));
}

TEST(UnixSocket, InPairsKeepsMessagesWholeAndIsNotInherited) {
    const auto [one, other] = unix_socket_pair(SOCK_SEQPACKET);
    ASSERT_EQ(write(one.get(), "first", 5), 5);
    ASSERT_EQ(write(one.get(), "second", 6), 6);
    std::array<char, 20> text{};
    EXPECT_EQ(read(other.get(), text.data(), text.size()), 5);
    EXPECT_EQ(read(other.get(), text.data(), text.size()), 6);
    const Descriptor single = unix_socket(SOCK_STREAM | SOCK_NONBLOCK);
    for (const Descriptor* socket : {&one, &other, &single})
        EXPECT_EQ(fcntl(socket->get(), F_GETFD), FD_CLOEXEC);
    EXPECT_NE(fcntl(single.get(), F_GETFL) & O_NONBLOCK, 0);
}

TEST(UnixSocket, OfATypeThatDoesNotExistIsNotOpen) {
    EXPECT_FALSE(unix_socket(77));
    EXPECT_NE(errno, 0);
    const auto [one, other] = unix_socket_pair(77);
    EXPECT_FALSE(one);
    EXPECT_FALSE(other);
}

}  // namespace
}  // namespace dihaptic::unix_socket_test
