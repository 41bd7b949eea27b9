// Tests what children inherit, and that the program waits for them. A shell serves as the child.
#include "base/child.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/mman.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <string>
#include <utility>

#include "base/descriptor.h"
#include "base/number.h"

namespace dihaptic::child_test {
namespace {

constexpr int kNothing = Launch::kNothing;

Launch shell(const std::string& script) {
    return {"sh", {"-c", script}, {kNothing, kNothing, kNothing}};
}

/// Returns the shell's output. `files` are passed to the shell with numbers from 3 onwards.
std::string said(const std::string& script, const std::vector<int>& files = {}, short flags = 0) {
    const Descriptor out(memfd_create("said", MFD_CLOEXEC));
    Launch launch = shell(script);
    launch.files[1] = out.get();
    launch.files.insert(launch.files.end(), files.begin(), files.end());
    launch.flags = flags;
    Child child;
    EXPECT_EQ(child.start(launch), 0);
    EXPECT_EQ(child.wait(), 0);
    std::array<char, 200> text{};
    const ssize_t size = pread(out.get(), text.data(), text.size(), 0);
    return {text.data(), size > 0 ? static_cast<size_t>(size) : 0};
}

TEST(Child, EndsWithItsStatus) {
    Child child;
    EXPECT_TRUE(child.has_ended());
    EXPECT_EQ(child.wait(), std::nullopt);
    ASSERT_EQ(child.start(shell("exit 7")), 0);
    EXPECT_GT(child.process(), 0);
    EXPECT_EQ(child.wait(), 7 << 8);
    EXPECT_EQ(child.process(), 0);
    EXPECT_TRUE(child.has_ended());
    EXPECT_EQ(child.wait(), 7 << 8);
}

TEST(Child, ThatDoesNotExistIsNotStarted) {
    Child child;
    EXPECT_EQ(child.start({"dihaptic-gone", {}, {}}), ENOENT);
    EXPECT_EQ(child.process(), 0);
    EXPECT_EQ(child.wait(), std::nullopt);
}

TEST(Child, IsLookedAtWithoutWaitingAndDoesNotOutliveItsOwner) {
    pid_t process = 0;
    {
        Child child;
        ASSERT_EQ(child.start(shell("exec sleep 100")), 0);
        EXPECT_FALSE(child.has_ended());
        process = child.process();
        EXPECT_EQ(kill(process, 0), 0);
    }
    EXPECT_EQ(kill(process, 0), -1);  // the child has gone, without leaving even a zombie
    EXPECT_EQ(errno, ESRCH);
}

TEST(Child, GetsTheFilesThatAreNamedAndNoOther) {
    const Descriptor memory(memfd_create("ours", MFD_CLOEXEC));
    ASSERT_EQ(write(memory.get(), "hello", 5), 5);
    ASSERT_EQ(lseek(memory.get(), 0, SEEK_SET), 0);
    const Descriptor ours(fcntl(memory.get(), F_DUPFD, 20));  // exec() does not close it
    const std::string number = number_text(ours.get());
    EXPECT_EQ(
        said("cat <&4; readlink /proc/$$/fd/3; [ -e /proc/$$/fd/" + number + " ] || echo no more",
             {kNothing, ours.get()}),
        "hello/dev/null\nno more\n");
    EXPECT_EQ(said("[ -e /proc/$$/fd/3 ] || echo none"), "none\n");
}

TEST(Child, KeepsAFileWhoseNumberItShares) {
    const Descriptor out(memfd_create("kept", MFD_CLOEXEC));
    const Descriptor before(dup(STDERR_FILENO));
    ASSERT_EQ(dup2(out.get(), STDERR_FILENO), STDERR_FILENO);
    Launch launch = shell("echo kept >&2");
    launch.files[2] = Launch::kKept;
    Child child;
    const int failed = child.start(launch);
    ASSERT_EQ(dup2(before.get(), STDERR_FILENO), STDERR_FILENO);
    ASSERT_EQ(failed, 0);
    EXPECT_EQ(child.wait(), 0);
    std::array<char, 10> text{};
    EXPECT_EQ(pread(out.get(), text.data(), text.size(), 0), 5);
}

/// Whether a child of this process that was started with these flags blocks, or ignores, any of the
/// first 16 signals. The child is not a shell, because a shell would change the signals itself.
std::pair<bool, bool> blocks_or_ignores(short flags) {
    const Descriptor out(memfd_create("status", MFD_CLOEXEC));
    Launch launch{"cat", {"/proc/self/status"}, {kNothing, out.get(), kNothing}};
    launch.flags = flags;
    Child child;
    EXPECT_EQ(child.start(launch), 0);
    EXPECT_EQ(child.wait(), 0);
    std::string text(8192, ' ');
    EXPECT_GT(pread(out.get(), text.data(), text.size(), 0), 0);
    const auto any = [&](const std::string& name) {
        const size_t at = text.find(name + ":\t");
        EXPECT_NE(at, std::string::npos) << text;
        return text.substr(at + name.size() + 2 + 12, 4) != "0000";
    };
    return {any("SigBlk"), any("SigIgn")};
}

TEST(Child, IgnoresAndBlocksSignalsOnlyAsWished) {
    sigset_t some;
    sigset_t before;
    sigemptyset(&some);
    sigaddset(&some, SIGUSR1);
    pthread_sigmask(SIG_BLOCK, &some, &before);
    const auto handled = signal(SIGUSR2, SIG_IGN);
    EXPECT_EQ(blocks_or_ignores(Launch::kFreshSignals), std::pair(false, false));
    EXPECT_EQ(blocks_or_ignores(0), std::pair(true, true));
    signal(SIGUSR2, handled);
    pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

}  // namespace
}  // namespace dihaptic::child_test
