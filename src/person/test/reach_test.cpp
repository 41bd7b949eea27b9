// Tests the reaches of simulated people in the whole program: they see and plan reaches, the
// simulated hand makes them, and its path is measured.
#include <gtest/gtest.h>

#include "analysis/adaptation.h"
#include "person/test/reaches.h"

namespace dihaptic::person::reach_test {
namespace {

TEST(Reaches, OfAPersonWithoutNoiseFollowTheTwoRateModelIncludingCatchTrialsAndTheClamp) {
    Sitting sitting("rotation-reversal");
    sitting.end_with("  blocks:", R"(  blocks:
    - { name: baseline, kind: baseline, repeats: 4 }
    - { name: rotation, kind: perturbed, perturb: rotation, repeats: 40, insert: [{ kind: catch, count: 4 }] }
    - { name: reversal, kind: perturbed, perturb: reversal, repeats: 8 }
    - { name: clamp, kind: visual_clamp, perturb: clamp, repeats: 24 }
    - { name: washout, kind: washout, repeats: 8 }
)");
    session::Plan plan = sitting.plan();
    Traits traits = median_person(Objects::device);
    traits.online_correction = traits.fast_limit = traits.slow_limit = 0;
    traits.fast_retention = 0.52;
    traits.fast_learning = 0.35;
    traits.slow_retention = 0.9999;
    traits.slow_learning = 0.03;
    sit_down(plan, traits);
    const Curve curve = reaches(plan);
    const std::vector<double> x = model::compensation(traits.rotation(), schedule(plan));
    for (size_t i = 0; i < x.size(); ++i) {
        EXPECT_NEAR(curve.hand[i], x[i], 0.6) << i;
        EXPECT_EQ(curve.outcome[i], "reached") << i;
        // a catch trial shows what was learned, without any perturbation
        if (plan.task->trials[i].kind == task::TrialKind::catch_trial) {
            EXPECT_GT(curve.hand[i], 5);
            EXPECT_NEAR(curve.shown[i], -curve.hand[i], 0.6);
        }
    }
    // spontaneous recovery: in the clamp, what was learned first returns
    const size_t clamp = 4 + 44 + 8;
    EXPECT_GT(curve.hand[clamp + 12], curve.hand[clamp] + 3);
    EXPECT_GT(curve.hand[clamp + 12], 2);
    // the washout begins with an after-effect, which then decays
    const size_t washout = clamp + 24;
    EXPECT_GT(curve.hand[washout], curve.hand[washout + 7] + 1);
}

TEST(Reaches, OfAPersonWhoLearnsHardlyMoreFromLargeErrorsFollowThatModel) {
    Sitting sitting("rotation-reversal");
    sitting.end_with("  blocks:", R"(  blocks:
    - { name: rotation, kind: perturbed, perturb: rotation, repeats: 20 }
    - { name: reversal, kind: perturbed, perturb: reversal, repeats: 12 }
)");
    session::Plan plan = sitting.plan();
    Traits traits = median_person(Objects::device);
    traits.online_correction = 0;
    sit_down(plan, traits);
    const Curve curve = reaches(plan);
    model::TwoRateState x;
    const auto learns = [](double error, double limit) { return limit * std::tanh(error / limit); };
    const std::vector<model::AdaptationTrial> trials = schedule(plan);
    for (size_t i = 0; i < trials.size(); ++i) {
        EXPECT_NEAR(curve.hand[i], x.output(), 0.6) << i;
        const double e = adaptation_error(trials[i], x.output());
        x = {next(traits.rotation().fast, x.fast, learns(e, traits.fast_limit / kDegree)),
             next(traits.rotation().slow, x.slow, learns(e, traits.slow_limit / kDegree))};
    }
}

TEST(Reaches, OverSeveralStatesAreLearnedAsInOne) {
    const auto curve = [](const std::string& reach) {
        Sitting sitting("rotation-reversal");
        sitting.end_with("    - name: reach\n", reach + R"(
    - name: arrived
      show: [target]
      exits: [{ when: time, after_s: 0.1, outcome: reached }]
  reach: { from: start, to: target, during: reach, distance_mm: 65, axis: [0, 0, 1] }
  blocks:
    - { name: baseline, kind: baseline, repeats: 2 }
    - { name: rotation, kind: perturbed, perturb: rotation, repeats: 20 }
    - { name: washout, kind: washout, repeats: 4 }
)");
        session::Plan plan = sitting.plan();
        sit_down(plan, median_person(Objects::device));
        return reaches(plan).hand;
    };
    const auto one = curve(R"(
    - name: reach
      show: [target]
      exits: [{ when: outside, region: shell, to: arrived }, { when: time, after_s: 2, outcome: too slow }]
      simulated_hand: [{ duration_s: 0.7, reach: target }]
)");
    // a timed reach has three states, of which the later two change only the message
    const auto three = curve(R"(
    - name: reach
      show: [target]
      exits: [{ when: outside, region: shell, outcome: too fast }, { when: time, after_s: 0.45, to: in time }]
      simulated_hand: [{ duration_s: 0.7, reach: target }]
    - name: in time
      show: [target]
      exits: [{ when: outside, region: shell, to: arrived }, { when: time, after_s: 0.1, to: late }]
    - name: late
      show: [target]
      exits: [{ when: outside, region: shell, to: arrived }, { when: time, after_s: 2, outcome: too slow }]
)");
    ASSERT_EQ(one.size(), three.size());
    for (size_t i = 0; i < one.size(); ++i) EXPECT_NEAR(three[i], one[i], 0.5) << i;
    EXPECT_GT(one[21], 15);
    EXPECT_GT(one[22], 8);
}

/// How many of the intervals of a fit to a noisy person's reaches contain the person's true rate,
/// of four. Checks that the fit is as good as the truth, and near it.
int rates_given_back(const std::string& id) {
    SCOPED_TRACE(id);
    session::Plan plan = Sitting("rotation-reversal").plan();
    // noise, and rates that a fit can tell apart; some people drawn learn at one rate only
    Traits traits = median_person(Objects::device);
    traits.id = id;
    traits.fast_retention = 0.62;
    traits.fast_learning = 0.26;
    traits.slow_retention = 0.999;
    traits.slow_learning = 0.031;
    traits.direction_noise = 4 * kDegree;
    traits.visual_noise = 1e-3;
    traits.extent_noise = 0.04;
    traits.online_correction = traits.fast_limit = traits.slow_limit = 0;
    sit_down(plan, traits);
    const Curve curve = reaches(plan);
    const auto trials = schedule(plan);
    const analysis::TwoRateFit fit = analysis::fit_two_rate(curve.hand, trials);
    const std::vector<double> truth = model::compensation(traits.rotation(), trials);
    double square = 0;  // sum of squared residuals at the true parameters
    for (size_t i = 0; i < truth.size(); ++i) square += std::pow(curve.hand[i] - truth[i], 2);
    EXPECT_LE(fit.mean_square, square / static_cast<double>(truth.size()));
    double off = 0;
    for (size_t i = 0; i < truth.size(); ++i) off += std::pow(fit.predicted[i] - truth[i], 2);
    off = std::sqrt(off / static_cast<double>(truth.size()));
    // noise is also learned, so the true curve is known only up to its own random changes
    EXPECT_LT(off, 0.5 * fit.residual_sd);
    EXPECT_NEAR(fit.residual_sd, traits.direction_noise / kDegree, 1.5);
    const auto within = [](double value, const analysis::Interval& interval) {
        return value >= interval.low && value <= interval.high ? 1 : 0;
    };
    return within(traits.fast_learning, fit.learning_fast) +
           within(traits.slow_learning, fit.learning_slow) +
           within(traits.fast_retention, fit.retention_fast) +
           within(traits.slow_retention, fit.retention_slow);
}

TEST(Reaches, OfNoisyPeopleGiveBackTheirRates) {
    // of twelve intervals of 95 %, at least ten contain the truth in 98 of 100 such tests
    EXPECT_GE(rates_given_back("P01") + rates_given_back("P02") + rates_given_back("P03"), 10);
}

TEST(Reaches, AreMendedInPartOnceTheyAreSeenToGoWrong) {
    Sitting sitting("rotation-reversal");
    sitting.end_with("  blocks:", R"(  blocks:
    - { name: rotation, kind: perturbed, perturb: rotation, repeats: 1 }
)");
    session::Plan plan = sitting.plan();
    sit_down(plan, median_person(Objects::device));
    const Curve curve = reaches(plan);
    EXPECT_GT(curve.hand[0], 1);  // people have 3.5 degrees
    EXPECT_LT(curve.hand[0], 6);
}

TEST(Reaches, OfNoLearnerStayWrong) {
    Sitting sitting("rotation-reversal");
    sitting.end_with("  blocks:", R"(  blocks:
    - { name: rotation, kind: perturbed, perturb: rotation, repeats: 12 }
)");
    session::Plan plan = sitting.plan();
    Traits traits = median_person(Objects::device);
    traits.fast_learning = traits.slow_learning = 0;
    traits.online_correction = 0;
    sit_down(plan, traits);
    const Curve curve = reaches(plan);
    for (size_t i = 0; i < curve.hand.size(); ++i) {
        EXPECT_NEAR(curve.hand[i], 0, 0.6);
        EXPECT_NEAR(curve.shown[i], kRotation, 0.6);
    }
}

TEST(Reaches, BeginAReactionTimeAfterTheTargetAndLastAsTheTempoSays) {
    Sitting sitting("rotation-reversal");
    sitting.end_with("  blocks:", R"(  blocks:
    - { name: baseline, kind: baseline, repeats: 3 }
)");
    session::Plan plan = sitting.plan();
    Traits traits = median_person(Objects::device);
    traits.tempo = 0.8;
    sit_down(plan, traits);
    std::vector<double> shown(4, -1);
    std::vector<double> begun(4, -1);
    std::vector<double> over(4, -1);
    run_trials(plan, [&](const frame::Frame& frame) {
        if (frame.phase < 2 || frame.trial < 1) return;
        const auto i = static_cast<size_t>(frame.trial);
        const double now = seconds(frame.time);
        const double way = (frame.fingers[0].p_WH - Vec3(0, -0.04, 0.12)).norm();
        if (shown[i] < 0) shown[i] = now;
        // a minimum-jerk movement covers 1 % of the path in 0.101 of its time, and 50 % in 0.5
        if (begun[i] < 0 && way > 1e-3) begun[i] = now;
        if (over[i] < 0 && way > 50e-3) over[i] = now;
    });
    for (size_t i = 1; i < 4; ++i) {
        const double lag = 0.01;  // time by which the handle lags behind its target [s]
        EXPECT_NEAR(begun[i] - shown[i], traits.reaction_time + 0.101 * 0.8 * 0.7 + lag, 0.01);
        EXPECT_NEAR(over[i] - shown[i], traits.reaction_time + 0.5 * 0.8 * 0.7 + lag, 0.01);
    }
}

TEST(Carries, OfAPersonWithoutNoiseFollowTheSingleRateModelAsTheirDisplayIsScaled) {
    Sitting sitting("scaling-adaptation");
    sitting.end_with("  blocks:", R"(  blocks:
    - { name: baseline, kind: baseline, repeats: 3 }
    - { name: scaled, kind: perturbed, perturb: scaled, repeats: 10 }
    - { name: washout, kind: washout, repeats: 4 }
)");
    session::Plan plan = sitting.plan();
    const Traits traits = median_person(Objects::device);
    sit_down(plan, traits);
    session::RunOptions options;
    options.out = sitting.folder.file("sessions");
    const session::Recorded result = session::record(plan, options, kGoOn);
    const auto curves = analysis::adaptation_curves(rows::TrialFile(result.folder + "/trials.csv"));
    ASSERT_EQ(curves.size(), 3u);  // one for each of x, y and z
    const double f = 100 * std::log(1.4);
    for (const analysis::AdaptationCurve& curve : curves) {
        SCOPED_TRACE(curve.round);
        EXPECT_EQ(curve.unit, "%");
        EXPECT_NEAR(curve.perturbation(), f, 3);
        ASSERT_EQ(curve.trials.size(), 17u);
        const double baseline = curve.windows().baseline.mean;
        EXPECT_NEAR(baseline, 0, 5);
        const std::vector<double> x =
            model::compensation(model::TwoRate{traits.gain(), {0, 0}}, curve.schedule());
        for (size_t i = 0; i < x.size(); ++i)
            EXPECT_NEAR(curve.trials[i].compensation - baseline, x[i], 3) << i;
        EXPECT_GT(curve.trials[12].compensation, 0.7 * f);
        EXPECT_GT(curve.trials[13].compensation, curve.trials[16].compensation + 5);
    }
}

}  // namespace
}  // namespace dihaptic::person::reach_test
