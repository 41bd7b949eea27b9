// Reaches for testing the measures: a closed-form reach, and variants of it that are spoilt in
// random ways.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>

#include "analysis/measures/measures.h"
#include "base/figure.h"

namespace dihaptic::analysis::measures_test {

inline constexpr double kTick = 1e-3;

/// A minimum-jerk reach along x, 0.1 m in 0.5 s, which begins 0.3 s after the go signal. The hand
/// is still in phase 1, for a second before the go signal, and after the reach until the end of
/// phase 2.
struct Reach {
    Attempt attempt;
    task::Movement options;
    MeasurePhases phases{{2}, 2, -1};
    double bow = 0;  ///< lateral displacement at the end [m]; before that, proportional to the
                     ///< distance covered

    explicit Reach(double lateral = 0, double last = 1.2) : bow(lateral) {
        attempt.plan.to_W = {0.1, 0, 0};
        attempt.plan.ideal << 0, -15, 0, 15, 0, 0, 0, 0, 0;
        attempt.share = 1;
        options.onset_speed = 0.05;
        for (int i = 0; i * kTick < 1 + last; ++i) {
            const double t = i * kTick - 1.3;
            MotionSample s{
                i * kTick, i < 1000 ? 1 : 2, Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), 2.0, true};
            const double u = std::clamp(t / 0.5, 0.0, 1.0);
            const double way = 0.1 * (10 * u * u * u - 15 * std::pow(u, 4) + 6 * std::pow(u, 5));
            const double speed = 0.2 * 30 * u * u * (1 - u) * (1 - u);
            s.p_W = {way, bow * way / 0.1, 0};
            s.v_W = {speed, bow * speed / 0.1, 0};
            s.f_W = {0, -0.6 * 15 * speed + 0.2, 0};
            attempt.samples.push_back(s);
        }
    }
    MeasuredValues take(const char* name) const {
        return AttemptMeasures(attempt, options, phases, kTick).measure(*task::measure_row(name));
    }
    double value(const char* name, size_t column = 0) const { return take(name).values[column]; }
};

/// Returns a reach with a random pathology, or none: a swing back, a jump at onset, no movement,
/// half a reach, a hand that has to wait at a wall, the wrong direction, noise, or a slow start.
inline Reach spoilt(std::mt19937& random) {
    std::uniform_real_distribution<double> unit(0, 1);
    const auto chance = [&](double share) { return unit(random) < share; };
    Reach reach;
    reach.attempt.plan.channel = chance(0.5) ? 1 : 0;
    if (reach.attempt.plan.channel == 1) reach.attempt.plan.field_share = kUnmeasured;
    const double size = chance(0.2) ? 0 : chance(0.3) ? unit(random) : 1;
    const double turn = chance(0.2) ? 2 * std::numbers::pi * unit(random) : 0.1 * unit(random);
    const double swing = chance(0.4) ? 0.2 * (unit(random) - 0.5) : 0;
    const double noise = chance(0.5) ? 0.02 * unit(random) : 0;
    const auto thrown = static_cast<size_t>(1000 + 400 * unit(random));
    const double throws = chance(0.3) ? 3 * unit(random) : 0;
    const double gain = chance(0.1) ? 1000 * unit(random) : 2 * unit(random);
    const double aside = chance(0.1) ? 50 * unit(random) : unit(random);
    std::normal_distribution<double> shakes(0, 1);
    for (size_t i = 0; i < reach.attempt.samples.size(); ++i) {
        MotionSample& s = reach.attempt.samples[i];
        const double u = std::clamp((s.time - 1.3) / 0.5, 0.0, 1.0);
        const Vec3 p = size * s.p_W;
        const Vec3 v = size * s.v_W;
        const Eigen::AngleAxisd R(turn, Vec3::UnitZ());
        s.p_W = R * p + Vec3(0, swing * std::sin(2 * std::numbers::pi * u), 0);
        s.v_W = R * v + noise * Vec3(shakes(random), shakes(random), 0);
        if (i >= thrown && i < thrown + 30) s.v_W.y() += throws;
        s.f_W = {0, -gain * 15 * v.x() + aside * shakes(random), 0};
        if (chance(1e-5)) s.continues = false;
    }
    return reach;
}

/// Expects that every measure of `count` spoilt reaches either is within its plausible range or is
/// missing with a reason.
inline void expect_sense_of_spoilt(int count) {
    std::mt19937 random(1);
    int measured = 0;
    int missing = 0;
    for (int i = 0; i < count; ++i) {
        const Reach reach = spoilt(random);
        const AttemptMeasures all(reach.attempt, reach.options, reach.phases, kTick);
        for (const task::MeasureRow& row : task::kMeasureTable) {
            if (row.needs & (task::MeasureRow::grip | task::MeasureRow::step)) continue;
            const MeasuredValues of = all.measure(row);
            for (size_t k = 0; k < of.values.size(); ++k) {
                const task::MeasureColumn& column = row.columns[k];
                const double value = of.values[k] * figure_form(column.name, column.unit).scale;
                const bool known_in_channel = std::string(column.name) == "field_share";
                if (std::isnan(value)) {
                    ++missing;
                    EXPECT_TRUE(!of.why.empty() || known_in_channel) << row.name;
                } else {
                    ++measured;
                    EXPECT_GE(value, column.least) << row.name;
                    EXPECT_LE(value, column.most) << row.name;
                }
            }
        }
    }
    EXPECT_GT(measured, 5 * count);
    EXPECT_GT(missing, 2 * count);
}

}  // namespace dihaptic::analysis::measures_test
