// Tests that a descriptor closes the file that it owns, exactly once, and closes nothing else.
#include "base/descriptor.h"

#include <fcntl.h>
#include <gtest/gtest.h>

#include <cerrno>

namespace dihaptic::descriptor_test {
namespace {

int opened() {
    return ::open("/dev/null", O_RDONLY | O_CLOEXEC);
}

bool is_open(int number) {
    return ::fcntl(number, F_GETFD) >= 0;
}

TEST(Descriptor, ClosesWhatItOwns) {
    int number = -1;
    {
        const Descriptor file(opened());
        number = file.get();
        EXPECT_TRUE(file);
        EXPECT_TRUE(is_open(number));
    }
    EXPECT_FALSE(is_open(number));
    EXPECT_FALSE(Descriptor());
    EXPECT_FALSE(Descriptor(-1));
}

TEST(Descriptor, HandsOver) {
    Descriptor first(opened());
    const int number = first.get();
    Descriptor second(std::move(first));
    EXPECT_EQ(second.get(), number);
    EXPECT_FALSE(first);  // NOLINT(bugprone-use-after-move): this is the test

    Descriptor third(opened());
    const int another = third.get();
    second = std::move(third);
    EXPECT_FALSE(is_open(number));
    EXPECT_EQ(second.get(), another);
    EXPECT_TRUE(is_open(another));
    EXPECT_FALSE(third);  // NOLINT(bugprone-use-after-move)
}

TEST(Descriptor, ClosesOnceAndLeavesErrnoAlone) {
    Descriptor file(opened());
    const int number = file.get();
    file.close();
    EXPECT_FALSE(file);
    const Descriptor next(opened());
    EXPECT_EQ(next.get(), number);  // the kernel assigns the lowest free number
    file.close();
    EXPECT_TRUE(is_open(number));

    {
        const Descriptor wrong(opened());
        ASSERT_EQ(::close(wrong.get()), 0);
        errno = ENOSPC;
    }  // closing the descriptor fails with EBADF
    EXPECT_EQ(errno, ENOSPC);
}

}  // namespace
}  // namespace dihaptic::descriptor_test
