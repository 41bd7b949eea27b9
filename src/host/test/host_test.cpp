// Tests the device host from the program's side. The device host loads fakes of the manufacturers'
// libraries into its own process. test/force_test.py tests the whole program.
#include <gtest/gtest.h>

#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <thread>

#include "base/geometry.h"
#include "base/number.h"
#include "devices/test/felt_outside.h"
#include "fake_makers.h"
#include "host/force_off.h"
#include "host/hosted_devices.h"
#include "host/messages.h"
#include "testing/allocation_guard.h"
#include "testing/files.h"

namespace dihaptic::host::host_test {
namespace {

using std::chrono::milliseconds;

Order order_on(const std::string& backend) {
    const bool hd = backend == "openhaptics";
    Order order;
    order.backend = backend;
    order.hosting.program = program();
    for (const int i : {1, 2}) {
        const std::string which =
            hd ? "name: PHANToM " + number_text(i) : "serial: " + number_text(100 + i);
        devices::DeviceConfig config;
        config.finger = i == 1 ? "thumb" : "index";
        config.options = parse_yaml(
            std::string("library: ") + (hd ? DIHAPTIC_FAKE_HD : DIHAPTIC_FAKE_DHD) + "\n" + which,
            "rig.yaml");
        config.place = {"rig.yaml", 10 + i};
        order.configs.push_back(config);
    }
    return order;
}

/// What the devices in the fake libraries are doing.
class Felt {
  public:
    Felt() : file_(folder_.write("felt", std::string(sizeof(devices::Felt) * 8, '\0'))) {
        setenv("DIHAPTIC_FAKE_FELT", file_.c_str(), 1);
    }
    ~Felt() { unsetenv("DIHAPTIC_FAKE_FELT"); }
    devices::Felt operator[](size_t device) const {
        devices::Felt out;
        std::ifstream in(file_, std::ios::binary);
        in.seekg(static_cast<std::streamoff>(device * sizeof(out)));
        in.read(reinterpret_cast<char*>(&out), sizeof(out));
        return out;
    }
    /// Waits until no device exerts a force. Returns the time from `since` until then [s], or NaN
    /// if that takes more than 2 s.
    double gone_after(int64_t since) const {
        const int64_t begin = monotonic();
        while ((*this)[0].force != 0 || (*this)[1].force != 0) {
            if (monotonic() - begin > 2'000'000'000L) return std::nan("");
        }
        return std::max((*this)[0].gone_at, (*this)[1].gone_at) - static_cast<double>(since) * 1e-9;
    }

  private:
    testing::TemporaryFolder folder_;
    std::string file_;
};

const std::vector<Wrench> kPush(2, Wrench{{0, 0, 2}, Vec3::Zero()});

TEST(Messages, KeepWhatTheySay) {
    Order order;
    order.backend = "forcedimension";
    order.tick = 1.0 / 3000;
    order.hosting = {"p", 0.0123456789, 55};
    devices::DeviceConfig config;
    config.finger = "thumb";
    config.X_WD = {rotation_xyz({0.1, 0.2, 0.3}), {1, 2, 1.0 / 3}};
    config.options = parse_yaml("a: 1\nb: [x, {c: }]\n", "rig.yaml");
    config.place = {"rig.yaml", 7};
    config.scale = 2.5;
    order.configs = {config};
    const Order same = order_of(nlohmann::json::parse(to_json(order).dump()));
    ASSERT_EQ(same.configs.size(), 1u);
    EXPECT_EQ(same.tick, order.tick);
    EXPECT_EQ(same.hosting.longest_silence, order.hosting.longest_silence);
    EXPECT_EQ(same.configs[0].X_WD.p, config.X_WD.p);
    EXPECT_EQ(same.configs[0].X_WD.R.coeffs(), config.X_WD.R.coeffs());
    EXPECT_EQ(to_yaml(same.configs[0].options), to_yaml(config.options));
    EXPECT_EQ(same.configs[0].options.find("b")->items[1].place.line, 2);
    EXPECT_EQ(same.configs[0].place.line, 7);
    EXPECT_EQ(same.configs[0].scale, 2.5);
    const Error error({"rig.yaml", 3}, "serial", "is \"odd\"", "Mend it.");
    EXPECT_STREQ(error_of(nlohmann::json::parse(to_json(error).dump())).what(), error.what());
}

class Kept : public ::testing::TestWithParam<const char*> {
  protected:
    Felt felt;
    Order order = order_on(GetParam());
    bool hd = std::string(GetParam()) == "openhaptics";

