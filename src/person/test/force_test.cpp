// Tests that simulated people learn force fields as forces: how they press against a channel, how
// closely this follows the adaptation model, and that vision and force are not confused.
#include <gtest/gtest.h>

#include "analysis/fits/two_rate_fit.h"
#include "base/number.h"
#include "person/test/forces.h"

namespace dihaptic::person::force_test {
namespace {

Traits steady_person() {
    Traits out = median_person(Objects::device);
    out.online_correction = out.fast_limit = out.slow_limit = 0;
    out.fast_learning = 0.35;
    return out;
}

std::vector<ForceReach> reaches_of(const Traits& traits, const std::string& blocks,
                                   double* yields = nullptr) {
    Sitting sitting("rotation-reversal");
    sitting.end_with("  perturbations:", force_task(blocks));
    session::Plan plan = sitting.plan();
    sit_down(plan, traits);
    if (yields != nullptr) *yields = yielding(plan);
    return force_reaches(plan);
}

std::vector<double> two_rate_index(const Traits& traits, const std::vector<ForceReach>& reaches,
                                   double yields) {
    return model_index(
        traits.force(), model::TwoRateState{}, [](const auto& s) { return s.output(); }, reaches,
        yields);
}

constexpr const char* kSchedule = R"(
    - { name: no field, kind: baseline, conditions: [away], repeats: 6, insert: [{ kind: force_channel, perturb: channel, count: 2 }] }
    - { name: curl, kind: perturbed, conditions: [away], perturb: curl, repeats: 42, insert: [{ kind: force_channel, perturb: channel, count: 6 }, { kind: catch, count: 3 }] }
    - { name: channel, kind: force_channel, conditions: [away], perturb: channel, repeats: 8 }
    - { name: washout, kind: washout, conditions: [away], repeats: 6, insert: [{ kind: force_channel, perturb: channel, count: 2 }] }
)";

TEST(Forces, OfAPersonWithoutNoisePressAgainstAChannelAsTheTwoRateModelSays) {
    const Traits traits = steady_person();
    double yields = 0;
    const auto reaches = reaches_of(traits, kSchedule, &yields);
    const auto x = two_rate_index(traits, reaches, yields);
    double most = 0;
    double before = NAN;  // deviation in the first reach in the field
    for (size_t i = 0; i < reaches.size(); ++i) {
        const ForceReach& reach = reaches[i];
        SCOPED_TRACE(number_text(i) + " " + reach.perturbed);
        most = std::max(most, x[i]);
        if (reach.perturbed == "channel") {
            EXPECT_NEAR(reach.index, x[i], 0.04);
            // the force must follow the time course of the speed, unlike when the hand aims
            // elsewhere
            if (x[i] > 0.3) {
                EXPECT_GT(reach.likeness, 0.97);
            }
            EXPECT_LT(std::abs(reach.deviation), 3e-3);
        }
        if (reach.perturbed == "curl" && std::isnan(before)) before = reach.deviation;
        // a catch trial shows an after-effect in the opposite direction
        if (reach.perturbed.empty() && x[i] > 0.3) {
            EXPECT_LT(reach.deviation, -3e-3);
        }
    }
    EXPECT_GT(before, 8e-3);
    EXPECT_GT(most, 0.5);
}

TEST(Forces, AreLearnedAsForcesAndRotationsAsRotations) {
    const Vec3 d = Vec3::UnitY();
    const auto learned = [&](const std::string& perturb) {
        Sitting sitting("rotation-reversal");
        sitting.end_with("  perturbations:",
                         force_task("    - { name: some, kind: perturbed, conditions: [away], "
                                    "perturb: " +
                                    perturb + ", repeats: 20 }\n"));
        session::Plan plan = sitting.plan();
        const Traits traits = steady_person();
        sit_down(plan, traits);
        run_trials(plan, [](const frame::Frame&) {});
        const auto& person = static_cast<const Person&>(*plan.seeing);
        return std::pair(person.rotations(1).expected(d), person.forces(1).expected(d));
    };
    const std::vector<model::AdaptationTrial> trials(21, {1, false});
    const Traits traits = steady_person();
    const double of_force = model::compensation(traits.force(), trials).back();
    const double of_turn = model::compensation(traits.rotation(), trials).back() * 30 * kDegree;

    const auto [no_turn, curl] = learned("curl");
    EXPECT_LT(no_turn.norm(), 1 * kDegree);
    EXPECT_NEAR(curl.x(), -kCurl * of_force, 0.05 * kCurl);
    EXPECT_LT(curl.tail<2>().norm(), 0.05 * kCurl);

    // people learn a field along the movement as a force along the movement
    const auto [no_turn_either, viscous] = learned("viscous");
    EXPECT_LT(no_turn_either.norm(), 1 * kDegree);
    EXPECT_NEAR(viscous.y(), -kCurl * of_force, 0.1 * kCurl);
    EXPECT_NEAR(viscous.x(), 0, 0.02 * kCurl);

    const auto [turn, no_force] = learned("rotation");
    EXPECT_NEAR(turn.z(), of_turn, 1 * kDegree);
    EXPECT_EQ(no_force, Vec3::Zero());

    const auto [both_turn, both_force] = learned("turned curl");
    EXPECT_NEAR(both_turn.z(), of_turn, 2 * kDegree);
    // after learning, the hand moves to the right of the straight path, so the direction of the
    // force that pushes it is rotated, too
    EXPECT_NEAR(both_force.norm(), kCurl * of_force, 0.15 * kCurl);
}

TEST(Forces, GeneraliseByAGaussianOfTheDirection) {
    const Traits traits = steady_person();
    double yields = 0;
    const auto reaches = reaches_of(traits, R"(
    - { name: curl, kind: perturbed, conditions: [away], perturb: curl, repeats: 30 }
    - { name: turned, kind: force_channel, conditions: [turned], perturb: channel, repeats: 1 }
    - { name: away, kind: force_channel, conditions: [away], perturb: channel, repeats: 1 }
)",
                                    &yields);
    const auto x = two_rate_index(traits, reaches, yields);
    EXPECT_NEAR(reaches[31].index, x[31], 0.04);
    // the learned push keeps its direction in space, so only part of it is across the turned path
    const double angle = kTurnedTarget * kDegree;
    const double share =
        std::exp(-std::pow(angle / traits.force_generalisation, 2) / 2) * std::cos(angle);
    EXPECT_NEAR(reaches[30].index, share * x[30], 0.04);
    EXPECT_GT(reaches[30].index, 0.1);
}

