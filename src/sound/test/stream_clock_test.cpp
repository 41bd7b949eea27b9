// Tests that the estimated times of a stream's buffers are as evenly spaced as the samples, however
// uneven the reported times are.
#include "sound/stream_clock.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/random.h"

namespace dihaptic::sound::stream_clock_test {
namespace {

TEST(StreamClock, FollowsACrystalThatIsOffAndTimesThatShake) {
    // 128 samples by a crystal that runs 100 ppm fast; the reported times jitter by 2 ms
    const double rate = 48000;
    const double buffer = 128 / (rate * 1.0001) * 1e9;
    Random random(1, "test");
    StreamClock clock(rate);
    double worst = 0;
    double worst_step = 0;
    int64_t last = 0;
    for (int i = 0; i < 20000; ++i) {
        const double truth = i * buffer;
        const int64_t out =
            clock.next(static_cast<int64_t>(truth + 1e6 * random.uniform(-2, 2)), 128);
        if (i > 1000) {
            worst = std::max(worst, std::abs(static_cast<double>(out) - truth));
            worst_step = std::max(worst_step, std::abs(static_cast<double>(out - last) - buffer));
        }
        last = out;
    }
    EXPECT_LT(worst, 0.5e6);
    EXPECT_LT(worst_step, 0.05e6);
}

TEST(StreamClock, BeginsAnewWhereTheStreamWasBrokenOff) {
    StreamClock clock(48000);
    EXPECT_EQ(clock.next(1000000, 480), 1000000);
    EXPECT_EQ(clock.next(11000000, 480), 11000000);
    EXPECT_EQ(clock.next(321000000, 480), 321000000);
    EXPECT_EQ(clock.next(331000000, 480), 331000000);
    clock.begin_anew();
    EXPECT_EQ(clock.next(343000000, 480), 343000000);
}

}  // namespace
}  // namespace dihaptic::sound::stream_clock_test
