// Tests that a device has only one owner at a time.
#include "devices/device_claim.h"
#include "base/number.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>

namespace dihaptic::devices::device_claim_test {
namespace {

/// A device that no other test uses.
frame::DeviceInfo device(const std::string& serial = number_text(getpid())) {
    frame::DeviceInfo info;
    info.model = "Made up";
    info.serial = serial;
    return info;
}

std::string refusal(const frame::DeviceInfo& info) {
    try {
        const DeviceClaim claim("test", info, {"rig.yaml", 3}, Time(0));
        return "";
    } catch (const Error& e) {
        return e.what();
    }
}

TEST(DeviceClaim, IsHeldByOneUntilItIsGivenBack) {
    {
        DeviceClaim first("test", device(), {}, Time(0));
        const DeviceClaim moved(std::move(first));
        const std::string told = refusal(device());
        EXPECT_NE(told.find("rig.yaml:3: error: serial: Made up is in use by "), std::string::npos)
            << told;
        EXPECT_NE(told.find("(process " + number_text(getpid()) + " of user "), std::string::npos)
            << told;
        EXPECT_EQ(refusal(device("another")), "");
        frame::DeviceInfo nameless = device("");
        EXPECT_EQ(refusal(nameless), "");
    }
    EXPECT_EQ(refusal(device()), "");
}

TEST(DeviceClaim, EndsWithItsProgramHoweverThatEnds) {
    int ready[2];
    ASSERT_EQ(pipe(ready), 0);
    const frame::DeviceInfo info = device();
    const pid_t child = fork();
    if (child == 0) {
        const DeviceClaim claim("test", info, {}, Time(0));
        if (write(ready[1], "x", 1) == 1) pause();
        _exit(0);
    }
    char byte = 0;
    ASSERT_EQ(read(ready[0], &byte, 1), 1);
    EXPECT_NE(refusal(info).find("(process " + number_text(child) + " of user "),
              std::string::npos);
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    EXPECT_EQ(refusal(info), "");
    close(ready[0]);
    close(ready[1]);
}

TEST(DeviceClaim, ThatIsGivenBackSoonIsWaitedFor) {
    std::optional<DeviceClaim> first;
    first.emplace("test", device(), Place{}, Time(0));
    std::thread ends([&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
        first.reset();
    });
    EXPECT_NO_THROW(DeviceClaim("test", device(), {}, std::chrono::seconds(20)));
    ends.join();
}

TEST(DeviceClaim, HoldsForOtherUsersToo) {
    if (geteuid() != 0) GTEST_SKIP() << "only root can become another user";
    const DeviceClaim mine("test", device(), {}, Time(0));
    const frame::DeviceInfo info = device();
    const pid_t child = fork();
    if (child == 0) {
        constexpr uid_t kNobody = 65534;
        if (setuid(kNobody) != 0) _exit(2);
        const std::string told = refusal(info);
        _exit(told.find("of user root") == std::string::npos ? 1 : 0);
    }
    int status = 0;
    waitpid(child, &status, 0);
    EXPECT_EQ(WEXITSTATUS(status), 0);
}

}  // namespace
}  // namespace dihaptic::devices::device_claim_test
