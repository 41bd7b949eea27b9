// Tests the shipped population on schedules to which nothing was calibrated. README.md describes
// how people behave on these schedules, and the criteria that the tests apply.
#include <fmt/format.h>

#include <algorithm>

#include "person/test/reaches.h"

namespace dihaptic::person {
namespace {

constexpr int kPeople = 60;

struct Sample {
    double mean = 0;
    double sd = 0;
    double error = 0;  ///< standard error of the mean
};

Sample sample(const std::vector<double>& values) {
    Sample out;
    const auto n = static_cast<double>(values.size());
    for (const double value : values) out.mean += value / n;
    for (const double value : values) out.sd += std::pow(value - out.mean, 2) / (n - 1);
    out.sd = std::sqrt(out.sd);
    out.error = out.sd / std::sqrt(n);
    return out;
}

/// The compensation in the blocks of a schedule, for each person and trial.
std::vector<std::vector<double>> curves(const std::string& blocks) {
    Sitting sitting("rotation-reversal");
    sitting.end_with("  blocks:", "  blocks:\n" + blocks);
    std::vector<std::vector<double>> out;
    for (int i = 1; i <= kPeople; ++i) {
        session::Plan plan = sitting.plan();
        sit_down(plan, draw_person(Objects::device, 1, fmt::format("sim-{:03d}", i)));
        out.push_back(reaches(plan).hand);
    }
    return out;
}

std::string block(const std::string& perturb, int repeats) {
    const std::string kind = perturb.empty()      ? "baseline"
                             : perturb == "none"  ? "washout"
                             : perturb == "clamp" ? "visual_clamp, perturb: clamp"
                                                  : "perturbed, perturb: " + perturb;
    static int count = 0;
    return fmt::format("    - {{ name: block {}, kind: {}, repeats: {} }}\n", ++count, kind,
                       repeats);
}

/// The mean over the trials in [from, to), except for trials that were given up.
double over(const std::vector<double>& curve, size_t from, size_t to) {
    double sum = 0;
    double count = 0;
    for (size_t i = from; i < std::min(to, curve.size()); ++i) {
        if (std::isnan(curve[i])) continue;
        sum += curve[i];
        ++count;
    }
    return sum / count;
}

TEST(Schedule, OfSeventeenOthers) {
    struct Place {
        const char* what;
        size_t from, to;
        double mean, sd;  // over people [degrees]
    };
    const auto all =
        curves(block("", 32) + block("rotation", 100) + block("reversal", 12) + block("clamp", 20));
    for (const Place& place :
         {Place{"rotation 2-9", 33, 41, 18.9, 4.5}, Place{"rotation 10-25", 41, 57, 25.0, 2.8},
          Place{"rotation, last 16", 116, 132, 27.9, 3.4},
          Place{"reversal, last 2", 142, 144, -15.6, 9.7}, Place{"clamp 5-12", 148, 156, 6.1, 7.5},
          Place{"clamp, last 8", 156, 164, 6.9, 7.4}}) {
        std::vector<double> values;
        for (const auto& curve : all)
            values.push_back(over(curve, place.from, place.to) - over(curve, 8, 32));
        const Sample found = sample(values);
        const bool mean = std::abs(found.mean - place.mean) <= 3;
        const double ratio = found.sd / place.sd;
        const bool sd = ratio >= 0.74 && ratio <= 1.52;
        fmt::print("A {:18s} {:6.1f} (SD {:4.1f})   people {:6.1f} (SD {:4.1f})  mean {}, SD {}\n",
                   place.what, found.mean, found.sd, place.mean, place.sd, mean ? "ok" : "FAILS",
                   sd ? "ok" : "FAILS");
        EXPECT_TRUE(mean) << place.what;
        EXPECT_TRUE(sd) << place.what;
    }
}

/// How much more slowly people learned the reversal than the rotation before, as a share of the
/// mean over people for the rotation. `initial`: the mean of each person's first 25 trials of the
/// rotation; computed if it is empty.
Sample interference(int first, std::vector<double>& initial) {
    const auto all = curves(block("", 20) + block("rotation", first) + block("reversal", 80));
    const size_t begin = 20 + static_cast<size_t>(first);
    // trial in which the mean curve crosses the baseline
    size_t cross = begin;
    const auto mean = [&](size_t i) {
        double sum = 0;
        for (const auto& curve : all) sum += (std::isnan(curve[i]) ? 0 : curve[i]) / kPeople;
        return sum;
    };
    while (cross + 25 < begin + 80 && mean(cross) > 0) ++cross;
    std::vector<double> slower;
    if (initial.empty()) {
        for (const auto& curve : all) initial.push_back(over(curve, 20, 45));
    }
    const double scale = sample(initial).mean;
    for (size_t i = 0; i < all.size(); ++i)
        slower.push_back((initial[i] + over(all[i], cross, cross + 25)) / scale);
    return sample(slower);
}

TEST(Schedule, OfAnterogradeInterference) {
    std::vector<double> initial;
    const Sample after_112 = interference(112, initial);
    const Sample after_13 = interference(13, initial);
    const Sample after_230 = interference(230, initial);
    for (const auto& [n, found] : {std::pair{13, after_13}, {112, after_112}, {230, after_230}})
        fmt::print("B after {:3d}: slower by {:.3f} of the first, SE {:.3f}\n", n, found.mean,
                   found.error);
    const bool slower = after_112.mean > 2 * after_112.error;
    const bool longer = after_13.mean < after_112.mean;
    const bool level = std::abs(after_230.mean - after_112.mean) < after_112.mean - after_13.mean;
    fmt::print("B slower {}, more so after a longer A {}, levels off {}\n", slower ? "ok" : "FAILS",
               longer ? "ok" : "FAILS", level ? "ok" : "FAILS");
    EXPECT_TRUE(slower);
    EXPECT_TRUE(longer);
    EXPECT_TRUE(level);
}

TEST(Schedule, OfSavingsAfterWashout) {
    const auto all =
        curves(block("", 20) + block("rotation", 60) + block("none", 100) + block("rotation", 20));
    std::vector<double> savings;
    for (const auto& curve : all) savings.push_back(over(curve, 180, 188) - over(curve, 20, 28));
    const Sample found = sample(savings);
    fmt::print("C savings {:.2f} degrees, SE {:.2f}: {}\n", found.mean, found.error,
               found.mean > 2 * found.error ? "ok" : "FAILS");
    EXPECT_GT(found.mean, 2 * found.error);
}

}  // namespace
}  // namespace dihaptic::person
