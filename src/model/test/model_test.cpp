#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "model/butterworth.h"
#include "model/grasp.h"
#include "model/minimum_jerk.h"

namespace dihaptic::model::model_test {
namespace {

TEST(MinimumJerk, StartsAndEndsAtRestWithItsPeakInTheMiddle) {
    EXPECT_EQ(minimum_jerk(-1).share, 0);
    EXPECT_EQ(minimum_jerk(0).rate, 0);
    EXPECT_EQ(minimum_jerk(2).share, 1);
    EXPECT_EQ(minimum_jerk(2).rate, 0);
    EXPECT_DOUBLE_EQ(minimum_jerk(0.5).share, 0.5);
    EXPECT_DOUBLE_EQ(minimum_jerk(0.5).rate, kMinimumJerkPeak);
    const double h = 1e-6;
    for (double s = 0.1; s < 1; s += 0.1) {
        EXPECT_NEAR((minimum_jerk(s + h).share - minimum_jerk(s - h).share) / (2 * h),
                    minimum_jerk(s).rate, 1e-8);
    }
}

TEST(MinimumJerk, PassesItsEndsAtTheSpeedsAskedForWithoutAcceleration) {
    const double x0 = 0.3, x1 = -0.2, v0 = 1.5, v1 = -0.7, T = 0.8;
    const auto x = [&](double t) {
        const double s = t / T;
        return x0 + (x1 - x0) * minimum_jerk(s).share + T * v0 * start_speed_part(s).share +
               T * v1 * end_speed_part(s).share;
    };
    const auto v = [&](double t) {
        const double s = t / T;
        return (x1 - x0) / T * minimum_jerk(s).rate + v0 * start_speed_part(s).rate +
               v1 * end_speed_part(s).rate;
    };
    EXPECT_DOUBLE_EQ(x(0), x0);
    EXPECT_DOUBLE_EQ(x(T), x1);
    EXPECT_DOUBLE_EQ(v(0), v0);
    EXPECT_NEAR(v(T), v1, 1e-14);
    const double h = 1e-5;
    EXPECT_NEAR((v(h) - v(0)) / h, 0, 1e-2);
    EXPECT_NEAR((v(T) - v(T - h)) / h, 0, 1e-2);
    for (double t = 0.05; t < T; t += 0.1) {
        EXPECT_NEAR((x(t + h) - x(t - h)) / (2 * h), v(t), 1e-8) << t;
    }
    // the sixth derivative of a minimum-jerk path is zero, so sixth differences vanish
    const double d = 0.02;
    for (double t = 3 * d; t < T - 3 * d; t += 0.1) {
        const double sixth = x(t - 3 * d) - 6 * x(t - 2 * d) + 15 * x(t - d) - 20 * x(t) +
                             15 * x(t + d) - 6 * x(t + 2 * d) + x(t + 3 * d);
        EXPECT_NEAR(sixth, 0, 1e-14) << t;
    }
}

std::vector<double> sine(double frequency, double rate, size_t n) {
    std::vector<double> out(n);
    for (size_t i = 0; i < n; ++i)
        out[i] = std::sin(2 * std::numbers::pi * frequency * static_cast<double>(i) / rate);
    return out;
}

/// Amplitude of a sine wave, from the root mean square of its middle half.
double amplitude(const std::vector<double>& x) {
    double square = 0;
    for (size_t i = x.size() / 4; i < 3 * x.size() / 4; ++i) square += x[i] * x[i];
    return std::sqrt(2 * square / (static_cast<double>(x.size()) / 2));
}

/// |H|^2 of a second-order Butterworth filter designed by the bilinear transform, i.e. the combined
/// gain of both passes at a frequency.
double both_passes(double frequency, double cutoff, double rate, bool high) {
    const double ratio =
        std::tan(std::numbers::pi * frequency / rate) / std::tan(std::numbers::pi * cutoff / rate);
    return 1 / (1 + std::pow(high ? 1 / ratio : ratio, 4));
}

TEST(Butterworth, HasTheMagnitudeOfItsClosedForm) {
    for (const double f : {1.0, 3.0, 5.0, 8.0, 20.0, 100.0}) {
        const auto x = sine(f, 1000, 8000);
        EXPECT_NEAR(amplitude(high_pass(x, 5, 1000)), both_passes(f, 5, 1000, true), 3e-3) << f;
        EXPECT_NEAR(amplitude(low_pass(x, 5, 1000)), both_passes(f, 5, 1000, false), 3e-3) << f;
    }
}

TEST(Butterworth, DoesNotShiftInTime) {
    const auto x = sine(2, 1000, 4000);
    const auto y = low_pass(x, 20, 1000);
    for (size_t i = 1000; i < 3000; ++i) EXPECT_NEAR(x[i], y[i], 1e-3);
}

TEST(Butterworth, LeavesAConstantAlone) {
    for (const double y : low_pass(std::vector<double>(100, 3.5), 5, 1000))
        EXPECT_NEAR(y, 3.5, 1e-12);
    for (const double y : high_pass(std::vector<double>(100, 3.5), 5, 1000))
        EXPECT_NEAR(y, 0, 1e-12);
}

TEST(Grasp, ClosedForms) {
    EXPECT_DOUBLE_EQ(series_spring_force(0.015, 300, 600), 3.0);
    EXPECT_DOUBLE_EQ(minimum_grip(0.981, 0.5), 0.981);
    EXPECT_DOUBLE_EQ(passive_stiffness(3, 1e-3), 6000);
}

TEST(Grasp, SafetyMargin) {
    const double g = 9.81;
    // grip force per digit [N] with a safety margin of 0.40 on sandpaper, suede and silk (Westling
    // and Johansson 1984)
    const double friction[] = {1.2, 0.7, 0.35};
    const double hold[][3] = {{1.4, 2.3, 4.7}, {2.7, 4.7, 9.3}, {5.4, 9.3, 18.7}};
    const double mass[] = {0.2, 0.4, 0.8};
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            EXPECT_NEAR(grip_with_margin(mass[i] * g, friction[j], 0.4), hold[i][j], 0.051);
    EXPECT_DOUBLE_EQ(safety_margin(grip_with_margin(2, 0.7, 0.3), 2, 0.7), 0.3);
    EXPECT_EQ(safety_margin(minimum_grip(2, 0.7), 2, 0.7), 0);
    EXPECT_LT(safety_margin(1, 2, 0.7), 0);
    EXPECT_DOUBLE_EQ(slip_ratio(0.5), 1);
}

}  // namespace
}  // namespace dihaptic::model::model_test
