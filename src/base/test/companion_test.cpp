// Tests of companions that crash, hang, exceed their limits or are missing. A shell stands in for
// the companion, because it can do all of this on command.
#include "base/companion.h"
#include "base/number.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <thread>

namespace dihaptic::companion_test {
namespace {

CompanionTask task(const std::string& script) {
    return {"/bin/sh",
            {"-c", script},
            {.processor_time = 1, .time = 20, .memory = 500'000'000, .output = 1'000'000},
            "reading the thing",
            "Mend it.",
            {"scene.yaml", 7},
            "file"};
}

std::string failure(const CompanionTask& of) {
    try {
        run_companion(of, "");
    } catch (const Error& e) {
        return e.what();
    }
    return "none";
}

TEST(Companion, ReadsItsInputAndGivesItsOutput) {
    std::string long_text;
    for (int i = 0; i < 100'000; ++i) long_text += "line\n";
    EXPECT_EQ(run_companion(task("cat"), long_text), long_text);
    EXPECT_EQ(run_companion(task(""), "unread"), "");
    EXPECT_EQ(run_companion(task("exit 1"), ""), std::nullopt);
    EXPECT_EQ(run_companion(task("echo half; exit 1"), ""), std::nullopt);
}

int waits = 0;
std::string waited_for;

TEST(Companion, ThatTakesLongIsTold) {
    tell_companion_waits([](const std::string& what, int seconds, int most) {
        ++waits;
        waited_for = what + " " + number_text(seconds) + " of " + number_text(most);
    });
    EXPECT_EQ(run_companion(task("sleep 0.1"), ""), "");
    EXPECT_EQ(waits, 0);
    EXPECT_EQ(run_companion(task("sleep 1.5; echo done"), ""), "done\n");
    EXPECT_EQ(waited_for, "reading the thing 1 of 20");
    tell_companion_waits(nullptr);
    EXPECT_EQ(run_companion(task("sleep 1.2"), ""), "");
    EXPECT_EQ(waits, 1);
}

TEST(Companion, ThatFailsIsToldWithItsInputThePlaceAndTheRemedy) {
    const std::string start = "scene.yaml:7: error: file: reading the thing ";
    EXPECT_EQ(failure(task("kill -SEGV $$")),
              start + "failed: /bin/sh crashed (Segmentation fault). Mend it.");
    EXPECT_EQ(failure(task("kill -KILL $$")), start + "took more than 500 MB of memory. Mend it.");
    EXPECT_EQ(failure(task("exit 3")), start + "took more than 500 MB of memory. Mend it.");
    EXPECT_EQ(failure(task("while :; do :; done")),
              start + "took more than 1 s of computing time. Mend it.");
    EXPECT_EQ(failure(task("exec cat /dev/zero")), start + "wrote more than 1 MB. Mend it.");
    CompanionTask asleep = task("sleep 100");
    asleep.limits.time = 1;
    EXPECT_EQ(failure(asleep), start + "took more than 1 s. Mend it.");
    CompanionTask gone = task("");
    gone.program = "dihaptic-gone";
    EXPECT_EQ(failure(gone),
              "scene.yaml:7: error: file: the program dihaptic-gone, which is for reading the "
              "thing, is missing. Build all of Dihaptic, or install it again.");
}

TEST(Companion, HasNeitherMoreMemoryNorOurFiles) {
    EXPECT_EQ(run_companion(task("sleep 0.5; ulimit -v; ulimit -t; ulimit -c"), ""),
              "488281\n1\n0\n");
    const std::optional<std::string> open = run_companion(task("echo /proc/$$/fd/*"), "");
    ASSERT_TRUE(open);
    EXPECT_EQ(open->find("/fd/4"), std::string::npos) << *open;
}

TEST(Companion, EndsWhenItIsStoppedAndOnlyThen) {
    const std::string cancelled =
        "scene.yaml:7: error: file: reading the thing was cancelled. Open the file again.";
    std::stop_source user;
    CompanionTask asleep = task("sleep 100");
    asleep.stop = user.get_token();
    std::thread later([&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
        user.request_stop();
    });
    EXPECT_EQ(failure(asleep), cancelled);
    later.join();
    EXPECT_EQ(failure(asleep), cancelled);  // stopped before it has started

    std::stop_source another;
    CompanionTask whole = task("sleep 0.1; echo whole");
    whole.stop = another.get_token();
    EXPECT_EQ(run_companion(whole, ""), "whole\n");
    another.request_stop();  // the companion has already ended
}

TEST(Companion, SeveralRunAtOnce) {
    std::vector<std::thread> threads;
    std::atomic<int> right{0};
    for (int i = 0; i < 4; ++i) {
        threads.emplace_back([&, i] {
            for (int k = 0; k < 5; ++k) {
                const std::string text = number_text(100 * i + k);
                if (run_companion(task("cat"), text) == text) ++right;
            }
        });
    }
    for (std::thread& thread : threads) thread.join();
    EXPECT_EQ(right, 20);
}

}  // namespace
}  // namespace dihaptic::companion_test
