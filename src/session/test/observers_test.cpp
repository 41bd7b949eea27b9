// Tests what observing programs cannot see themselves: that a tick publishes its frame without
// allocating memory, and what happens to observers during pauses and after the end of the session.
// What they see and do is tested in python/test/live_test.py.
#include "session/listeners/observers.h"

#include <gtest/gtest.h>
#include <sys/socket.h>

#include <filesystem>
#include <future>

#include "base/unix_socket.h"
#include "session/test/sessions.h"
#include "testing/allocation_guard.h"

namespace dihaptic::session::observers_test {
namespace {

class Observer {
  public:
    explicit Observer(const std::string& name) : socket_(unix_socket(SOCK_SEQPACKET)) {
        EXPECT_TRUE(UnixAddress::of_name(name).connect(socket_));
        EXPECT_NE(read().find("\"session\""), std::string::npos);
    }

    void send(const std::string& message) const {
        EXPECT_GT(::send(socket_.get(), message.data(), message.size(), 0), 0);
    }
    /// Returns the next message; "" if no more messages will arrive.
    std::string read() const {
        std::string text(1 << 16, '\0');
        const ssize_t size = recv(socket_.get(), text.data(), text.size(), 0);
        text.resize(size > 0 ? static_cast<size_t>(size) : 0);
        return text;
    }

  private:
    Descriptor socket_;
};

/// A session that other programs may watch, and whose ticks are run by the test.
struct Watched {
    Watched(const Sessions& sessions, const Plan& plan, const servo::Servo& servo)
        : folder(recording::SessionFolder::create(sessions.files.folder.path(), "watched")) {
        options.observers = true;
        info.outcomes = {"hit"};
        observers = let_observe({plan, options, folder, info, servo, true});
    }
    RunOptions options;
    recording::SessionInfo info;
    const recording::SessionFolder folder;
    std::unique_ptr<Listener> observers;
};

TEST(Observers, SeeTicksThatAllocateNothing) {
    DIHAPTIC_NEEDS_ALLOCATION_GUARD();
    Sessions sessions;
    const Plan plan = sessions.plan(Mover::simulated_person);
    const auto servo = make_servo(plan);
    const Watched watched(sessions, plan, *servo);
    const Observer observer(socket_name(watched.folder.path()));
    observer.send(R"({"turn": {"stiffness": 300}})");
    observer.send(R"({"key": "y", "trigger": 7})");
    observer.send(R"({"key": "n"})");
    observer.send(R"({"watch": ["grip_force", "stiffness"], "every_ms": 0})");
    EXPECT_NE(observer.read().find("watching"), std::string::npos);
    servo->activate();
    double stiffness = 0;
    const frame::Director director = [&](const frame::Frame& last, std::span<const frame::Handle>,
                                         frame::Commands& commands) {
        watched.observers->steer({last, nullptr, commands, servo->period(), true});
        stiffness = commands.knobs.stiffness;
        EXPECT_FALSE(watched.observers->ends());
    };
    Time now{0};
    size_t allocations = 0;
    {
        const testing::AllocationGuard guard;
        for (int i = 0; i < 1000; ++i) {
            watched.observers->take(servo->tick(now, director));
            now += servo->period();
        }
        allocations = guard.count();
    }
    EXPECT_EQ(allocations, 0u);
    EXPECT_EQ(stiffness, 300);
    EXPECT_NE(observer.read().find("\"values\""), std::string::npos);
    const std::vector<std::string> told = watched.observers->finish();
    ASSERT_EQ(told.size(), 1u);
    EXPECT_NE(told[0].find("2 keys, 1 trigger, 1 turn of knobs."), std::string::npos) << told[0];
    std::string last;
    for (std::string said; !(said = observer.read()).empty();) last = said;
    EXPECT_EQ(last, R"({"over":true})");
}

TEST(Observers, EndASessionThatIsPaused) {
    for (const Clock clock : {Clock::virtual_clock, Clock::real}) {
        SCOPED_TRACE(clock == Clock::real ? "real" : "virtual");
        Sessions sessions;
        const Plan plan = sessions.plan(Mover::simulated_person);
        const testing::TemporaryFolder out;
        Live live;
        live.paused = true;
        RunOptions options;
        options.clock = clock;
        options.out = out.path();
        options.observers = true;
        options.live = &live;
        const std::atomic<bool> stop{false};
        auto run = std::async(std::launch::async, [&] { return record(plan, options, stop); });
        std::string folder;
        while (folder.empty()) {
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
            for (const auto& entry : std::filesystem::directory_iterator(out.path())) {
                // the session's socket listens once the file contains its name
                std::error_code none;
                const auto size = std::filesystem::file_size(entry.path() / "observers", none);
                if (!none && size > 0) folder = entry.path();
            }
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(200));
        const Observer observer(socket_name(folder));
        observer.send(R"({"end": true})");
        const auto ended = run.wait_for(std::chrono::seconds(30));
        EXPECT_EQ(ended, std::future_status::ready);
        live.ended = true;
        EXPECT_TRUE(run.get().interrupted);
    }
}

TEST(Observers, AreToldEveryEndOfAnAttemptThoughTheyReadAfterTheSession) {
    Sessions sessions;
    const Plan plan = sessions.plan(Mover::simulated_person);
    const auto servo = make_servo(plan);
    const Watched watched(sessions, plan, *servo);
    const Observer observer(socket_name(watched.folder.path()));
    observer.send(R"({"watch": [], "every_ms": 60000})");
    EXPECT_NE(observer.read().find("watching"), std::string::npos);
    servo->activate();
    frame::Frame frame = servo->tick(Time{0}, {});
    frame.task.outcome = 0;
    constexpr int kEnds = 1000;  // the socket has room for about 300
    for (frame.trial = 1; frame.trial <= kEnds; ++frame.trial) {
        watched.observers->take(frame);
        if (frame.trial % 16 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    auto over = std::async(std::launch::async, [&] { return watched.observers->finish(); });
    int ends = 0;
    for (std::string said; !(said = observer.read()).empty();)
        ends += said.find("ended") != std::string::npos ? 1 : 0;
    over.get();
    EXPECT_EQ(ends, kEnds);
}

}  // namespace
}  // namespace dihaptic::session::observers_test
