// Tests that the mixer begins and ends sounds exactly at the requested sample, and that it reports
// when.
#include "sound/mixer.h"

#include <gtest/gtest.h>

#include <cmath>

#include "testing/allocation_guard.h"

namespace dihaptic::sound::mixer_test {
namespace {

constexpr double kRate = 1000;  // one sample per millisecond
constexpr int64_t kMs = 1000000;

Wave ones(size_t n, float value, bool goes_on = false, double ramp = 0) {
    return {std::vector<float>(n, value), goes_on, ramp};
}

/// Renders buffers of these sizes, one after the other, starting at time `first`.
std::vector<float> play(Mixer& mixer, const std::vector<size_t>& buffers, int64_t first = 0) {
    std::vector<float> out;
    for (const size_t n : buffers) {
        std::vector<float> buffer(n, 9.0f);
        mixer.render(buffer, first + static_cast<int64_t>(out.size()) * kMs);
        out.insert(out.end(), buffer.begin(), buffer.end());
    }
    return out;
}

TEST(Mixer, BeginsASoundAFixedTimeAfterItsOrderWhateverTheBuffers) {
    for (const std::vector<size_t>& buffers :
         {std::vector<size_t>{100}, {1, 1, 98}, {33, 33, 34}, {24, 1, 75}}) {
        Mixer mixer({ones(10, 0.5f)}, kRate, 0.02);
        mixer.order({7, 0, true, 1.5, 5 * kMs});
        const auto out = play(mixer, buffers);
        for (size_t i = 0; i < 100; ++i) EXPECT_EQ(out[i], i >= 25 && i < 35 ? 0.5f : 0.0f) << i;
        const auto onset = mixer.take_onset();
        ASSERT_TRUE(onset);
        EXPECT_EQ(onset->tick, 7);
        EXPECT_EQ(onset->asked, 1.5);
        EXPECT_NEAR(onset->heard, 1.52, 1e-12);
        EXPECT_FALSE(mixer.take_onset());
    }
}

TEST(Mixer, SaysSoWhenAnOrderComesTooLate) {
    Mixer mixer({ones(10, 0.5f)}, kRate, 0.02);
    mixer.order({0, 0, true, 1, 0});
    const auto out = play(mixer, {50}, 100 * kMs);
    EXPECT_EQ(out[0], 0.5f);
    EXPECT_NEAR(mixer.take_onset()->heard, 1.1, 1e-12);
}

TEST(Mixer, AddsWhatIsHeardAtOnceAndKeepsItWithinBounds) {
    Mixer mixer({ones(10, 0.4f), ones(10, 0.9f)}, kRate, 0);
    mixer.order({0, 0, true, 0, 0});
    mixer.order({0, 0, true, 0, 5 * kMs});
    mixer.order({0, 1, true, 0, 20 * kMs});
    mixer.order({0, 1, true, 0, 25 * kMs});
    const auto out = play(mixer, {50});
    EXPECT_EQ(out[4], 0.4f);
    EXPECT_EQ(out[7], 0.8f);
    EXPECT_EQ(out[12], 0.4f);
    EXPECT_EQ(out[27], 1.0f);
}

TEST(Mixer, RepeatsWhatGoesOnUntilItsEndIsOrdered) {
    Mixer mixer({ones(7, 0.5f, true, 0.01)}, kRate, 0.002);
    mixer.order({0, 0, true, 0, 0});
    mixer.order({60, 0, false, 0.06, 60 * kMs});
    const auto out = play(mixer, {13, 41, 46});
    const auto swell = [](double part) { return (1 - std::cos(M_PI * part)) / 2; };
    for (size_t i = 0; i < 100; ++i) {
        const double t = static_cast<double>(i);
        const double wanted = t < 2    ? 0
                              : t < 12 ? swell((t - 2) / 10)
                              : t < 62 ? 1
                              : t < 72 ? 1 - swell((t - 62) / 10)
                                       : 0;
        EXPECT_NEAR(out[i], 0.5 * wanted, 1e-6) << i;
    }
    // the sound can begin again, and is not ended by the earlier end
    mixer.order({0, 0, true, 0, 100 * kMs});
    EXPECT_EQ(play(mixer, {40}, 100 * kMs)[30], 0.5f);
}

TEST(Mixer, LeavesOutWhatIsTooMuchAndCountsIt) {
    Mixer mixer({ones(10, 0.01f)}, kRate, 0);
    for (int i = 0; i < 40; ++i) mixer.order({i, 0, true, 0, 0});
    play(mixer, {5});
    EXPECT_EQ(mixer.left_out(), 8);
    int onsets = 0;
    while (mixer.take_onset()) ++onsets;
    EXPECT_EQ(onsets, 32);
}

TEST(Mixer, NeitherOrdersNorSamplesAllocate) {
    Mixer mixer({ones(10, 0.5f), ones(10, 0.1f, true)}, kRate, 0.01);
    std::vector<float> buffer(64);
    const testing::AllocationGuard guard;
    for (int i = 0; i < 1000; ++i) {
        mixer.order({i, i % 2, true, 0, i * 64 * kMs});
        if (i % 2 == 1) mixer.order({i, 1, false, 0, i * 64 * kMs});
        mixer.render(buffer, i * 64 * kMs);
    }
    EXPECT_EQ(guard.count(), 0u);
}

}  // namespace
}  // namespace dihaptic::sound::mixer_test
