#include "haptics/chatter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "base/random.h"

namespace dihaptic::haptics::chatter_test {
namespace {

constexpr double kTick = 1e-3;

/// The first tick in which a force chatters, or -1 if it does not chatter within a second.
int chatters_at(const std::function<double(int tick)>& force, double h = kTick) {
    Chatter chatter;
    for (int i = 0; i < 1 / h; ++i) {
        chatter.add({0, 0, force(i)}, h);
        if (chatter.amplitude() > 0) return i;
    }
    return -1;
}

TEST(Chatter, IsAForceThatAlternatesFromTickToTick) {
    const auto alternating = [](double by) {
        return [by](int i) { return 8 + (i % 2 == 0 ? by : -by); };
    };
    const int at = chatters_at(alternating(1));
    EXPECT_GT(at, 40);
    EXPECT_LT(at, 60);  // required: within 100 ms
    EXPECT_EQ(chatters_at(alternating(0.24)), -1);
    EXPECT_GT(chatters_at(alternating(0.26)), 0);
    EXPECT_NEAR(chatters_at(alternating(1), kTick / 4), 4 * at, 8);
}

TEST(Chatter, IsNeitherABlowNorAVibrationNorASlope) {
    using std::numbers::pi;
    EXPECT_EQ(chatters_at([](int i) { return i > 100 ? 8.5 : 0; }), -1);
    EXPECT_EQ(chatters_at([](int i) { return i % 10 < 5 ? 8.5 : 0; }), -1);
    EXPECT_EQ(chatters_at([](int i) { return 8.5 * i / 1000; }), -1);
    // texture and tremor: 2 N at 100 Hz give d = 2 N (1 - cos(2 pi f h)) / 2
    EXPECT_EQ(chatters_at([](int i) { return 4 + 2 * std::sin(2 * pi * 100 * i * kTick); }), -1);
    // encoder steps of 0.03 mm with a stiffness of 8000 N/m
    Random random(1, "steps");
    EXPECT_EQ(chatters_at([&](int) { return 4 + 0.24 * std::round(random.uniform(-1, 1)); }), -1);
}

}  // namespace
}  // namespace dihaptic::haptics::chatter_test
