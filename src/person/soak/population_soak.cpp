// A population on the schedule of TwoRateProprioception (64 baseline, 160 at 30 degrees, 16
// reversed, 48 clamped), through the whole program, against the mean of its 32 people.
#include <fmt/format.h>

#include <array>

#include "person/test/reaches.h"

namespace dihaptic::person {
namespace {

struct Figure {
    const char* what;
    size_t from;
    size_t to;
    double people;  ///< [degrees]
};
constexpr std::array kFigures{Figure{"trial 1", 64, 65, 3.5},
                              Figure{"trial 7", 70, 71, 17.6},
                              Figure{"trial 37", 100, 101, 24.2},
                              Figure{"last 32", 192, 224, 26.8},
                              Figure{"end of the reversal", 239, 240, -5.7},
                              Figure{"6th clamp trial", 245, 246, 11.5},
                              Figure{"last 32 of the clamp", 256, 288, 11.1}};
constexpr double kClose = 3;  // [degrees]

/// Mean over people of each figure.
std::array<double, kFigures.size()> population(int people, bool adapts) {
    Sitting sitting("rotation-reversal");
    std::array<double, kFigures.size()> out{};
    for (int i = 1; i <= people; ++i) {
        experiment::Plan plan = sitting.plan();
        Traits traits = draw_person(Objects::device, 1, fmt::format("P{:03d}", i));
        if (!adapts) traits.fast_learning = traits.slow_learning = 0;
        sit_down(plan, traits);
        const Curve curve = reaches(plan);
        for (size_t f = 0; f < kFigures.size(); ++f) {
            double sum = 0;
            double count = 0;
            for (size_t n = kFigures[f].from; n < kFigures[f].to; ++n) {
                if (std::isnan(curve.hand[n])) continue;  // given up three times
                sum += curve.hand[n];
                ++count;
            }
            out[f] += sum / count / people;
        }
    }
    return out;
}

TEST(Population, OfFortyAdaptsAsPeopleDo) {
    const auto mean = population(40, true);
    for (size_t f = 0; f < kFigures.size(); ++f) {
        fmt::print("{:22s} {:6.1f}   people {:6.1f}\n", kFigures[f].what, mean[f],
                   kFigures[f].people);
        EXPECT_NEAR(mean[f], kFigures[f].people, kClose) << kFigures[f].what;
    }
}

TEST(Population, WithoutAdaptationDoesNot) {
    const auto mean = population(10, false);
    int far = 0;
    for (size_t f = 0; f < kFigures.size(); ++f)
        far += std::abs(mean[f] - kFigures[f].people) > kClose ? 1 : 0;
    EXPECT_GE(far, 5);
}

}  // namespace
}  // namespace dihaptic::person
