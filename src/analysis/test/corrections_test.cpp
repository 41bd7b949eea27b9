// Tests the detection of simulated corrections: the latency of a minimum-jerk correction in noise,
// and the reasons for a missing latency.
#include "analysis/corrections.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/random.h"
#include "model/minimum_jerk.h"

namespace dihaptic::analysis::corrections_test {
namespace {

constexpr double kTick = 1e-3;

/// Trials with a correction of `size` [m] that begins at `onset` and lasts 0.4 s, in addition to a
/// drift that differs between trials.
struct Planted {
    std::vector<Velocities> trials;

    Planted(int count, double onset, double size, uint64_t seed, int ticks = 800) {
        Random random(seed, "corrections");
        for (int i = 0; i < count; ++i) {
            const double drift = 0.01 * random.normal();
            const double bend = 0.02 * random.normal();
            Velocities& v = trials.emplace_back();
            for (int k = 0; k < ticks; ++k) {
                const double t = k * kTick;
                const double s = (t - onset) / 0.4;
                const double rate = s > 0 && s < 1 ? model::minimum_jerk(s).rate / 0.4 : 0;
                v.push_back(drift + bend * t + size * rate);
            }
        }
    }
    std::vector<const Velocities*> all() const {
        std::vector<const Velocities*> out;
        for (const Velocities& v : trials) out.push_back(&v);
        return out;
    }
};

/// Returns the time, from the onset of a movement of 0.4 s, at which the line through a quarter and
/// three quarters of the first peak of a minimum-jerk acceleration reaches 0.
double bias() {
    // a(s) = 60 s (1 - s) (1 - 2 s), whose peak is at s = (3 - sqrt(3)) / 6
    const auto a = [](double s) { return s * (1 - s) * (1 - 2 * s); };
    const double at = (3 - std::sqrt(3.0)) / 6;
    const auto reaches = [&](double share) {
        double low = 0, high = at;
        for (int i = 0; i < 60; ++i) {
            const double middle = (low + high) / 2;
            (a(middle) < share * a(at) ? low : high) = middle;
        }
        return low;
    };
    const double quarter = reaches(0.25), three = reaches(0.75);
    return 0.4 * (quarter - (three - quarter) / 2);
}

TEST(Corrections, HaveTheLatencyThatWasPlanted) {
    EXPECT_LT(std::abs(bias()), 0.006);
    for (const double onset : {0.12, 0.25}) {
        for (const double size : {0.02, -0.04}) {
            const rows::CorrectionRow row = find_correction(Planted(40, onset, size, 1).all(),
                                                            Planted(40, 0, 0, 2).all(), kTick);
            EXPECT_EQ(row.why, "");
            EXPECT_EQ(row.trials, 40);
            EXPECT_NEAR(row.latency, onset + bias(), 0.006) << onset << " " << size;
            EXPECT_NEAR(row.velocity, size * 1.875 / 0.4, 0.1 * std::abs(size * 1.875 / 0.4));
            EXPECT_NEAR(row.at, onset + 0.2, 0.02);
            EXPECT_GT(row.acceleration * size, 0);
        }
    }
}

TEST(Corrections, SayWhyThereIsNone) {
    const Planted matched(20, 0, 0, 2), jumped(20, 0.15, 0.02, 1);
    const auto of = [&](const Planted& trials, const Planted& against) {
        return find_correction(trials.all(), against.all(), kTick);
    };
    EXPECT_EQ(of(Planted(2, 0.15, 0.02, 1), matched).why,
              "at least 3 trials of each kind are needed");
    EXPECT_EQ(of(Planted(20, 0, 0, 3), matched).why,
              "the means never differ by 3 standard errors for 20 ms");
    EXPECT_TRUE(std::isnan(of(Planted(20, 0, 0, 3), matched).latency));
    EXPECT_EQ(of(Planted(20, -0.1, 0.05, 3), matched).why,
              "the hand departs from the matched trials when the state begins, or earlier");
    const rows::CorrectionRow shorter = of(jumped, Planted(20, 0, 0, 2, 200));
    EXPECT_EQ(shorter.left_out, 20);
    EXPECT_EQ(shorter.why, "at least 3 trials of each kind are needed");
    const rows::CorrectionRow exact = of(matched, matched);
    EXPECT_TRUE(std::isnan(exact.velocity));
    EXPECT_EQ(exact.why, "the means never differ by 3 standard errors for 20 ms");
}

TEST(Corrections, AreComparedAsFarAsMostTrialsLast) {
    Planted jumped(20, 0.15, 0.02, 1);
    const Planted matched(20, 0, 0, 2);
    const rows::CorrectionRow whole = find_correction(jumped.all(), matched.all(), kTick);
    EXPECT_NEAR(whole.compared, 0.8, 1e-9);
    jumped.trials[3].resize(320);  // one of the trials ended early
    const rows::CorrectionRow row = find_correction(jumped.all(), matched.all(), kTick);
    EXPECT_EQ(row.left_out, 1);
    EXPECT_NEAR(row.compared, 0.8, 1e-9);
    EXPECT_NEAR(row.latency, whole.latency, 0.01);
    for (Velocities& v : jumped.trials) v.resize(400);
    EXPECT_NEAR(find_correction(jumped.all(), matched.all(), kTick).compared, 0.32, 0.081);
}

TEST(Corrections, AreThoseOfTheFirstExcursionNotOfTheWayBack) {
    Planted jumped(20, 0.12, 0.01, 1);
    for (Velocities& v : jumped.trials) {
        for (size_t k = 0; k < v.size(); ++k) {
            const double s = (static_cast<double>(k) * kTick - 0.45) / 0.2;
            if (s > 0 && s < 1) v[k] -= 0.01 * model::minimum_jerk(s).rate / 0.2;  // faster
        }
    }
    const rows::CorrectionRow row =
        find_correction(jumped.all(), Planted(20, 0, 0, 2).all(), kTick);
    EXPECT_GT(row.velocity, 0);
    EXPECT_NEAR(row.latency, 0.12 + bias(), 0.012);
}

}  // namespace
}  // namespace dihaptic::analysis::corrections_test
