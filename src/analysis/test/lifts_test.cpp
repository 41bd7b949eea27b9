// Tests the analysis of grip-lifts, using signals with known events: ramps in the form of half a
// cosine.
#include "analysis/lifts.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "analysis/savitzky_golay.h"
#include "base/random.h"

namespace dihaptic::analysis::lifts_test {
namespace {

constexpr double kTick = 1e-3;
constexpr double kFriction = 0.7;
const Vec3 kGravity(0, 0, -9.81);

TEST(SavitzkyGolay, HasTheDerivativesOfACubicToItsEnds) {
    std::vector<double> y;
    const auto cubic = [](double t) { return 1 + 2 * t - 3 * t * t + 4 * t * t * t; };
    for (int i = 0; i < 200; ++i) y.push_back(cubic(i * kTick));
    for (int i = 0; i < 200; ++i) {
        const double t = i * kTick;
        const auto k = static_cast<size_t>(i);
        EXPECT_NEAR(savitzky_golay(y, kTick, 0.062, 0)[k], cubic(t), 1e-12);
        EXPECT_NEAR(savitzky_golay(y, kTick, 0.062, 1)[k], 2 - 6 * t + 12 * t * t, 1e-9);
        EXPECT_NEAR(savitzky_golay(y, kTick, 0.062, 2)[k], -6 + 24 * t, 1e-6);
    }
    EXPECT_EQ(savitzky_golay(std::vector<double>(10, 1.0), kTick, 0.062, 1),
              std::vector<double>(10, 0.0));
}

/// A ramp that rises from 0 to 1 between two times.
double ramp(double t, double from, double to) {
    if (t <= from) return 0;
    if (t >= to) return 1;
    return (1 - std::cos(std::numbers::pi * (t - from) / (to - from))) / 2;
}

struct Plan {
    double touch = 0.5, onset = 0.6, lift_off = 0.9, lower = 3, replaced = 3.5, let_go = 3.8;
    double grip = 4, weight = 4, height = 0.05;
    double noise = 0;       // SD of the noise in each digit's forces [N]
    double lag = 0;         // lag of grip behind load [s]
    double slides_at = -1;  // start of a slide of 20 ms at 50 mm/s [s]; negative: no slide
    double rise = 0.4;      // duration of the upward movement [s]
    double pauses_at = -1;  // start of a pause, which triples the grip [s]; negative: none
    double unknown = 0;     // end of the missing ticks, when the object becomes known [s]
    bool stands = false;    // whether contacts with the support are recorded
    bool falls = false;
    bool slides_out = false;  // whether the object sinks while the digits stay up
};

constexpr int kSamples = 4500;

/// Appends a lift to a trace.
void add_lift(GraspTrace& trace, const Plan& plan, uint64_t seed = 1) {
    Random random(seed, "noise");
    double slid = 0;
    const auto before = static_cast<int>(trace.samples().size());
    for (int i = 0; i < kSamples; ++i) {
        const double t = i * kTick;
        frame::Frame frame;
        frame.time = (before + i) * std::chrono::milliseconds(1);
        frame.bodies.resize(2);
        frame.fingers.resize(2);
        // grip and load reach their final values together at the end of loading
        const double down = ramp(t, plan.replaced, plan.let_go);
        const double grip = (0.25 * ramp(t, plan.touch, plan.onset + plan.lag) +
                             0.75 * ramp(t, plan.onset + plan.lag, plan.lift_off + plan.lag)) *
                            plan.grip * (plan.pauses_at >= 0 && t >= plan.pauses_at ? 3 : 1) *
                            (1 - down);
        const bool paused = plan.pauses_at >= 0 && t >= plan.pauses_at;
        const double load = ramp(t, plan.onset, plan.lift_off) * plan.weight * (1 - down);
        const bool fell = plan.falls && t > 2;
        double h = plan.height * (ramp(t, plan.lift_off, plan.lift_off + plan.rise) -
                                  ramp(t, plan.lower, plan.replaced));
        double v = (plan.height * (ramp(t + kTick, plan.lift_off, plan.lift_off + plan.rise) -
                                   ramp(t + kTick, plan.lower, plan.replaced)) -
                    h) /
                   kTick;
        if (fell) {
            h = std::max(0.0, plan.height - 9.81 / 2 * (t - 2) * (t - 2));
            v = h > 0 ? -9.81 * (t - 2) : 0;
        }
        const double hand = h;
        if (plan.slides_out) h *= 1 - ramp(t, 2, 2.4);
        if (plan.slides_at >= 0 && t > plan.slides_at && t <= plan.slides_at + 0.02)
            slid += 0.05 * kTick;
        frame.bodies[1].X_WB.p = {0, 0, t < plan.unknown ? kUnmeasured : 0.02 + h};
        frame.bodies[1].v_WB = {0, 0, v};
        frame.bodies[1].awake = 1;
        if (paused && t < plan.pauses_at + 1.5 * kTick) frame.status |= kResumed;
        if (plan.stands && h <= 0) {
            frame::ContactFrame& contact = frame.contacts.emplace_back();
            contact.a = 0;
            contact.b = 1;
            contact.normal_force = 0.1;
        }
        for (int f = 0; f < 2; ++f) {
            const double side = f == 0 ? -1 : 1;
            frame.fingers[static_cast<size_t>(f)].p_WP = {0.02 * side, 0, 0.02 + hand + slid};
            if (fell) continue;
            const double n = grip + plan.noise * random.normal();
            if (n <= 0) continue;
            frame::ContactFrame& contact = frame.contacts.emplace_back();
            contact.a = 1;
            contact.b = 2 + f;
            contact.n_W = {side, 0, 0};
            contact.normal_force = n;
            // force on the finger, which the object pulls down
            contact.f_B_W = {side * n, 0, -load / 2 + plan.noise * random.normal()};
        }
        trace.add(frame);
    }
}

rows::LiftRow lift_of(const Plan& plan, uint64_t seed = 1) {
    GraspTrace trace(1, kTick);
    add_lift(trace, plan, seed);
    const double friction[] = {kFriction, kFriction};
    return find_lift(trace, kGravity, friction);
}

TEST(Lifts, EventsAndForcesAreThoseOfTheSignals) {
    const Plan plan;
    const rows::LiftRow lift = lift_of(plan);
    EXPECT_EQ(lift.mark, "complete");
    // rates are smoothed over 62 ms, so onsets are found up to half of that time too early
    EXPECT_NEAR(lift.touch, plan.touch, 0.032);
    EXPECT_NEAR(lift.load_onset, plan.onset, 0.032);
    EXPECT_NEAR(lift.preload, 0.1, 0.032);
    EXPECT_NEAR(lift.lift_off, plan.lift_off, 0.03);
    EXPECT_NEAR(lift.loading, 0.3, 0.06);
    EXPECT_NEAR(lift.replacement, plan.replaced, 0.05);
    EXPECT_NEAR(lift.release, plan.let_go, 0.04);
    EXPECT_NEAR(lift.static_grip, 4, 1e-9);
    EXPECT_NEAR(lift.static_load, 4, 1e-9);
    EXPECT_NEAR(lift.static_ratio, 1, 1e-9);
    EXPECT_NEAR(lift.safety_margin, 1 - 1 / (2 * kFriction), 1e-9);
    EXPECT_NEAR(lift.peak_grip, 4, 1e-6);
    EXPECT_NEAR(lift.peak_load, 4, 1e-6);
    // the largest rate of a half-cosine ramp is pi / 2 times its mean rate
    EXPECT_NEAR(lift.peak_load_rate, std::numbers::pi / 2 * 4 / 0.3, 0.5);
    EXPECT_NEAR(lift.peak_grip_rate, std::numbers::pi / 2 * 3 / 0.3, 0.5);
    EXPECT_NEAR(lift.height, 0.05, 1e-9);
    EXPECT_NEAR(lift.overshoot, 0, 1e-9);
    EXPECT_EQ(lift.slips, 0);
    EXPECT_TRUE(std::isnan(lift.first_slip));
}

TEST(Lifts, GripIsSeenToFollowLoad) {
    Plan plan;
    const rows::LiftRow together = lift_of(plan);
    // the grip's first rise, during the preload, extends into the first 31 ms of loading
    EXPECT_GT(together.grip_load_r, 0.88);
    EXPECT_NEAR(together.grip_load_lag, 0, 0.015);
    EXPECT_NEAR(together.slope, 0.75, 0.03);
    plan.lag = 0.04;
    const rows::LiftRow late = lift_of(plan);
    EXPECT_LT(late.grip_load_r, together.grip_load_r);
    EXPECT_NEAR(late.grip_load_lag - together.grip_load_lag, 0.04, 0.01);
    EXPECT_GT(late.grip_load_r_peak, 0.88);
}

TEST(Lifts, WhatIsNotThereIsMarked) {
    Plan plan;
    plan.grip = 0;
    EXPECT_EQ(lift_of(plan).mark, "no touch");
    plan = {};
    plan.height = 0.005;
    EXPECT_EQ(lift_of(plan).mark, "not lifted");
    plan = {};
    plan.lower = 10;
    plan.replaced = plan.let_go = 11;
    EXPECT_EQ(lift_of(plan).mark, "not put down");
    plan = {};
    plan.let_go = 60;
    EXPECT_EQ(lift_of(plan).mark, "not released");
    plan = {};
    plan.lower = 1.4;
    plan.replaced = 1.9;
    EXPECT_EQ(lift_of(plan).mark, "no hold");
    plan = {};
    plan.falls = true;
    EXPECT_EQ(lift_of(plan).mark, "dropped");
    EXPECT_EQ(find_lift(GraspTrace(1, kTick), kGravity, {}).mark, "no touch");
}

TEST(Lifts, WhatSinksThroughTheFingersIsDropped) {
    Plan plan;
    plan.stands = plan.slides_out = true;
    EXPECT_EQ(lift_of(plan).mark, "dropped");
    plan.slides_out = false;
    EXPECT_EQ(lift_of(plan).mark, "complete");
}

TEST(Lifts, OfOneTraceAreParted) {
    Plan plan;
    plan.stands = true;
    GraspTrace trace(1, kTick);
    add_lift(trace, plan);
    ASSERT_EQ(lifts_in(trace, kGravity).size(), 1u);
    Plan other = plan;
    other.lift_off = 1.2;
    other.weight = 3;
    add_lift(trace, other);
    Plan low = plan;  // the object is pressed but not lifted
    low.height = 0.005;
    add_lift(trace, low);
    const std::vector<Range> parts = lifts_in(trace, kGravity);
    ASSERT_EQ(parts.size(), 3u);
    size_t last = 0;
    const double friction[] = {kFriction, kFriction};
    std::vector<rows::LiftRow> lifts;
    for (const Range& part : parts) {
        EXPECT_EQ(part.first, last);
        last = part.last;
        lifts.push_back(find_lift(trace.part(part), kGravity, friction));
    }
    EXPECT_EQ(last, trace.samples().size());
    EXPECT_EQ(lifts[0].mark, "complete");
    EXPECT_EQ(lifts[1].mark, "complete");
    EXPECT_EQ(lifts[2].mark, "not lifted");
    EXPECT_NEAR(lifts[0].lift_off, plan.lift_off, 0.01);
    EXPECT_NEAR(lifts[1].lift_off, kSamples * kTick + other.lift_off, 0.01);
    EXPECT_NEAR(lifts[0].static_load, plan.weight, 1e-9);
    EXPECT_NEAR(lifts[1].static_load, other.weight, 1e-9);
}

TEST(Lifts, APauseBetweenThemIsOfNone) {
    Plan plan;
    plan.stands = true;
    Plan idle = plan;
    idle.grip = idle.height = 0;
    idle.pauses_at = 2;
    GraspTrace trace(1, kTick);
    for (const Plan& next : {idle, plan, idle, plan}) add_lift(trace, next);
    const std::vector<Range> parts = lifts_in(trace, kGravity);
    ASSERT_EQ(parts.size(), 2u);
    const double friction[] = {kFriction, kFriction};
    for (size_t i = 0; i < parts.size(); ++i) {
        const rows::LiftRow lift = find_lift(trace.part(parts[i]), kGravity, friction);
        EXPECT_EQ(lift.mark, "complete");
        EXPECT_NEAR(lift.lift_off,
                    static_cast<double>(2 * i + 1) * kSamples * kTick + plan.lift_off, 0.01);
    }
}

TEST(Lifts, WithNothingAfterThemAreNoMore) {
    Plan idle;
    idle.stands = true;
    GraspTrace trace(1, kTick);
    for (int i = 0; i < 2; ++i) add_lift(trace, idle);
    idle.grip = idle.height = 0;
    add_lift(trace, idle);
    EXPECT_EQ(lifts_in(trace, kGravity).size(), 2u);
    GraspTrace nothing(1, kTick);
    add_lift(nothing, idle);
    EXPECT_EQ(lifts_in(nothing, kGravity).size(), 1u);
    EXPECT_EQ(lifts_in(GraspTrace(1, kTick), kGravity).size(), 1u);
}

TEST(Lifts, ASlowOneLeavesItsSupportBeforeItIsFast) {
    Plan plan;
    plan.height = 0.012;
    plan.rise = 1.9;  // no faster than 1 cm/s
    plan.lift_off = 0.9;
    plan.stands = true;
    EXPECT_NEAR(lift_of(plan).lift_off, plan.lift_off, 0.01);
    EXPECT_LT(lift_of(plan).touch, lift_of(plan).lift_off);
}

TEST(Lifts, OneWithAPauseIsMarkedAndHasNoFigures) {
    Plan plan;
    plan.pauses_at = 2;
    const rows::LiftRow lift = lift_of(plan);
    EXPECT_EQ(lift.mark, "paused");
    EXPECT_TRUE(std::isnan(lift.peak_grip));
    EXPECT_TRUE(std::isnan(lift.touch));
}

TEST(Lifts, OneThatBeginsWhereTicksAreMissingIsMeasuredFromWhereItIsKnown) {
    Plan plan;
    plan.unknown = 0.03;
    EXPECT_EQ(lift_of(plan).mark, "complete");
    EXPECT_NEAR(lift_of(plan).height, plan.height, 1e-3);
    plan.unknown = 9;
    EXPECT_EQ(lift_of(plan).mark, "place not known");
}

TEST(Lifts, ASlipIsCountedAndItsTimeIsTold) {
    Plan plan;
    plan.slides_at = 1.5;
    const rows::LiftRow lift = lift_of(plan);
    EXPECT_EQ(lift.slips, 2);  // one slip of each digit
    EXPECT_NEAR(lift.slip, 1e-3, 1e-4);
    EXPECT_NEAR(lift.first_slip, 1.5, 0.002);
    EXPECT_TRUE(lift.complete());
}

TEST(Lifts, SurviveNoise) {
    int complete = 0;
    for (uint64_t seed = 1; seed <= 40; ++seed) {
        Plan plan;
        plan.noise = 0.02;
        const rows::LiftRow lift = lift_of(plan, seed);
        complete += lift.complete();
        EXPECT_NEAR(lift.touch, plan.touch, 0.04) << seed;
        EXPECT_NEAR(lift.load_onset, plan.onset, 0.05) << seed;
        EXPECT_NEAR(lift.lift_off, plan.lift_off, 0.04) << seed;
    }
    EXPECT_GE(complete, 38);
}

}  // namespace
}  // namespace dihaptic::analysis::lifts_test
