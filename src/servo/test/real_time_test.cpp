#include "servo/real_time.h"

#include <gtest/gtest.h>
#include <sched.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <optional>

namespace dihaptic::servo::real_time_test {
namespace {

TEST(Pace, KeepsPhaseAndLeavesOutWhatALateTickMissed) {
    Pace pace{Time(1000), Time(5000)};
    pace.end_tick(Time(5400));
    EXPECT_EQ(pace.due, Time(6000));
    EXPECT_FALSE(pace.late);
    pace.end_tick(Time(7000));  // ends exactly at the next deadline: not late yet
    EXPECT_EQ(pace.due, Time(7000));
    EXPECT_EQ(pace.overruns, 0);
    pace.end_tick(Time(8001));
    EXPECT_EQ(pace.due, Time(9000));
    EXPECT_TRUE(pace.late);
    pace.end_tick(Time(13500));  // misses three deadlines: one overrun
    EXPECT_EQ(pace.due, Time(14000));
    EXPECT_TRUE(pace.late);
    EXPECT_EQ(pace.overruns, 2);
    pace.end_tick(Time(14100));
    EXPECT_EQ(pace.due, Time(15000));
    EXPECT_FALSE(pace.late);
    EXPECT_EQ(pace.overruns, 2);
}

TEST(RealTime, SaysWhatWasRefusedAndHowToAllowIt) {
    EXPECT_EQ(describe(RealTime::Refusals{}, 80, false), "");
    EXPECT_EQ(describe(RealTime::Refusals{.priority = EPERM, .memory = ENOMEM}, 80, false),
              "real time: Linux refused priority 80 (EPERM), locked memory (ENOMEM), so ticks may "
              "come late; dihaptic doctor gives the commands that allow it");
    EXPECT_EQ(describe(RealTime::Refusals{.awake = EACCES}, 80, true),
              "real time: Linux refused wakeful processors (EACCES), so ticks may come late; "
              "dihaptic doctor shows how to start a container with these permissions");
}

/// Returns the message that a process without any permissions receives.
std::string told_without_permission() {
    int ends[2];
    if (pipe(ends) != 0) return "no pipe";
    const pid_t child = fork();
    if (child == 0) {
        const rlimit none{0, 0};
        setrlimit(RLIMIT_RTPRIO, &none);
        setrlimit(RLIMIT_MEMLOCK, &none);
        // root is granted everything, so drop root privileges
        if (geteuid() == 0 && setuid(65534) != 0) _exit(1);
        const std::string told = describe(try_real_time(80), 80);
        const auto written = write(ends[1], told.data(), told.size());
        _exit(written == static_cast<ssize_t>(told.size()) ? 0 : 1);
    }
    close(ends[1]);
    std::string told;
    char text[4096];
    for (ssize_t n = 0; (n = read(ends[0], text, sizeof text)) > 0;)
        told.append(text, static_cast<size_t>(n));
    close(ends[0]);
    int status = 1;
    waitpid(child, &status, 0);
    return status == 0 ? told : "the child failed";
}

TEST(RealTime, RunsWithoutPermissionAndTellsInOneLine) {
    const std::string told = told_without_permission();
    EXPECT_EQ(told.rfind("real time: Linux refused priority 80 (EPERM)", 0), 0u) << told;
#ifndef DIHAPTIC_SANITIZED  // sanitizers need so much memory that they do not really lock it
    EXPECT_NE(told.find("locked memory (EPERM)"), std::string::npos) << told;
#endif
    EXPECT_NE(told.find("dihaptic doctor gives the commands"), std::string::npos) << told;
    EXPECT_EQ(told.find('\n'), std::string::npos);
}

/// Locked memory of this process [kB].
int64_t locked_memory() {
    std::ifstream status("/proc/self/status");
    for (std::string word; status >> word;) {
        int64_t size = 0;
        if (word == "VmLck:" && status >> size) return size;
    }
    return -1;
}

TEST(RealTime, GivesBackWhatItWasGranted) {
    const int64_t before = locked_memory();
    std::optional<RealTime> real_time(std::in_place, 60);
    const RealTime::Refusals refusals = real_time->refusals();
    if (refusals.priority == 0) {
        sched_param now{};
        EXPECT_EQ(sched_getscheduler(0), SCHED_FIFO);
        sched_getparam(0, &now);
        EXPECT_EQ(now.sched_priority, 60);
    }
#ifndef DIHAPTIC_SANITIZED
    if (refusals.memory == 0) {
        EXPECT_GT(locked_memory(), before);
    }
#endif
    real_time.reset();
    EXPECT_EQ(sched_getscheduler(0), SCHED_OTHER);
    EXPECT_EQ(locked_memory(), before);
    if (refusals.any()) GTEST_SKIP() << describe(refusals, 60);
}

}  // namespace
}  // namespace dihaptic::servo::real_time_test
