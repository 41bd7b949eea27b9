#include "servo/lateness.h"

#include <gtest/gtest.h>

#include "servo/suspension.h"
#include "testing/allocation_guard.h"

namespace dihaptic::servo::lateness_test {
namespace {

using std::chrono::milliseconds;

/// A loop with a period of one millisecond and some late ticks.
struct Loop {
    Lateness late{milliseconds(1)};
    Time now{0};

    void tick(Time elapsed) {
        now += elapsed;
        late.tick(now, elapsed);
    }
    void tick(Time elapsed, int count) {
        for (int i = 0; i < count; ++i) tick(elapsed);
    }
};

TEST(Lateness, IsExactlyNothingInTimeAndWithTheJitterOfAClock) {
    Loop loop;
    for (int i = 0; i < 3000; ++i) loop.tick(std::chrono::microseconds(i % 2 ? 600 : 1400));
    EXPECT_EQ(loop.late.sustained(), 0);
    EXPECT_EQ(loop.late.expected(), 0);
}

TEST(Lateness, ForgivesASinglePause) {
    Loop loop;
    loop.tick(milliseconds(1), 2000);
    loop.tick(milliseconds(39));
    EXPECT_DOUBLE_EQ(loop.late.expected(), 38e-3);
    for (int i = 0; i < 2000; ++i) {
        EXPECT_EQ(loop.late.sustained(), 0);
        loop.tick(milliseconds(1));
        // the late tick is forgotten after a fifth of a second
        EXPECT_EQ(loop.late.expected() > 0, i < 216) << i;
    }
}

TEST(Lateness, OfTicksThatAreAllLateIsTheirsWithinASecondAndAHalf) {
    for (const int by : {1, 2, 5, 10, 20, 38}) {
        Loop loop;
        loop.tick(milliseconds(1), 1000);
        double last = 0;
        for (const Time end = loop.now + milliseconds(1500); loop.now < end;) {
            loop.tick(milliseconds(1 + by));
            EXPECT_LE(last, loop.late.sustained() * (1 + 1e-9));
            last = loop.late.sustained();
        }
        // all ticks are late by more than half a period; all intervals except one are used
        EXPECT_NEAR(last, by * 1e-3, 0.05e-3 * by) << by;
        loop.tick(milliseconds(1), 3000);
        EXPECT_EQ(loop.late.sustained(), 0) << by;
    }
}

TEST(Lateness, CountsEachIntervalByItsLength) {
    Loop loop;
    for (int i = 0; i < 100; ++i) {
        loop.tick(milliseconds(21));
        loop.tick(milliseconds(1), 4);
    }
    // 40 intervals of 21 ms in the last second, one of which is forgiven
    EXPECT_NEAR(loop.late.sustained(), 39 * 21e-3 * 20e-3 / (1 - 21e-3), 1e-4);
}

TEST(Lateness, NeverChangesAtOnce) {
    Loop loop;
    loop.tick(milliseconds(1), 100);
    double last = 0;
    for (int i = 0; i < 3500; ++i) {
        // a pause of 39 ms every fifth of a second, then no more pauses
        loop.tick(milliseconds(i % 200 == 0 && i < 2000 ? 39 : 1));
        if (last > 1e-4) {
            EXPECT_NEAR(loop.late.sustained() / last, 1, 0.4) << i;
            if (i % 200 != 0) {
                EXPECT_NEAR(loop.late.sustained() / last, 1, 0.06) << i;
            }
        }
        last = loop.late.sustained();
    }
    EXPECT_EQ(last, 0);
}

TEST(Lateness, BearsAClockThatGoesBack) {
    Loop loop;
    for (int i = 0; i < 5000; ++i) loop.tick(milliseconds(i % 2 ? 20 : -20));
    EXPECT_GE(loop.late.sustained(), 0);
    EXPECT_LE(loop.late.expected(), 19e-3);
    EXPECT_GE(loop.late.expected(), 0);
    loop.late.restart();
    loop.tick(milliseconds(1), 10);
    EXPECT_EQ(loop.late.sustained(), 0);
}

TEST(Lateness, BeginsAnewAndAllocatesNothing) {
    DIHAPTIC_NEEDS_ALLOCATION_GUARD();
    Loop loop;
    const testing::AllocationGuard guard;
    loop.tick(std::chrono::microseconds(1501), 5000);
    EXPECT_NEAR(loop.late.sustained(), 0.501e-3, 1e-5);
    loop.late.restart();
    EXPECT_EQ(loop.late.sustained(), 0);
    EXPECT_EQ(loop.late.expected(), 0);
    loop.tick(milliseconds(1), 5000);
    EXPECT_EQ(loop.late.sustained(), 0);
    EXPECT_EQ(guard.count(), 0u);
}

// ---- suspension -------------------------------------------------------------------------------

using std::chrono::microseconds;
using std::chrono::seconds;

TEST(Suspension, IsTheTimeThatOnlyOneOfTheClocksCounted) {
    Suspension suspension({seconds(100), seconds(500), seconds(100)});
    EXPECT_EQ(suspension.since({seconds(101), seconds(501), seconds(101)}), Time(0));
    EXPECT_EQ(suspension.since({seconds(102), seconds(562), seconds(102)}), seconds(60));
    EXPECT_EQ(suspension.since({seconds(103), seconds(563), seconds(103)}), Time(0));
    EXPECT_EQ(suspension.since({seconds(104), seconds(565), seconds(104)}), seconds(1));
}

TEST(Suspension, IsNotWhatAThreadHadToWaitBetweenTwoReadings) {
    // first reading, later reading, and readings with a wait before and after the middle value
    Suspension suspension({seconds(100), seconds(501), seconds(101)});
    EXPECT_EQ(suspension.since({seconds(102), seconds(502), seconds(102)}), Time(0));
    EXPECT_EQ(suspension.since({seconds(103), seconds(508), seconds(108)}), Time(0));
    EXPECT_EQ(suspension.since({seconds(109), seconds(509), seconds(112)}), Time(0));
    EXPECT_EQ(suspension.since({seconds(113), seconds(573), seconds(113)}), seconds(59));
}

TEST(Suspension, NoneIsFoundWhileThisRuns) {
    Suspension suspension(Suspension::read());
    for (int i = 0; i < 1000; ++i) EXPECT_EQ(suspension.since(Suspension::read()), Time(0));
}

}  // namespace
}  // namespace dihaptic::servo::lateness_test