    /// Calls `tick` until it returns false, at the devices' own pace or, if they do not pace, at 1
    /// kHz.
    static void run(devices::DeviceGroup& devices, const std::function<bool()>& tick) {
        if (devices.paces()) return devices.pace(tick);
        while (tick()) std::this_thread::sleep_for(milliseconds(1));
    }
};
INSTANTIATE_TEST_SUITE_P(Backends, Kept, ::testing::Values("openhaptics", "forcedimension"),
                         [](const auto& instance) { return std::string(instance.param); });

TEST_P(Kept, DevicesAreThoseOfTheBackend) {
    const auto mine = devices::find_backend(GetParam())->make(order.configs, {});
    const auto kept = host_devices(order);
    EXPECT_EQ(kept->size(), 2);
    EXPECT_EQ(kept->paces(), mine->paces());
    EXPECT_EQ(kept->descriptions(), mine->descriptions());
}

TEST_P(Kept, DevicesThatAreNotThereAreToldOfWithTheirPlace) {
    order.configs[1].options =
        parse_yaml(std::string("library: ") + (hd ? DIHAPTIC_FAKE_HD : DIHAPTIC_FAKE_DHD) +
                       (hd ? "\nname: nobody" : "\nserial: 999"),
                   "rig.yaml");
    try {
        host_devices(order);
        FAIL();
    } catch (const Error& e) {
        EXPECT_EQ(e.problems().front().place.line, 12) << e.what();
        EXPECT_FALSE(e.problems().front().remedy.empty());
    }
}

TEST_P(Kept, DevicesGiveTheForceOfEachTickWithoutAllocating) {
    const auto kept = host_devices(order);
    for (int life = 0; life < 2; ++life) {
        kept->activate();
        std::vector<devices::Reading> readings(2);
        int ticks = 0;
        bool well = true;
        std::optional<testing::AllocationGuard> guard;
        run(*kept, [&] {
            if (ticks == 10) guard.emplace();
            kept->read(Time(ticks), readings);
            for (const devices::Reading& reading : readings) well = well && reading.status == 0;
            kept->write(kPush);
            if (++ticks < 200) return true;
            if (testing::AllocationGuard::works()) {
                EXPECT_EQ(guard->count(), 0u);
            }
            guard.reset();
            return false;
        });
        EXPECT_TRUE(well);
        if (!hd) {  // HD's scheduler has stopped, so no force acts
            EXPECT_EQ(felt[1].force, 2);
        }
        kept->deactivate();
        EXPECT_EQ(felt[0].force, 0);
        EXPECT_EQ(felt[1].force, 0);
    }
}

TEST_P(Kept, DevicesLoseTheirForceWhenTheProgramIsSilent) {
    const auto kept = host_devices(order);
    kept->activate();
    std::vector<devices::Reading> readings(2);
    int ticks = 0;
    double gone = 0;
    double again = 0;
    run(*kept, [&] {
        kept->read(Time(ticks), readings);
        if (++ticks == 300) {  // by then, HD's force has ramped up
            EXPECT_GT(felt[0].force, 1);
            gone = felt.gone_after(monotonic());
        }
        kept->write(kPush);
        again = std::max(again, ticks > 310 ? felt[0].force : 0.0);
        return ticks < 400;
    });
    EXPECT_GT(gone, order.hosting.longest_silence - 0.005);
    EXPECT_LT(gone, order.hosting.longest_silence + 0.5);  // a margin for busy machines
    EXPECT_GT(again, 1);  // the servo decides whether force may come back
}

TEST_P(Kept, DevicesAreAtZeroWhenTheProgramIsAboutToDie) {
    const auto kept = host_devices(order);
    kept->activate();
    std::vector<devices::Reading> readings(2);
    int ticks = 0;
    run(*kept, [&] {
        kept->read(Time(ticks), readings);
        kept->write(kPush);
        if (++ticks == 300) {
            EXPECT_GT(felt[0].force, 1);
            const int64_t begin = monotonic();
            force_off_now();
            EXPECT_LT(felt.gone_after(begin), 0.5);
        }
        if (ticks > 310) {
            EXPECT_EQ(felt[0].force, 0);
        }
        return ticks < 400;
    });
    kept->deactivate();
    kept->activate();
    ticks = 0;
    double again = 0;
    run(*kept, [&] {
        kept->read(Time(ticks), readings);
        kept->write(kPush);
        again = std::max(again, felt[0].force);
        return ++ticks < 300;
    });
    EXPECT_GT(again, 1);
}

/// The device host that this process started last. This process has no other children.
pid_t keeper_pid() {
    std::ifstream children("/proc/self/task/" + number_text(getpid()) + "/children");
    pid_t out = 0;
    for (pid_t one = 0; children >> one;) out = one;
    return out;
}

TEST_P(Kept, DevicesOfAKeeperThatWasStoppedLoseTheirForceAtOnceWhenItGoesOn) {
    // the firmware's watchdog would end the force by itself
    if (!hd) {
        for (devices::DeviceConfig& config : order.configs)
            config.options.set("watchdog", Node::plain_word("no"));
    }
    const auto kept = host_devices(order);
    const pid_t host = keeper_pid();
    ASSERT_GT(host, 0);
    kept->activate();
    std::vector<devices::Reading> readings(2);
    int ticks = 0;
    double gone = std::nan("");
    run(*kept, [&] {
        kept->read(Time(ticks), readings);
        const bool last = ++ticks == 300;
        if (last) {
            EXPECT_GT(felt[0].force, 1);
            kill(host, SIGSTOP);
            waitpid(host, nullptr, WUNTRACED);
        }
        kept->write(kPush);  // by the time the device host is resumed, this request is old
        if (!last) return true;
        // longer than a force may last without a request, and longer than HD may go without a
        // callback
        std::this_thread::sleep_for(milliseconds(150));
        const int64_t begin = monotonic();
        kill(host, SIGCONT);
        gone = felt.gone_after(begin);
        return false;
    });
    // on an idle machine; a new request would hold the force for twice as long
    EXPECT_LT(gone, order.hosting.longest_silence / 2);
}

TEST(Host, ThatDoesNotAnswerIsGivenUpWhenTheProgramIsInterrupted) {
    const testing::TemporaryFolder folder;
    Order order = order_on("forcedimension");
    order.hosting.program = folder.write("silent", "#!/bin/sh\nexec sleep 60\n");
    std::filesystem::permissions(order.hosting.program, std::filesystem::perms::owner_all);
    const int64_t begin = monotonic();
    order.hosting.given_up = [begin] { return monotonic() - begin > 100'000'000; };
    try {
        host_devices(order);
        FAIL();
    } catch (const Error& e) {
        EXPECT_NE(std::string(e.what()).find("interrupted while"), std::string::npos) << e.what();
    }
    // the device host's process has to be ended too, which takes kSetDown
    EXPECT_LT(static_cast<double>(monotonic() - begin) * 1e-9, 20);
}

TEST_P(Kept, DevicesHaveOneOwnerAtATime) {
    const auto first = host_devices(order);
    const pid_t owner = keeper_pid();
    const auto second = host_devices(order);
    first->activate();
    try {
        second->activate();
        FAIL();
    } catch (const Error& e) {
        const std::string told = e.what();
        EXPECT_NE(told.find("rig.yaml:11: error: serial: "), std::string::npos) << told;
        EXPECT_NE(
            told.find("is in use by dihaptic-host (process " + number_text(owner) + " of user "),
            std::string::npos)
            << told;
    }
    first->deactivate();
    second->activate();
    // the kernel releases the claims of a device host that was killed
    kill(keeper_pid(), SIGKILL);
    first->activate();
}

TEST(ForceOff, IsDoneWhereNothingIsKept) {
    EXPECT_TRUE(force_off_now());
}

}  // namespace
}  // namespace dihaptic::host::host_test
