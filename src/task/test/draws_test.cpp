// Tests the draws of trials: their distributions are compared with closed forms, and the seed must
// determine their values.
#include "task/file/draws.h"
#include "base/number.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include "base/table.h"
#include "scene/scene.h"
#include "task/plan/task_plan.h"
#include "task/plan/trials.h"
#include "testing/files.h"

namespace dihaptic::task::draws_test {
namespace {

constexpr size_t kTrials = 10000;
constexpr double kLeastP = 0.01;

std::vector<double> drawn_10000(const DrawSpec& draw, uint64_t seed) {
    const std::vector<int> blocks(kTrials, 1);
    return drawn(draw, blocks, 7, seed);
}

/// Returns the probability that a random sample is at least as far from the distribution as this
/// sample, by the Kolmogorov-Smirnov test; the sample size enters as in Stephens (1970).
template <class Cdf>
double p_of(std::vector<double> sample, const Cdf& cdf) {
    std::sort(sample.begin(), sample.end());
    const auto n = static_cast<double>(sample.size());
    double distance = 0;
    for (size_t i = 0; i < sample.size(); ++i) {
        const double f = cdf(sample[i]);
        distance = std::max(
            {distance, f - static_cast<double>(i) / n, static_cast<double>(i + 1) / n - f});
    }
    const double x = (std::sqrt(n) + 0.12 + 0.11 / std::sqrt(n)) * distance;
    double p = 0;
    for (int k = 1; k < 100; ++k) p += (k % 2 == 1 ? 2 : -2) * std::exp(-2 * k * k * x * x);
    return p;
}

DrawSpec foreperiod() {
    DrawSpec draw;
    draw.name = "wait_s";
    draw.exponential = ExponentialDraw{0.5, 0.3, 2};
    return draw;
}

double foreperiod_cdf(double t) {
    return (1 - std::exp(-(t - 0.3) / 0.5)) / (1 - std::exp(-1.7 / 0.5));
}

TEST(Draws, ForeperiodsAreTruncatedExponentials) {
    for (const uint64_t seed : {1, 2, 3, 4, 5}) {
        const std::vector<double> waits = drawn_10000(foreperiod(), seed);
        EXPECT_GT(p_of(waits, foreperiod_cdf), kLeastP) << seed;
        EXPECT_GE(*std::min_element(waits.begin(), waits.end()), 0.3);
        EXPECT_LE(*std::max_element(waits.begin(), waits.end()), 2);
    }
}

TEST(Draws, TenThousandForeperiodsAreFrozenInTheListAndRepeatedByTheSeed) {
    Diagnostics diagnostics;
    scene::Scene scene;
    read_fields(scene, parse_yaml("bodies: [{ name: floor, shape: plane, fixed: yes }]", "s.yaml"),
                diagnostics);
    Task task;
    read_fields(
        task,
        parse_yaml("draws: [{ name: wait_s, exponential: { mean: 0.5, from: 0.3, to: 2 } }]\n"
                   "states: [{ name: wait, exits: [{ when: time, after_s: wait, "
                   "outcome: done }] }]\n"
                   "blocks: [{ name: only, repeats: 10000 }]\n",
                   "t.yaml"),
        diagnostics);
    const TaskPlan plan = plan_task(task, scene, diagnostics);
    diagnostics.throw_if_errors();
    const testing::TemporaryFolder folder;
    const auto list = [&](uint64_t seed) {
        const std::string file = folder.file("trial-list.csv");
        write_csv(trial_list(plan.task, make_trials(plan.task, 7, seed)), file);
        return testing::read_file(file);
    };
    EXPECT_NE(list(1), list(2));
    EXPECT_EQ(list(1), list(1));
    std::vector<double> waits;  // values read from the list, as in a resumed session
    for (const Trial& trial : read_trial_list(plan.task, folder.file("trial-list.csv")))
        waits.push_back(trial.draws.at(0));
    ASSERT_EQ(waits.size(), kTrials);
    EXPECT_GT(p_of(waits, foreperiod_cdf), kLeastP);
}

TEST(Draws, TheHazardOfAForeperiodIsFlat) {
    DrawSpec draw = foreperiod();
    draw.exponential->to.reset();
    const std::vector<double> waits = drawn_10000(draw, 11);
    for (const double from : {0.3, 0.6, 0.9, 1.2}) {
        const auto later = [&](double t) {
            return std::count_if(waits.begin(), waits.end(), [t](double w) { return w >= t; });
        };
        const auto waiting = static_cast<double>(later(from));
        const double ended = 1 - static_cast<double>(later(from + 0.3)) / waiting;
        const double closed = 1 - std::exp(-0.3 / 0.5);
        EXPECT_NEAR(ended, closed, 4 * std::sqrt(closed * (1 - closed) / waiting)) << from;
    }
}

TEST(Draws, UniformAndNormalNumbersFollowTheirDistributions) {
    DrawSpec uniform;
    uniform.name = "side_mm";
    uniform.uniform = UniformDraw{-20, 30};
    DrawSpec normal;
    normal.name = "force_N";
    normal.normal = NormalDraw{2, 0.5, {}, {}};
    DrawSpec truncated;
    truncated.name = "some";
    truncated.normal = NormalDraw{2, 0.5, 1.5, 4};
    const auto below = [](double x) { return std::erfc(-(x - 2) / 0.5 / std::sqrt(2)) / 2; };
    for (const uint64_t seed : {1, 2, 3}) {
        EXPECT_GT(p_of(drawn_10000(uniform, seed), [](double x) { return (x + 20) / 50; }),
                  kLeastP);
        EXPECT_GT(p_of(drawn_10000(normal, seed), below), kLeastP);
        EXPECT_GT(p_of(drawn_10000(truncated, seed),
                       [&](double x) { return (below(x) - below(1.5)) / (below(4) - below(1.5)); }),
                  kLeastP);
    }
}

TEST(Draws, AChoiceFollowsItsWeights) {
    DrawSpec draw;
    draw.name = "side";
    draw.choice = {"left", "right", "none"};
    draw.weights = {1, 3, 0};
    std::map<double, int> counts;
    for (const double value : drawn_10000(draw, 1)) ++counts[value];
    EXPECT_EQ(counts.size(), 2u);  // texts are represented by their indices
    EXPECT_NEAR(counts[1], 7500, 4 * std::sqrt(10000 * 0.75 * 0.25));
    draw.choice = {"-1", "2.5"};
    draw.weights.clear();
    counts.clear();
    for (const double value : drawn_10000(draw, 1)) ++counts[value];
    EXPECT_EQ(counts.size(), 2u);
    EXPECT_NEAR(counts[2.5], 5000, 200);
}

TEST(Draws, APermutationHasEachValueEquallyOftenInABlock) {
    DrawSpec draw;
    draw.name = "step";
    draw.permutation = {"1", "2", "3", "4"};
    std::vector<int> blocks(10, 1);
    blocks.resize(22, 2);
    std::set<std::vector<double>> orders;
    for (uint64_t seed = 0; seed < 200; ++seed) {
        const std::vector<double> values = drawn(draw, blocks, 7, seed);
        const auto sorted = [&](size_t from, size_t to) {
            std::vector<double> out(values.begin() + static_cast<long>(from),
                                    values.begin() + static_cast<long>(to));
            orders.insert(out);
            std::sort(out.begin(), out.end());
            return out;
        };
        for (const size_t from : {0u, 4u, 10u, 14u, 18u})
            EXPECT_EQ(sorted(from, from + 4), (std::vector<double>{1, 2, 3, 4}));
    }
    EXPECT_EQ(orders.size(), 24u);
}

TEST(Draws, AreOfTheSeedAndOfTheirNames) {
    EXPECT_EQ(drawn_10000(foreperiod(), 1), drawn_10000(foreperiod(), 1));
    EXPECT_NE(drawn_10000(foreperiod(), 1), drawn_10000(foreperiod(), 2));
    DrawSpec other = foreperiod();
    other.name = "pause_s";
    EXPECT_NE(drawn_10000(foreperiod(), 1), drawn_10000(other, 1));
    DrawSpec number;
    number.name = "who";
    number.participant = true;
    EXPECT_EQ(drawn_10000(number, 1), std::vector<double>(kTrials, 7));
}

TEST(Draws, HaveTheDigitsOfATable) {
    for (const double value : drawn_10000(foreperiod(), 3))
        EXPECT_EQ(value, finite_number(to_csv(Table::Cell(value))));
}

}  // namespace
}  // namespace dihaptic::task::draws_test
