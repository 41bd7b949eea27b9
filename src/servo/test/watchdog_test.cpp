#include "servo/watchdog.h"

#include <gtest/gtest.h>
#include <pthread.h>
#include <sched.h>

#include <future>

#include "lift.h"
#include "servo/run.h"

namespace dihaptic::servo::watchdog_test {
namespace {

using std::chrono::milliseconds;

TEST(Watchdog, LeavesTicksThatEndAlone) {
    std::atomic<int> stops{0};
    {
        Watchdog watchdog(
            std::chrono::seconds(5), [&] { ++stops; }, [] {});
        for (int i = 0; i < 20; ++i) {
            std::this_thread::sleep_for(milliseconds(1));
            watchdog.end_tick(Watchdog::Clock::now());
        }
    }
    EXPECT_EQ(stops, 0);
}

TEST(Watchdog, StopsOnceFromAThreadOfItsOwn) {
    std::promise<std::thread::id> stopper;
    const auto begin = Watchdog::Clock::now();
    Watchdog watchdog(
        milliseconds(30), [&] { stopper.set_value(std::this_thread::get_id()); }, [] {});
    EXPECT_NE(stopper.get_future().get(), std::this_thread::get_id());
    EXPECT_GE(Watchdog::Clock::now() - begin, milliseconds(30));
    std::this_thread::sleep_for(milliseconds(50));  // a second stop would throw
}

/// Tests the situation after SIGSTOP and SIGCONT, in which both deadlines have long passed.
TEST(Watchdog, GivesAProgramThatStoodStillTheTimeToEndATick) {
    std::promise<void> stopped;
    std::atomic<bool> stuck{false};
    {
        Watchdog watchdog(
            milliseconds(30), [&] { stopped.set_value(); }, [&] { stuck = true; });
        watchdog.end_tick(Watchdog::Clock::now() - std::chrono::seconds(10));
        stopped.get_future().wait();
        std::this_thread::sleep_for(milliseconds(200));
        watchdog.end_tick(Watchdog::Clock::now());
    }
    EXPECT_FALSE(stuck);
}

/// Tests a servo that spins on the only processor that it and its watchdog may use. If both had the
/// same priority, the watchdog would wait for ever.
TEST(Watchdog, StopsAServoThatSpinsOnTheOnlyProcessor) {
    std::atomic<bool> stopped{false};
    int refused = 0;
    double took = 0;
    std::thread([&] {
        cpu_set_t one;
        CPU_ZERO(&one);
        CPU_SET(sched_getcpu(), &one);
        refused = pthread_setaffinity_np(pthread_self(), sizeof one, &one);
        sched_param priority{};
        priority.sched_priority = 10;
        if (refused == 0) refused = pthread_setschedparam(pthread_self(), SCHED_FIFO, &priority);
        if (refused != 0) return;
        Watchdog watchdog(
            milliseconds(30), [&] { stopped = true; }, [] {});
        // the kernel stops real-time threads after 950 ms of each second
        const auto begin = Watchdog::Clock::now();
        const auto spun = [&] {
            return std::chrono::duration<double>(Watchdog::Clock::now() - begin).count();
        };
        while (!stopped && spun() < 0.5) {
        }
        took = spun();
    }).join();
    if (refused != 0) {
        GTEST_SKIP() << "one processor and SCHED_FIFO: refused (" << strerrorname_np(refused)
                     << "), so a spinning servo was not tested";
    }
    EXPECT_TRUE(stopped);
    EXPECT_LT(took, 0.4);
}

/// A device whose write call blocks in tick number `tick` until the device is stopped or released.
class BlockingGroup final : public devices::DeviceGroup {
  public:
    BlockingGroup(int tick, bool can_stop, bool simulated)
        : DeviceGroup({info(simulated)}), tick_(tick), can_stop_(can_stop) {}
    bool can_stop() const override { return can_stop_; }
    void let_go() {
        const std::lock_guard lock(mutex_);
        free_ = true;
        wake_.notify_all();
    }
    std::atomic<int> stops{0};
    std::atomic<bool> blocks{false};
    int activations = 0;

  private:
    static frame::DeviceInfo info(bool simulated) {
        frame::DeviceInfo out;
        out.simulated = simulated;
        return out;
    }
    void do_activate() override { ++activations; }
    void do_deactivate() override {}
    void do_read(Time, std::span<devices::Reading> readings) noexcept override { readings[0] = {}; }
    void do_write(std::span<const Wrench>) noexcept override {
        if (tick_-- != 0) return;
        blocks = true;
        std::unique_lock lock(mutex_);
        wake_.wait(lock, [&] { return free_; });
    }
    bool do_stop() noexcept override {
        ++stops;
        let_go();
        return true;
    }