/// A person whose reaches vary. `noise`: SD of their direction [rad].
Traits noisy_person(double noise) {
    Traits out = steady_person();
    out.id = "P01";
    out.direction_noise = noise;
    out.visual_noise = 5e-4;
    out.extent_noise = 0.04;
    out.tempo_noise = 0.07;
    return out;
}

/// One trial in eight is a force-channel trial; at the end, all trials are.
constexpr const char* kLongSchedule = R"(
    - { name: no field, kind: baseline, conditions: [away], repeats: 14, insert: [{ kind: force_channel, perturb: channel, count: 2 }] }
    - { name: curl, kind: perturbed, conditions: [away], perturb: curl, repeats: 140, insert: [{ kind: force_channel, perturb: channel, count: 20 }] }
    - { name: reversed, kind: perturbed, conditions: [away], perturb: reversed, repeats: 14, insert: [{ kind: force_channel, perturb: channel, count: 4 }] }
    - { name: channel, kind: force_channel, conditions: [away], perturb: channel, repeats: 30 }
)";

struct Measured {
    std::vector<double> index;  ///< NaN except in channels; corrected for the yielding of walls
    std::vector<model::AdaptationTrial> trials;
};

Measured measured(const Traits& traits) {
    double yields = 0;
    const auto reaches = reaches_of(traits, kLongSchedule, &yields);
    Measured out;
    for (const ForceReach& reach : reaches) {
        const bool channel = reach.perturbed == "channel";
        out.index.push_back(channel ? reach.index / (1 - yields) : NAN);
        const double f = reach.perturbed == "curl" ? 1 : reach.perturbed == "reversed" ? -1 : 0;
        out.trials.push_back({f, channel});
    }
    return out;
}

/// Whether an interval gives back a rate, or a retention, of which it is the forgetting that
/// counts. Channels are so steady that some intervals are narrower than what the walls' yielding
/// and the course of the push make of a rate, about a tenth.
bool gives_back(double rate, const analysis::Interval& interval) {
    const double spare = 0.1 * std::min(rate, 1 - rate);
    return rate >= interval.low - spare && rate <= interval.high + spare;
}

