// Tests what other programs cannot see of a session that they watch: that a tick shows its frame
// without allocating, and what becomes of them in its pauses and after its end. What they see and
// do is tested where they are: python/test/live_test.py.
#include "session/onlookers.h"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstddef>
#include <cstring>
#include <filesystem>
#include <future>

#include "session/test/sessions.h"
#include "testing/allocation_guard.h"

namespace dihaptic::session::onlookers_test {
namespace {

class Onlooker {
  public:
    explicit Onlooker(const std::string& name) : socket_(::socket(AF_UNIX, SOCK_SEQPACKET, 0)) {
        sockaddr_un address{};
        address.sun_family = AF_UNIX;
        std::memcpy(address.sun_path + 1, name.data(), name.size());
        const size_t size = offsetof(sockaddr_un, sun_path) + 1 + name.size();
        EXPECT_EQ(connect(socket_, reinterpret_cast<const sockaddr*>(&address),
                          static_cast<socklen_t>(size)),
                  0);
        EXPECT_NE(read().find("\"session\""), std::string::npos);
    }
    ~Onlooker() { close(socket_); }
    Onlooker(const Onlooker&) = delete;
    Onlooker& operator=(const Onlooker&) = delete;

    void send(const std::string& message) const {
        EXPECT_GT(::send(socket_, message.data(), message.size(), 0), 0);
    }
    /// The next message; "" if there will be none.
    std::string read() const {
        std::string text(1 << 16, '\0');
        const ssize_t size = recv(socket_, text.data(), text.size(), 0);
        text.resize(size > 0 ? static_cast<size_t>(size) : 0);
        return text;
    }

  private:
    int socket_;
};

TEST(Onlookers, SeeTicksThatAllocateNothing) {
    DIHAPTIC_NEEDS_ALLOCATION_GUARD();
    Sessions sessions;
    const Plan plan = sessions.plan(Mover::simulated_person);
    const auto servo = make_servo(plan);
    Onlookers onlookers(plan, sessions.files.folder.path(), true, false);
    onlookers.open(*servo, {}, {});
    const Onlooker onlooker(socket_name(sessions.files.folder.path()));
    onlooker.send(R"({"turn": {"stiffness": 300}})");
    onlooker.send(R"({"key": "y"})");
    onlooker.send(R"({"watch": ["grip_force", "stiffness"], "every_ms": 0})");
    EXPECT_NE(onlooker.read().find("watching"), std::string::npos);
    servo->activate();
    char key = 0;
    double stiffness = 0;
    const frame::Director director = [&](const frame::Frame& last, std::span<const frame::Handle>,
                                         frame::Commands& commands) {
        onlookers.turn_knobs(last, seconds(servo->period()), commands.knobs);
        stiffness = commands.knobs.stiffness;
        key = std::max(key, onlookers.take_key());
        EXPECT_EQ(onlookers.take_trigger(), 0);
        EXPECT_FALSE(onlookers.ended());
    };
    Time now{0};
    size_t allocations = 0;
    {
        const testing::AllocationGuard guard;
        for (int i = 0; i < 1000; ++i) {
            onlookers.show(servo->tick(now, director));
            now += servo->period();
        }
        allocations = guard.count();
    }
    EXPECT_EQ(allocations, 0u);
    EXPECT_EQ(key, 'y');
    EXPECT_EQ(stiffness, 300);
    EXPECT_NE(onlooker.read().find("\"values\""), std::string::npos);
    const std::vector<std::string> told = onlookers.finish();
    ASSERT_EQ(told.size(), 1u);
    EXPECT_NE(told[0].find("1 key, 0 triggers, 1 turn of knobs."), std::string::npos) << told[0];
    std::string last;
    for (std::string said; !(said = onlooker.read()).empty();) last = said;
    EXPECT_EQ(last, R"({"over":true})");
}

TEST(Onlookers, EndASessionThatIsPaused) {
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
        options.onlookers = true;
        options.live = &live;
        const std::atomic<bool> stop{false};
        auto run = std::async(std::launch::async, [&] { return record(plan, options, stop); });
        std::string folder;
        while (folder.empty()) {
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
            for (const auto& entry : std::filesystem::directory_iterator(out.path())) {
                if (std::filesystem::exists(entry.path() / "raw.log")) folder = entry.path();
            }
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(200));
        const Onlooker onlooker(socket_name(folder));
        onlooker.send(R"({"end": true})");
        const auto ended = run.wait_for(std::chrono::seconds(30));
        EXPECT_EQ(ended, std::future_status::ready);
        live.ended = true;
        EXPECT_TRUE(run.get().interrupted);
    }
}

TEST(Onlookers, AreToldEveryEndOfAnAttemptThoughTheyReadAfterTheSession) {
    Sessions sessions;
    const Plan plan = sessions.plan(Mover::simulated_person);
    const auto servo = make_servo(plan);
    Onlookers onlookers(plan, sessions.files.folder.path(), true, false);
    onlookers.open(*servo, {}, {"hit"});
    const Onlooker onlooker(socket_name(sessions.files.folder.path()));
    onlooker.send(R"({"watch": [], "every_ms": 60000})");
    EXPECT_NE(onlooker.read().find("watching"), std::string::npos);
    servo->activate();
    frame::Frame frame = servo->tick(Time{0}, {});
    frame.task.outcome = 0;
    constexpr int kEnds = 1000;  // the socket has room for some 300
    for (frame.trial = 1; frame.trial <= kEnds; ++frame.trial) {
        onlookers.show(frame);
        if (frame.trial % 16 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    auto over = std::async(std::launch::async, [&] { return onlookers.finish(); });
    int ends = 0;
    for (std::string said; !(said = onlooker.read()).empty();)
        ends += said.find("ended") != std::string::npos ? 1 : 0;
    over.get();
    EXPECT_EQ(ends, kEnds);
}

}  // namespace
}  // namespace dihaptic::session::onlookers_test