    int tick_;
    bool can_stop_;
    std::mutex mutex_;
    std::condition_variable wake_;
    bool free_ = false;
};

struct Blocked {
    BlockingGroup* devices = nullptr;
    std::unique_ptr<Servo> servo;
    Timing timing;

    explicit Blocked(bool can_stop, bool simulated = false) {
        scene::Scene scene = block_on_table();
        scene.fingers.resize(1);
        auto group = std::make_unique<BlockingGroup>(50, can_stop, simulated);
        devices = group.get();
        servo = std::make_unique<Servo>(scene, frame::Settings{}, std::move(group),
                                        std::vector<Pose>{Pose{Quat::Identity(), {0, 0, 0.2}}});
        servo->activate();
        timing.reserve(4000);
    }
    void run(const std::function<void(const Timing::Stall&)>& stuck) {
        const std::atomic<bool> stop{false};
        run_real(*servo, {}, {}, Time(0), std::chrono::seconds(3), stop, timing, stuck);
    }
};

TEST(WatchdogInRealTime, StopsDevicesThatBlockAndTheRunEndsWithAFault) {
    Blocked blocked(true);
    blocked.run([](const Timing::Stall&) { FAIL(); });
    EXPECT_EQ(blocked.devices->stops, 1);
    ASSERT_TRUE(blocked.timing.stall);
    EXPECT_TRUE(blocked.timing.stall->stopped);
    EXPECT_NE(describe(*blocked.timing.stall).find("the watchdog switched the devices' force off"),
              std::string::npos);
    // by its own clock, the tick after the blocked one is late, as in a replay
    EXPECT_EQ(blocked.servo->fault().kind, haptics::FaultKind::late);
    EXPECT_GT(blocked.servo->fault().value, frame::Settings{}.safety.max_pause);
    EXPECT_LT(blocked.timing.reached, std::chrono::seconds(3));  // i.e. one second after the fault
}

/// Tests a stop that no fault reports, because the tick was the last one before a pause.
TEST(Watchdog, WhatItStoppedBeginsAnewAfterAPause) {
    Blocked blocked(true);
    blocked.servo->resume();
    EXPECT_EQ(blocked.devices->activations, 1);
    blocked.servo->stop_devices();
    blocked.servo->resume();
    EXPECT_EQ(blocked.devices->activations, 2);
    blocked.servo->resume();
    EXPECT_EQ(blocked.devices->activations, 2);
}

TEST(WatchdogInRealTime, TellsOfSimulatedDevicesThatWaitedAndLeavesThemAlone) {
    Blocked blocked(true, true);
    std::thread freeing([&] {
        while (!blocked.devices->blocks) std::this_thread::sleep_for(milliseconds(1));
        std::this_thread::sleep_for(milliseconds(300));
        blocked.devices->let_go();
    });
    blocked.run([](const Timing::Stall&) { FAIL(); });
    freeing.join();
    EXPECT_EQ(blocked.devices->stops, 0);
    EXPECT_FALSE(blocked.timing.stall);
    EXPECT_FALSE(blocked.servo->fault());
    EXPECT_GT(blocked.timing.reached, std::chrono::seconds(2));
    EXPECT_GE(blocked.timing.pauses, 1);
    EXPECT_GT(blocked.timing.longest_pause, 0.1);
    EXPECT_NE(describe_pauses(blocked.timing).find("waited longer than allowed"),
              std::string::npos);
    EXPECT_EQ(describe_pauses({}), "");
}

TEST(WatchdogInRealTime, SaysWhenTheLoopIsStuckForGood) {
    Blocked blocked(false);
    std::atomic<int> told{0};
    blocked.run([&](const Timing::Stall& stall) {
        ++told;
        EXPECT_FALSE(stall.stopped);
        EXPECT_NE(describe(stall).find("could not switch the devices' force off"),
                  std::string::npos);
        blocked.devices->let_go();  // a real program would end here
    });
    EXPECT_EQ(told, 1);
    EXPECT_EQ(blocked.devices->stops, 0);
    EXPECT_EQ(blocked.servo->fault().kind, haptics::FaultKind::late);
}

}  // namespace
}  // namespace dihaptic::servo::watchdog_test