TEST(Forces, OfANoisyPersonGiveBackTheRatesOfBothProcesses) {
    Traits traits = noisy_person(1.5 * kDegree);
    traits.force_slow_learning = 0.03;
    const Measured all = measured(traits);
    const analysis::TwoRateFit fit = analysis::fit_two_rate(all.index, all.trials);
    EXPECT_TRUE(gives_back(traits.force_fast_retention, fit.retention_fast))
        << fit.retention_fast.low << " to " << fit.retention_fast.high;
    EXPECT_TRUE(gives_back(traits.force_fast_learning, fit.learning_fast))
        << fit.learning_fast.low << " to " << fit.learning_fast.high;
    EXPECT_TRUE(gives_back(traits.force_slow_retention, fit.retention_slow))
        << fit.retention_slow.low << " to " << fit.retention_slow.high;
    EXPECT_TRUE(gives_back(traits.force_slow_learning, fit.learning_slow))
        << fit.learning_slow.low << " to " << fit.learning_slow.high;
    const std::vector<double> truth = model::compensation(traits.force(), all.trials);
    double off = 0;
    for (size_t i = 0; i < truth.size(); ++i) off += std::pow(fit.predicted[i] - truth[i], 2);
    off = std::sqrt(off / static_cast<double>(truth.size()));
    EXPECT_LT(off, 0.08);
    EXPECT_LT(fit.residual_sd, 0.2);
}

TEST(Forces, OfANoisyPersonWithOneProcessGiveBackItsRates) {
    Traits traits = noisy_person(4.3 * kDegree);
    traits.force_slow_learning = 0;
    traits.force_fast_retention = 0.97;
    traits.force_fast_learning = 0.1;
    const Measured all = measured(traits);
    const analysis::SingleRateFit fit = analysis::fit_single_rate(all.index, all.trials);
    EXPECT_TRUE(gives_back(traits.force_fast_retention, fit.retention))
        << fit.retention.low << " to " << fit.retention.high;
    EXPECT_TRUE(gives_back(traits.force_fast_learning, fit.learning))
        << fit.learning.low << " to " << fit.learning.high;
}

TEST(Forces, OfNoiseInAChannelAreThoseThatMoveAnArm) {
    // ten people of Avraham et al. (2017) had an SD of 0.05 of a field of 6 N*s/m; hands that noise
    // displaces against their stiffness would have 0.1
    double squares = 0;
    double n = 0;
    for (const ForceReach& reach : reaches_of(noisy_person(4.3 * kDegree), R"(
    - { name: channel, kind: force_channel, conditions: [away], perturb: channel, repeats: 40 }
)")) {
        squares += reach.index * reach.index;
        ++n;
    }
    const double of_people = 0.05 * 6 / kCurl;
    EXPECT_GT(std::sqrt(squares / n), 0.7 * of_people);
    EXPECT_LT(std::sqrt(squares / n), 1.4 * of_people);
}

TEST(Forces, ThatComeLateAreExpectedLate) {
    Sitting sitting("rotation-reversal");
    sitting.end_with("  perturbations:", force_task(R"(
    - { name: curl, kind: perturbed, conditions: [away], perturb: curl, repeats: 60 }
)"));
    sitting.replace("axis: [0, 0, 1], damping_Ns_m: 13 }",
                    "axis: [0, 0, 1], damping_Ns_m: 13, delay_ms: 70 }");
    session::Plan plan = sitting.plan();
    sit_down(plan, steady_person());
    run_trials(plan, [](const frame::Frame&) {});
    const auto& person = static_cast<const Person&>(*plan.seeing);
    EXPECT_NEAR(person.forces(1).lag(), 0.07, 0.02);
}

TEST(Forces, OfNoLearnerAreNone) {
    Traits traits = noisy_person(1.5 * kDegree);
    traits.force_fast_learning = traits.force_slow_learning = 0;
    // without this, the hand would drift because of what movements back to the start seem to teach
    traits.fast_learning = traits.slow_learning = 0;
    double sum = 0, squares = 0, n = 0;
    for (const double index : measured(traits).index) {
        if (std::isnan(index)) continue;
        sum += index;
        squares += index * index;
        ++n;
    }
    const double mean = sum / n;
    const double error = std::sqrt((squares / n - mean * mean) / (n - 1));
    EXPECT_LT(std::abs(mean), 2 * error);
    EXPECT_LT(error, 0.05);
}

}  // namespace
}  // namespace dihaptic::person::force_test
